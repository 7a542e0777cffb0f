// SPDX-License-Identifier: GPL-3.0-or-later
#include "view/dropped_files.h"

#include <fmt/format.h>
#include <stdlib.h>

#include <algorithm>
#include <cerrno>
#include <charconv>
#include <cstring>
#include <filesystem>
#include <memory>
#include <system_error>

#include "assets/import_asset.h"
#include "core/lower_case.h"
#include "opaline/error.h"
#include "values/json_tree.h"

namespace opaline {
namespace {

namespace fs = std::filesystem;

constexpr std::ptrdiff_t kDeepest = 8;  // folders of a name
constexpr std::size_t kLongestName = 200;
constexpr const char* kExpected =
    "an asset (.glb, .gltf, .obj, .ply, .stl, .off) or an environment map (.exr, .hdr)";

bool is_plain_path(const std::string& name) {
  const fs::path path(name);
  return !path.empty() && std::distance(path.begin(), path.end()) <= kDeepest &&
         std::ranges::all_of(path, [](const fs::path& part) { return is_plain_name(part.string()); });
}

template <class Action>
void on_disk(const std::string& path, const Action& action) {
  try {
    action();
  } catch (const fs::filesystem_error& failure) {
    throw run_failed(path, "cannot store dropped files: " + failure.code().message());
  }
}

/// The file to open.
std::string main_file(const std::vector<std::string>& names) {
  std::vector<std::string> assets;
  std::ranges::copy_if(names, std::back_inserter(assets), is_asset_name);
  if (assets.size() > 1)
    throw bad_file("", "several assets were dropped", "one asset with its textures",
                   assets[0] + " and " + assets[1]);
  if (!assets.empty()) return assets.front();
  const auto environment = std::ranges::find_if(names, is_environment_name);
  if (environment == names.end())
    throw bad_file("", "nothing to open was dropped", kExpected, printable(names.front()));
  return *environment;
}

struct Place {
  std::string_view drop;
  std::size_t file;
};

/// The drop and the file of an upload's address.
Place place_of(std::string_view address) {
  constexpr std::string_view kStart = DroppedFiles::kAddress;
  const std::size_t slash = address.find('/', kStart.size());
  const std::string_view drop = address.substr(0, slash).substr(kStart.size()),
                         index = slash == address.npos ? std::string_view() : address.substr(slash + 1);
  const auto is_number = [](std::string_view text) {
    return !text.empty() && text.size() <= 16 && text.find_first_not_of("0123456789") == text.npos;
  };
  if (!is_number(drop) || !is_number(index))
    throw bad_file("", "an upload has an invalid address", "numbers of a drop and of a file",
                   printable(address));
  std::size_t file = DroppedFiles::kMostFiles;
  std::from_chars(index.data(), index.data() + index.size(), file);
  if (file >= DroppedFiles::kMostFiles)
    throw bad_file("", "too many files were dropped", fmt::format("at most {}", DroppedFiles::kMostFiles));
  return {drop, file};
}

}  // namespace

bool is_plain_name(const std::string& name) {
  const fs::path file(name);
  return !name.empty() && file.filename() == file && !name.starts_with('.') && name.size() <= kLongestName &&
         std::ranges::none_of(name, [](char c) { return (unsigned char)(c) < ' '; });
}

bool is_environment_name(const std::string& path) {
  const std::string extension = in_lower_case(fs::path(path).extension().string());
  return extension == ".exr" || extension == ".hdr";
}

DroppedFiles::~DroppedFiles() {
  forget();
  std::error_code ignored;
  if (is_new_) fs::remove(folder_, ignored);  // if it is empty
}

void DroppedFiles::forget() {
  std::error_code ignored;
  if (!incoming_.empty()) fs::remove_all(incoming_, ignored);
  incoming_.clear();
  drop_.clear();
  uploads_.clear();
}

std::string DroppedFiles::begin(std::string_view address, std::uint64_t bytes) {
  const Place place = place_of(address);
  if (place.drop != drop_) {
    forget();
    on_disk(folder_, [&] { is_new_ = fs::create_directories(folder_) || is_new_; });
    incoming_ = folder_ + "/.incoming-XXXXXX";
    if (::mkdtemp(incoming_.data()) == nullptr) {
      incoming_.clear();
      throw run_failed(folder_, std::string("cannot store dropped files: ") + std::strerror(errno));
    }
    drop_ = place.drop;
  }
  uploads_.resize(std::max(uploads_.size(), place.file + 1));
  Upload& upload = uploads_[place.file];
  if (upload.has_begun) throw bad_file("", "a dropped file is uploaded twice");
  upload = {bytes, true, false};
  std::uint64_t all = 0;
  for (const Upload& each : uploads_) all += std::min(each.bytes, kMostBytes + 1);
  if (all > kMostBytes) {
    forget();
    throw bad_file("", "the dropped files are too large", fmt::format("at most {} GiB", kMostBytes >> 30));
  }
  return fmt::format("{}/{}", incoming_, place.file);
}

void DroppedFiles::end(std::string_view address) {
  const Place place = place_of(address);
  if (place.drop == drop_ && place.file < uploads_.size()) uploads_[place.file].has_ended = true;
}

std::string DroppedFiles::take(const std::string& drop, const std::vector<std::string>& names) {
  const bool is_known = !drop.empty() && drop == drop_;
  const std::shared_ptr<void> end(nullptr, [&](void*) {
    if (is_known) forget();
  });
  if (!is_known || names.size() != uploads_.size() || !std::ranges::all_of(uploads_, &Upload::has_ended))
    throw bad_file("", "the dropped files are incomplete", "uploads of all files of one drop");
  for (const std::string& name : names)
    if (!is_plain_path(name))
      throw bad_file("", "a dropped file has an invalid name",
                     "names without '..', not hidden, at most 200 bytes long", "'" + printable(name) + "'");
  const std::string main = main_file(names), stem = fs::path(main).stem().string();
  std::string folder = folder_ + '/' + stem;
  for (int copy = 2; fs::exists(fs::symlink_status(folder)); ++copy)
    folder = fmt::format("{}/{}-{}", folder_, stem, copy);
  taken_.push_back(folder);
  const std::string path = folder + '/' + main;
  try {
    on_disk(folder, [&] {
      for (std::size_t i = 0; i < names.size(); ++i) {
        const fs::path target = fs::path(folder) / names[i];
        fs::create_directories(target.parent_path());
        fs::rename(fmt::format("{}/{}", incoming_, i), target);
      }
    });
  } catch (const Error&) {
    discard(path);
    throw;
  }
  return path;
}

void DroppedFiles::discard(const std::string& path) {
  for (const std::string& folder : taken_)
    if (path.starts_with(folder + '/')) {
      std::error_code ignored;
      fs::remove_all(folder, ignored);
    }
}

}  // namespace opaline
