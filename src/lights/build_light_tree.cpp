// SPDX-License-Identifier: GPL-3.0-or-later
#include "lights/build_light_tree.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "lights/light_kind.h"

namespace opaline {
namespace {

class Builder {
 public:
  explicit Builder(std::span<const Light> lights) {
    for (const Light& light : lights) {
      lamps_.push_back(*lamp_of(light));
      const Rgb colour = emission(light);
      lamps_.back().intensity *= (colour.x + colour.y + colour.z) / 3;
    }
    built_.order.resize(lights.size());
    std::iota(built_.order.begin(), built_.order.end(), 0u);
    built_.nodes.reserve(2 * lights.size());
    built_.nodes.resize(1);
    fill(0, 0, std::uint32_t(lights.size()));
  }
  BuiltLightTree& built() { return built_; }

 private:
  std::span<std::uint32_t> members(std::uint32_t first, std::uint32_t count) {
    return std::span(built_.order).subspan(first, count);
  }

  void fill(std::size_t index, std::uint32_t first, std::uint32_t count) {
    LightTree::Node node = bounds_of(members(first, count));
    node.first = first;
    node.count = count;
    if (count > 1) node.children = std::uint32_t(built_.nodes.size());
    built_.nodes[index] = node;
    if (count == 1) return;
    built_.nodes.resize(built_.nodes.size() + 2);
    halve(members(first, count));
    fill(node.children, first, count / 2);
    fill(node.children + 1, first + count / 2, count - count / 2);
  }

  void halve(std::span<std::uint32_t> members) {
    Vec3d low = lamps_[members[0]].center, high = low;
    for (const std::uint32_t m : members) widen(low, high, lamps_[m].center);
    const Vec3d side = high - low;
    const std::size_t axis = side.x >= side.y && side.x >= side.z ? 0 : side.y >= side.z ? 1 : 2;
    const auto along = [&](std::uint32_t m) { return std::pair(lamps_[m].center[axis], m); };
    std::ranges::nth_element(members, members.begin() + std::ptrdiff_t(members.size() / 2), {}, along);
  }

  LightTree::Node bounds_of(std::span<const std::uint32_t> members) const {
    LightTree::Node node;
    Vec3d low = lamps_[members[0]].center, high = low, way{};
    for (const std::uint32_t m : members) {
      const Lamp& lamp = lamps_[m];
      low = component_min(low, lamp.center - Vec3d(lamp.radius));
      high = component_max(high, lamp.center + Vec3d(lamp.radius));
      node.brightness += lamp.intensity;
      way += lamp.facing.value_or(Vec3d{});
    }
    node.center = Vec3f(.5 * (low + high));
    for (const std::uint32_t m : members) {
      const double reach = length(lamps_[m].center - Vec3d(node.center)) + lamps_[m].radius;
      node.radius = std::max(node.radius, float(reach * (1 + 1e-6)));
    }
    bound_ways(members, normalized(way), node);
    return node;
  }

  void bound_ways(std::span<const std::uint32_t> members, const Vec3d& axis, LightTree::Node& node) const {
    double half = 0, full = 0, reach = 0;
    for (const std::uint32_t m : members) {
      const Lamp& lamp = lamps_[m];
      if (!lamp.facing) return;  // all around
      half = std::max(half, std::acos(std::clamp(dot(*lamp.facing, axis), -1.0, 1.0)));
      reach = std::max(reach, lamp.reach);
      full = std::max(full, lamp.full);
      node.fades_by_square |= lamp.fades_by_square;
    }
    if (axis == Vec3d{}) return;
    node.axis = Vec3f(axis);
    node.cos_half = float(std::cos(half));
    node.sin_half = float(std::sin(half));
    node.cos_reach = float(std::cos(reach));
    node.cos_full = float(std::cos(full));
  }

  std::vector<Lamp> lamps_;
  BuiltLightTree built_;
};

}  // namespace

bool fits_into_tree(const Light& light) {
  return lamp_of(light).has_value();
}

BuiltLightTree build_light_tree(std::span<const Light> lights) {
  return std::move(Builder(lights).built());
}

}  // namespace opaline
