// SPDX-License-Identifier: GPL-3.0-or-later
// `opaline bench`: cost and error of a scene's settings.
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

/// Measures each scene's rungs, prints a table and writes the CSV and the report. Returns the exit code: 0, 3
/// if a rung failed, or 1 if one is worse than in earlier results.
/// error Error{bad_input}: an unusable scene, half or file of earlier results; Error{run_failed}: the
///       reference or an output failed; Error{interrupted}: the old outputs remain
int bench_command(const BenchArguments& arguments);

}  // namespace opaline
