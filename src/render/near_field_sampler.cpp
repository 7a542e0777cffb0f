// SPDX-License-Identifier: GPL-3.0-or-later
#include "render/near_field_sampler.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>

#include "opaline/core/random.h"
#include "opaline/lights/light.h"

namespace opaline {
namespace {

// What may be at stake before shadow rays are worth their time; and what usually is, where they are.
constexpr float kWorth = 0.02f, kUsual = 0.06f;
// Where as much is at stake as usual: places of a point alone; of neighbours together, which fill the near
// field of each less evenly; and how many each of many neighbours brings at least.
constexpr int kAlone = 24, kTogether = 96, kEach = 3;
constexpr std::uint64_t kStride = 11;  // in the sequence from one point's places to the next one's
constexpr int kFewerRays = 16;      // than a point's own are traced from a place to each light with an area
constexpr float kErrorLeft = 0.4f;  // of what the interpolated irradiance was off by
constexpr std::size_t kMostTogether = 64;  // points that share their places

}  // namespace

// The mean irradiance around each point of a set, per kind of light; NaN where no place was found.
struct NearFieldSampler::Means {
  std::vector<std::vector<RgbF>> of;
};

// Places of all marked points together, on the surface once found.
struct NearFieldSampler::Places {
  std::vector<TracedRay> rays;
  std::vector<SurfacePoint> points;
  std::vector<std::uint64_t> keys;
  std::vector<std::uint32_t> sets;  // of the points that brought them
};

NearFieldSampler::NearFieldSampler(const Body& group)
    : kernel_(group.kernel), is_own_mesh_(*std::ranges::max_element(group.plan.meshes) + 1) {
  for (const std::uint32_t mesh : group.plan.meshes) is_own_mesh_[mesh] = true;
  const double h = double(kernel_.radius);
  std::array<double, kRings> mean_rings{};
  for (std::size_t c = 0; c < 3; ++c) {
    if (!(kernel_.own_irradiance[c] > 0)) continue;
    std::array<double, kRings> rings;
    for (std::size_t i = 0; i < kRings; ++i)
      rings[i] = near_ring(group.profile.channels[c], h, (double(i) + 0.5) / kRings);
    const double sum = std::accumulate(rings.begin(), rings.end(), 0.0);
    for (std::size_t i = 0; i < kRings && sum > 0; ++i) {
      const double area = std::numbers::pi * h * h * double(2 * i + 1) / (kRings * kRings);
      densities_[i][c] = float(rings[i] / (sum * area));
      mean_rings[i] += rings[i] / sum;
    }
  }
  const double all = std::accumulate(mean_rings.begin(), mean_rings.end(), 0.0);
  const float channels = float(std::round(all));
  double square = 0;
  for (std::size_t i = 0; i < kRings && all > 0; ++i) {
    densities_[i][3] = (densities_[i][0] + densities_[i][1] + densities_[i][2]) / channels;
    const double part = mean_rings[i] / all, r = h * (double(i) + 0.5) / kRings;
    within_[i + 1] = within_[i] + part;
    square += part * r * r;
  }
  root_mean_square_ = std::sqrt(square);
  for (const Densities& ring : densities_)
    for (std::size_t c = 0; c < 3; ++c) key_ = hash_bits(key_, std::bit_cast<std::uint32_t>(float(ring[c])));
}

std::vector<std::uint32_t> NearFieldSampler::refine(const PointIrradianceInput& lighting,
                                                    std::span<const RgbF> own, std::span<Exitance> exitance,
                                                    std::span<Rgb> noise, HeldView::NearField* held) const {
  std::vector<std::uint32_t> marked;
  std::vector<float> stakes(exitance.size());
  for (std::uint32_t i = 0; i < exitance.size(); ++i) {
    stakes[i] = at_stake(own[i], exitance[i]);
    if (stakes[i] > kWorth) marked.push_back(i);
  }
  std::vector<std::uint32_t> open = marked;  // whose near fields are to be found
  if (held != nullptr && held->kernel == key_) {
    const auto known =
        std::stable_partition(open.begin(), open.end(), [&](std::uint32_t i) { return !held->is_found[i]; });
    add_held(*held, lighting, own, {known, open.end()}, exitance, noise);
    open.erase(known, open.end());
  } else if (held != nullptr) {
    const std::size_t n = exitance.size();
    *held = {key_, std::vector<bool>(n), std::vector<RgbF>(n * lighting.lights.size())};
  }
  if (open.empty()) return marked;
  const std::vector<std::size_t> ends = split(lighting.points, open);
  Places places;
  std::vector<int> drawn;
  for (std::size_t set = 0, first = 0; set < ends.size(); first = ends[set++]) {
    for (std::size_t m = first; m < ends[set]; ++m) {
      // Of what lies beyond an edge in a part p of the near field, about p is at stake, and the deviation of
      // a place is as the root of p.
      const float wanted =
          std::sqrt(stakes[open[m]] / kUsual) *
          places_of(open[m], std::span(open).subspan(first, ends[set] - first), lighting.points);
      const double rounding = unit_double(hash_bits(3002, lighting.keys[open[m]]));
      drawn.push_back(std::max(1, int(wanted + rounding)));
      draw(lighting, open[m], drawn[m], places);
    }
    places.sets.resize(places.rays.size(), std::uint32_t(set));
  }
  find(lighting.rays, places);
  PointIrradianceInput around = lighting;
  around.points = places.points;
  around.keys = places.keys;
  around.light_samples = std::max(1, lighting.light_samples / kFewerRays);
  around.variance = {};
  // All lights together, and, to be held, each in white.
  const std::vector<PointTransfers> transfers = transfers_at(around);
  std::vector<std::vector<RgbF>> entered{combine_lights(transfers, around)};
  if (held != nullptr)
    for (const PointTransfers& light : transfers)
      entered.emplace_back(light.weights.begin(), light.weights.end());
  for (std::size_t set = 0, first = 0; set < ends.size(); first = ends[set++]) {
    const auto [begin, end] = std::equal_range(places.sets.begin(), places.sets.end(), std::uint32_t(set));
    const std::size_t skip = std::size_t(begin - places.sets.begin()), count = std::size_t(end - begin);
    const std::span<const std::uint32_t> own_set = std::span(open).subspan(first, ends[set] - first);
    std::vector<std::span<const RgbF>> set_entered;
    for (const std::vector<RgbF>& values : entered)
      set_entered.push_back(std::span(values).subspan(skip, count));
    const Means means = means_of(lighting.points, own_set, std::span(drawn).subspan(first),
                                 std::span(places.points).subspan(skip, count), set_entered);
    for (std::size_t m = 0; m < own_set.size(); ++m) {
      const std::uint32_t i = own_set[m];
      replace_mixed(own[i], means.of[0][m], exitance[i], noise[i]);
      if (held == nullptr) continue;
      held->is_found[i] = true;
      for (std::size_t l = 0; l < lighting.lights.size(); ++l)
        held->transfers[l * exitance.size() + i] = means.of[l + 1][m];
    }
  }
  return marked;
}

// Where the near fields of points were found before.
void NearFieldSampler::add_held(const HeldView::NearField& held, const PointIrradianceInput& lighting,
                                std::span<const RgbF> own, std::span<const std::uint32_t> points,
                                std::span<Exitance> exitance, std::span<Rgb> noise) const {
  for (const std::uint32_t i : points) {
    RgbF mean;
    for (std::size_t l = 0; l < lighting.lights.size(); ++l)
      mean += RgbF(emission(lighting.lights[l])) * held.transfers[l * exitance.size() + i];
    replace_mixed(own[i], mean, exitance[i], noise[i]);
  }
}

// Puts the near field's mean irradiance, NaN where it is not known, where `evaluate` took a mixture. noise:
// the variance of a mean of places of which some have all the light there is, and others none.
void NearFieldSampler::replace_mixed(const RgbF& own, const RgbF& mean, Exitance& e, Rgb& noise) const {
  for (std::size_t c = 0; c < 3; ++c) {
    if (std::isnan(mean[c])) continue;
    const float brightest = std::max({own[c], e.irradiance[c], mean[c]});
    const double near = double(e.near[c]);
    noise[c] = near * near * double(mean[c]) * double(brightest - mean[c]) / kTogether;
    const float share = kernel_.own_irradiance[c], mixed = share * own[c] + (1 - share) * e.irradiance[c];
    e.exitance[c] += e.near[c] * (mean[c] - mixed);
    e.error[c] *= kErrorLeft;
  }
}

// The share of the exitance that hangs on which of the two irradiances is right.
float NearFieldSampler::at_stake(const RgbF& own, const Exitance& e) const {
  float most = 0;
  for (std::size_t c = 0; c < 3; ++c) {
    const float share = kernel_.own_irradiance[c],
                part = e.near[c] * share * (1 - share) * std::abs(own[c] - e.irradiance[c]);
    most = std::max(most, part < e.exitance[c] ? part / e.exitance[c] : part > 0 ? 1.0f : 0.0f);
  }
  return most;
}

// Sorts the points into sets of neighbours; returns where each set ends.
std::vector<std::size_t> NearFieldSampler::split(std::span<const SurfacePoint> points,
                                                 std::span<std::uint32_t> marked) {
  std::vector<std::size_t> ends, open{marked.size()};
  for (std::size_t first = 0; !open.empty();) {
    const std::size_t last = open.back();
    if (last - first <= kMostTogether) {
      ends.push_back(last);
      open.pop_back();
      first = last;
      continue;
    }
    Vec3f low = points[marked[first]].position, high = low;
    for (std::size_t i = first; i < last; ++i) {
      low = component_min(low, points[marked[i]].position);
      high = component_max(high, points[marked[i]].position);
    }
    const Vec3f side = high - low;
    const std::size_t axis = side.x >= side.y && side.x >= side.z ? 0 : side.y >= side.z ? 1 : 2;
    const std::size_t middle = (first + last) / 2;
    const auto along = [&](std::uint32_t m) { return std::pair(points[m].position[axis], m); };
    std::ranges::nth_element(marked.subspan(first, last - first), marked.begin() + std::ptrdiff_t(middle), {},
                             along);
    open.push_back(middle);
  }
  return ends;
}

// So many that with those of its neighbours the point has about kTogether, but kAlone of its own at most.
float NearFieldSampler::places_of(std::uint32_t point, std::span<const std::uint32_t> set,
                                  std::span<const SurfacePoint> points) const {
  const float square = float(root_mean_square_ * root_mean_square_);
  int neighbours = 0;
  for (std::size_t i = 0; i < set.size() && neighbours * kEach < kTogether; ++i) {
    const Vec3f apart = points[set[i]].position - points[point].position;
    neighbours += dot(apart, apart) < square && dot(points[point].normal, points[set[i]].normal) > 0;
  }
  return float(std::clamp(kTogether / std::max(1, neighbours), kEach, kAlone));
}

// All points together take their places from one low-discrepancy sequence, each from where its number in the
// batch says: not from where another's end, or all would change from frame to frame where one comes or goes.
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
    const float r = float(drawn_distance(u));
    const double angle = 2 * std::numbers::pi * v;
    const Vec3f place = point.position + x * (r * float(std::cos(angle))) + y * (r * float(std::sin(angle)));
    places.rays.push_back({Ray(place + point.normal * r, -point.normal, 2 * r), {}});
    places.keys.push_back(hash_bits(lighting.keys[number], k));
  }
}

