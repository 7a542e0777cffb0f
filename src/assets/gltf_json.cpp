// SPDX-License-Identifier: GPL-3.0-or-later
#include "assets/gltf_json.h"

#include <array>
#include <cstdint>
#include <cstring>
#include <string_view>
#include <utility>

#include "opaline/core/error.h"

namespace opaline {
namespace {

constexpr std::size_t most_depth = 128;
constexpr std::array<std::string_view, 5> unread{"animations", "images", "samplers", "skins", "textures"};

/// The JSON of a GLB file lies behind 20 bytes of headers, the last 8 of them its length and its kind.
constexpr std::size_t glb_header = 20, glb_length_at = 12;

/// Where the JSON begins and ends.
struct Extent {
  std::size_t begin, end;
};

Extent json_extent(const std::string& file) {
  if (!file.starts_with("glTF") || file.size() < glb_header) return {0, file.size()};
  std::uint32_t length = 0;
  for (std::size_t i = 4; i-- > 0;) length = length << 8 | std::uint8_t(file[glb_length_at + i]);
  return {glb_header, std::min(file.size(), glb_header + length)};
}

/// Walks over the brackets and strings of a JSON text without a recursion.
class JsonScan {
 public:
  JsonScan(const std::string& path, std::string& file) : path_(path), file_(file) {}

  GltfOutline run() {
    const Extent extent = json_extent(file_);
    for (at_ = extent.begin; at_ < extent.end; ++at_) {
      const char c = file_[at_];
      if (c == '"') string(extent.end);
      if (c == '{' || c == '[') open();
      if (c == '}' || c == ']') close();
    }
    return std::move(outline_);
  }

 private:
  void string(std::size_t end) {
    const std::size_t first = at_ + 1;
    for (++at_; at_ < end && file_[at_] != '"'; ++at_)
      if (file_[at_] == '\\') ++at_;
    if (depth_ == 1 && at_ < end) top_level_word(first);
  }

  /// Within the outermost object; a value is taken for a key, too, and does no harm.
  void top_level_word(std::size_t first) {
    list_ = file_.substr(first, at_ - first);
    for (const std::string_view key : unread)
      if (list_ == key) file_[first] = '-';
  }

  void open() {
    if (depth_ == 1) list_begin_ = at_;
    if (depth_ == 2) ++outline_.counts[list_];
    if (++depth_ > most_depth)
      throw bad_file(path_, "its JSON is nested too deep",
                     "at most " + std::to_string(most_depth) + " levels");
  }

  void close() {
    if (depth_ == 0 || --depth_ != 1) return;
    if (list_ == "images") outline_.images = file_.substr(list_begin_, at_ + 1 - list_begin_);
    if (list_ == "textures") outline_.textures = file_.substr(list_begin_, at_ + 1 - list_begin_);
  }

  const std::string& path_;
  std::string& file_;
  std::size_t at_ = 0, depth_ = 0, list_begin_ = 0;
  std::string list_;
  GltfOutline outline_;
};

}  // namespace

GltfOutline prepare_gltf_json(const std::string& path, std::string& file) {
  return JsonScan(path, file).run();
}

}  // namespace opaline
