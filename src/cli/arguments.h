// SPDX-License-Identifier: GPL-3.0-or-later
// The command line as data.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "benchmark/bench_command.h"
#include "cache/blob_cache.h"
#include "core/log.h"
#include "image/picture_layers.h"
#include "opaline/error.h"
#include "view/view_server.h"

namespace opaline {

struct RenderArguments {
  std::string program;       ///< as it was called
  std::string command_line;  ///< all of it, for a shell
  std::string scene;
  /// For load_scene: what the short options mean, in a fixed order, then every --set in the order given.
  std::vector<std::string> overrides;
  std::vector<std::string> outputs;        ///< at least one; .exr or .png, no two alike
  LayerChoice layers{false, {"diffuse"}};  ///< layers of the EXR files, beside R, G, B and A
  std::string samples_ply;                 ///< empty: none
  std::string resume;                      ///< file of a direct rendering's sums to go on from; empty: none
  std::string cache;                       ///< folder of stage results; empty: none
  std::uint64_t cache_bytes = BlobCache::kDefaultBytes;
  std::vector<int> frames;  ///< empty: one picture; else outputs have a place for the frame's number
  int threads = 0;          ///< 0: one for each core
  bool timings_in_metadata = false;
  std::optional<double> target_error;  ///< settings are chosen for it; relative, > 0
  std::optional<double> time_budget;   ///< settings are chosen for it; CPU of the whole process, s, > 0
  bool verify = false;                 ///< measure the error of the picture
  bool gives_entry_samples = false, gives_until_error = false;  ///< the options, not --set
  Log log;
};

/// The samples, light and trees of frames, into a cache.
struct PrecomputeArguments {
  std::string scene;
  std::vector<std::string> overrides;
  std::string cache;
  std::uint64_t cache_bytes = BlobCache::kDefaultBytes;
  std::vector<int> frames;  ///< empty: no range, the scene as it is
  int threads = 0;
  Log log;
};

/// An asset of another program, to be written as a scene file.
struct ImportArguments {
  std::string asset;
  std::string scene;       ///< to write
  std::string material;    ///< MaterialX, in place of the asset's materials; empty: these
  bool overwrite = false;  ///< a scene that is there and says something else
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

/// A medium's radial profiles beside random walks.
struct ProfileArguments {
  std::string medium;               ///< a preset's name, or a JSON object as a scene's media have
  std::optional<double> eta, g;     ///< in place of the medium's
  std::optional<double> thickness;  ///< mm; none: a half space
  std::optional<std::uint64_t> walks;
  std::uint64_t seed = 1;
  std::string report;  ///< folder; empty: none
  int threads = 0;     ///< 0: one for each core
  std::string command_line;
  Log log;
};

/// A scene on a page.
struct ViewArguments {
  std::string program;  ///< as it was called
  std::string scene;
  std::vector<std::string> overrides;
  std::vector<int> frames;  ///< empty: those that the scene has keys for
  ViewOptions options;
  bool opens_browser = true;  ///< where there is a desktop
  int threads = 0;            ///< 0: one for each core
  Log log;
};

enum class CacheAction { list, verify, prune };

struct CacheArguments {
  CacheAction action = CacheAction::list;
  std::string folder;
  std::uint64_t most_bytes = BlobCache::kDefaultBytes;  ///< prune
  Log log;
};

/// Text to print, as of --help.
struct ShowText {
  std::string text;
};

using Command =
    std::variant<ShowText, RenderArguments, InfoArguments, CompareArguments, BenchArguments, CacheArguments,
                 PrecomputeArguments, ProfileArguments, ImportArguments, ViewArguments>;

enum class OutputFormat { exr, png, unknown };
OutputFormat output_format(const std::string& path);  ///< by extension, upper or lower case
/// error Error{bad_input}: an unknown option, a value that is not one, an output that is neither EXR nor PNG
Command parse_arguments(int argc, const char* const* argv);

/// True if the words ask for a log of JSON, whatever else is wrong with them.
bool asks_for_json(int argc, const char* const* argv);

/// A failure whose place is "--set KEY=VALUE", where the command line has an option in its stead: its place is the option.
Error placed_at_option(const Error& failure, int argc, const char* const* argv);

}  // namespace opaline
