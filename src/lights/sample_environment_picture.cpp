// SPDX-License-Identifier: GPL-3.0-or-later
// Importance sampling of an environment map.
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <tuple>
#include <utility>

#include "lights/cumulative_shares.h"
#include "lights/environment_picture.h"
#include "lights/light.h"

namespace opaline {
namespace {

constexpr double kPi = std::numbers::pi;
constexpr double kOutsideLobe = .125;  // fraction of directions; bright lights may be in a lobe's tail

}  // namespace

// Probability of a block.
double EnvironmentPicture::block_share(std::size_t normal, std::size_t block) const {
  const std::size_t row = block / block_columns_;
  return share_of(&block_row_ends_[normal * block_rows_], row) *
         share_of(&block_column_ends_[(normal * block_rows_ + row) * block_columns_], block % block_columns_);
}

double EnvironmentPicture::block_share(std::size_t normal, std::size_t block, const InLobe& lobe) const {
  if (lobe.blocks.empty()) return block_share(normal, block);
  const auto at = std::ranges::lower_bound(lobe.blocks, block);
  const double in_lobe = at != lobe.blocks.end() && *at == block
                             ? share_of(lobe.ends.data(), std::size_t(at - lobe.blocks.begin()))
                             : 0;
  return kOutsideLobe * block_share(normal, block) + (1 - kOutsideLobe) * in_lobe;
}

std::size_t EnvironmentPicture::draw_block(std::size_t normal, double& u, double& v) const {
  const std::size_t row = draw(&block_row_ends_[normal * block_rows_], block_rows_, v);
  return row * block_columns_ +
         draw(&block_column_ends_[(normal * block_rows_ + row) * block_columns_], block_columns_, u);
}

std::size_t EnvironmentPicture::draw_block(std::size_t normal, const InLobe& lobe, double& u,
                                           double& v) const {
  if (lobe.blocks.empty()) return draw_block(normal, u, v);
  if (u < kOutsideLobe) {
    u /= kOutsideLobe;
    return draw_block(normal, u, v);
  }
  u = (u - kOutsideLobe) / (1 - kOutsideLobe);
  return lobe.blocks[draw(lobe.ends.data(), lobe.ends.size(), u)];
}

template <class... Lobe>
void EnvironmentPicture::sample_blocks(std::span<const std::array<double, 2>> unit_squares,
                                       std::size_t normal, double turn, std::span<Sample> samples,
                                       const Lobe&... lobe) const {
  constexpr std::size_t kAtOnce = 8;
  std::array<Place, kAtOnce> places;
  for (std::size_t begin = 0; begin < unit_squares.size(); begin += kAtOnce) {
    const std::size_t count = std::min(kAtOnce, unit_squares.size() - begin);
    for (std::size_t i = 0; i < count; ++i) {
      Place& place = places[i];
      std::tie(place.u, place.v) = std::tie(unit_squares[begin + i][0], unit_squares[begin + i][1]);
      place.block = draw_block(normal, lobe..., place.u, place.v);
      const std::size_t block_column = place.block % block_columns_,
                        first_row = place.block / block_columns_ * block_;
      place.row = first_row + draw(&cell_rows_[block_column * rows_ + first_row],
                                   std::min(block_, rows_ - first_row), place.v);
      place.column = block_column * block_;
      __builtin_prefetch(&cell_columns_[place.row * columns_ + place.column]);
    }
    for (std::size_t i = 0; i < count; ++i) {
      Place& place = places[i];
      place.column += draw(&cell_columns_[place.row * columns_ + place.column],
                           std::min(block_, columns_ - place.column), place.u);
      __builtin_prefetch(&cells_[place.row * columns_ + place.column]);
    }
    for (std::size_t i = 0; i < count; ++i) {
      const auto& [u, v, block, r, c] = places[i];
      const Cell& cell = cells_[r * columns_ + c];
      Sample& drawn = samples[begin + i];
      const double density = block_share(normal, block, lobe...) * double(cell.importance);
      if (!(density > 0)) {
        drawn = {{0, 1, 0}, {}, 0, 0};
        continue;
      }
      const double cosine = row_cosines_[r] + (row_cosines_[r + 1] - row_cosines_[r]) * v,
                   sine = std::sqrt(std::max(0.0, 1 - cosine * cosine));
      const double left = double(c * step_), right = std::min(double(width_), left + double(step_));
      const double longitude =
          (.5 - (left + (right - left) * u) / double(width_)) * 2 * kPi + turn * kPi / 180;
      drawn = {{sine * std::sin(longitude), cosine, sine * std::cos(longitude)},
               cell.mean * float(block_flux_[block] / density),
               std::max(0.0f, assumed_cosines_[normal * block_flux_.size() + block]),
               std::uint32_t(block)};
    }
  }
}

EnvironmentPicture::Sample EnvironmentPicture::sample(std::array<double, 2> unit_square, const Vec3d& normal,
                                                      double turn) const {
  Sample drawn;
  sample(std::span(&unit_square, 1), normal, turn, std::span(&drawn, 1));
  return drawn;
}

void EnvironmentPicture::sample(std::span<const std::array<double, 2>> unit_squares, const Vec3d& normal,
                                double turn, std::span<Sample> samples) const {
  sample_blocks(unit_squares, nearest_normal(normal), turn, samples);
}

void EnvironmentPicture::sample(std::span<const std::array<double, 2>> unit_squares, const Vec3d& normal,
                                const InLobe& lobe, double turn, std::span<Sample> samples) const {
  sample_blocks(unit_squares, nearest_normal(normal), turn, samples, lobe);
}

EnvironmentPicture::InLobe EnvironmentPicture::blocks_in_lobe(const Vec3d& mirrored, float alpha,
                                                              const Vec3d& normal) const {
  // Reach of a lobe, in alphas: reflection doubles the angle of a facet, and 1 % of facets are beyond three
  // times alpha.
  constexpr float kReach = 6, kWidest = 1;  // radians
  const float half_block = float(std::hypot(kPi / double(block_rows_), 2 * kPi / double(block_columns_)) / 2);
  const float reach = kReach * alpha + half_block;
  if (reach > kWidest) return {};
  const auto row_at = [&](double angle) {
    return std::min(block_rows_ - 1, std::size_t(std::clamp(angle, 0.0, kPi) / kPi * double(height_) /
                                                 double(block_ * step_)));
  };
  const double angle = std::acos(std::clamp(mirrored.y, -1.0, 1.0)), sine = std::sin(angle);
  const double wide = std::sin(double(reach));
  std::size_t first_column = 0, columns = block_columns_;
  if (wide < sine) {
    const double per_column = double(block_ * step_) / double(width_);
    const double middle = .5 - std::atan2(mirrored.x, mirrored.z) / (2 * kPi),
                 half = std::asin(wide / sine) / (2 * kPi);
    const double left = std::floor((middle - half) / per_column),
                 right = std::floor((middle + half) / per_column);
    columns = std::min(block_columns_, std::size_t(right - left) + 1);
    first_column = std::size_t(left + double(block_columns_)) % block_columns_;
  }
  const float wider = alpha * alpha + half_block * half_block / 4;
  const Lobe lobe{Vec3f(mirrored), std::sqrt(wider)};
  const float* const assumed = &assumed_cosines_[nearest_normal(normal) * block_flux_.size()];
  const float least = std::cos(reach);
  InLobe in_lobe;
  const auto look_at = [&](std::size_t begin, std::size_t end) {
    for (std::size_t b = begin; b < end; ++b)
      if (dot(middles_[b], lobe.mirrored) > least) in_lobe.blocks.push_back(std::uint16_t(b));
  };
  const std::size_t end_column = first_column + columns,
                    over_border = end_column - std::min(end_column, block_columns_);
  for (std::size_t r = row_at(angle - double(reach)); r <= row_at(angle + double(reach)); ++r) {
    const std::size_t row = r * block_columns_;
    look_at(row, row + over_border);
    look_at(row + first_column, row + std::min(end_column, block_columns_));
  }
  // Adds the brightest blocks: a sun in the lobe's tail may exceed everything in its middle.
  in_lobe.blocks.insert(in_lobe.blocks.end(), brightest_.begin(), brightest_.end());
  std::ranges::sort(in_lobe.blocks);
  std::erase_if(in_lobe.blocks, [&, last = -1](std::uint16_t b) mutable {
    return std::exchange(last, int(b)) == int(b) || assumed[b] < 0 || !(block_flux_[b] > 0);
  });
  double sum = 0;
  for (const std::uint16_t b : in_lobe.blocks) {
    sum += block_flux_[b] * double(opaline::mirrored(lobe, dot(middles_[b], lobe.mirrored)));
    in_lobe.ends.push_back(float(sum));
  }
  if (!(sum > 0)) return {};
  normalize(in_lobe.ends.data(), in_lobe.ends.size(), sum);
  return in_lobe;
}

std::size_t EnvironmentPicture::nearest_normal(const Vec3d& normal) {
  const double sum = std::abs(normal.x) + std::abs(normal.y) + std::abs(normal.z);
  double x = normal.x / sum, y = normal.y / sum;
  if (normal.z < 0) {
    const double unfolded = (1 - std::abs(y)) * (x < 0 ? -1 : 1);
    y = (1 - std::abs(x)) * (y < 0 ? -1 : 1);
    x = unfolded;
  }
  const auto step = [](double v) {
    return std::size_t(std::clamp(std::round((v * .5 + .5) * (kNormals - 1)), 0.0, double(kNormals - 1)));
  };
  return step(y) * kNormals + step(x);
}

EnvironmentPicture::Unshadowed EnvironmentPicture::unshadowed(std::size_t nearest_normal,
                                                              std::span<const float> parts) const {
  Unshadowed sum = unshadowed_[nearest_normal];
  const float* const assumed = &assumed_cosines_[nearest_normal * parts.size()];
  for (std::size_t b = 0; b < parts.size(); ++b) {
    const double hidden = 1 - double(parts[b]);
    if (assumed[b] < 0 || hidden == 0) continue;
    if (assumed[b] > 0)
      sum.others -= integrals_[b].radiance * (double(assumed[b]) * hidden);
    else
      for (std::size_t k = 0; k < 3; ++k) sum.above[k] -= integrals_[b].vectors[k] * hidden;
  }
  return sum;
}

std::size_t EnvironmentPicture::cell_of(const Vec3d& direction) const {
  const auto [x, y] = place_of(direction);
  return std::min(rows_ - 1, std::size_t(y) / step_) * columns_ +
         std::min(columns_ - 1, std::size_t(x) / step_);
}

template <class... Lobe>
float EnvironmentPicture::density_in_block(const Vec3d& direction, const Vec3d& normal,
                                           const Lobe&... lobe) const {
  const std::size_t cell = cell_of(direction),
                    block = cell / columns_ / block_ * block_columns_ + cell % columns_ / block_;
  const double flux = block_flux_[block];
  if (!(flux > 0)) return 0;
  return float(block_share(nearest_normal(normal), block, lobe...) * double(cells_[cell].importance) / flux);
}

float EnvironmentPicture::density(const Vec3d& direction, const Vec3d& normal) const {
  return density_in_block(direction, normal);
}

float EnvironmentPicture::density(const Vec3d& direction, const Vec3d& normal, const InLobe& lobe) const {
  return density_in_block(direction, normal, lobe);
}

}  // namespace opaline
