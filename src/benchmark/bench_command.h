// SPDX-License-Identifier: GPL-3.0-or-later
// `opaline bench`: what a scene's settings cost, and how far off their pictures are.
#pragma once

#include <string>
#include <vector>

#include "benchmark/ladder.h"
#include "core/log.h"

namespace opaline {

struct BenchArguments {
  std::vector<std::string> scenes;     ///< at least one
  std::vector<std::string> overrides;  ///< for load_scene
  std::string csv, report;             ///< file, folder; empty: none
  std::string against;                 ///< results.json of an earlier benchmark; empty: none
  std::vector<std::string> halves;     ///< none, or two with a single scene
  double reference_error = 0;
  std::string reference_dir;  ///< empty: in the report, or beside the CSV
  std::vector<Rung> rungs;    ///< more than the ladder has
  int repeats = 3, threads = 1;
  bool quick = false;
  bool profiles = false;  ///< each translucent scene with each radial profile
  bool truth = false;     ///< each translucent scene against random walks, too
  std::string command_line;
  Log log;
};

/// Measures each scene's rungs, prints a table and writes the CSV and the report; the exit code: 0, or 3
/// where a rung failed, or 1 where one is worse than in earlier results.
/// error Error{bad_input}: a scene, half or earlier results that cannot be used; Error{run_failed}: the
///       reference cannot be made, an output not be written; Error{interrupted}: the old outputs stay
int bench_command(const BenchArguments& arguments);

}  // namespace opaline
