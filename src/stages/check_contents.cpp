// SPDX-License-Identifier: GPL-3.0-or-later
#include "stages/check_contents.h"

#include <algorithm>
#include <atomic>
#include <cmath>

#include "core/parallel.h"
#include "exitance/surface_patch.h"

namespace opaline {
namespace {

bool is_number(float value) {
  return std::isfinite(value);
}
bool is_amount(double value) {
  return std::isfinite(value) && value >= 0;
}
bool are_numbers(const Vec3f& v) {
  return is_number(v.x) && is_number(v.y) && is_number(v.z);
}
bool is_close(double a, double b, double relative) {
  return std::abs(a - b) <= relative * std::max(std::abs(a), std::abs(b));
}

/// True if all of 0 to below `size` fulfil the condition; in parallel.
template <class Condition>
bool all_of(std::size_t size, const Condition& condition) {
  std::atomic<bool> holds = true;
  parallel_chunks(size, 4096, [&](std::size_t begin, std::size_t end, std::size_t) {
    for (std::size_t i = begin; i < end && holds; ++i)
      if (!condition(i)) holds = false;
  });
  return holds;
}

bool stands_on_its_triangle(const SurfaceSample& s, const World& world) {
  constexpr float kRounding = 1e-5f;
  if (s.triangle >= world.meshes[s.mesh].triangles.size()) return false;
  if (!(s.u >= -kRounding && s.v >= -kRounding && s.u + s.v <= 1 + kRounding)) return false;
  if (!are_numbers(s.centroid) || !is_amount(s.area)) return false;
  const SurfacePoint point = surface_point(world.meshes[s.mesh], s.triangle, s.u, s.v);
  const Vec3f apart = point.position - s.position, turned = point.normal - s.normal;
  const float far = 1e-6f * float(world.diagonal);
  return dot(apart, apart) <= far * far && dot(turned, turned) <= 1e-6f;
}

/// Checks node i and all nodes below it, before `end`.
struct TreeCheck {
  const Octree& tree;

  // The root's samples share one cube; every level of it has at most one node on the way to a leaf.
  static constexpr int kMostLevels = 23;

