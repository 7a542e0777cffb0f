// SPDX-License-Identifier: GPL-3.0-or-later
#include "model_table.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <string_view>
#include <vector>

#include "input/load_scene.h"
#include "methods/volume/volume_state.h"
#include "opaline/error.h"
#include "subsurface/method.h"
#include "user_seconds.h"
#include "volume/nearest_sample.h"
#include "volume_truth.h"

namespace opaline {
namespace {

constexpr std::size_t kCells = 2000;
constexpr double kUntilError = .035;  // of a cell
constexpr std::size_t kPointsOfCell = 40;

struct NamedText {
  std::string_view name, text;
};
// The bunny's lights stand above and on both sides: of a plate that lies they light one side, of a fin both.
constexpr std::array<NamedText, 5> kShapes{{
    {"sphere, 25 mm across", R"("sphere": {"center": [0, 25, 0], "radius": 12.5})"},
    {"plate, 30 x 30 x 1 mm",
     R"("slab": {"center": [0, 25, 0], "width": 30, "depth": 30, "thickness": 1}, "normals": "faceted")"},
    {"plate, 30 x 30 x 4 mm",
     R"("slab": {"center": [0, 25, 0], "width": 30, "depth": 30, "thickness": 4}, "normals": "faceted")"},
    {"fin, 20 x 20 x 2 mm",
     R"("slab": {"width": 20, "depth": 20, "thickness": 2}, "normals": "faceted",
      "transform": [{"rotate": {"axis": [1, 0, 0], "degrees": 90}}, {"translate": [0, 25, 0]}])"},
    {"bunny, 50 mm",
     R"("file": ")" OPALINE_SCENES_DIR R"(/assets/bunny.obj", "fit_size": 50, "fill_holes": true)"},
}};
constexpr std::array<NamedText, 3> kMedia{{{"marble", "marble"}, {"milk", "wholemilk"}, {"skin1", "skin1"}}};

struct Model {
  std::string name;
  Method method = Method::hierarchical;
  ProfileKind profile = ProfileKind::dipole;
};

std::vector<Model> all_models() {
  std::vector<Model> models;
  for (std::size_t kind = 0; kind < kProfileNames.size(); ++kind)
    if (ProfileKind(kind) != ProfileKind::directional_dipole)  // by `direct` alone
      models.push_back({std::string(kProfileNames[kind]), Method::hierarchical, ProfileKind(kind)});
  models.push_back({"volume_diffusion", Method::volume_diffusion});
  return models;
}

std::string scene_text(const NamedText& shape, const NamedText& medium) {
  return fmt::format(R"({{
  "media": {{"medium": {{"preset": "{}"}}}},
  "shapes": [{{"name": "body", {}, "medium": "medium"}}],
  "lights": [
    {{"name": "back", "type": "point", "position": [-60, 90, -60], "intensity": 60000}},
    {{"name": "front", "type": "point", "position": [70, 70, 110], "intensity": 30000}}
  ],
  "camera": {{"position": [0, 32, 140], "look_at": [0, 24, 0], "field_of_view": 25}},
  "film": {{"resolution": [512, 512]}}
}}
)",
                     medium.text, shape.text);
}

/// Random walks on the cells of kCells samples.
struct WalkedCells {
  Truth truth;
  std::vector<SurfaceSample> samples;
};

WalkedCells walked_cells(Scene scene, const std::string& path) {
  WalkedCells cells;
  scene.settings.samples = kCells;
  scene.settings.until_error = kUntilError;
  scene.settings.reenter = false;  // as with all models
  const bool is_there = read_truth(path, cells.truth);
  scene.settings.method = is_there ? Method::hierarchical : Method::volume;
  Session session;
  session.edit(scene);
  session.prepare();
  const Body& body = session.bodies()[0];
  cells.samples = body.surface.samples;
  if (is_there) return cells;
  cells.truth = {volume_state(body).exitance.value.exitance, volume_state(body).exitance.value.error};
  write_truth(path, cells.truth);
  fmt::print(stderr, "{}: {} walks a cell, error {:.1f} %\n", path, volume_state(body).exitance.value.walks,
             100 * volume_state(body).exitance.value.relative_error);
  return cells;
}

