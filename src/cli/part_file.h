// SPDX-License-Identifier: GPL-3.0-or-later
// File of one part of the work on an image, written by `render --part` and read by `merge`.
#pragma once

#include <cstdint>
#include <cstring>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "cache/content_hash.h"
#include "cli/arguments.h"
#include "core/atomic_file.h"
#include "core/image_part.h"
#include "core/input_file.h"

namespace opaline {

/// Identifies the image of a part.
struct PartRecord {
  std::string version;  ///< program version
  std::string scene;    ///< absolute path
  std::string hash;     ///< scene_hash or frame_hash
  std::vector<std::string> overrides;
  LayerChoice layers;
  std::optional<int> frame;
  ImagePart part;
};

/// Record of a part to render.
PartRecord record_of(const RenderArguments& arguments, const std::string& hash, std::optional<int> frame);

/// First difference between parts of one image, as a predicate; empty: none. Ignores the number of the part.
std::string difference(const PartRecord& part, const PartRecord& other);

/// Reads a part. The values follow the header one after the other.
class PartFile {
 public:
  /// error Error{bad_input} naming the file: missing, not a part, or damaged
  explicit PartFile(const std::string& path);

  const std::string& path() const { return path_; }
  const PartRecord& record() const { return record_; }
  bool is_complete() const { return is_complete_; }
  /// Description of the values by the method.
  const Json& contents() const { return contents_; }

  /// `count` values, beginning `offset` bytes after the header.
  /// error Error{bad_input} naming the file: fewer are there
  template <class T>
  std::vector<T> values(std::uint64_t offset, std::size_t count) const {
    const std::string bytes = bytes_at(offset, count, sizeof(T));
    std::vector<T> values(count);
    if (count > 0) std::memcpy(values.data(), bytes.data(), bytes.size());
    return values;
  }

 private:
  std::string bytes_at(std::uint64_t offset, std::uint64_t count, std::uint64_t item_bytes) const;

  std::string path_;
  InputFile file_;
  PartRecord record_;
  bool is_complete_ = false;
  Json contents_;
  std::uint64_t begin_ = 0, end_ = 0;  // range of the values
};

/// Writes a part, completely or not at all.
class PartOutput {
 public:
  /// error Error{run_failed} naming the file, as for all functions
  PartOutput(const std::string& path, const PartRecord& record, bool is_complete, const Json& contents);

  template <class T>
  void append(std::span<const T> values) {
    append({reinterpret_cast<const char*>(values.data()), values.size_bytes()});
  }
  void commit();

 private:
  void append(std::string_view bytes);

  AtomicFile file_;
  ContentHash hash_;
};

}  // namespace opaline
