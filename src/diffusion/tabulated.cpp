// SPDX-License-Identifier: GPL-3.0-or-later
// From rings of random walks to a smooth table.
#include "diffusion/tabulated.h"

#include <tbb/task_arena.h>

#include <algorithm>
#include <boost/math/quadrature/gauss.hpp>
#include <cmath>
#include <cstdint>
#include <deque>
#include <limits>
#include <mutex>
#include <numbers>
#include <utility>
#include <vector>

#include "diffusion/layered_albedo.h"
#include "transport/fresnel.h"
#include "transport/half_space.h"
#include "transport/laboratory.h"
#include "transport/point_source.h"

namespace opaline {
namespace {

constexpr std::size_t kKnots = RadialTable::kKnots;

// Longer walks exit far away, where the table equals the exact decay.
constexpr std::uint64_t kMostCollisions = 1 << 16;
constexpr double kMostWalks = 400000;
// Darker media hardly change the shape (all but 2 % of the light is scattered once), and few walks return.
constexpr double kMostAbsorbed = .97;
constexpr std::size_t kPilotWalks = 1024;

SlabWalks walk(const WalkedMedium& walked) {
  const double absorbed = std::min(walked.absorbed, kMostAbsorbed), eta = std::clamp(walked.eta, .1, 10.);
  std::vector<SlabLayer> layers;
  for (const FlatLayer& layer : walked.layers)
    layers.push_back({{layer.sigma_a, layer.sigma_s_prime, 0, eta}, layer.thickness});
  LaboratorySettings settings;
  settings.most_collisions = kMostCollisions;
  settings.cosine_bins = 1;
  const auto traced = [&](std::uint64_t seed, std::size_t walks) {
    settings.seed = seed;
    settings.walks = walks;
    return layers.empty() ? walk_slab({absorbed, 1 - absorbed, 0, eta}, {}, kDiffuseEntry, settings)
                          : walk_layers(layers, kDiffuseEntry, settings);
  };
  const double each = traced(7001, kPilotWalks).collisions + 3;  // 3: entry and exit
  for (std::size_t i = 0; i < kKnots; ++i) settings.radii.push_back(RadialTable::knot(i));
  return traced(7002, std::size_t(std::clamp(kWalkedCollisions / each, 1., kMostWalks)));
}

/// The slowest decay of the layers, per mean free path.
double decay_of(const WalkedMedium& medium) {
  if (medium.layers.empty()) return decay_constant(medium.absorbed);
  double slowest = std::numeric_limits<double>::infinity();
  for (const FlatLayer& layer : medium.layers) {
    const double extinction = layer.sigma_a + layer.sigma_s_prime;
    if (!(extinction * layer.thickness > 0)) continue;
    const double absorbed = layer.sigma_a / extinction;
    slowest = std::min(slowest, extinction * (absorbed < 1 ? decay_constant(absorbed) : 1));
  }
  return std::isfinite(slowest) ? slowest : 0;
}

RadialReference reference_of(const WalkedMedium& medium) {
  // The width is half the distance between the dipole's source, one mean free path deep, and its image: 1 + 2
  // A / 3.
  const double inside = std::min(.99, average_reflectance_inside(medium.eta));
  return {decay_of(medium), 1 + 2. / 3 * (1 + inside) / (1 - inside)};
}

/// The reference's fraction of each ring: before the first knot, between knots, and beyond the last one.
std::vector<double> reference_shares(const RadialReference& reference) {
  const auto ring = [&](double r) { return 2 * std::numbers::pi * r * reference(r); };
  using Rule = boost::math::quadrature::gauss<double, 10>;
  const auto share = [&](double low, double high) {
    return Rule::integrate([&](double u) { return std::exp(u) * ring(std::exp(u)); }, std::log(low),
                           std::log(high));
  };
  std::vector<double> shares{RadialTable::kFirst * ring(RadialTable::kFirst)};
  for (std::size_t i = 1; i < kKnots; ++i)
    shares.push_back(share(RadialTable::knot(i - 1), RadialTable::knot(i)));
  const double last = RadialTable::knot(kKnots - 1);
  shares.push_back(last * ring(last) / (1 + reference.decay * last));
  return shares;
}

/// Solves for f at the knots, with the reference times e^f matching the walks: minimizes the Poisson deviance
/// of the rings plus penalties on first and second differences of f. Convex; by Newton's method.
class SmoothFit {
 public:
  SmoothFit(std::vector<double> reference, std::vector<double> walked, double variance)
      : reference_(std::move(reference)), walked_(std::move(walked)), variance_(variance) {}

