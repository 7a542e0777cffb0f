// SPDX-License-Identifier: GPL-3.0-or-later
#include "methods/hierarchical/near_field/near_field_sampler.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>

#include "core/random.h"
#include "exitance/refined_stake.h"
#include "lights/light.h"
#include "methods/hierarchical/hierarchical_state.h"

namespace opaline {
namespace {

// Stakes: typical, and least for shadow rays to pay off: of sparse points, dense points, and points so dense
// that many share their rays. (Stake: fraction of the exitance depending on the near field's irradiance,
// stake_of.)
constexpr float kUsual = 0.06f, kWorthApart = kRefinedStake, kWorthClose = 0.015f, kWorthShared = 0.005f;
constexpr float kFinestAt = 0.1f;  // stake requiring the finest lattice
// Samples at a typical stake: of an isolated point; of neighbours together, which cover each near field less
// evenly; least of each.
constexpr int kAlone = 24, kTogether = 96, kEach = 3;
constexpr std::uint64_t kStride = 11;  // offset between the sequences of successive points
constexpr int kFewerRays = 16;      // shadow rays per light with an area at a point, over those at a sample
constexpr float kErrorLeft = 0.4f;  // remaining fraction of the interpolation error

// In units of the narrowest channel's half-mass distance: coarsest lattice spacing; spacing of points below
// which they use the lattice, and below which they far outnumber its points; kernel's reach, above which its
// core is too narrow for the lattice.
constexpr double kCoarsest = 0.45, kClose = 0.85, kFineGrained = 0.33;
constexpr float kFarthest = 12;
constexpr double kPerPoint = 1;  // finest lattice spacing, over that of the points
constexpr std::uint32_t kFinest = 4;
constexpr std::size_t kDense = 32;  // least refined points of a batch for cells to pay off
// Variance of a mean over the lattice beside a shadow edge with the lit fraction f, over f (1 - f) (spacing /
// half-mass distance)^3. It is (4 / pi) (1 / 6) / 0.25 times the integral of the squared kernel along the
// edge, sqrt(pi / 2) / pi^2 for a Gaussian of unit rms distance. Each square on the edge adds 1/6 of the
// square of its weight.
constexpr float kLatticeVariance = 0.063f;

// Median distance of successive points, mm.
double typical_distance(std::span<const SurfacePoint> points) {
  if (points.size() < 2) return std::numeric_limits<double>::infinity();
  std::vector<float> distances;
  distances.reserve(points.size() - 1);
  for (std::size_t i = 1; i < points.size(); ++i)
    distances.push_back(length(points[i].position - points[i - 1].position));
  const auto middle = distances.begin() + std::ptrdiff_t(distances.size() / 2);
  std::ranges::nth_element(distances, middle);
  return double(*middle);
}

// Bounced irradiance, constant over a near field.
RgbF bounced_at(const PointIrradianceInput& lighting, std::size_t point) {
  return lighting.bounced.empty() ? RgbF{} : lighting.bounced[point];
}

}  // namespace

// Inputs and results of refine.
struct NearFieldSampler::Found {
  const PointIrradianceInput& lighting;
  std::span<const RgbF> own;
  std::span<Exitance> exitance;
  std::span<Rgb> noise;
};

// Sampled points of all refined points, on the surface after find.
struct NearFieldSampler::Places {
  std::vector<TracedRay> rays;
  std::vector<SurfacePoint> points;
  std::vector<std::uint64_t> keys;
  std::vector<std::uint32_t> sets;  // set of each one
};

NearFieldSampler::NearFieldSampler(const Body& group, int light_samples,
                                   std::shared_ptr<IrradianceLattice>* held)
    : kernel_(hierarchical_state(group).kernel()),
      near_(group),
      is_own_mesh_(*std::ranges::max_element(group.plan.meshes) + 1) {
  for (const std::uint32_t mesh : group.plan.meshes) is_own_mesh_[mesh] = true;
  const double spacing = kCoarsest * double(near_.narrowest);
  const int of_place = std::max(1, light_samples / kFewerRays);
  if (held != nullptr && *held != nullptr &&
      (*held)->is_of(is_own_mesh_, spacing, group.boundary, of_place)) {
    lattice_ = *held;
    return;
  }
  lattice_ =
      std::make_shared<IrradianceLattice>(is_own_mesh_, spacing, group.boundary, of_place, held != nullptr);
  if (held != nullptr) *held = lattice_;
}

std::vector<std::uint32_t> NearFieldSampler::refine(const PointIrradianceInput& lighting,
                                                    std::span<const RgbF> own, std::span<Exitance> exitance,
                                                    std::span<Rgb> noise) const {
  const double apart = typical_distance(lighting.points);
  const double widths = apart / double(near_.narrowest);
  const float worth = widths < kFineGrained ? kWorthShared : widths < kClose ? kWorthClose : kWorthApart;
  std::vector<std::uint32_t> marked;
  for (std::uint32_t i = 0; i < exitance.size(); ++i)
    if (at_stake(own[i], exitance[i]) > worth) marked.push_back(i);
  if (marked.empty()) return marked;
  std::vector<std::uint32_t> sorted = marked;
  const Found found{lighting, own, exitance, noise};
  const std::optional<std::uint32_t> level = finest_level(apart, sorted.size());
  const std::vector<std::size_t> ends = split(lighting.points, sorted);
  if (level)
    look_up(found, sorted, ends, *level);
  else
    draw_all(found, sorted, ends);
  return marked;
}

// Averages over the shared lattice.
void NearFieldSampler::look_up(const Found& found, std::span<std::uint32_t> sorted,
                               std::span<const std::size_t> ends, std::uint32_t finest) const {
  const std::span<const SurfacePoint> points = found.lighting.points;
  for (std::size_t set = 0, first = 0; set < ends.size(); first = ends[set++]) {
    const std::span<std::uint32_t> chosen = sorted.subspan(first, ends[set] - first);
    sort_into_groups(points, chosen);
    const std::uint32_t level = level_of(found, chosen, finest);
    NearFieldMeans means(near_, points, chosen, {});
    std::vector<const IrradianceLattice::Cell*> cells;
    for (const IrradianceLattice::Key& key : lattice_->keys_near(points, chosen, double(near_.reach), level))
      cells.push_back(&lattice_->cell(key, found.lighting));
    means.add_lattice(cells);
    RgbF variance;
    for (std::size_t c = 0; c < 3; ++c) {
      const float step = float(lattice_->spacing(level)) / near_.half[c];
      variance[c] = kLatticeVariance * step * step * step;
    }
    replace_all(found, chosen, means, variance);
  }
}

// Averages over sampled points, shared within a set.
void NearFieldSampler::draw_all(const Found& found, std::span<const std::uint32_t> sorted,
                                std::span<const std::size_t> ends) const {
  const PointIrradianceInput& lighting = found.lighting;
  Places places;
  std::vector<int> drawn;
  for (std::size_t set = 0, first = 0; set < ends.size(); first = ends[set++]) {
    for (std::size_t m = first; m < ends[set]; ++m) {
      // A fraction p of the near field beyond an edge causes an error of about p, and a sample's deviation is
      // about the root of p.
      const std::uint32_t i = sorted[m];
      const float wanted = std::sqrt(at_stake(found.own[i], found.exitance[i]) / kUsual) *
                           places_of(i, sorted.subspan(first, ends[set] - first), lighting.points);
      const double rounding = unit_double(hash_bits(3002, lighting.keys[i]));
      drawn.push_back(std::max(1, int(wanted + rounding)));
      draw(lighting, i, drawn[m], places);
    }
    places.sets.resize(places.rays.size(), std::uint32_t(set));
  }
  find(lighting.rays, places);
  std::vector<SurfacePoint> bent;
  if (lighting.bend) bent = places.points;
  for (SurfacePoint& point : bent) point.width = float(near_.narrowest);
  const std::vector<float> factors = bend_all(lighting, bent);
  PointIrradianceInput around = lighting;
  around.points = lighting.bend ? bent : places.points;
  around.keys = places.keys;
  around.light_samples = std::max(1, lighting.light_samples / kFewerRays);
  around.variance = {};
  std::vector<RgbF> entered = irradiance_at(around);
  for (std::size_t i = 0; i < factors.size(); ++i) entered[i] = entered[i] * factors[i];
  for (std::size_t set = 0, first = 0; set < ends.size(); first = ends[set++]) {
    const auto [begin, end] = std::equal_range(places.sets.begin(), places.sets.end(), std::uint32_t(set));
    const std::size_t skip = std::size_t(begin - places.sets.begin()), count = std::size_t(end - begin);
    const std::span<const std::uint32_t> points = sorted.subspan(first, ends[set] - first);
    NearFieldMeans means(near_, lighting.points, points, std::span(drawn).subspan(first));
    means.add_drawn(std::span(places.points).subspan(skip, count), std::span(entered).subspan(skip, count));
    replace_all(found, points, means, RgbF(1.0f / kTogether));
  }
}

// variance: of the lit fraction f beside a shadow edge, over f (1 - f)
void NearFieldSampler::replace_all(const Found& found, std::span<const std::uint32_t> points,
                                   const NearFieldMeans& means, const RgbF& variance) const {
  for (std::size_t m = 0; m < points.size(); ++m) {
    const std::uint32_t i = points[m];
    replace_mixed(found.own[i], means.mean(m) + bounced_at(found.lighting, i), variance, found.exitance[i],
                  found.noise[i]);
  }
}

// Finest lattice level at this spacing of the points, mm; none if sampling is cheaper.
std::optional<std::uint32_t> NearFieldSampler::finest_level(double apart, std::size_t marked) const {
  if (marked < kDense || !(apart <= kClose * double(near_.narrowest)) ||
      near_.reach > kFarthest * near_.narrowest)
    return {};
  std::uint32_t level = 0;
  while (level < kFinest && lattice_->spacing(level) > kPerPoint * apart) ++level;
  return level;
}

// Lattice level of a set. The deviation of a mean falls with the power 3/2 of the spacing, so sets with a
// stake below kFinestAt use coarser levels at equal error.
std::uint32_t NearFieldSampler::level_of(const Found& found, std::span<const std::uint32_t> set,
                                         std::uint32_t finest) const {
  float most = std::numeric_limits<float>::min();
  for (const std::uint32_t i : set) most = std::max(most, at_stake(found.own[i], found.exitance[i]));
  const float coarser = std::max(0.0f, 4.0f / 3 * std::log2(kFinestAt / most));
  return finest - std::min(finest, std::uint32_t(coarser));
}

// Replaces the mixed irradiance of a near field by its mean; NaN: unknown. noise: variance of the mean, for
// points either fully lit or in shadow.
void NearFieldSampler::replace_mixed(const RgbF& own, const RgbF& mean, const RgbF& variance, Exitance& e,
                                     Rgb& noise) const {
  for (std::size_t c = 0; c < 3; ++c) {
    if (std::isnan(mean[c])) continue;
    const float brightest = std::max({own[c], e.irradiance[c], mean[c]});
    const double near = double(e.near[c]);
    noise[c] = near * near * double(mean[c]) * double(brightest - mean[c]) * double(variance[c]);
    const float share = kernel_.own_irradiance[c], mixed = share * own[c] + (1 - share) * e.irradiance[c];
    e.exitance[c] += e.near[c] * (mean[c] - mixed);
    e.error[c] *= kErrorLeft;
  }
}

float NearFieldSampler::at_stake(const RgbF& own, const Exitance& e) const {
  return stake_of(kernel_.own_irradiance, own, e);
}

// Sorts the points into sets of neighbours; returns where each set ends.
std::vector<std::size_t> NearFieldSampler::split(std::span<const SurfacePoint> points,
                                                 std::span<std::uint32_t> marked) {
  std::vector<std::size_t> ends, open{marked.size()};
  for (std::size_t first = 0; !open.empty();) {
    const std::size_t last = open.back();
    if (last - first <= NearFieldMeans::kMostPoints) {
      ends.push_back(last);
      open.pop_back();
      first = last;
      continue;
    }
    open.push_back((first + last) / 2);
    part(points, marked.subspan(first, last - first), open.back() - first);
  }
  return ends;
}

// Sorts a set into groups of kGroup neighbours.
void NearFieldSampler::sort_into_groups(std::span<const SurfacePoint> points, std::span<std::uint32_t> set) {
  for (std::size_t size = NearFieldMeans::kMostPoints / 2; size >= NearFieldMeans::kGroup; size /= 2)
    for (std::size_t first = 0; first + size < set.size(); first += 2 * size)
      part(points, set.subspan(first, std::min(2 * size, set.size() - first)), size);
}

// Splits the points in space, `count` of them first.
void NearFieldSampler::part(std::span<const SurfacePoint> points, std::span<std::uint32_t> marked,
                            std::size_t count) {
  Vec3f low = points[marked[0]].position, high = low;
  for (const std::uint32_t m : marked) widen(low, high, points[m].position);
  const Vec3f side = high - low;
  const std::size_t axis = side.x >= side.y && side.x >= side.z ? 0 : side.y >= side.z ? 1 : 2;
  const auto along = [&](std::uint32_t m) { return std::pair(points[m].position[axis], m); };
  std::ranges::nth_element(marked, marked.begin() + std::ptrdiff_t(count), {}, along);
}

// Samples of a point: about kTogether among its neighbours, at most kAlone of its own.
float NearFieldSampler::places_of(std::uint32_t point, std::span<const std::uint32_t> set,
                                  std::span<const SurfacePoint> points) const {
  const float square = float(near_.root_mean_square * near_.root_mean_square);
  int neighbours = 0;
  for (std::size_t i = 0; i < set.size() && neighbours * kEach < kTogether; ++i) {
    const Vec3f apart = points[set[i]].position - points[point].position;
    neighbours += dot(apart, apart) < square && dot(points[point].normal, points[set[i]].normal) > 0;
  }
  return float(std::clamp(kTogether / std::max(1, neighbours), kEach, kAlone));
}

// All points use one low-discrepancy sequence, each from an index given by its number in the batch, so adding
// or removing a point changes no other between frames.
void NearFieldSampler::draw(const PointIrradianceInput& lighting, std::uint32_t number, int count,
                            Places& places) const {
  const SurfacePoint& point = lighting.points[number];
  const std::uint64_t batch = hash_bits(lighting.seed, lighting.keys.front()),
                      first = kStride * std::uint64_t(number);
  const std::array<double, 2> shift{unit_double(hash_bits(3000, batch)), unit_double(hash_bits(3001, batch))};
  Vec3f x, y;
  tangent_frame(point.normal, x, y);
  for (std::uint64_t k = first; k < first + std::uint64_t(count); ++k) {
    const auto [u, v] = r2_point(k, shift);
    const float r = float(near_.drawn_distance(u));
    const double angle = 2 * std::numbers::pi * v;
    const Vec3f place = point.position + x * (r * float(std::cos(angle))) + y * (r * float(std::sin(angle)));
    places.rays.push_back({Ray(place + point.normal * r, -point.normal, 2 * r), {}});
    places.keys.push_back(hash_bits(lighting.keys[number], k));
  }
}

// Removes samples off the body's surface or on back faces.
void NearFieldSampler::find(const RayScene& rays, Places& places) const {
  rays.intersect(places.rays);
  places.points.reserve(places.rays.size());
  std::size_t kept = 0;
  for (std::size_t i = 0; i < places.rays.size(); ++i) {
    const auto& [ray, hit] = places.rays[i];
    if (hit.mesh >= is_own_mesh_.size() || !is_own_mesh_[hit.mesh]) continue;
    const SurfacePoint point = rays.surface_point(hit.mesh, hit.triangle, hit.u, hit.v);
    if (dot(point.geometric, ray.direction) >= 0) continue;
    places.points.push_back(point);
    places.sets[kept] = places.sets[i];
    places.keys[kept++] = places.keys[i];
  }
  places.sets.resize(kept);
  places.keys.resize(kept);
}

}  // namespace opaline
