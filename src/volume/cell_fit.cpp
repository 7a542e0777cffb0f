// SPDX-License-Identifier: GPL-3.0-or-later
#include "volume/cell_fit.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "core/cancel_check.h"
#include "core/parallel.h"

namespace opaline {
namespace {

// Tuned on smooth fields with and without noise (src/volume/README.md).
constexpr float kFitRadius = 2.6f, kBlendRadius = 1.2f, kSurpriseRadius = 2.4f;  // spacings
// Spacings: radius around the centre with cached cells; largest radius of expected points; margin for
// rounding.
constexpr float kTakenBeyond = .5f, kFarthestTaken = 1.5f, kRounding = 1e-3f;
constexpr int kSurpriseRounds = 3;
constexpr float kCube = 2.6f;  // side of the search cubes, spacings
constexpr double kShapePerSurprise = 1.4;
constexpr float kBlendedNoise = .9f;  ///< noise of blended fits over that of one
constexpr float kLeastCosine = .4f;   // least cosine between the normals of neighbours
/// Second moment of a cell along an axis, over its squared area: between a hexagon (0.0802) and a square
/// (0.0833).
constexpr double kCellMoment = .0815;

constexpr std::size_t kTerms = 6;
using Terms = std::array<double, kTerms>;

/// 1 where normals agree; 0 where the surface has turned too far.
double alike(const Vec3f& a, const Vec3f& b) {
  constexpr double kPerRange = 1 / double(1 - kLeastCosine);
  return std::max(0.0, double(dot(a, b) - kLeastCosine) * kPerRange);
}

/// Falls from 1 to 0 at the radius; its argument is the squared distance over the squared radius.
double bump(double distance2) {
  const double left = 1 - distance2;
  return left > 0 ? left * left : 0;
}

/// Symmetric, positive definite.
class NormalEquations {
 public:
  void add(const Terms& terms, double weight) {
    for (std::size_t i = 0; i < kTerms; ++i) {
      const double weighted = weight * terms[i];
      for (std::size_t j = 0; j < kTerms; ++j) rows_[i][j] += weighted * terms[j];
    }
  }

  /// Inverse of the matrix, by Cholesky factorization. Regularized: coefficients not determined by few or
  /// collinear neighbours become 0.
  std::array<Terms, kTerms> inverse() const {
    constexpr double kLeastSlope = 1e-4, kLeastCurvature = 1e-3;
    std::array<Terms, kTerms> factor{}, inverse{};  // lower triangles; the factor's diagonal is not stored
    for (std::size_t i = 0; i < kTerms; ++i) {
      double diagonal = rows_[i][i] + (i == 0 ? 0 : i < 3 ? kLeastSlope : kLeastCurvature);
      for (std::size_t j = 0; j < i; ++j) {
        double sum = rows_[i][j];
        for (std::size_t k = 0; k < j; ++k) sum -= factor[i][k] * factor[j][k];
        factor[i][j] = sum * inverse[j][j];
        diagonal -= factor[i][j] * factor[i][j];
      }
      inverse[i][i] = 1 / std::sqrt(std::max(diagonal, 1e-30));
      for (std::size_t j = 0; j < i; ++j) {
        for (std::size_t k = j; k < i; ++k) inverse[i][j] -= factor[i][k] * inverse[k][j];
        inverse[i][j] *= inverse[i][i];
      }
    }
    std::array<Terms, kTerms> product{};
    for (std::size_t i = 0; i < kTerms; ++i)
      for (std::size_t j = 0; j <= i; ++j) {
        for (std::size_t k = i; k < kTerms; ++k) product[i][j] += inverse[k][i] * inverse[k][j];
        product[j][i] = product[i][j];
      }
    return product;
  }

