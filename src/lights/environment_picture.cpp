// SPDX-License-Identifier: GPL-3.0-or-later
#include "lights/environment_picture.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <filesystem>
#include <functional>
#include <map>
#include <mutex>
#include <numbers>
#include <numeric>
#include <utility>

#include "core/random.h"
#include "image/color_channels.h"
#include "image/display_window.h"
#include "lights/cumulative_shares.h"
#include "opaline/error.h"
#include "opaline/image.h"
#include "opaline/scene.h"

namespace opaline {
namespace {

constexpr double kPi = std::numbers::pi;
constexpr std::size_t kMostColumns = 1024, kBlockColumns = 64, kBrightest = 32;
// Largest angle between a normal and its table's, radians; and least cosine of directions visible from such
// normals alone.
constexpr double kBetweenNormals = .15, kLeastCosine = .05;

// Unfolded normal of the unfolded octahedron, both in [-1, 1].
Vec3d unfolded_normal(double x, double y) {
  const double z = 1 - std::abs(x) - std::abs(y), over = std::max(-z, 0.0);
  return normalized(Vec3d{x + (x < 0 ? over : -over), y + (y < 0 ? over : -over), z});
}

float mean_of(const RgbF& colour) {
  return (colour.x + colour.y + colour.z) / 3;
}

std::string place_text(std::size_t pixel, std::size_t width) {
  return "pixel (" + std::to_string(pixel % width) + ", " + std::to_string(pixel / width) + ")";
}

/// Negative pixels, from the ringing of sharp filters beside bright areas; replaced by 0.
struct NegativePixels {
  std::size_t count = 0, lowest_at = 0;
  float lowest = 0;

