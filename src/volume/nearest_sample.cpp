// SPDX-License-Identifier: GPL-3.0-or-later
#include "volume/nearest_sample.h"

#include <algorithm>
#include <array>
#include <bit>
#include <limits>

#include "geometry/surface_point.h"

namespace opaline {
namespace {

constexpr int kBits = 21;               // bits of a cube's coordinate
constexpr float kWidest = 0x1p20f - 4;  // cubes along an axis
constexpr std::int32_t kMostRings = 6;  // maximum rings of cubes searched around a point
constexpr std::uint32_t kNone = ~0u;

Vec3f sheet_normal(const SurfaceSample& sample, const World* world) {
  if (world == nullptr) return sample.normal;
  return surface_point(world->meshes[sample.mesh], sample.triangle, sample.u, sample.v).geometric;
}

// The 26 steps to a cube's neighbours, those sharing a face first, to find the nearest sample early.
constexpr auto kNeighbours = [] {
  std::array<std::array<std::int8_t, 3>, 26> steps{};
  std::size_t count = 0;
  for (int sum = 1; sum <= 3; ++sum)
    for (int z = -1; z <= 1; ++z)
      for (int y = -1; y <= 1; ++y)
        for (int x = -1; x <= 1; ++x)
          if (x * x + y * y + z * z == sum) steps[count++] = {std::int8_t(x), std::int8_t(y), std::int8_t(z)};
  return steps;
}();

}  // namespace

NearestSample::NearestSample(std::span<const SurfaceSample> samples, const World* world, float cube_edge) {
  const auto bits = std::bit_width(2 * samples.size() + 1);
  slots_.resize(std::size_t(1) << bits);
  shift_ = 64 - int(bits);
  if (samples.empty()) return;
  Vec3f high = low_ = samples[0].position;
  double area = 0;
  for (const SurfaceSample& s : samples) {
    low_ = component_min(low_, s.position);
    high = component_max(high, s.position);
    area += double(s.area);
  }
  const float widest = max_component(high - low_);
  edge_ = std::max(cube_edge * float(std::sqrt(area / double(samples.size()))), widest / kWidest);
  if (!(edge_ > 0)) edge_ = 1;
  inverse_edge_ = 1 / edge_;
  std::vector<std::size_t> slots(samples.size());
  for (std::size_t i = 0; i < samples.size(); ++i) {
    const std::uint64_t key = key_of(place_of(samples[i].position));
    slots[i] = slot_of(key);
    slots_[slots[i]].key = key;
    ++slots_[slots[i]].count;
  }
  std::uint32_t first = 0;
  for (Cube& cube : slots_) {
    cube.first = first;
    first += cube.count;
  }
  members_.resize(samples.size());
  std::vector<std::uint32_t> filled(slots_.size());
  for (std::uint32_t i = 0; i < samples.size(); ++i)
    members_[slots_[slots[i]].first + filled[slots[i]]++] = {samples[i].position,
                                                             sheet_normal(samples[i], world), i};
}

NearestSample NearestSample::by_centroids(std::span<const SurfaceSample> samples, float cube_edge,
                                          double least_area) {
  double area = 0;
  for (const SurfaceSample& s : samples) area += double(s.area);
  least_area *= area / double(samples.size());
  std::vector<SurfaceSample> cells;
  std::vector<std::uint32_t> index;
  for (std::uint32_t i = 0; i < samples.size(); ++i) {
    if (double(samples[i].area) < least_area) continue;
    cells.push_back(samples[i]);
    cells.back().position = samples[i].centroid;
    index.push_back(i);
  }
  NearestSample nearest(cells, nullptr, cube_edge);
  for (Member& member : nearest.members_) member.sample = index[member.sample];
  return nearest;
}

// Cube of a position; cubes at the limits represent everything beyond.
NearestSample::Place NearestSample::place_of(const Vec3f& position) const {
  const auto coordinate = [this](float c) {
    return std::int32_t(std::clamp(std::floor(c * inverse_edge_), -2.0f, kWidest + 2)) + 2;
  };
  const Vec3f p = position - low_;
  return {coordinate(p.x), coordinate(p.y), coordinate(p.z)};
}

std::uint64_t NearestSample::key_of(const Place& p) {
  return std::uint64_t(p.x) | std::uint64_t(p.y) << kBits | std::uint64_t(p.z) << 2 * kBits;
}

// Slot of a cube, or the free slot for it.
std::size_t NearestSample::slot_of(std::uint64_t key) const {
  std::size_t slot = (key * 0x9E3779B97F4A7C15ull) >> shift_;
  while (slots_[slot].count > 0 && slots_[slot].key != key) slot = (slot + 1) & (slots_.size() - 1);
  return slot;
}

std::span<const NearestSample::Member> NearestSample::members_of(const Place& p) const {
  if (p.x < 0 || p.y < 0 || p.z < 0) return {};
  const Cube& cube = slots_[slot_of(key_of(p))];
  return std::span(members_).subspan(cube.first, cube.count);
}

void NearestSample::look_into(const Place& place, const Vec3f& position, const Vec3f* normal,
                              Found& best) const {
  for (const Member& member : members_of(place)) {
    const Vec3f apart = member.position - position;
    const float distance2 = dot(apart, apart);
    if (distance2 > best.distance2 || (distance2 == best.distance2 && member.sample > best.sample)) continue;
    if (normal == nullptr || same_sheet(member.normal, *normal)) best = {distance2, member.sample};
  }
}

NearestSample::Found NearestSample::nearest(const Vec3f& position, const Vec3f* normal) const {
  Found best{std::numeric_limits<float>::infinity(), kNone};
  const Place middle = place_of(position);
  look_into(middle, position, normal, best);
  const Vec3f within =
      (position - low_) - Vec3f(float(middle.x - 2), float(middle.y - 2), float(middle.z - 2)) * edge_;
  const auto gap2 = [this](float at, int step) {  // squared distance to the cubes on one side along an axis
    const float gap = step < 0 ? at : step > 0 ? edge_ - at : 0;
    return gap * std::abs(gap);
  };
  for (const auto& [x, y, z] : kNeighbours)
    if (gap2(within.x, x) + gap2(within.y, y) + gap2(within.z, z) <= best.distance2)
      look_into({middle.x + x, middle.y + y, middle.z + z}, position, normal, best);
  for (std::int32_t ring = 2; ring <= kMostRings; ++ring) {
    const float searched = float(ring - 1) * edge_;
    if (best.distance2 <= searched * searched) break;
    for (std::int32_t z = -ring; z <= ring; ++z)
      for (std::int32_t y = -ring; y <= ring; ++y) {
        const bool shell = std::max(std::abs(z), std::abs(y)) == ring;
        for (std::int32_t x = -ring; x <= ring; x += shell ? 1 : 2 * ring)
          look_into({middle.x + x, middle.y + y, middle.z + z}, position, normal, best);
      }
  }
  return best;
}

std::uint32_t NearestSample::at(const Vec3f& position, const Vec3f& normal) const {
  Found best = nearest(position, &normal);
  if (best.sample == kNone) best = nearest(position, nullptr);
  if (best.sample != kNone) return best.sample;
  for (const Member& member : members_) {
    const Vec3f apart = member.position - position;
    if (dot(apart, apart) <= best.distance2) best = {dot(apart, apart), member.sample};
  }
  return best.sample == kNone ? 0 : best.sample;
}

}  // namespace opaline