 private:
  std::array<Terms, kTerms> rows_{};
};

/// A mean in the fit of a cell's quadratic.
struct FittedMean {
  std::uint32_t sample;
  double weight;
  Terms terms;  ///< averaged over its cell
};

constexpr std::size_t kChunk = 256;  // cells

}  // namespace

CellWeights::Places::Places(std::span<const SurfaceSample> samples)
    : middles(NearestSample::by_centroids(samples, kCube)), of_sample(samples.size()) {
  double area = 0;
  for (const SurfaceSample& s : samples) area += double(s.area);
  if (area > 0) spacing = float(std::sqrt(area / double(samples.size())));
  const std::span<const NearestSample::Member> members = middles.members();
  for (std::size_t m = 0; m < members.size(); ++m) of_sample[members[m].sample] = std::uint32_t(m);
}

CellWeights::CellWeights(std::span<const SurfaceSample> samples)
    : places_(std::make_shared<const Places>(samples)), chunks_(chunk_count(samples.size(), kChunk)) {
  const CancelCheck check;
  parallel_chunks(samples.size(), kChunk, [&](std::size_t begin, std::size_t end, std::size_t c) {
    check();
    chunks_[c] = chunk_of(*places_, samples, begin, end);
    chunks_[c].neighbours.shrink_to_fit();
    chunks_[c].terms.shrink_to_fit();
  });
}

// Least squares with neighbours weighted by area: the inverse of the normal equations, times the contribution
// of each mean.
CellWeights::Chunk CellWeights::chunk_of(const Places& places, std::span<const SurfaceSample> samples,
                                         std::size_t begin, std::size_t end) {
  const float radius = kFitRadius * places.spacing;
  const double scale = 1 / double(places.spacing), per_radius2 = 1 / (double(radius) * double(radius));
  constexpr double kPerSurpriseRadius2 =
      double(kFitRadius * kFitRadius / (kSurpriseRadius * kSurpriseRadius));
  const auto moment_of = [&](std::uint32_t sample) {
    return kCellMoment * double(samples[sample].area) * scale * scale;
  };
  Chunk chunk;
  std::vector<FittedMean> means;
  for (const NearestSample::Member& own : places.middles.members().subspan(begin, end - begin)) {
    Frame frame{{}, {}, float(moment_of(own.sample))};
    tangent_frame(own.normal, frame.along_u, frame.along_v);
    means.clear();
    double weights = 0;
    places.middles.for_near(own.position, radius, [&](const NearestSample::Member& member) {
      const Vec3f apart = member.position - own.position;
      const double distance2 = double(dot(apart, apart)) * per_radius2;
      if (!(distance2 < 1)) return;
      const double turned = alike(member.normal, own.normal),
                   weight = bump(distance2) * turned * double(samples[member.sample].area);
      if (!(weight > 0)) return;
      const double u = double(dot(apart, frame.along_u)) * scale,
                   v = double(dot(apart, frame.along_v)) * scale, moment = moment_of(member.sample);
      means.push_back({member.sample, weight, {1, u, v, u * u + moment, u * v, v * v + moment}});
      chunk.neighbours.push_back({member.sample, float(bump(distance2 * kPerSurpriseRadius2) * turned)});
      weights += weight;
    });
    if (means.empty()) {
      chunk.neighbours.push_back({own.sample, 1});
      chunk.terms.push_back({1});
    }
    NormalEquations equations;
    for (FittedMean& mean : means) equations.add(mean.terms, mean.weight *= 1 / weights);
    const std::array<Terms, kTerms> inverse = equations.inverse();
    for (const FittedMean& mean : means) {
      Terms solved{};
      for (std::size_t i = 0; i < kTerms; ++i) {  // symmetric: columns are rows
        const double weighted = mean.weight * mean.terms[i];
        for (std::size_t j = 0; j < kTerms; ++j) solved[j] += weighted * inverse[i][j];
      }
      std::ranges::transform(solved, chunk.terms.emplace_back().begin(), [](double t) { return float(t); });
    }
    chunk.frames.push_back(frame);
    chunk.ends.push_back(std::uint32_t(chunk.neighbours.size()));
  }
  return chunk;
}

CellFit::CellFit(std::span<const SurfaceSample> samples, std::span<const RgbF> means,
                 std::span<const RgbF> errors)
    : places_(std::make_shared<const CellWeights::Places>(samples)), fits_(means.size()) {
  std::vector<Rgb> surprises(means.size());
  std::vector<CellWeights::Chunk> chunks(chunk_count(means.size(), kChunk));
  const CancelCheck check;
  parallel_chunks(means.size(), kChunk, [&](std::size_t begin, std::size_t end, std::size_t c) {
    check();
    chunks[c] = CellWeights::chunk_of(*places_, samples, begin, end);
    fit(chunks[c], begin, means, errors, surprises);
    chunks[c].terms = {};  // most of its memory
  });
  smooth(chunks, std::move(surprises));
}

CellFit::CellFit(const CellWeights& weights, std::span<const RgbF> means, std::span<const RgbF> errors)
    : places_(weights.places_), fits_(means.size()) {
  std::vector<Rgb> surprises(means.size());
  parallel_chunks(means.size(), kChunk, [&](std::size_t begin, std::size_t, std::size_t c) {
    fit(weights.chunks_[c], begin, means, errors, surprises);
  });
  if (!errors.empty()) smooth(weights.chunks_, std::move(surprises));
}

// Fits the quadratics. A cell's surprise is its squared residual, minus the expectation from the means'
// errors.
void CellFit::fit(const CellWeights::Chunk& chunk, std::size_t begin, std::span<const RgbF> means,
                  std::span<const RgbF> errors, std::span<Rgb> surprises) {
  const auto add_square = [](Rgb& sum, const Channels& channels) {  // in double: exceeds the range of float
    for (int c = 0; c < 3; ++c) sum[std::size_t(c)] += double(channels[c]) * double(channels[c]);
  };
  const std::span<const NearestSample::Member> members = places_->middles.members();
  std::size_t next = 0;
  for (std::size_t i = 0; i < chunk.frames.size(); ++i) {
    const CellWeights::Frame& frame = chunk.frames[i];
    const std::uint32_t own = members[begin + i].sample;
    Fit fit{frame.along_u, frame.along_v, {}, {}, {}};
    Channels missed{};
    Rgb noise2{}, missed_noise2{};
    for (; next < chunk.ends[i]; ++next) {
      const std::uint32_t sample = chunk.neighbours[next].sample;
      const std::array<float, kTerms>& terms = chunk.terms[next];
      const Channels mean = channels_of(means[sample]);
      for (std::size_t t = 0; t < kTerms; ++t) fit.terms[t] += mean * terms[t];
      if (errors.empty()) continue;
      const Channels error = channels_of(errors[sample]);
      add_square(noise2, error * terms[0]);
      const float over_cell = terms[0] + frame.moment * (terms[3] + terms[5]),
                  miss = (sample == own ? 1 : 0) - over_cell;
      missed += mean * miss;
      add_square(missed_noise2, error * miss);
    }
    for (int c = 0; c < 3; ++c) {
      fit.noise[c] = float(std::sqrt(noise2[std::size_t(c)]));
      surprises[own][std::size_t(c)] = double(missed[c]) * double(missed[c]) - missed_noise2[std::size_t(c)];
    }
    fits_[begin + i] = fit;
  }
}

// Smooths the surprises, as single ones are mostly noise. Repeated averaging equals a wide kernel, but visits
// fewer cells.
void CellFit::smooth(std::span<const CellWeights::Chunk> chunks, std::vector<Rgb> surprises) {
  const std::span<const NearestSample::Member> members = places_->middles.members();
  std::vector<Rgb> smoothed(surprises.size());
  for (int round = 0; round < kSurpriseRounds; ++round) {
    parallel_chunks(members.size(), kChunk, [&](std::size_t begin, std::size_t end, std::size_t c) {
      std::size_t next = 0;
      for (std::size_t m = begin; m < end; ++m) {
        Rgb sum{};
        double weights = 0;
        for (; next < chunks[c].ends[m - begin]; ++next) {
          const auto& [sample, closeness] = chunks[c].neighbours[next];
          sum += surprises[sample] * double(closeness);
          weights += double(closeness);
        }
        smoothed[members[m].sample] = weights > 0 ? sum / weights : Rgb{};
      }
    });
    surprises.swap(smoothed);
  }
  for (std::size_t m = 0; m < members.size(); ++m)
    for (std::size_t c = 0; c < 3; ++c)
      fits_[m].shape[int(c)] =
          float(kShapePerSurprise * std::sqrt(std::max(0.0, surprises[members[m].sample][c])));
}

CellFit::Reader::Reader(const CellFit& fit) : fit_(fit), taken_(std::numeric_limits<float>::infinity()) {}

void CellFit::Reader::expect(std::span<const Vec3f> positions) {
  Vec3f low(std::numeric_limits<float>::infinity()), high = -low;
  for (const Vec3f& position : positions) widen(low, high, position);
  const float beyond = length(high - low) * .5f / fit_.places_->spacing + kRounding;
  if (beyond <= kFarthestTaken) take_around((low + high) * .5f, beyond);
}

// Caches the cells around a position in the order of their cubes, independent of the position, so sums have
// the same bits.
void CellFit::Reader::take_around(const Vec3f& position, float beyond) {
  taken_ = position, beyond_ = beyond;
  near_.clear();
  const float radius = (kBlendRadius + beyond + kRounding) * fit_.places_->spacing, radius2 = radius * radius;
  const std::span<const NearestSample::Member> members = fit_.places_->middles.members();
  fit_.places_->middles.for_near(position, radius, [&](const NearestSample::Member& member) {
    const Vec3f apart = member.position - position;
    if (dot(apart, apart) < radius2) near_.push_back(std::uint32_t(&member - members.data()));
  });
  fours_.assign((near_.size() + 3) / 4, {});  // padding has zero normals, hence weight 0
  weighed_.resize(fours_.size());
  blended_.resize(4 * fours_.size() + 1);
  for (std::size_t i = 0; i < near_.size(); ++i)
    for (std::size_t axis = 0; axis < 3; ++axis) {
      fours_[i / 4].middle[axis][i % 4] = members[near_[i]].position[axis];
      fours_[i / 4].normal[axis][i % 4] = members[near_[i]].normal[axis];
    }
}

CellFit::Value CellFit::Reader::at(const Vec3f& position, const Vec3f& normal) {
  const float per_spacing = 1 / fit_.places_->spacing;
  const Vec3f moved = (position - taken_) * per_spacing;
  if (!(dot(moved, moved) <= beyond_ * beyond_)) take_around(position, kTakenBeyond);
  constexpr float kPerRadius2 = 1 / (kBlendRadius * kBlendRadius);
  std::size_t count = 0;
  for (std::size_t four = 0; four < fours_.size(); ++four) {
    const auto& [middle, other] = fours_[four];
    const Four x = (position.x - middle[0]) * per_spacing, y = (position.y - middle[1]) * per_spacing,
               z = (position.z - middle[2]) * per_spacing;
    const Four left = 1 - (x * x + y * y + z * z) * kPerRadius2,
               turned = other[0] * normal.x + other[1] * normal.y + other[2] * normal.z - kLeastCosine;
    weighed_[four] = {{x, y, z}, left * left * turned};
    const auto counts = (left > 0) & (turned > 0);  // -1 or 0
    for (std::size_t lane = 0; lane < 4; ++lane) {  // branchless: the branch is unpredictable
      blended_[count] = std::uint32_t(4 * four + lane);
      count += std::size_t(-counts[lane]);
    }
  }
  Channels value{}, noise{}, shape{};
  float weights = 0;
  for (const std::uint32_t i : std::span(blended_).first(count)) {
    const auto& [from, weight4] = weighed_[i / 4];
    const std::size_t lane = i % 4;
    const Fit& fit = fit_.fits_[near_[i]];
    const Vec3f apart{from[0][lane], from[1][lane], from[2][lane]};
    const float weight = weight4[lane], u = dot(apart, fit.along_u), v = dot(apart, fit.along_v);
    const auto& t = fit.terms;
    value += (t[0] + t[1] * u + t[2] * v + t[3] * (u * u) + t[4] * (u * v) + t[5] * (v * v)) * weight;
    noise += fit.noise * weight;
    shape += fit.shape * weight;
    weights += weight;
  }
  if (weights > 0) {
    value /= weights;
    noise *= kBlendedNoise / weights;
    shape /= weights;
  } else if (!fit_.fits_.empty()) {
    const Fit& fit = fit_.fits_[fit_.places_->of_sample[fit_.places_->middles.at(position, normal)]];
    value = fit.terms[0], noise = fit.noise, shape = fit.shape;
  }
  return {component_max(rgb_of(value), RgbF{}), rgb_of(noise), rgb_of(shape)};
}

}  // namespace opaline