  void add(std::size_t pixel, float value) {
    ++count;
    if (value >= lowest) return;
    lowest = value;
    lowest_at = pixel;
  }
};

/// Limits values so weighted sums over an environment stay finite in single precision.
constexpr float kMostRadiance = 1e30f;

/// Colours of the display window, 0 outside the data window.
std::vector<RgbF> colours_of(const std::string& path, const Image& image, NegativePixels& negative) {
  const ChannelPlaces places = channel_places(image.channels, path);
  if (std::min({places[0], places[1], places[2]}) < 0)
    throw bad_file(path, "has no colour channels for an environment map",
                   "the channels R, G and B, or Y, or one alone");
  check_windows(path, {image.crop_x, image.crop_y, image.width, image.height},
                {0, 0, image.full_width, image.full_height});
  const auto width = std::size_t(image.full_width);
  std::vector<RgbF> pixels(width * std::size_t(image.full_height));
  for (std::size_t i = 0; i < pixels.size(); ++i) {
    const int x = int(i % width) - image.crop_x, y = int(i / width) - image.crop_y;
    if (x < 0 || x >= image.width || y < 0 || y >= image.height) continue;
    const float* const values =
        &image.pixels[(std::size_t(y) * std::size_t(image.width) + std::size_t(x)) * image.channels.size()];
    for (std::size_t c = 0; c < 3; ++c) {
      const float value = values[places[c]];
      if (!(std::abs(value) <= kMostRadiance))
        throw bad_file(path, place_text(i, width) + " is not finite or too large", "a radiance up to 1e30",
                       fmt::format("{:g}", value));
      pixels[i][c] = std::max(value, 0.0f);
    }
    const float lowest = std::min({values[places[0]], values[places[1]], values[places[2]]});
    if (lowest < 0) negative.add(i, lowest);
  }
  return pixels;
}

struct KnownPicture {
  std::filesystem::file_time_type time;
  std::uintmax_t bytes = 0;
  std::weak_ptr<const EnvironmentPicture> picture;
};

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
  make_means();
  make_importance();
  make_blocks();
  make_cosine_tables();
}

std::shared_ptr<const EnvironmentPicture> EnvironmentPicture::read(const std::string& path,
                                                                   const std::array<Rgb, 3>* from_rgb) {
  static std::mutex mutex;
  static std::map<std::pair<std::string, std::vector<double>>, KnownPicture> known;
  std::error_code missing;  // reported by read_image
  const auto time = std::filesystem::last_write_time(path, missing);
  const auto bytes = std::filesystem::file_size(path, missing);
  const std::lock_guard lock(mutex);
  std::vector<double> mix;
  if (from_rgb != nullptr)
    for (const Rgb& row : *from_rgb) mix.insert(mix.end(), {row.x, row.y, row.z});
  KnownPicture& entry = known[{path, mix}];
  if (auto picture = entry.picture.lock(); picture && !missing && entry.time == time && entry.bytes == bytes)
    return picture;
  const Image image = read_image(path);
  if (image.full_width != 2 * image.full_height)
    throw bad_file(path, "is not an environment map", "a lat-long image, twice as wide as high",
                   std::to_string(image.full_width) + " x " + std::to_string(image.full_height));
  NegativePixels negative;
  std::vector<RgbF> pixels = colours_of(path, image, negative);
  if (from_rgb != nullptr)
    for (RgbF& pixel : pixels) pixel = RgbF(component_max(at_wavelengths(*from_rgb, Rgb(pixel)), Rgb{}));
  const auto picture = std::make_shared<EnvironmentPicture>(
      std::size_t(image.full_width), std::size_t(image.full_height), std::move(pixels));
  picture->path_ = path;
  if (negative.count > 0)
    picture->warning_ =
        fmt::format("{}: {} of {} pixels have a negative radiance, replaced by 0; the lowest is {:.3g} at {}",
                    path, negative.count, picture->pixels_.size(), negative.lowest,
                    place_text(negative.lowest_at, picture->width_));
  entry = {time, bytes, picture};
  return picture;
}

void EnvironmentPicture::make_means() {
  step_ = (width_ + kMostColumns - 1) / kMostColumns;
  columns_ = (width_ + step_ - 1) / step_;
  rows_ = (height_ + step_ - 1) / step_;
  cells_.resize(columns_ * rows_);
  for (std::size_t r = 0; r <= rows_; ++r)
    row_cosines_.push_back(std::cos(kPi * double(std::min(height_, r * step_)) / double(height_)));
  for (std::size_t r = 0; r < rows_; ++r) {
    std::vector<double> weights(columns_);
    std::vector<Rgb> sums(columns_);
    for (std::size_t y = r * step_; y < std::min(height_, (r + 1) * step_); ++y) {
      // A row's fraction of the sphere.
      const double band =
          std::cos(kPi * double(y) / double(height_)) - std::cos(kPi * double(y + 1) / double(height_));
      for (std::size_t x = 0; x < width_; ++x) {
        weights[x / step_] += band;
        sums[x / step_] += Rgb(pixels_[y * width_ + x]) * band;
      }
    }
    for (std::size_t c = 0; c < columns_; ++c) cells_[r * columns_ + c].mean = RgbF(sums[c] / weights[c]);
  }
}

// Importance of cells, including some of their neighbours': reflected rays see the image interpolated, so a
// dark cell beside a light contains some of its radiance, and without light samples there such rays would
// have huge weights.
void EnvironmentPicture::make_importance() {
  constexpr float kOfNeighbours = .04f;
  for (std::size_t r = 0; r < rows_; ++r)
    for (std::size_t c = 0; c < columns_; ++c) {
      float around = 0;
      for (const std::size_t row : {r > 0 ? r - 1 : 0, r, std::min(r + 1, rows_ - 1)})
        for (const std::size_t column : {c > 0 ? c - 1 : columns_ - 1, c, c + 1 < columns_ ? c + 1 : 0})
          around += mean_of(cells_[row * columns_ + column].mean) *
                    ((row == r ? 2.0f : 1.0f) * (column == c ? 2.0f : 1.0f) / 16);
      Cell& cell = cells_[r * columns_ + c];
      cell.importance = mean_of(cell.mean) * (1 - kOfNeighbours) + around * kOfNeighbours;
    }
}

// Flux of a cell, integrated over its directions.
double EnvironmentPicture::flux_of(std::size_t row, std::size_t column) const {
  const auto share = [this](std::size_t cell) {
    return double(std::min(cell * step_, width_)) / double(width_);
  };
  return double(cells_[row * columns_ + column].importance) * (row_cosines_[row] - row_cosines_[row + 1]) *
         2 * kPi * (share(column + 1) - share(column));
}

void EnvironmentPicture::make_blocks() {
  block_ = (columns_ + kBlockColumns - 1) / kBlockColumns;
  block_columns_ = (columns_ + block_ - 1) / block_;
  block_rows_ = (rows_ + block_ - 1) / block_;
  block_flux_.resize(block_columns_ * block_rows_);
  cell_rows_.resize(block_columns_ * rows_);
  cell_columns_.resize(columns_ * rows_);
  for (std::size_t block_row = 0; block_row < block_rows_; ++block_row)
    for (std::size_t block_column = 0; block_column < block_columns_; ++block_column) {
      const std::size_t first_row = block_row * block_, first = block_column * block_;
      const std::size_t end_row = std::min(rows_, first_row + block_),
                        end = std::min(columns_, first + block_);
      float* const row_ends = &cell_rows_[block_column * rows_];
      double whole = 0;
      for (std::size_t r = first_row; r < end_row; ++r) {
        float* const column_ends = &cell_columns_[r * columns_];
        double row = 0;
        for (std::size_t c = first; c < end; ++c) column_ends[c] = float(row += flux_of(r, c));
        normalize(column_ends + first, end - first, row);
        row_ends[r] = float(whole += row);
      }
      normalize(row_ends + first_row, end_row - first_row, whole);
      block_flux_[block_row * block_columns_ + block_column] = whole;
    }
  brightest_.resize(block_flux_.size());
  std::iota(brightest_.begin(), brightest_.end(), std::uint16_t(0));
  const auto count = std::min(kBrightest, brightest_.size());
  std::ranges::partial_sort(brightest_, brightest_.begin() + std::ptrdiff_t(count), std::greater<>(),
                            [&](std::uint16_t b) { return block_flux_[b]; });
  brightest_.resize(count);
}

// Closed form, as samples are uniform over the directions of a cell.
std::vector<EnvironmentPicture::BlockIntegral> EnvironmentPicture::block_integrals() const {
  const auto longitude = [this](std::size_t column) {
    return (.5 - double(std::min(column * step_, width_)) / double(width_)) * 2 * kPi;
  };
  const auto squared_sine = [this](std::size_t row) {  // its integral over the angle from +y
    const double cosine = row_cosines_[row];
    return (std::acos(cosine) - cosine * std::sqrt(std::max(0.0, 1 - cosine * cosine))) / 2;
  };
  std::vector<BlockIntegral> blocks(block_columns_ * block_rows_);
  for (std::size_t r = 0; r < rows_; ++r) {
    const double top = row_cosines_[r], bottom = row_cosines_[r + 1];
    const double sines = squared_sine(r + 1) - squared_sine(r);
    for (std::size_t c = 0; c < columns_; ++c) {
      const double right = longitude(c), left = longitude(c + 1);
      const Vec3d direction{(std::cos(left) - std::cos(right)) * sines,
                            (right - left) * (top * top - bottom * bottom) / 2,
                            (std::sin(right) - std::sin(left)) * sines};
      const Rgb colour(cells_[r * columns_ + c].mean);
      BlockIntegral& block = blocks[r / block_ * block_columns_ + c / block_];
      block.radiance += colour * ((right - left) * (top - bottom));
      for (std::size_t k = 0; k < 3; ++k) block.vectors[k] += direction * colour[k];
    }
  }
  return blocks;
}

void EnvironmentPicture::make_cosine_tables() {
  const double half_block = std::hypot(kPi / double(block_rows_), 2 * kPi / double(block_columns_)) / 2;
  const double lowest = -std::sin(std::min(kPi / 2, kBetweenNormals + half_block));
  std::vector<Vec3d> middles;
  for (std::size_t r = 0; r < block_rows_; ++r)
    for (std::size_t c = 0; c < block_columns_; ++c)
      middles.push_back(direction_of(
          {(double(c) + .5) * double(block_ * step_), (double(r) + .5) * double(block_ * step_)}));
  for (const Vec3d& middle : middles) middles_.emplace_back(middle);
  block_row_ends_.resize(kNormals * kNormals * block_rows_);
  block_column_ends_.resize(kNormals * kNormals * middles.size());
  assumed_cosines_.resize(kNormals * kNormals * middles.size());
  unshadowed_.resize(kNormals * kNormals);
  integrals_ = block_integrals();
  for (std::size_t n = 0; n < kNormals * kNormals; ++n) {
    const auto side = [](std::size_t i) { return 2 * double(i) / (kNormals - 1) - 1; };
    const Vec3d normal = unfolded_normal(side(n % kNormals), side(n / kNormals));
    float* const row_ends = &block_row_ends_[n * block_rows_];
    double whole = 0;
    for (std::size_t r = 0; r < block_rows_; ++r) {
      float* const column_ends = &block_column_ends_[(n * block_rows_ + r) * block_columns_];
      double row = 0;
      for (std::size_t c = 0; c < block_columns_; ++c) {
        const std::size_t b = r * block_columns_ + c;
        const double cosine = dot(normal, middles[b]);
        const double assumed = cosine > lowest ? std::max(cosine, kLeastCosine) : 0;
        column_ends[c] = float(row += block_flux_[b] * assumed);
        if (cosine > -lowest) {
          for (std::size_t k = 0; k < 3; ++k) unshadowed_[n].above[k] += integrals_[b].vectors[k];
          continue;
        }
        assumed_cosines_[n * middles.size() + b] = assumed > 0 ? float(assumed) : -1;
        unshadowed_[n].others += integrals_[b].radiance * assumed;
      }
      normalize(column_ends, block_columns_, row);
      row_ends[r] = float(whole += row);
    }
    normalize(row_ends, block_rows_, whole);
  }
}

Vec3d EnvironmentPicture::direction_of(std::array<double, 2> place) const {
  const double angle = kPi * std::min(1.0, place[1] / double(height_)), sine = std::sin(angle);
  const double longitude = (.5 - std::min(1.0, place[0] / double(width_))) * 2 * kPi;
  return {sine * std::sin(longitude), std::cos(angle), sine * std::cos(longitude)};
}

std::array<double, 2> EnvironmentPicture::place_of(const Vec3d& direction) const {
  return {(.5 - std::atan2(direction.x, direction.z) / (2 * kPi)) * double(width_),
          std::acos(std::clamp(direction.y, -1.0, 1.0)) / kPi * double(height_)};
}

std::size_t EnvironmentPicture::memory() const {
  const std::size_t floats = 4 * pixels_.size() + 4 * cells_.size() + cell_rows_.size() +
                             cell_columns_.size() + block_row_ends_.size() + block_column_ends_.size() +
                             assumed_cosines_.size();
  return floats * sizeof(float) + pixels_.size() * sizeof(RgbF) +
         (row_cosines_.size() + block_flux_.size()) * sizeof(double) +
         unshadowed_.size() * sizeof(Unshadowed) +
         block_flux_.size() * (sizeof(BlockIntegral) + sizeof(Vec3f));
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

}  // namespace opaline
