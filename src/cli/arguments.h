// SPDX-License-Identifier: GPL-3.0-or-later
// The command line as data.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "benchmark/bench_command.h"
#include "benchmark/profile_request.h"
#include "cache/blob_cache.h"
#include "core/image_part.h"
#include "core/log.h"
#include "image/picture_layers.h"
#include "opaline/error.h"
#include "view/view_server.h"

namespace opaline {

/// Files of all parts of an image, in order.
struct MergedParts {
  std::vector<std::string> files;  ///< empty: no parts
  std::string hash;                ///< their scene_hash or frame_hash
};

struct RenderArguments {
  std::string program;       ///< as called
  std::string command_line;  ///< complete, for a shell
  std::string scene;
  /// For load_scene: the values of short options in a fixed order, then every --set in the given order.
  std::vector<std::string> overrides;
  std::vector<std::string> outputs;        ///< at least one; .exr or .png, or a .mp4 of frames, no two alike
  LayerChoice layers{false, {"diffuse"}};  ///< layers of the EXR files, beside R, G, B and A
  std::string samples_ply;                 ///< empty: none
  std::string resume;                      ///< sums of an earlier `direct` render, to continue; empty: none
  std::optional<ImagePart> part;  ///< renders this part of the image only, to the one output, a .part
  MergedParts merged;             ///< takes the sums from these parts
  std::string cache;              ///< folder of stage results; empty: none
  std::uint64_t cache_bytes = BlobCache::kDefaultBytes;
  std::vector<int> frames;  ///< empty: one image; otherwise output names contain ## for the number
  std::optional<int> frames_per_second;  ///< for a movie; none: 24
  int threads = 0;                       ///< 0: one for each core
  bool timings_in_metadata = false;
  std::optional<double> target_error;  ///< chooses settings by error; relative, > 0
  std::optional<double> time_budget;   ///< chooses settings by CPU time of the whole process, s, > 0
  bool verify = false;                 ///< measures the error of the image
  bool gives_entry_samples = false, gives_until_error = false;  ///< the options, not --set
  Log log;
};

/// Renders frames, as many as those of `render`, with the camera turned once around its look_at.
struct TurntableArguments {
  RenderArguments render;
  Log log;
};

/// Adds parts to the image of their command.
struct MergeArguments {
  std::vector<std::string> parts;
  RenderArguments render;  ///< outputs, threads, log and names of the program only
  Log log;
};

/// Precomputes samples, light and trees of frames into a cache.
struct PrecomputeArguments {
  std::string scene;
  std::vector<std::string> overrides;
  std::string cache;
  std::uint64_t cache_bytes = BlobCache::kDefaultBytes;
  std::vector<int> frames;  ///< empty: no range, the scene as it is
  int threads = 0;
  Log log;
};

/// Converts an asset of another program into a scene file.
struct ImportArguments {
  std::string asset;
  std::string scene;      ///< output
  std::string material;   ///< MaterialX, replacing the asset's materials; empty: none
  std::string animation;  ///< name or index of a glTF animation; empty: the first
  std::vector<std::string> overrides = {};
  bool overwrite = false;  ///< replaces an existing scene with other contents
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

/// Compares a medium's radial profiles with random walks.
struct ProfileArguments {
  GivenProfile given;
  std::string report;  ///< folder; empty: none
  int threads = 0;     ///< 0: one for each core
  std::string command_line;
  Log log;
};

/// Serves a scene as a page.
struct ViewArguments {
  std::string program;  ///< as called
  std::string scene;
  std::vector<std::string> overrides;
  std::vector<int> frames;  ///< empty: the frames of the scene's keys
  ViewOptions options;
  bool opens_browser = true;  ///< on a desktop
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

using Command = std::variant<ShowText, RenderArguments, TurntableArguments, MergeArguments, InfoArguments,
                             CompareArguments, BenchArguments, CacheArguments, PrecomputeArguments,
                             ProfileArguments, ImportArguments, ViewArguments>;

enum class OutputFormat { exr, png, mp4, part, unknown };
OutputFormat output_format(const std::string& path);  ///< by extension, upper or lower case
/// error Error{bad_input}: an unknown option, an invalid value, or an output other than EXR or PNG
Command parse_arguments(int argc, const char* const* argv);

/// True if the arguments request a JSON log, even if others are invalid.
bool asks_for_json(int argc, const char* const* argv);

/// Moves an error from "--set KEY=VALUE" to the equivalent option, if the command line has it.
Error placed_at_option(const Error& failure, int argc, const char* const* argv);

}  // namespace opaline
