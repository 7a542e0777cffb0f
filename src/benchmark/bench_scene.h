// SPDX-License-Identifier: GPL-3.0-or-later
// A scene of a benchmark: its rungs, its reference.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "benchmark/bench_command.h"
#include "benchmark/ladder.h"
#include "opaline/monitor.h"
#include "opaline/scene.h"

namespace opaline {

/// Two images with independent noise, by `direct` or by random walks.
struct BenchReference {
  std::array<std::string, 2> halves;  ///< file names
  std::array<std::string, 2> seeds;   ///< "unknown" where a file does not say
  std::string made;                   ///< in words
  std::size_t cells = 0;              ///< cells of random walks, on the body with the most; 0: `direct`
};

struct BenchScene {
  std::string file;
  std::string id;                      ///< in rows: the file, and the profile if each is measured
  std::string name;                    ///< without folders, for files; no two alike
  std::string key;                     ///< scene_hash of the runs' scene
  std::vector<std::string> overrides;  ///< overrides of every run, before those of a setting
  Scene scene;                         ///< without its meshes
  std::size_t planned_samples = 0;     ///< planned samples of the group with the most
  std::vector<Rung> rungs;
  BenchReference reference;
  std::uint64_t direct_seed = 0;  ///< seed of the direct runs, distinct from those of the reference
};

/// Settings and rungs of a scene, once, or once per profile on request if a shape is translucent; with
/// `truth` once more against random walks. A child process makes the plan.
/// error Error{bad_input} as load_scene and make_plan
std::vector<BenchScene> open_bench_scenes(const BenchArguments& arguments, const std::string& file,
                                          Monitor& monitor);

/// Uses the user's halves (never against random walks), or renders two, cached in `folder` under names with
/// their key.
/// error Error{bad_input}: halves of another size; Error{run_failed}: a rendering failed
void prepare_reference(const BenchArguments& arguments, const std::string& folder, BenchScene& scene,
                       Monitor& monitor);

/// Overrides of a run, after those of the scene.
std::vector<std::string> rung_overrides(const BenchScene& scene, const Rung& rung);

/// Command line of a run, for run_own_child; without "-o" and the image.
std::vector<std::string> render_arguments(const BenchArguments& arguments, const BenchScene& scene,
                                          const std::vector<std::string>& overrides);

}  // namespace opaline
