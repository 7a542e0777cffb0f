// SPDX-License-Identifier: GPL-3.0-or-later
// Files uploaded by a page: assets with their textures, and environment maps.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace opaline {

/// Stores the files of one drop at a time; a new drop replaces an incomplete one. A taken drop has a folder of its own.
class DroppedFiles {
 public:
  static constexpr std::size_t kMostFiles = 256;
  static constexpr std::uint64_t kMostBytes = std::uint64_t(2) << 30;  ///< per drop
  /// Path of uploads: kAddress, the drop's number, '/', and the number of the file in the drop.
  static constexpr std::string_view kAddress = "/dropped/";

  /// in    folder: created with the first drop
  explicit DroppedFiles(std::string folder) : folder_(std::move(folder)) {}
  ~DroppedFiles();
  DroppedFiles(const DroppedFiles&) = delete;
  DroppedFiles& operator=(const DroppedFiles&) = delete;

  /// File to write an upload to.
  /// in    address: of the upload; bytes: its size
  /// error Error{bad_input}: more than kMostFiles or kMostBytes, another address, or the same file again;
  ///       Error{run_failed}: the folder cannot be written
  std::string begin(std::string_view address, std::uint64_t bytes);

  /// Notes the end of an upload.
  void end(std::string_view address);

  /// Moves the uploads into a new folder, and returns the path of the asset, or of the environment map without one.
  /// in    names: of the files in the order of their numbers, with '/' between folders
  /// error Error{bad_input}: no such drop, missing files, invalid names, no asset and no environment map, or several
  ///       assets; Error{run_failed}: a file cannot be moved
  std::string take(const std::string& drop, const std::vector<std::string>& names);

  /// Removes the folder of a path returned by `take`.
  void discard(const std::string& path);

 private:
  struct Upload {
    std::uint64_t bytes = 0;
    bool has_begun = false, has_ended = false;
  };
  void forget();

  std::string folder_, drop_, incoming_;  // incoming_: folder of uploads; empty: none
  std::vector<Upload> uploads_;           // by file of the drop
  std::vector<std::string> taken_;        // folders
  bool is_new_ = false;                   // folder_ was made here
};

/// True if the path ends in a format of environment maps.
bool is_environment_name(const std::string& path);

/// True for a file name without a folder, not hidden, of at most 200 bytes, without control characters.
bool is_plain_name(const std::string& name);

}  // namespace opaline
