// SPDX-License-Identifier: GPL-3.0-or-later
#include "model_table.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <optional>
#include <vector>

#include "core/units.h"
#include "input/load_scene.h"
#include "methods/volume/volume_state.h"
#include "opaline/error.h"
#include "plan/expected_error.h"
#include "scene/names.h"
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
  std::string name, text;
};

NamedText mesh_file(const std::string& name, const std::string& path) {
  return {name, fmt::format(R"("file": "{}", "fit_size": 50, "fill_holes": true)", path)};
}

NamedText lying_plate(double thickness) {
  return {fmt::format("plate, 30 x 30 x {} mm", thickness),
          fmt::format(R"("slab": {{"center": [0, 25, 0], "width": 30, "depth": 30, "thickness": {}}},
      "normals": "faceted")",
                      thickness)};
}

// The bunny's lights stand above and on both sides: of a plate that lies they light one side, of a fin both.
std::vector<NamedText> table_shapes() {
  return {{"sphere, 25 mm across", R"("sphere": {"center": [0, 25, 0], "radius": 12.5})"},
          lying_plate(1),
          lying_plate(4),
          {"fin, 20 x 20 x 2 mm",
           R"("slab": {"width": 20, "depth": 20, "thickness": 2}, "normals": "faceted",
      "transform": [{"rotate": {"axis": [1, 0, 0], "degrees": 90}}, {"translate": [0, 25, 0]}])"},
          mesh_file("bunny, 50 mm", OPALINE_SCENES_DIR "/assets/bunny.obj")};
}

std::vector<NamedText> table_media() {
  return {{"marble", "marble"}, {"milk", "wholemilk"}, {"skin1", "skin1"}};
}

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

/// A shape in a medium, and its file without the ending.
struct Pair {
  NamedText shape, medium;
  std::string stem;
};

std::vector<Pair> all_pairs(const std::string& folder, const std::vector<NamedText>& shapes) {
  std::filesystem::create_directories(folder);
  std::vector<Pair> pairs;
  for (const NamedText& shape : shapes)
    for (const NamedText& medium : table_media()) {
      Pair& pair = pairs.emplace_back(Pair{shape, medium, folder + "/"});
      for (const char letter : fmt::format("{} {}", shape.name, medium.name))
        if (letter != ',') pair.stem += letter == ' ' ? '-' : letter;
    }
  return pairs;
}

std::string title_of(const Pair& pair) {
  return fmt::format("{} {}", pair.shape.name, pair.medium.name);
}

/// parts: of titles; empty: all
bool is_asked(const Pair& pair, std::span<const std::string> parts) {
  const std::string title = title_of(pair);
  return parts.empty() || std::ranges::any_of(parts, [&](const std::string& part) {
           return title.find(part) != std::string::npos;
         });
}

Scene scene_of(const Pair& pair, const std::vector<std::string>& overrides) {
  const std::string file = pair.stem + ".json";
  std::ofstream(file) << scene_text(pair.shape, pair.medium);
  return load_scene(file, overrides);
}

/// Random walks on the cells of kCells samples.
struct WalkedCells {
  Truth truth;
  std::vector<SurfaceSample> samples;
};

