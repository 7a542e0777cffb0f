// SPDX-License-Identifier: GPL-3.0-or-later
#include "opaline/lights/environment_picture.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <filesystem>
#include <map>
#include <mutex>
#include <numbers>
#include <utility>

#include "opaline/core/error.h"
#include "opaline/core/random.h"
#include "opaline/image/image.h"

namespace opaline {
namespace {

constexpr double kPi = std::numbers::pi;
constexpr std::size_t kMostColumns = 1024;

float mean_of(const RgbF& colour) {
  return (colour.x + colour.y + colour.z) / 3;
}

std::string place_text(std::size_t pixel, std::size_t width) {
  return "pixel (" + std::to_string(pixel % width) + ", " + std::to_string(pixel / width) + ")";
}

std::vector<RgbF> colours_of(const std::string& path, const Image& image) {
  const auto channel = [&](const char* name) {
    return std::size_t(std::ranges::find(image.channels, name) - image.channels.begin());
  };
  std::array<std::size_t, 3> rgb{channel("R"), channel("G"), channel("B")};
  if (image.channels.size() == 1) rgb = {0, 0, 0};
  if (std::ranges::max(rgb) >= image.channels.size())
    throw bad_file(path, "has no colours for an environment", "the channels R, G and B, or one alone");
  std::vector<RgbF> pixels(std::size_t(image.width) * std::size_t(image.height));
  for (std::size_t i = 0; i < pixels.size(); ++i) {
    const float* const values = &image.pixels[i * image.channels.size()];
    pixels[i] = {values[rgb[0]], values[rgb[1]], values[rgb[2]]};
    // Lat-long pictures that were resampled with a sharp filter have pixels a little below zero.
    for (float* const value : {&pixels[i].x, &pixels[i].y, &pixels[i].z})
      if (!std::isfinite(*value = std::max(*value, 0.0f)))
        throw bad_file(path, place_text(i, std::size_t(image.width)) + " is not finite", "radiance >= 0");
  }
  return pixels;
}

struct KnownPicture {
  std::filesystem::file_time_type time;
  std::uintmax_t bytes = 0;
  std::weak_ptr<const EnvironmentPicture> picture;
};

// The share of [0, 1) that `u` lies in, by its end; u becomes its place within.
std::size_t draw(const float* ends, std::size_t count, double& u) {
  const std::size_t i =
      std::min(count - 1, std::size_t(std::upper_bound(ends, ends + count, float(u)) - ends));
  const double begin = i > 0 ? double(ends[i - 1]) : 0, width = double(ends[i]) - begin;
  u = width > 0 ? std::clamp((u - begin) / width, 0.0, 1.0) : .5;
  return i;
}

// Running sums to shares of the last.
void normalize(float* ends, std::size_t count, double sum) {
  for (std::size_t i = 0; i < count; ++i)
    ends[i] = sum > 0 ? float(double(ends[i]) / sum) : float(i + 1) / float(count);
  ends[count - 1] = 1;
}

}  // namespace

EnvironmentPicture::EnvironmentPicture(std::size_t width, std::size_t height, std::vector<RgbF> pixels)
    : width_(width), height_(height), pixels_(std::move(pixels)) {
  require(width > 0 && height > 0 && pixels_.size() == width * height,
          "an environment has width x height pixels");
  hash_ = hash_bits(width, height);
  for (const RgbF& p : pixels_) {
    is_grey_ = is_grey_ && p.x == p.y && p.y == p.z;
    for (const float value : {p.x, p.y, p.z}) hash_ = hash_bits(hash_, std::bit_cast<std::uint32_t>(value));
  }
  make_table();
}

std::shared_ptr<const EnvironmentPicture> EnvironmentPicture::read(const std::string& path) {
  static std::mutex mutex;
  static std::map<std::string, KnownPicture> known;
  std::error_code missing;  // read_image says so
  const auto time = std::filesystem::last_write_time(path, missing);
  const auto bytes = std::filesystem::file_size(path, missing);
  const std::lock_guard lock(mutex);
  KnownPicture& entry = known[path];
  if (auto picture = entry.picture.lock(); picture && !missing && entry.time == time && entry.bytes == bytes)
    return picture;
  const Image image = read_image(path);
  if (image.width != 2 * image.height)
    throw bad_file(path, "is no picture of an environment", "a lat-long picture, twice as wide as high",
                   std::to_string(image.width) + " x " + std::to_string(image.height));
  const auto picture = std::make_shared<const EnvironmentPicture>(
      std::size_t(image.width), std::size_t(image.height), colours_of(path, image));
  entry = {time, bytes, picture};
  return picture;
}

void EnvironmentPicture::make_table() {
  step_ = (width_ + kMostColumns - 1) / kMostColumns;
  columns_ = (width_ + step_ - 1) / step_;
  rows_ = (height_ + step_ - 1) / step_;
  means_.resize(columns_ * rows_);
  row_ends_.resize(rows_);
  column_ends_.resize(columns_ * rows_);
  for (std::size_t r = 0; r < rows_; ++r) {
    std::vector<double> weights(columns_);
    std::vector<Rgb> sums(columns_);
    for (std::size_t y = r * step_; y < std::min(height_, (r + 1) * step_); ++y) {
      // A row's share of the sphere.
      const double band =
          std::cos(kPi * double(y) / double(height_)) - std::cos(kPi * double(y + 1) / double(height_));
      for (std::size_t x = 0; x < width_; ++x) {
        weights[x / step_] += band;
        sums[x / step_] += Rgb(pixels_[y * width_ + x]) * band;
      }
    }
    double sum = 0;
    for (std::size_t c = 0; c < columns_; ++c) {
      const std::size_t i = r * columns_ + c;
      means_[i] = RgbF(sums[c] / weights[c]);
      column_ends_[i] = float(sum += (sums[c].x + sums[c].y + sums[c].z) / 3);
    }
    normalize(&column_ends_[r * columns_], columns_, sum);
    row_ends_[r] = float(total_ += sum * 2 * kPi / double(width_));
  }
  normalize(row_ends_.data(), rows_, total_);
}

std::array<double, 2> EnvironmentPicture::place_of(const Vec3d& direction) const {
  return {(.5 - std::atan2(direction.x, direction.z) / (2 * kPi)) * double(width_),
          std::acos(std::clamp(direction.y, -1.0, 1.0)) / kPi * double(height_)};
}

RgbF EnvironmentPicture::radiance(const Vec3d& direction) const {
  const auto [x, y] = place_of(direction);
  const double column = x - .5, row = y - .5;
  const double left = std::floor(column), top = std::floor(row);
  const float right_share = float(column - left), bottom_share = float(row - top);
  const auto at = [&](double at_column, double at_row) {
    const std::size_t r = std::size_t(std::clamp(at_row, 0.0, double(height_ - 1)));
    const double w = double(width_);
    return pixels_[r * width_ + std::size_t(at_column < 0    ? at_column + w
                                            : at_column >= w ? at_column - w
                                                             : at_column)];
  };
  return (at(left, top) * (1 - right_share) + at(left + 1, top) * right_share) * (1 - bottom_share) +
         (at(left, top + 1) * (1 - right_share) + at(left + 1, top + 1) * right_share) * bottom_share;
}

EnvironmentPicture::Sample EnvironmentPicture::sample(std::array<double, 2> unit_square) const {
  auto [u, v] = unit_square;
  const std::size_t r = draw(row_ends_.data(), rows_, v);
  const std::size_t c = draw(&column_ends_[r * columns_], columns_, u);
  const RgbF mean = means_[r * columns_ + c];
  if (!(mean_of(mean) > 0)) return {{0, 1, 0}, {}};
  const auto between = [this](std::size_t cell, double share, std::size_t end) {
    const double first = double(cell * step_);
    return first + (std::min(double(end), first + double(step_)) - first) * share;
  };
  const double cos_top = std::cos(kPi * between(r, 0, height_) / double(height_)),
               cos_bottom = std::cos(kPi * between(r, 1, height_) / double(height_));
  const double cosine = cos_top + (cos_bottom - cos_top) * v,
               sine = std::sqrt(std::max(0.0, 1 - cosine * cosine));
  const double longitude = (.5 - between(c, u, width_) / double(width_)) * 2 * kPi;
  return {{sine * std::sin(longitude), cosine, sine * std::cos(longitude)},
          mean * float(total_ / double(mean_of(mean)))};
}

float EnvironmentPicture::density(const Vec3d& direction) const {
  const auto [x, y] = place_of(direction);
  const std::size_t c = std::min(columns_ - 1, std::size_t(x) / step_),
                    r = std::min(rows_ - 1, std::size_t(y) / step_);
  return total_ > 0 ? float(double(mean_of(means_[r * columns_ + c])) / total_) : 0;
}

}  // namespace opaline