// Keeps the places that lie on the group's surface and show their outside.
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

// The inverse of the mean kernel's distribution.
double NearFieldSampler::drawn_distance(double u) const {
  const auto above = std::ranges::upper_bound(within_, u * within_.back());
  const std::size_t ring = std::min(std::size_t(above - within_.begin()), kRings) - 1;
  const double inside = within_[ring], part = within_[ring + 1] - inside;
  const double t = part > 0 ? std::min(1.0, (u * within_.back() - inside) / part) : 0.5;
  return double(kernel_.radius) * (double(ring) + t) / kRings;
}

// The mean irradiance of each marked point's near field; entered: at the places, per kind of light.
NearFieldSampler::Means NearFieldSampler::means_of(std::span<const SurfacePoint> points,
                                                   std::span<const std::uint32_t> marked,
                                                   std::span<const int> drawn,
                                                   std::span<const SurfacePoint> places,
                                                   std::span<const std::span<const RgbF>> entered) const {
  // Points past the last have no normal: they see no place.
  constexpr std::size_t kAtOnce = 4;
  static_assert(kMostTogether % kAtOnce == 0);
  const std::size_t n = marked.size(), end = (n + kAtOnce - 1) / kAtOnce * kAtOnce;
  using Numbers = std::array<float, kMostTogether>;
  Numbers x{}, y{}, z{}, nx{}, ny{}, nz{}, brought{};
  for (std::size_t m = 0; m < n; ++m) {
    const auto& [position, normal, geometric, offset] = points[marked[m]];
    x[m] = position.x, y[m] = position.y, z[m] = position.z;
    nx[m] = normal.x, ny[m] = normal.y, nz[m] = normal.z;
    brought[m] = float(drawn[m]);
  }
  const float rings = float(kRings) / kernel_.radius;
  std::array<int, kMostTogether> ring;
  std::array<Densities, kMostTogether> here;
  std::array<Densities, kMostTogether> weights{};
  std::vector<std::array<Densities, kMostTogether>> all_sums(entered.size());
  for (std::size_t i = 0; i < places.size(); ++i) {
    const Vec3f &position = places[i].position, &geometric = places[i].geometric;
    const float px = position.x, py = position.y, pz = position.z;
    const float gx = geometric.x, gy = geometric.y, gz = geometric.z;
    for (std::size_t m = 0; m < end; ++m) {
      const float dx = x[m] - px, dy = y[m] - py, dz = z[m] - pz;
      // Without a branch, so that compilers take several points at once.
      const float r = std::sqrt(dx * dx + dy * dy + dz * dz) * rings, within = r < kRings ? r : float(kRings);
      ring[m] = int(nx[m] * gx + ny[m] * gy + nz[m] * gz > 0 ? within : float(kRings));
    }
    std::array<Densities, kAtOnce> sums{};
    for (std::size_t m = 0; m < end; m += kAtOnce)
      for (std::size_t k = 0; k < kAtOnce; ++k) {
        here[m + k] = densities_[std::size_t(ring[m + k])];
        sums[k] += here[m + k] * brought[m + k];
      }
    const float expected = (sums[0] + sums[1] + (sums[2] + sums[3]))[3];  // places per mm^2 here
    if (!(expected > 0)) continue;
    const Densities inverse = Densities{} + 1 / expected;
    for (std::size_t m = 0; m < n; ++m) {
      here[m] *= inverse;
      weights[m] += here[m];
    }
    for (std::size_t l = 0; l < entered.size(); ++l) {
      const RgbF& e = entered[l][i];
      const Densities irradiance{e.x, e.y, e.z, 0};
      for (std::size_t m = 0; m < n; ++m) all_sums[l][m] += here[m] * irradiance;
    }
  }
  Means means{
      std::vector(entered.size(), std::vector<RgbF>(n, RgbF(std::numeric_limits<float>::quiet_NaN())))};
  for (std::size_t l = 0; l < entered.size(); ++l)
    for (std::size_t m = 0; m < n; ++m)
      for (std::size_t c = 0; c < 3; ++c)
        if (weights[m][c] > 0) means.of[l][m][c] = all_sums[l][m][c] / weights[m][c];
  return means;
}

}  // namespace opaline
