// SPDX-License-Identifier: GPL-3.0-or-later
#include "session/walk_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <filesystem>
#include <sstream>

#include "image/sums_file.h"
#include "opaline/error.h"
#include "opaline/image.h"

namespace opaline {
namespace {

// The arrays are stored one after the other in the pixels, row by row; a text line per source identifies
// them.
constexpr const char* kSources = "opaline:walk_sources";
constexpr int kWidth = 1024;
constexpr std::array<const char*, 2> kChannels{"flux", "root"};

/// Text keeps all bits.
std::uint64_t bits(double value) {
  return std::bit_cast<std::uint64_t>(value);
}

std::string line_of(const StageKey& key, const SourceSums& source) {
  std::string line = hex(key);
  for (const WalkSums& walks : source.channels)
    line += fmt::format(" {} {} {:x} {:x} {:x}", walks.passes, walks.flux.size(), bits(walks.entered),
                        bits(walks.lost), bits(walks.stopped));
  return line + '\n';
}

Error not_walks(const std::string& path) {
  return bad_file(path, "does not hold the sums of random walks", "a file written by --resume");
}

/// Takes the next array.
class Arrays {
 public:
  Arrays(const std::string& path, const Image& image) : path_(path), image_(image) {
    for (std::size_t c = 0; c < kChannels.size(); ++c) {
      const auto place = std::ranges::find(image.channels, kChannels[c]);
      if (place == image.channels.end()) throw not_walks(path);
      places_[c] = std::size_t(place - image.channels.begin());
    }
  }

  void take(WalkSums& walks, std::size_t count) {
    if (count > image_.pixels.size() / image_.channels.size() - taken_) throw not_walks(path_);
    for (std::size_t i = taken_; i < taken_ + count; ++i) {
      const float* pixel = image_.pixels.data() + i * image_.channels.size();
      walks.flux.push_back(pixel[places_[0]]);
      walks.roots.push_back(pixel[places_[1]]);
    }
    taken_ += count;
  }

 private:
  const std::string& path_;
  const Image& image_;
  std::array<std::size_t, kChannels.size()> places_{};
  std::size_t taken_ = 0;
};

StageKey key_of(const std::string& digits, const std::string& path) {
  if (digits.size() != 32 || digits.find_first_not_of("0123456789abcdef") != std::string::npos)
    throw not_walks(path);
  return {std::stoull(digits.substr(0, 16), nullptr, 16), std::stoull(digits.substr(16), nullptr, 16)};
}

}  // namespace

void write_walks(const std::string& path, const WalkFile& walks) {
  std::string lines;
  std::vector<std::array<float, 2>> values;
  for (const auto& [key, source] : walks) {
    lines += line_of(key, source);
    for (const WalkSums& sums : source.channels)
      for (std::size_t i = 0; i < sums.flux.size(); ++i) values.push_back({sums.flux[i], sums.roots[i]});
  }
  Image image;
  image.width = image.full_width = kWidth;
  image.height = image.full_height = int(values.size() / kWidth) + 1;
  image.channels = {kChannels.begin(), kChannels.end()};
  image.pixels.resize(std::size_t(image.width) * std::size_t(image.height) * kChannels.size());
  for (std::size_t i = 0; i < values.size(); ++i)
    std::ranges::copy(values[i], image.pixels.begin() + std::ptrdiff_t(2 * i));
  image.metadata = {{kSources, lines}};
  write_exr(path, image, false);
}

WalkFile read_walks(const std::string& path) {
  WalkFile walks;
  std::error_code ignored;
  if (!std::filesystem::exists(path, ignored)) return walks;
  const Image image = read_sums_file(path);
  const auto text =
      std::ranges::find_if(image.metadata, [](const auto& entry) { return entry.first == kSources; });
  if (text == image.metadata.end()) throw not_walks(path);
  Arrays arrays(path, image);
  std::istringstream lines(text->second);
  for (std::string line; std::getline(lines, line);) {
    std::istringstream words(line);
    std::string digits;
    words >> digits;
    SourceSums& source = walks[key_of(digits, path)];
    for (WalkSums& sums : source.channels) {
      std::size_t count = 0;
      std::uint64_t entered = 0, lost = 0, stopped = 0;
      words >> std::dec >> sums.passes >> count >> std::hex >> entered >> lost >> stopped;
      if (!words) throw not_walks(path);
      sums.entered = std::bit_cast<double>(entered);
      sums.lost = std::bit_cast<double>(lost);
      sums.stopped = std::bit_cast<double>(stopped);
      arrays.take(sums, count);
    }
  }
  return walks;
}

}  // namespace opaline