/// Shares of the mean exitance, in the channel of the largest rms.
struct ModelError {
  double rms = 0, bias = 0, p99 = 0;
};

ModelError channel_error(const WalkedCells& cells, const std::vector<Rgb>& means,
                         const std::vector<bool>& is_known, std::size_t c) {
  double squares = 0, bias = 0, mean = 0, area = 0;
  std::vector<double> sizes;
  for (std::size_t i = 0; i < means.size(); ++i) {
    if (!is_known[i]) continue;
    const double a = double(cells.samples[i].area), truth = double(cells.truth.exitance[i][c]),
                 noise = double(cells.truth.error[i][c]), difference = means[i][c] - truth;
    squares += a * (difference * difference - noise * noise);
    bias += a * difference;
    mean += a * truth;
    area += a;
    sizes.push_back(std::sqrt(std::max(0.0, difference * difference - noise * noise)));
  }
  mean /= area;
  const auto p99 = sizes.begin() + std::ptrdiff_t(.99 * double(sizes.size()));
  std::ranges::nth_element(sizes, p99);
  return {std::sqrt(std::max(0.0, squares / area)) / mean, bias / area / mean, *p99 / mean};
}

/// R, G, B, from the exitance at points all over the surface.
std::array<ModelError, 3> errors_of(const WalkedCells& cells, const Session& session,
                                    std::span<const SurfaceSample> points,
                                    const std::vector<RgbF>& exitance) {
  const NearestSample nearest(cells.samples, &session.world());
  std::vector<Rgb> means(cells.samples.size());
  std::vector<double> areas(cells.samples.size());
  for (std::size_t i = 0; i < points.size(); ++i) {
    const std::uint32_t cell = nearest.at(points[i].position, points[i].normal);
    means[cell] += Rgb(exitance[i]) * double(points[i].area);
    areas[cell] += double(points[i].area);
  }
  std::vector<bool> is_known(areas.size());
  for (std::size_t i = 0; i < areas.size(); ++i) {
    is_known[i] = areas[i] > 0;
    if (is_known[i]) means[i] = means[i] / areas[i];
  }
  std::array<ModelError, 3> errors;
  for (std::size_t c = 0; c < 3; ++c) errors[c] = channel_error(cells, means, is_known, c);
  return errors;
}

const ModelError& worst_of(const std::array<ModelError, 3>& errors) {
  return *std::ranges::max_element(errors, {}, &ModelError::rms);
}

/// By `auto`.
ChosenProfile chosen_profile(const Scene& scene) {
  Session session;
  session.edit(scene);
  return session.plan().groups.at(0).model.profile;
}

/// chosen: by `auto`, whose thickness a multipole takes.
Scene with_model(Scene scene, const Model& model, const ChosenProfile& chosen) {
  scene.settings.method = model.method;
  scene.settings.reenter = false;
  scene.media[0].profile = model.profile;
  scene.media[0].thickness = chosen.thickness;
  return scene;
}

std::array<ModelError, 3> measured_errors(const Session& session, const WalkedCells& cells) {
  const SurfaceSamples points = sample_surface({.world = session.world(),
                                                .meshes = session.bodies()[0].plan.meshes,
                                                .count = kPointsOfCell * kCells,
                                                .seed = 99});
  return errors_of(cells, session, points.samples, exitance_at(session, points.samples));
}

/// User CPU from the scene to its picture, s: the smaller of two.
double picture_seconds(const Scene& scene) {
  const auto once = [&] {
    return user_seconds([&] {
      Session session;
      session.expect_edits(false);
      session.edit(scene);
      session.render();
    });
  };
  return std::min(once(), once());
}

/// A shape in a medium, and its file without the ending.
struct Pair {
  const NamedText *shape, *medium;
  std::string stem;
};

std::vector<Pair> all_pairs(const std::string& folder) {
  std::vector<Pair> pairs;
  for (const NamedText& shape : kShapes)
    for (const NamedText& medium : kMedia) {
      Pair& pair = pairs.emplace_back(Pair{&shape, &medium, folder + "/"});
      for (const char letter : fmt::format("{} {}", shape.name, medium.name))
        if (letter != ',') pair.stem += letter == ' ' ? '-' : letter;
    }
  return pairs;
}

