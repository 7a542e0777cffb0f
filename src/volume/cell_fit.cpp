// SPDX-License-Identifier: GPL-3.0-or-later
#include "opaline/volume/cell_fit.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "opaline/core/parallel.h"

namespace opaline {
namespace {

// Measured on smooth fields without noise and with (src/volume/README.md).
constexpr float kFitRadius = 2.6f, kBlendRadius = 1.2f, kSurpriseRadius = 2.4f;  // spacings
// Spacings: a reader's cells serve points that far off; those that are expected, at most; and what is added for rounding.
constexpr float kTakenBeyond = .5f, kFarthestTaken = 1.5f, kRounding = 1e-3f;
constexpr int kSurpriseRounds = 3;
constexpr float kCube =
    2.6f;  // spacings: against 1, three quarters of the time on the bunny; above 2 all alike
constexpr double kShapePerSurprise = 1.4;
constexpr float kBlendedNoise = .9f;  ///< over that of one fit
constexpr float kLeastCosine = .4f;   // between normals that have to do with each other
/// Mean square, along any axis, of a cell's points about its middle, over its area: of a hexagon .0802, of a
/// square .0833.
constexpr double kCellMoment = .0815;

constexpr std::size_t kTerms = 6;
using Terms = std::array<double, kTerms>;

/// 1 where normals agree; 0 where the surface has turned too far.
double alike(const Vec3f& a, const Vec3f& b) {
  return std::max(0.0, double(dot(a, b) - kLeastCosine) / double(1 - kLeastCosine));
}

/// Falls from 1 to 0 at the radius.
double bump(const Vec3f& apart, float radius) {
  const float distance2 = dot(apart, apart), radius2 = radius * radius;
  if (!(distance2 < radius2)) return 0;
  const double left = 1 - double(distance2) / double(radius2);
  return left * left;
}

/// Symmetric and positive.
class NormalEquations {
 public:
  void add(const Terms& terms, double weight) {
    for (std::size_t i = 0; i < kTerms; ++i)
      for (std::size_t j = 0; j <= i; ++j) rows_[i][j] += weight * terms[i] * terms[j];
  }

  /// Cholesky, in place. What few neighbours, or neighbours in a row, leave open becomes 0.
  void factor() {
    constexpr double kLeastSlope = 1e-4, kLeastCurvature = 1e-3;
    for (std::size_t i = 1; i < kTerms; ++i) rows_[i][i] += i < 3 ? kLeastSlope : kLeastCurvature;
    for (std::size_t i = 0; i < kTerms; ++i)
      for (std::size_t j = 0; j <= i; ++j) {
        double sum = rows_[i][j];
        for (std::size_t k = 0; k < j; ++k) sum -= rows_[i][k] * rows_[j][k];
        rows_[i][j] = i == j ? std::sqrt(std::max(sum, 1e-30)) : sum / rows_[j][j];
      }
  }

  Terms solve(Terms b) const {
    for (std::size_t i = 0; i < kTerms; ++i) {
      for (std::size_t k = 0; k < i; ++k) b[i] -= rows_[i][k] * b[k];
      b[i] /= rows_[i][i];
    }
    for (std::size_t i = kTerms; i-- > 0;) {
      for (std::size_t k = i + 1; k < kTerms; ++k) b[i] -= rows_[k][i] * b[k];
      b[i] /= rows_[i][i];
    }
    return b;
  }

