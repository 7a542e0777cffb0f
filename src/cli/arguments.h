// SPDX-License-Identifier: GPL-3.0-or-later
// The command line as data.
#pragma once

#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "cli/log.h"
#include "opaline/report/ladder.h"

namespace opaline {

struct RenderArguments {
  std::string scene;
  /// For load_scene: what the short options mean, in a fixed order, then every --set in the order given.
  std::vector<std::string> overrides;
  std::vector<std::string> outputs;  ///< at least one; .exr or .png, no two alike
  std::string samples_ply;           ///< empty: none
  std::string resume;                ///< file of a direct rendering's sums to go on from; empty: none
  int threads = 0;                   ///< 0: one for each core
  bool timings_in_metadata = false;
  Log log;
};

struct InfoArguments {
  std::string scene;
  std::vector<std::string> overrides;
  Log log;
};

struct CompareArguments {
  std::string picture;
  std::string reference;            ///< empty with halves
  std::vector<std::string> halves;  ///< none or two
  std::string layer;                ///< empty: R, G, B
  std::string error_picture;        ///< empty: none; .exr or .png
  std::optional<double> fail_above, exposure;
  Log log;
};

struct BenchArguments {
  std::vector<std::string> scenes;     ///< at least one
  std::vector<std::string> overrides;  ///< as RenderArguments
  std::string csv, report;          ///< file, folder; empty: none
  std::string against;              ///< results.json of an earlier benchmark; empty: none
  std::vector<std::string> halves;  ///< none, or two with a single scene
  double reference_error = 0;
  std::string reference_dir;  ///< empty: in the report, or beside the CSV
  std::vector<Rung> rungs;    ///< more than the ladder has
  int repeats = 3, threads = 1;
  bool quick = false;
  std::string command_line;
  Log log;
};

/// --help or --version: text to print, and done.
struct ShowText {
  std::string text;
};

using Command = std::variant<ShowText, RenderArguments, InfoArguments, CompareArguments, BenchArguments>;

enum class OutputFormat { exr, png, unknown };
OutputFormat output_format(const std::string& path);  ///< by extension, upper or lower case

/// error Error{bad_input}: an unknown option, a value that is not one, an output that is neither EXR nor PNG
Command parse_arguments(int argc, const char* const* argv);

}  // namespace opaline
