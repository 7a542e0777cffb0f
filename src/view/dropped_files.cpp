// SPDX-License-Identifier: GPL-3.0-or-later
#include "view/dropped_files.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <charconv>
#include <filesystem>
#include <memory>
#include <numeric>
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
  if (!folder_.empty()) fs::remove(folder_, ignored);  // if it is empty
}

std::string DroppedFiles::incoming() const {
  return fmt::format("{}/.incoming-{}", folder_, ::getpid());
}

void DroppedFiles::forget() {
  std::error_code ignored;
  if (!drop_.empty()) fs::remove_all(incoming(), ignored);
  drop_.clear();
  bytes_.clear();
}

std::string DroppedFiles::begin(std::string_view address, std::uint64_t bytes) {
  const std::size_t slash = address.find('/', kAddress.size());
  const std::string_view drop = address.substr(0, slash).substr(kAddress.size()),
                         index = slash == address.npos ? std::string_view() : address.substr(slash + 1);
  const auto is_number = [](std::string_view text) {
    return !text.empty() && text.size() <= 16 && text.find_first_not_of("0123456789") == text.npos;
  };
  if (!is_number(drop) || !is_number(index))
    throw bad_file("", "an upload has an invalid address", "numbers of a drop and of a file",
                   printable(address));
  std::size_t file = kMostFiles;
  std::from_chars(index.data(), index.data() + index.size(), file);
  if (file >= kMostFiles)
    throw bad_file("", "too many files were dropped", fmt::format("at most {}", kMostFiles));
  if (drop != drop_) {
    forget();
    on_disk(folder_, [&] { fs::create_directories(incoming()); });
    drop_ = drop;
  }
  bytes_.resize(std::max(bytes_.size(), file + 1));
  bytes_[file] = bytes;
  if (bytes > kMostBytes || std::reduce(bytes_.begin(), bytes_.end()) > kMostBytes) {
    forget();
    throw bad_file("", "the dropped files are too large", fmt::format("at most {} GiB", kMostBytes >> 30));
  }
  return fmt::format("{}/{}", incoming(), file);
}

std::string DroppedFiles::take(const std::string& drop, const std::vector<std::string>& names) {
  const bool is_known = !drop.empty() && drop == drop_;
  const std::shared_ptr<void> end(nullptr, [&](void*) {
    if (is_known) forget();
  });
  if (!is_known || names.size() != bytes_.size())
    throw bad_file("", "the dropped files are incomplete", "uploads of all files of one drop");
  for (const std::string& name : names)
    if (!is_plain_path(name))
      throw bad_file("", "a dropped file has an invalid name",
                     "names without '..', not hidden, at most 200 bytes long", "'" + printable(name) + "'");
  const std::string main = main_file(names), stem = fs::path(main).stem().string();
  std::string folder = folder_ + '/' + stem;
  for (int copy = 2; fs::exists(folder); ++copy) folder = fmt::format("{}/{}-{}", folder_, stem, copy);
  taken_.push_back(folder);
  const std::string path = folder + '/' + main;
  try {
    on_disk(folder, [&] {
      for (std::size_t i = 0; i < names.size(); ++i) {
        const fs::path target = fs::path(folder) / names[i];
        fs::create_directories(target.parent_path());
        fs::rename(fmt::format("{}/{}", incoming(), i), target);
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