  std::vector<double> solve() {
    double model = 0, data = 0;
    for (std::size_t i = 0; i <= kKnots; ++i) {
      model += reference_[i];
      data += walked_[i];
    }
    std::vector<double> f(kKnots, std::log(data / model));
    for (int round = 0; round < 60; ++round) {
      const std::vector<double> step = newton_step(f);
      double largest = 0;
      for (const double s : step) largest = std::max(largest, std::abs(s));
      const double scale = std::min(1.0, kLongestStep / std::max(largest, 1e-300));
      for (std::size_t i = 0; i < kKnots; ++i) f[i] += scale * step[i];
      if (largest < 1e-10) break;
    }
    return f;
  }

 private:
  // Expected standard deviations of f's first and second differences between knots, chosen by the walks' own
  // noise (Tabulated.IsTheLongerWalk).
  static constexpr double kSlope = .12, kBend = .03, kLongestStep = 2;
  static constexpr std::size_t kBand = 2;
  using Row = std::array<double, kBand + 1>;  // row of the symmetric matrix: diagonal, and to its right

  std::vector<double> newton_step(const std::vector<double>& f) const {
    std::vector<Row> matrix(kKnots, Row{});
    std::vector<double> right(kKnots, 0.0);
    const auto add = [&](std::size_t first, const std::vector<double>& row, double weight, double residual) {
      for (std::size_t a = 0; a < row.size(); ++a) {
        right[first + a] -= row[a] * residual;
        for (std::size_t b = a; b < row.size(); ++b) matrix[first + a][b - a] += weight * row[a] * row[b];
      }
    };
    const auto add_ring = [&](std::size_t first, const std::vector<double>& row, std::size_t i) {
      double log_ratio = 0;
      for (std::size_t a = 0; a < row.size(); ++a) log_ratio += row[a] * f[first + a];
      const double model = reference_[i] * std::exp(log_ratio);
      add(first, row, model / variance_, (model - walked_[i]) / variance_);
    };
    add_ring(0, {1}, 0);
    for (std::size_t i = 1; i < kKnots; ++i) add_ring(i - 1, {.5, .5}, i);
    add_ring(kKnots - 1, {1}, kKnots);
    for (std::size_t i = 1; i < kKnots; ++i)
      add(i - 1, {-1, 1}, 1 / (kSlope * kSlope), (f[i] - f[i - 1]) / (kSlope * kSlope));
    for (std::size_t i = 2; i < kKnots; ++i)
      add(i - 2, {1, -2, 1}, 1 / (kBend * kBend), (f[i] - 2 * f[i - 1] + f[i - 2]) / (kBend * kBend));
    return solve_banded(matrix, right);
  }

  static std::vector<double> solve_banded(std::vector<Row> m, std::vector<double> b) {
    const std::size_t n = b.size();
    for (std::size_t k = 0; k < n; ++k)
      for (std::size_t i = 1; i <= kBand && k + i < n; ++i) {
        const double factor = m[k][i] / m[k][0];
        for (std::size_t j = i; j <= kBand; ++j) m[k + i][j - i] -= factor * m[k][j];
        b[k + i] -= factor * b[k];
      }
    for (std::size_t k = n; k-- > 0;) {
      for (std::size_t i = 1; i <= kBand && k + i < n; ++i) b[k] -= m[k][i] * b[k + i];
      b[k] /= m[k][0];
    }
    return b;
  }