Scene scene_of(const Pair& pair, const std::vector<std::string>& overrides) {
  const std::string file = pair.stem + ".json";
  std::ofstream(file) << scene_text(*pair.shape, *pair.medium);
  return load_scene(file, overrides);
}

}  // namespace

std::vector<RgbF> exitance_at(const Session& session, std::span<const SurfaceSample> places) {
  const Body& body = session.bodies()[0];
  std::vector<Vec3d> points;
  std::vector<Vec3f> normals;
  for (const SurfaceSample& s : places) {
    points.push_back(out_of_world(session.world(), Vec3d(s.position)));
    normals.push_back(s.normal);
  }
  return radiant_exitance(body, session.world(), points, normals, session.scene().settings);
}

void print_model_table(const std::string& folder) {
  const std::vector<Model> models = all_models();
  std::filesystem::create_directories(folder);
  fmt::print(
      "rms / bias / p99 of the worst channel in % of the mean exitance, over {} cells; bold: chosen by "
      "`auto`\n\n| shape | medium |",
      kCells);
  for (const Model& model : models) fmt::print(" {} |", model.name);
  fmt::print("\n|---|---|");
  for (std::size_t m = 0; m < models.size(); ++m) fmt::print("---|");
  std::vector<std::vector<double>> costs(models.size());
  for (const Pair& pair : all_pairs(folder)) {
    const Scene scene = scene_of(pair, {});
    const WalkedCells cells = walked_cells(scene, pair.stem + ".truth");
    fmt::print("\n| {} | {} |", pair.shape->name, pair.medium->name);
    const ChosenProfile chosen = chosen_profile(scene);
    const double lambert = picture_seconds(with_model(scene, {"", Method::lambert}, chosen));
    for (std::size_t m = 0; m < models.size(); ++m) {
      const Scene modelled = with_model(scene, models[m], chosen);
      Session session;
      session.edit(modelled);
      session.prepare();
      const ModelError error = worst_of(measured_errors(session, cells));
      const bool is_chosen = models[m].method == Method::hierarchical && models[m].profile == chosen.kind;
      const char* mark = is_chosen ? "**" : "";
      fmt::print(" {}{:.1f} / {:+.1f} / {:.0f}{} |", mark, 100 * error.rms, 100 * error.bias, 100 * error.p99,
                 mark);
      std::fflush(stdout);
      costs[m].push_back(picture_seconds(modelled) / lambert);
    }
  }
  fmt::print("\n| user CPU over lambert, median | |");
  for (const std::vector<double>& cost : costs) fmt::print(" {:.1f} |", median(cost));
  fmt::print("\n");
}

void print_model_channels(const std::string& folder, const std::string& name,
                          const std::vector<std::string>& choices) {
  std::vector<std::string> overrides, parts;
  for (const std::string& choice : choices)
    (choice.find('=') != std::string::npos ? overrides : parts).push_back(choice);
  const std::vector<Model> models = all_models();
  const auto model = std::ranges::find(models, name, &Model::name);
  if (model == models.end())
    throw bad_file(folder, "no model of the table", "volume_diffusion or a profile", name);
  std::filesystem::create_directories(folder);
  fmt::print("rms / bias / p99 in %: R, G, B; user CPU of the exitance, s\n");
  for (const Pair& pair : all_pairs(folder)) {
    const std::string title = fmt::format("{} {}", pair.shape->name, pair.medium->name);
    const auto is_in_title = [&](const std::string& part) { return title.find(part) != std::string::npos; };
    if (!parts.empty() && std::ranges::none_of(parts, is_in_title)) continue;
    const WalkedCells cells = walked_cells(scene_of(pair, {}), pair.stem + ".truth");
    const Scene scene = scene_of(pair, overrides);
    const Scene modelled = with_model(scene, *model, chosen_profile(scene));
    Session session;
    const double seconds = user_seconds([&] {
      session.edit(modelled);
      session.prepare();
    });
    fmt::print("{:<30}", title);
    for (const ModelError& error : measured_errors(session, cells))
      fmt::print(" {:6.2f} /{:+6.2f} /{:5.1f}  ", 100 * error.rms, 100 * error.bias, 100 * error.p99);
    fmt::print("{:6.2f}\n", seconds);
    std::fflush(stdout);
  }
}

}  // namespace opaline