 private:
  std::array<Terms, kTerms> rows_{};
};

struct Neighbour {
  std::uint32_t sample;
  double weight;
  Terms terms;  ///< means over its cell
};

std::vector<SurfaceSample> at_centroids(std::span<const SurfaceSample> samples) {
  std::vector<SurfaceSample> moved(samples.begin(), samples.end());
  for (SurfaceSample& s : moved) s.position = s.centroid;
  return moved;
}

double product(const Terms& a, const Terms& b) {
  double sum = 0;
  for (std::size_t t = 0; t < kTerms; ++t) sum += a[t] * b[t];
  return sum;
}

}  // namespace

/// Calls use(member, weight) for the cells within so many spacings whose normals are alike.
template <class Use>
void CellFit::for_alike(const Vec3f& position, const Vec3f& normal, float spacings, const Use& use) const {
  const float radius = spacings * spacing_;
  middles_.for_near(position, radius, [&](const NearestSample::Member& member) {
    const double near = bump(member.position - position, radius);
    if (!(near > 0)) return;
    const double weight = near * alike(member.normal, normal);
    if (weight > 0) use(member, weight);
  });
}

CellFit::CellFit(std::span<const SurfaceSample> samples, std::span<const RgbF> means,
                 std::span<const RgbF> errors)
    : middles_(at_centroids(samples), nullptr, kCube), fits_(samples.size()), places_(samples.size()) {
  double area = 0;
  std::vector<Cell> cells;
  for (std::size_t i = 0; i < samples.size(); ++i) {
    area += double(samples[i].area);
    cells.push_back({means[i], errors[i], samples[i].area});
  }
  if (area > 0) spacing_ = float(std::sqrt(area / double(samples.size())));
  std::vector<Surprise> surprises(samples.size());
  const std::span<const NearestSample::Member> members = middles_.members();  // near each other: in the cache
  parallel_chunks(members.size(), 256, [&](std::size_t begin, std::size_t end, std::size_t) {
    for (std::size_t m = begin; m < end; ++m) {
      places_[members[m].sample] = std::uint32_t(m);
      fits_[m] = fitted(members[m], cells, surprises[members[m].sample]);
    }
  });
  // That of one cell is mostly chance. Means of means reach as far as a wide one, past fewer cells.
  std::vector<Rgb> smoothed(surprises.size());
  for (int round = 0; round < kSurpriseRounds; ++round) {
    parallel_chunks(samples.size(), 256, [&](std::size_t begin, std::size_t end, std::size_t) {
      for (std::size_t i = begin; i < end; ++i) {
        Rgb sum{};
        double weights = 0;
        for (const auto& [other, weight] : surprises[i].near) {
          sum += surprises[other].square * double(weight);
          weights += double(weight);
        }
        smoothed[i] = weights > 0 ? sum / weights : Rgb{};
      }
    });
    for (std::size_t i = 0; i < surprises.size(); ++i) surprises[i].square = smoothed[i];
  }
  for (std::size_t m = 0; m < members.size(); ++m)
    for (std::size_t c = 0; c < 3; ++c)
      fits_[m].shape[int(c)] =
          float(kShapePerSurprise * std::sqrt(std::max(0.0, smoothed[members[m].sample][c])));
}

// Least squares, neighbours weighted by area. The surprise is the square of what the fit's mean over the cell misses of
// the cell's mean, less what the means' errors make of it on average.
CellFit::Fit CellFit::fitted(const NearestSample::Member& own, std::span<const Cell> cells,
                             Surprise& surprise) const {
  const Cell& own_cell = cells[own.sample];
  const double scale = 1 / double(spacing_);
  Vec3f along_u, along_v;
  tangent_frame(own.normal, along_u, along_v);
  Fit fit{along_u, along_v, {}, channels_of(own_cell.error), {}};
  const auto moment_of = [&](const Cell& cell) { return kCellMoment * double(cell.area) * scale * scale; };
  std::vector<Neighbour> near;
  near.reserve(32);
  surprise.near.reserve(24);
  NormalEquations equations;
  double weights = 0;
  for_alike(own.position, own.normal, kFitRadius, [&](const NearestSample::Member& member, double weight) {
    const Cell& cell = cells[member.sample];
    weight *= double(cell.area);
    const Vec3f apart = member.position - own.position;
    if (const double close = bump(apart, kSurpriseRadius * spacing_); close > 0)
      surprise.near.push_back({member.sample, float(close * alike(member.normal, own.normal))});
    const double u = double(dot(apart, along_u)) * scale, v = double(dot(apart, along_v)) * scale,
                 moment = moment_of(cell);
    near.push_back({member.sample, weight, {1, u, v, u * u + moment, u * v, v * v + moment}});
    weights += weight;
  });
  if (!(weights > 0)) {
    fit.terms[0] = channels_of(own_cell.mean);
    return fit;
  }
  for (Neighbour& n : near) equations.add(n.terms, n.weight /= weights);
  equations.factor();
  const double own_moment = moment_of(own_cell);
  const Terms at_center = equations.solve({1}),
              over_cell = equations.solve({1, 0, 0, own_moment, 0, own_moment});
  std::array<Terms, 3> sums{};
  Rgb noise2{}, missed{}, missed_noise2{};
  for (const Neighbour& n : near) {
    const Cell& cell = cells[n.sample];
    const Rgb mean(cell.mean), error2 = Rgb(cell.error) * Rgb(cell.error);
    for (std::size_t c = 0; c < 3; ++c)
      for (std::size_t t = 0; t < kTerms; ++t) sums[c][t] += n.weight * mean[c] * n.terms[t];
    const double share = n.weight * product(at_center, n.terms),
                 miss = (n.sample == own.sample ? 1 : 0) - n.weight * product(over_cell, n.terms);
    noise2 += error2 * (share * share);
    missed += mean * miss;
    missed_noise2 += error2 * (miss * miss);
  }
  for (std::size_t c = 0; c < 3; ++c) {
    const Terms solved = equations.solve(sums[c]);
    for (std::size_t t = 0; t < kTerms; ++t) fit.terms[t][int(c)] = float(solved[t]);
    fit.noise[int(c)] = float(std::sqrt(noise2[c]));
  }
  surprise.square = missed * missed - missed_noise2;
  return fit;
}

CellFit::Reader::Reader(const CellFit& fit) : fit_(fit), taken_(std::numeric_limits<float>::infinity()) {}

void CellFit::Reader::expect(std::span<const Vec3f> positions) {
  Vec3f low(std::numeric_limits<float>::infinity()), high = -low;
  for (const Vec3f& position : positions)
    low = component_min(low, position), high = component_max(high, position);
  const float beyond = length(high - low) * .5f / fit_.spacing_ + kRounding;
  if (beyond <= kFarthestTaken) take_around((low + high) * .5f, beyond);
}

// In the order of the cubes that they lie in, whatever point they are taken around: sums have the same bits.
void CellFit::Reader::take_around(const Vec3f& position, float beyond) {
  taken_ = position, beyond_ = beyond;
  near_.clear();
  const float radius = (kBlendRadius + beyond + kRounding) * fit_.spacing_, radius2 = radius * radius;
  const std::span<const NearestSample::Member> members = fit_.middles_.members();
  fit_.middles_.for_near(position, radius, [&](const NearestSample::Member& member) {
    const Vec3f apart = member.position - position;
    if (dot(apart, apart) < radius2) near_.push_back(std::uint32_t(&member - members.data()));
  });
  fours_.assign((near_.size() + 3) / 4, {});  // those past the last have no normal: their weight is 0
  for (std::size_t i = 0; i < near_.size(); ++i)
    for (std::size_t axis = 0; axis < 3; ++axis) {
      fours_[i / 4].middle[axis][i % 4] = members[near_[i]].position[axis];
      fours_[i / 4].normal[axis][i % 4] = members[near_[i]].normal[axis];
    }
}

CellFit::Value CellFit::Reader::at(const Vec3f& position, const Vec3f& normal) {
  const float per_spacing = 1 / fit_.spacing_;
  const Vec3f moved = (position - taken_) * per_spacing;
  if (!(dot(moved, moved) <= beyond_ * beyond_)) take_around(position, kTakenBeyond);
  constexpr float kPerRadius2 = 1 / (kBlendRadius * kBlendRadius);
  Channels value{}, noise{}, shape{};
  float weights = 0;
  for (std::size_t four = 0; four < fours_.size(); ++four) {
    const auto& [middle, other] = fours_[four];
    const Four x = (position.x - middle[0]) * per_spacing, y = (position.y - middle[1]) * per_spacing,
               z = (position.z - middle[2]) * per_spacing;
    const Four left = 1 - (x * x + y * y + z * z) * kPerRadius2,
               turned = other[0] * normal.x + other[1] * normal.y + other[2] * normal.z - kLeastCosine;
    const Four weight4 = left * left * turned;
    for (int lane = 0; lane < 4; ++lane) {
      if (!(left[lane] > 0 && turned[lane] > 0)) continue;
      const Fit& fit = fit_.fits_[near_[4 * four + std::size_t(lane)]];
      const Vec3f apart{x[lane], y[lane], z[lane]};
      const float weight = weight4[lane], u = dot(apart, fit.along_u), v = dot(apart, fit.along_v);
      const auto& t = fit.terms;
      value += (t[0] + t[1] * u + t[2] * v + t[3] * (u * u) + t[4] * (u * v) + t[5] * (v * v)) * weight;
      noise += fit.noise * weight;
      shape += fit.shape * weight;
      weights += weight;
    }
  }
  if (weights > 0) {
    value /= weights;
    noise *= kBlendedNoise / weights;
    shape /= weights;
  } else if (!fit_.fits_.empty()) {
    const Fit& fit = fit_.fits_[fit_.places_[fit_.middles_.at(position, normal)]];
    value = fit.terms[0], noise = fit.noise, shape = fit.shape;
  }
  return {component_max(rgb_of(value), RgbF{}), rgb_of(noise), rgb_of(shape)};
}

}  // namespace opaline