WalkedCells walked_cells(const Pair& pair, bool reenters) {
  const std::string path = pair.stem + (reenters ? "-reenter.truth" : ".truth");
  WalkedCells cells;
  Scene scene = scene_of(pair, {});
  scene.settings.samples = kCells;
  scene.settings.until_error = kUntilError;
  scene.settings.reenter = reenters;
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

/// rms / bias / p99 of the worst channel, in %.
std::string worst_error(const Session& session, const WalkedCells& cells) {
  const std::array<ModelError, 3> errors = measured_errors(session, cells);
  const ModelError& worst = *std::ranges::max_element(errors, {}, &ModelError::rms);
  return fmt::format("{:.1f} / {:+.1f} / {:.0f}", 100 * worst.rms, 100 * worst.bias, 100 * worst.p99);
}

/// User CPU from the scene to its image, s: the median of three.
double picture_seconds(const Scene& scene) {
  const auto once = [&] {
    return user_seconds([&] {
      Session session;
      session.expect_edits(false);
      session.edit(scene);
      session.render();
    });
  };
  return median({once(), once(), once()});
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
  fmt::print(
      "rms / bias / p99 of the worst channel in % of the mean exitance, over {} cells; bold: chosen by "
      "`auto`\n\n| shape | medium |",
      kCells);
  for (const Model& model : models) fmt::print(" {} |", model.name);
  fmt::print("\n|---|---|");
  for (std::size_t m = 0; m < models.size(); ++m) fmt::print("---|");
  std::vector<std::vector<double>> costs(models.size());
  for (const Pair& pair : all_pairs(folder, table_shapes())) {
    const Scene scene = scene_of(pair, {});
    const WalkedCells cells = walked_cells(pair, /*reenters=*/false);
    fmt::print("\n| {} | {} |", pair.shape.name, pair.medium.name);
    const ChosenProfile chosen = chosen_profile(scene);
    const double lambert = picture_seconds(with_model(scene, {"", Method::lambert}, chosen));
    for (std::size_t m = 0; m < models.size(); ++m) {
      const Scene modelled = with_model(scene, models[m], chosen);
      Session session;
      session.edit(modelled);
      session.prepare();
      const std::string error = worst_error(session, cells);
      const bool is_chosen = models[m].method == Method::hierarchical && models[m].profile == chosen.kind;
      const char* mark = is_chosen ? "**" : "";
      fmt::print(" {}{}{} |", mark, error, mark);
      std::fflush(stdout);
      costs[m].push_back(picture_seconds(modelled) / lambert);
    }
  }
  fmt::print("\n| user CPU over lambert, median | |");
  for (const std::vector<double>& cost : costs) fmt::print(" {:.1f} |", median(cost));
  fmt::print("\n");
}

void print_default_table(const std::string& folder, std::span<const std::string> meshes_and_parts) {
  std::vector<NamedText> shapes = table_shapes();
  shapes.insert(shapes.begin() + 1, lying_plate(.5));
  std::vector<std::string> parts;
  for (const std::filesystem::path path : meshes_and_parts)
    if (std::filesystem::exists(path))
      shapes.push_back(mesh_file(path.stem(), std::filesystem::absolute(path)));
    else
      parts.push_back(path);
  const std::vector<Pair> pairs = all_pairs(folder, shapes);
  for (const std::string& part : parts)
    if (std::ranges::none_of(pairs, [&](const Pair& pair) { return is_asked(pair, {&part, 1}); }))
      throw bad_file(part, "is neither a file nor part of a row", "a mesh, or as \"bunny, 50 mm milk\"", "");
  fmt::print(
      "rms / bias / p99 of the worst channel in % of the mean exitance, over {} cells, with re-entry\n\n"
      "| shape | medium | error | expected | method | user CPU over lambert |\n"
      "|---|---|---|---|---|---|\n",
      kCells);
  for (const Pair& pair : pairs) {
    if (!is_asked(pair, parts)) continue;
    const WalkedCells cells = walked_cells(pair, /*reenters=*/true);
    Scene scene = scene_of(pair, {});
    scene.settings.method = Method::lambert;
    const double lambert = picture_seconds(scene);
    scene.settings.method = Method::automatic;
    Session session;
    session.edit(scene);
    session.prepare();
    const BodyPlan& body = session.plan().groups.at(0);
    const std::optional<double> expected = expected_error(body.model, body.method);
    fmt::print("| {} | {} | {} | {} | {} | {:.1f} |\n", pair.shape.name, pair.medium.name,
               worst_error(session, cells), expected ? short_percent(*expected) : "unknown",
               name_of(body.method), picture_seconds(scene) / lambert);
    std::fflush(stdout);
  }
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
  fmt::print("rms / bias / p99 in %: R, G, B; user CPU of the exitance, s\n");
  for (const Pair& pair : all_pairs(folder, table_shapes())) {
    if (!is_asked(pair, parts)) continue;
    const WalkedCells cells = walked_cells(pair, /*reenters=*/false);
    const Scene scene = scene_of(pair, overrides);
    const Scene modelled = with_model(scene, *model, chosen_profile(scene));
    Session session;
    const double seconds = user_seconds([&] {
      session.edit(modelled);
      session.prepare();
    });
    fmt::print("{:<30}", title_of(pair));
    for (const ModelError& error : measured_errors(session, cells))
      fmt::print(" {:6.2f} /{:+6.2f} /{:5.1f}  ", 100 * error.rms, 100 * error.bias, 100 * error.p99);
    fmt::print("{:6.2f}\n", seconds);
    std::fflush(stdout);
  }
}

}  // namespace opaline
