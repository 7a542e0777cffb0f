// SPDX-License-Identifier: GPL-3.0-or-later
// A scene of a benchmark: its rungs, its reference.
#pragma once

#include <array>
#include <cstdint>
#include <set>
#include <string>
#include <vector>

#include "benchmark/bench_command.h"
#include "benchmark/ladder.h"
#include "opaline/monitor.h"
#include "opaline/scene.h"

namespace opaline {

/// Two pictures with independent noise, by `direct` or by random walks.
struct BenchReference {
  std::array<std::string, 2> halves;  ///< file names
  std::array<std::string, 2> seeds;   ///< "unknown" where a file does not say
  std::string made;                   ///< in words
  std::size_t cells = 0;              ///< cells of random walks, on the body with the most; 0: `direct`
};

struct BenchScene {
  std::string file;
  std::string id;                      ///< in rows: the file, and the profile where each has its turn
  std::string name;                    ///< without folders, for files; no two alike
  std::string key;                     ///< scene_hash of what every run renders
  std::vector<std::string> overrides;  ///< overrides of every run, before those of a setting
  Scene scene;                         ///< without its meshes
  std::size_t planned_samples = 0;     ///< planned samples of the group with the most
  std::vector<Rung> rungs;
  BenchReference reference;
  std::uint64_t direct_seed = 0;  ///< seed of the direct runs, distinct from those of the reference
};

/// Its settings and rungs, once, or once for each profile if that is asked for and something is translucent; with
/// `truth` once more, against random walks. The plan is asked of a child process.
/// error Error{bad_input} as load_scene and make_plan
std::vector<BenchScene> open_bench_scenes(const BenchArguments& arguments, const std::string& file,
                                          Monitor& monitor);

/// The user's halves (against random walks never), or two renderings, kept in and taken from `folder` under names that
/// hold their key.
/// error Error{bad_input}: halves of another size; Error{run_failed}: a rendering failed
void prepare_reference(const BenchArguments& arguments, const std::string& folder, BenchScene& scene,
                       Monitor& monitor);

/// Overrides of a run, after those of the scene.
std::vector<std::string> rung_overrides(const BenchScene& scene, const Rung& rung);

/// Command line of a run, for run_own_child; "-o" and the picture are still missing.
std::vector<std::string> render_arguments(const BenchArguments& arguments, const BenchScene& scene,
                                          const std::vector<std::string>& overrides);

}  // namespace opaline
