// SPDX-License-Identifier: GPL-3.0-or-later
#include "benchmark/bench_scene.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <iterator>
#include <utility>

#include "asset_files/asset_file.h"
#include "benchmark/child_process.h"
#include "core/units.h"
#include "input/load_scene.h"
#include "opaline/error.h"
#include "opaline/image.h"
#include "scene/scene_properties.h"
#include "session/scene_hash.h"

namespace opaline {
namespace {

namespace fs = std::filesystem;

constexpr int kQuickWidth = 128;
constexpr std::array<const char*, 2> kProfiles{"dipole", "normalized_diffusion"};
constexpr std::array<const char*, 2> kReferenceSeeds{"101", "102"};

// Random walks of the reference stop at this noise. Fewer cells would smooth the reference visibly: an error
// of volume_diffusion would appear larger.
constexpr std::size_t kWalkedCells = 6000;
constexpr double kWalkNoise = .2;  // walk noise of a cell

void add_sets(std::vector<std::string>& arguments, const std::vector<std::string>& overrides) {
  for (const std::string& text : overrides) arguments.insert(arguments.end(), {"--set", text});
}

/// The requested event of a child; its failure is this run's.
Json answer_of(const OwnChild& child, const std::string& event) {
  if (!child.failure.empty()) throw Error(ErrorKind(child.exit_code), {}, 0, 0, child.failure);
  const Json* answer = child.event(event);
  if (answer == nullptr) throw run_failed("", "a child process returned no result");
  return *answer;
}

std::size_t planned_samples(const BenchScene& scene, Monitor& monitor) {
  std::vector<std::string> line{"info", scene.file, "--log", "json"};
  add_sets(line, scene.overrides);
  std::size_t most = 0;
  const Json plan = answer_of(run_own_child(line, monitor), "plan");
  for (const Json& group : plan.at("groups")) most = std::max(most, group.at("samples").get<std::size_t>());
  return most;
}

std::string quick_resolution(const Film& film) {
  const double aspect = double(film.resolution[1]) / double(film.resolution[0]);
  const long height = std::clamp(std::lround(kQuickWidth * aspect), 1L, 65536L);
  return fmt::format("film.resolution=[{},{}]", kQuickWidth, height);
}

/// Checks a half against the scene's image size, and returns its seed; frees its pixels.
std::string check_half(const std::string& path, const BenchScene& scene) {
  const Image image = read_image(path);
  const Film& film = scene.scene.film;
  const std::array<int, 4> part =
      film.crop.value_or(std::array<int, 4>{0, 0, film.resolution[0], film.resolution[1]});
  const int width = part[2] - part[0], height = part[3] - part[1];
  if (image.width != width || image.height != height || extract_layer(image, "").channels.empty())
    throw bad_file(path, "not a reference of " + scene.file,
                   fmt::format("{} x {} pixels of R, G, B", width, height),
                   fmt::format("{} x {}", image.width, image.height));
  for (const auto& [key, value] : image.metadata)
    if (key == "opaline:seed") return value;
  return "unknown";
}

/// Settings of a reference half: overrides, and its noise threshold as a number and in words.
struct HalfSettings {
  std::vector<std::string> overrides;
  double until_error;
  std::string words;
};

HalfSettings half_settings(const BenchArguments& arguments, const BenchScene& scene) {
  const std::size_t cells = scene.reference.cells;
  if (cells == 0)
    return {{"settings.method=direct", "settings.entry_samples=1000000000"},
            arguments.reference_error,
            fmt::format("direct, until {:.3g} %", 100 * arguments.reference_error)};
  return {{"settings.method=volume", fmt::format("settings.samples={}", cells)},
          kWalkNoise,
          fmt::format("random walks on {} surface cells, until {:.3g} % noise per cell; without re-entry",
                      grouped(cells), 100 * kWalkNoise)};
}

/// Text of the samples and noise of a half.
std::string told(const BenchReference& reference, const Json& done) {
  if (reference.cells == 0)
    return fmt::format("{:.3g} % with {} entry samples per pixel", 100 * done.value("direct_noise", 0.0),
                       grouped(done.value("entry_samples", std::uint64_t{0})));
  return fmt::format("{:.3g} % with {} walks per cell, channel and light",
                     100 * done.value("walk_noise", 0.0), grouped(done.value("walks", std::uint64_t{0})));
}

/// Renders a half, or continues one above the noise threshold; returns its file.
std::string render_half(const BenchArguments& arguments, const std::string& folder, const BenchScene& scene,
                        const std::string& seed, Monitor& monitor) {
  const HalfSettings half_of = half_settings(arguments, scene);
  std::vector<std::string> overrides = scene.overrides;
  overrides.insert(overrides.end(), half_of.overrides.begin(), half_of.overrides.end());
  overrides.push_back("settings.seed=" + seed);
  const std::string stem = fmt::format("{}/{}-{:.16}-seed{}", folder, fs::path(scene.file).stem().string(),
                                       direct_sums_key(scene.file, overrides, scene.scene), seed);
  const std::string half = stem + ".exr";
  // On all cores: it is not timed, and its bytes do not depend on them.
  std::vector<std::string> line{"render", scene.file, "--log",    "json",
                                "-o",     half,       "--resume", stem + ".sums.exr"};
  add_sets(line, overrides);
  add_sets(line, {fmt::format("settings.until_error={}", half_of.until_error)});
  write_line(stderr, fmt::format("bench: reference of {}, seed {}, until {:.3g} %: {}", scene.id, seed,
                                 100 * half_of.until_error, half));
  const OwnChild child = run_own_child(line, monitor);
  const Json done = answer_of(child, "done");
  write_line(stderr, fmt::format("bench:   {}, {}", told(scene.reference, done),
                                 short_time(child.cost.wall_seconds)));
  return half;
}

/// The scene's own seed, or the first one not used by the reference.
std::uint64_t other_seed(std::uint64_t seed, const std::array<std::string, 2>& taken) {
  const auto is_taken = [&](std::uint64_t s) {
    return std::ranges::find(taken, std::to_string(s)) != taken.end();
  };
  if (is_taken(seed))
    for (seed = 0; is_taken(seed);) ++seed;
  return seed;
}

/// error Error{bad_input} naming the rung: an unknown setting, or an invalid value
void check_rungs(const BenchArguments& arguments, const BenchScene& scene) {
  for (const Rung& rung : arguments.rungs) {
    std::vector<std::string> overrides = scene.overrides;
    std::ranges::copy(rung_overrides(scene, rung), std::back_inserter(overrides));
    try {
      load_scene(scene.file, overrides);
    } catch (const Error& failure) {
      throw Error(failure.kind, "--rung " + rung.knob + '=' + rung.value, 0, 0, failure.message,
                  failure.expected, failure.got);
    }
  }
}

/// more: overrides after the user's own.
BenchScene open_bench_scene(const BenchArguments& arguments, const std::string& file,
                            const std::vector<std::string>& more, Monitor& monitor) {
  BenchScene scene;
  scene.file = scene.id = file;
  scene.overrides = arguments.overrides;
  scene.overrides.insert(scene.overrides.end(), more.begin(), more.end());
  scene.scene = load_scene(file, scene.overrides);
  // Before the user's overrides, which win.
  if (scene.scene.settings.method == Method::automatic)
    scene.overrides.insert(scene.overrides.begin(), "settings.method=hierarchical");  // whose settings vary
  if (arguments.quick) scene.overrides.insert(scene.overrides.begin(), quick_resolution(scene.scene.film));
  // Half precision would round them to 0.05 %.
  scene.overrides.emplace_back("film.pixel_type=float");
  scene.scene = load_scene(file, scene.overrides);
  scene.name = fs::path(file).stem().string();
  scene.key = scene_hash(file, scene.overrides, scene.scene);
  scene.planned_samples = planned_samples(scene, monitor);
  scene.rungs = ladder({scene.planned_samples, arguments.quick, bounces_of(scene.scene) > 0});
  scene.rungs.insert(scene.rungs.end(), arguments.rungs.begin(), arguments.rungs.end());
  check_rungs(arguments, scene);
  if (scene.planned_samples == 0)
    print_warning({}, file + ": the scene has no translucent shape, so no setting trades error for time");
  return scene;
}

/// The scene for comparing models with random walks, without light between shapes.
BenchScene open_truth(const BenchArguments& arguments, const std::string& file, Monitor& monitor) {
  BenchScene scene =
      open_bench_scene(arguments, file, {"settings.bounces=0", "settings.reenter=false"}, monitor);
  scene.id += " (random walks)";
  scene.name += "-walks";
  scene.key += "-walks";
  scene.rungs = truth_ladder(arguments.quick);
  scene.rungs.insert(scene.rungs.end(), arguments.rungs.begin(), arguments.rungs.end());
  scene.reference.cells = std::min(scene.planned_samples, kWalkedCells);
  return scene;
}

}  // namespace

std::vector<std::string> rung_overrides(const BenchScene& scene, const Rung& rung) {
  std::vector<std::string> media;
  for (const Medium& medium : scene.scene.media) media.push_back(medium.name);
  std::vector<std::string> overrides = overrides_of(rung, media);
  if (rung.method == "direct") {
    overrides.push_back(fmt::format("settings.seed={}", scene.direct_seed));
    // Its knob is the number of entry samples, independent of the scene's noise threshold.
    if (scene.scene.settings.until_error) overrides.emplace_back("settings.until_error=1e-30");
  }
  return overrides;
}

std::vector<BenchScene> open_bench_scenes(const BenchArguments& arguments, const std::string& file,
                                          Monitor& monitor) {
  std::vector<BenchScene> scenes{open_bench_scene(arguments, file, {}, monitor)};
  if (scenes[0].planned_samples == 0) return scenes;
  if (arguments.truth) scenes.push_back(open_truth(arguments, file, monitor));
  if (!arguments.profiles) return scenes;
  const BenchScene own = std::move(scenes[0]);
  scenes.erase(scenes.begin());
  for (const char* profile : kProfiles) {
    std::vector<std::string> more;
    for (const Medium& medium : own.scene.media)
      more.push_back(fmt::format("media.{}.profile={}", medium.name, profile));
    BenchScene& scene = *scenes.insert(scenes.end() - (arguments.truth ? 1 : 0),
                                       open_bench_scene(arguments, file, more, monitor));
    scene.id += fmt::format(" ({})", profile);
    scene.name += fmt::format("-{}", profile);
  }
  return scenes;
}

void prepare_reference(const BenchArguments& arguments, const std::string& folder, BenchScene& scene,
                       Monitor& monitor) {
  BenchReference& reference = scene.reference;
  const bool given = !arguments.halves.empty() && reference.cells == 0;
  reference.made = given ? "given" : half_settings(arguments, scene).words;
  for (std::size_t i = 0; i < 2; ++i) {
    reference.halves[i] =
        given ? arguments.halves[i] : render_half(arguments, folder, scene, kReferenceSeeds[i], monitor);
    reference.seeds[i] = check_half(reference.halves[i], scene);
  }
  scene.direct_seed = other_seed(scene.scene.settings.seed, reference.seeds);
}

std::vector<std::string> render_arguments(const BenchArguments& arguments, const BenchScene& scene,
                                          const std::vector<std::string>& overrides) {
  std::vector<std::string> line{"render", scene.file,  "--log",
                                "json",   "--threads", std::to_string(arguments.threads)};
  if (are_files_outside_assets_allowed()) line.push_back("--allow-outside");
  add_sets(line, scene.overrides);
  add_sets(line, overrides);
  return line;
}

}  // namespace opaline