  bool is_subtree(std::uint32_t i, std::uint32_t end, int levels) const {
    const OctreeNode& node = tree.nodes[i];
    if (node.skip <= i || node.skip > end || levels == 0) return false;
    if (node.leaf) return node.skip == i + 1 && node.count > 0;
    std::uint32_t child = i + 1;
    std::uint64_t at = node.first;
    int children = 0;
    while (child < node.skip) {
      const OctreeNode& below = tree.nodes[child];
      if (below.first != at || !is_subtree(child, node.skip, levels - 1)) return false;
      at += below.count;
      child = below.skip;
      ++children;
    }
    return children >= 2 && children <= 8 && child == node.skip &&
           at == std::uint64_t(node.first) + node.count;
  }
};

bool are_values(const OctreeNode& node) {
  for (std::size_t c = 0; c < 4; ++c)
    if (!is_number(node.x[c]) || !is_number(node.y[c]) || !is_number(node.z[c]) || !is_amount(node.flux[c]))
      return false;
  return are_numbers(node.center) && are_numbers(node.half) && min_component(node.half) >= 0 &&
         std::ranges::all_of(node.spread, is_number);
}

bool are_values(const TreeSample& s) {
  return is_number(s.x) && is_number(s.y) && is_number(s.z) && is_amount(s.area) &&
         std::ranges::all_of(s.flux, [](float flux) { return is_amount(flux); });
}

bool are_values(const Exitance& e) {
  return are_numbers(e.exitance) && are_numbers(e.irradiance) && are_numbers(e.near) && are_numbers(e.error);
}

}  // namespace

std::size_t most_samples(const SampledSurface& surface) {
  std::size_t most =
      std::size_t(SamplingInput{surface.world, surface.meshes}.candidate_rounds) * surface.count;
  for (const std::uint32_t m : surface.meshes) most += surface.world.meshes[m].triangles.size();
  return most;
}

bool are_samples_of(const SurfaceSamples& samples, const SampledSurface& surface) {
  const std::vector<SurfaceSample>& all = samples.samples;
  if (all.empty() || all.size() > most_samples(surface)) return false;
  if (!(is_amount(samples.radius) && samples.radius > 0) ||
      !is_close(samples.area, area_of(surface.world, surface.meshes), 1e-5))
    return false;
  if (!all_of(all.size(), [&](std::size_t i) { return stands_on_its_triangle(all[i], surface.world); }))
    return false;
  double sum = 0;
  for (const SurfaceSample& s : all) sum += double(s.area);
  return is_close(sum, samples.area, 1e-4);
}

bool is_light_of(const LightTransfer& transfer, std::size_t samples) {
  return transfer.weights.size() == samples && is_amount(transfer.relative_error) &&
         std::isfinite(transfer.edge_shift) &&
         std::ranges::all_of(transfer.weights, [](float weight) { return is_amount(weight); });
}

bool are_values_of(std::span<const RgbF> values, std::size_t samples) {
  return values.size() == samples && std::ranges::all_of(values, [](const RgbF& value) {
           return is_amount(value.x) && is_amount(value.y) && is_amount(value.z);
         });
}

bool has_flags(std::span<const char> items, std::size_t item_bytes, std::size_t offset) {
  for (std::size_t at = offset; at < items.size(); at += item_bytes)
    if (static_cast<unsigned char>(items[at]) > 1) return false;
  return true;
}

bool is_tree_of(const Octree& tree, const SurfaceSamples& samples) {
  const std::size_t count = samples.samples.size();
  if (count == 0) return tree.nodes.empty() && tree.samples.empty() && tree.normals.empty();
  if (tree.samples.size() != count || tree.normals.size() != count || tree.nodes.empty() ||
      tree.nodes.size() >= 2 * count)
    return false;
  const OctreeNode& root = tree.nodes.front();
  if (root.first != 0 || root.count != count || root.skip != tree.nodes.size()) return false;
  if (!(std::isfinite(tree.flux_unit) && tree.flux_unit > 0)) return false;
  double area = 0;
  for (const SurfaceSample& s : samples.samples) area += double(s.area);
  return TreeCheck{tree}.is_subtree(0, root.skip, TreeCheck::kMostLevels) &&
         is_close(double(root.flux[3]), area, 1e-4) &&
         all_of(tree.nodes.size(), [&](std::size_t i) { return are_values(tree.nodes[i]); }) &&
         all_of(count,
                [&](std::size_t i) { return are_values(tree.samples[i]) && are_numbers(tree.normals[i]); });
}

bool is_walked_profile(std::span<const double> logarithms, double decay, double width) {
  constexpr double kSteepest = 50;  // neighbouring values of a table differ by some units
  return logarithms.size() == RadialTable::kKnots && decay >= 0 && decay <= 1 && width >= 1 && width <= 200 &&
         std::ranges::all_of(logarithms, [](double f) { return std::abs(f) < kSteepest; });
}

bool is_exitance_of(const SurfaceCache& cache, const World& world, std::span<const std::uint32_t> meshes) {
  const auto is_split = [&](const SurfaceCache::Split& split) {
    const std::uint64_t cells = std::max<std::uint64_t>(1, split.segments);
    return cells < (1u << 16) && split.first + cells * cells <= cache.patches.size();
  };
  for (const std::uint32_t m : meshes)
    if (cache.splits[m].size() != world.meshes[m].triangles.size() ||
        !std::ranges::all_of(cache.splits[m], is_split))
      return false;
  const auto is_patch = [&](const SurfaceCache::Patch& patch) {
    return std::ranges::all_of(patch.vertices, [&](std::uint32_t v) { return v < cache.vertices.size(); }) &&
           (patch.lattice == SurfaceCache::kNone || patch.lattice == SurfaceCache::kLeftToPoints ||
            patch.lattice < cache.lattices.size());
  };
  const auto is_lattice = [&](const SurfaceCache::Lattice& lattice) {
    return lattice.segments >= 2 && lattice.segments % 2 == 0 && lattice.segments < (1u << 16) &&
           lattice.first + lattice_size(lattice.segments) <= cache.lattice_nodes.size();
  };
  const auto is_vertex = [](const SurfaceCache::Vertex& v) {
    return are_values(v.value) && are_numbers(v.position) && std::ranges::all_of(v.slope, are_numbers);
  };
  return std::ranges::all_of(cache.own_irradiance, [](float share) { return is_amount(share); }) &&
         std::ranges::all_of(cache.patches, is_patch) && std::ranges::all_of(cache.lattices, is_lattice) &&
         std::ranges::all_of(cache.lattice_nodes, [&](std::uint32_t n) { return n < cache.nodes.size(); }) &&
         std::ranges::all_of(cache.vertices, is_vertex) &&
         std::ranges::all_of(cache.nodes, [](const Exitance& e) { return are_values(e); });
}

}  // namespace opaline