  std::vector<double> reference_, walked_;
  double variance_;  ///< variance of a ring's fraction, over the fraction
};

RadialTable walked_table(const WalkedMedium& medium) {
  const RadialReference reference = reference_of(medium);
  const SlabWalks walked = walk(medium);
  // The exact total of a homogeneous medium reduces noise; layers' rings share the noise of their total.
  const double total = medium.layers.empty()
                           ? half_space_albedo(std::min(medium.absorbed, kMostAbsorbed), medium.eta)
                           : walked.back.total.value;
  std::vector<double> shares;
  double variance = 0, sum = 0;
  for (const WalkedRing& ring : walked.back.rings) {
    shares.push_back(std::max(0.0, ring.share.value / total));
    sum += shares.back();
    variance += ring.share.error / total * (ring.share.error / total);
  }
  shares.push_back(std::max(0.0, 1 - sum));  // the rest beyond the last knot, unfinished walks included
  return {reference,
          SmoothFit(reference_shares(reference), std::move(shares), std::max(1e-12, variance / sum)).solve()};
}

using SharedShape = std::shared_ptr<const ProfileShape>;

struct KnownShape {
  WalkedMedium medium;
  SharedShape shape;
};

/// The most recent shapes of this process.
class KnownShapes {
 public:
  SharedShape find(const WalkedMedium& medium) {
    const std::lock_guard lock(mutex_);
    const auto known = std::ranges::find(shapes_, medium, &KnownShape::medium);
    return known != shapes_.end() ? known->shape : nullptr;
  }
  void add(const WalkedMedium& medium, SharedShape shape) {
    const std::lock_guard lock(mutex_);
    shapes_.push_back({medium, std::move(shape)});
    if (shapes_.size() > kWalkedShapesKept) shapes_.pop_front();
  }

 private:
  std::mutex mutex_;
  std::deque<KnownShape> shapes_;
};

KnownShapes& known_shapes() {
  static KnownShapes shapes;
  return shapes;
}

SharedShape shape_of(const WalkedMedium& medium) {
  if (SharedShape known = known_shapes().find(medium)) return known;
  SharedShape shape;
  // A thread waiting for its walks must not start tasks waiting for this table.
  tbb::this_task_arena::isolate(
      [&] { shape = std::make_shared<const ProfileShape>(ProfileShape{walked_table(medium)}); });
  known_shapes().add(medium, shape);
  return shape;
}

TabulatedProfile profile_of(double mean_free_path, double total, const WalkedMedium& medium) {
  return {{mean_free_path, total, decay_of(medium),
           std::make_shared<const LazyShape>([=] { return shape_of(medium); })},
          medium};
}

}  // namespace

bool has_walked_table(const WalkedMedium& medium) {
  return known_shapes().find(medium) != nullptr;
}

void take_walked_table(const WalkedMedium& medium, RadialTable table) {
  if (has_walked_table(medium)) return;
  known_shapes().add(medium, std::make_shared<const ProfileShape>(ProfileShape{std::move(table)}));
}

TabulatedProfile make_profile(const ReducedMedium& medium, std::type_identity<TabulatedProfile>) {
  return profile_of(medium.mean_free_path, half_space_albedo(medium.absorbed, medium.eta),
                    {medium.absorbed, medium.eta});
}

TabulatedProfile make_layered_profile(std::span<const FlatLayer> layers, const ReducedMedium& equivalent) {
  const double length = equivalent.mean_free_path;
  WalkedMedium medium{equivalent.absorbed, equivalent.eta};
  for (const auto& [sigma_a, sigma_s_prime, thickness] : layers)
    medium.layers.push_back({sigma_a * length, sigma_s_prime * length, thickness / length});
  return profile_of(length, layered_albedo(medium.layers, medium.eta), medium);
}

}  // namespace opaline
