// SPDX-License-Identifier: GPL-3.0-or-later
#include "opaline/octree/octree.h"

#include <tbb/parallel_sort.h>

#include <cmath>
#include <tuple>

#include "opaline/core/morton.h"
#include "opaline/core/parallel.h"

namespace opaline {
namespace {

constexpr int kLevels = 21;  // bits of an integer coordinate; three of them fill a Morton key

struct Keyed {
  std::uint64_t key;
  std::uint32_t sample;
};

auto content(const FluxSample& s) {
  return std::tie(s.position.x, s.position.y, s.position.z, s.area, s.irradiance.x, s.irradiance.y,
                  s.irradiance.z, s.normal.x, s.normal.y, s.normal.z);
}

// Samples along the Morton curve; equal keys in the order of their content, so that input order has no say.
std::vector<Keyed> morton_order(std::span<const FluxSample> samples) {
  Vec3f low = samples[0].position, high = low;
  for (const FluxSample& s : samples) {
    low = component_min(low, s.position);
    high = component_max(high, s.position);
  }
  const double side = double(max_component(high - low));
  const double scale = side > 0 ? double(1 << kLevels) / side : 0;
  const auto integer = [&](float p, float origin) {
    return std::min(std::uint64_t((double(p) - double(origin)) * scale), std::uint64_t((1 << kLevels) - 1));
  };
  std::vector<Keyed> order(samples.size());
  parallel_chunks(samples.size(), 4096, [&](std::size_t begin, std::size_t end, std::size_t) {
    for (std::size_t i = begin; i < end; ++i) {
      const Vec3f& p = samples[i].position;
      order[i] = {morton_key(integer(p.x, low.x), integer(p.y, low.y), integer(p.z, low.z)),
                  std::uint32_t(i)};
    }
  });
  tbb::parallel_sort(order, [&](const Keyed& a, const Keyed& b) {
    return a.key != b.key ? a.key < b.key : content(samples[a.sample]) < content(samples[b.sample]);
  });
  return order;
}

// What a node is made from, in double: sums per lane R, G, B, area.
struct Sums {
  std::array<double, 4> weight{};
  std::array<Vec3d, 4> moment{};
  std::array<double, 6> flux_square{}, area_square{};  // second moments: of all channels' flux, of the area
  Vec3f low{INFINITY, INFINITY, INFINITY}, high{-INFINITY, -INFINITY, -INFINITY};

  void add(const Sums& other) {
    for (std::size_t c = 0; c < 4; ++c) {
      weight[c] += other.weight[c];
      moment[c] += other.moment[c];
    }
    for (std::size_t i = 0; i < 6; ++i) {
      flux_square[i] += other.flux_square[i];
      area_square[i] += other.area_square[i];
    }
    low = component_min(low, other.low);
    high = component_max(high, other.high);
  }
};

class Builder {
 public:
  Builder(Octree& tree, const std::vector<Keyed>& order) : tree_(tree), order_(order) {}

  Sums build(std::uint32_t begin, std::uint32_t end, int level) {
    // Levels at which all samples share one child add nothing.
    while (level < kLevels && digit(begin, level) == digit(end - 1, level)) ++level;
    const std::size_t index = tree_.nodes.size();
    tree_.nodes.emplace_back();
    Sums sums;
    const bool leaf = end - begin <= kLeafSamples || level == kLevels;
    if (leaf) {
      for (std::uint32_t i = begin; i < end; ++i) sums.add(sums_of(tree_.samples[i]));
    } else {
      for (std::uint32_t first = begin; first < end;) {
        std::uint32_t last = first + 1;
        while (last < end && digit(last, level) == digit(first, level)) ++last;
        sums.add(build(first, last, level + 1));
        first = last;
      }
    }
    store(index, sums, begin, end, leaf);
    return sums;
  }

 private:
  unsigned digit(std::uint32_t i, int level) const {
    return order_[i].key >> (3 * (kLevels - 1 - level)) & 7;
  }

  static Sums sums_of(const TreeSample& s) {
    Sums sums;
    const Vec3f p{s.x, s.y, s.z};
    for (std::size_t c = 0; c < 4; ++c) {
      sums.weight[c] = double(c < 3 ? s.flux[c] : s.area);
      sums.moment[c] = Vec3d(p) * sums.weight[c];
    }
    const Vec3d d(p);
    const double flux = sums.weight[0] + sums.weight[1] + sums.weight[2];
    const std::array<double, 6> squares{d.x * d.x, d.y * d.y, d.z * d.z, d.x * d.y, d.x * d.z, d.y * d.z};
    for (std::size_t i = 0; i < 6; ++i) {
      sums.flux_square[i] = flux * squares[i];
      sums.area_square[i] = sums.weight[3] * squares[i];
    }
    sums.low = sums.high = p;
    return sums;
  }

  // About the mean; what rounding leaves below zero on the diagonal is zero.
  static std::array<float, 6> central_moment(const Sums& sums) {
    double weight = sums.weight[0] + sums.weight[1] + sums.weight[2];
    Vec3d first = sums.moment[0] + sums.moment[1] + sums.moment[2];
    const bool lit = weight > 0;
    if (!lit) weight = sums.weight[3], first = sums.moment[3];
    if (!(weight > 0)) return {};
    const std::array<double, 6>& square = lit ? sums.flux_square : sums.area_square;
    const Vec3d m = first / weight;
    const std::array<double, 6> mean{m.x * m.x, m.y * m.y, m.z * m.z, m.x * m.y, m.x * m.z, m.y * m.z};
    std::array<float, 6> central;
    for (std::size_t i = 0; i < 6; ++i) {
      const double value = square[i] / weight - mean[i];
      central[i] = float(i < 3 ? std::max(0.0, value) : value);
    }
    return central;
  }

  void store(std::size_t index, const Sums& sums, std::uint32_t begin, std::uint32_t end, bool leaf) {
    OctreeNode& node = tree_.nodes[index];
    const Vec3d middle = 0.5 * (Vec3d(sums.low) + Vec3d(sums.high));
    for (std::size_t c = 0; c < 4; ++c) {
      const std::size_t from = sums.weight[c] > 0 ? c : 3;
      const Vec3d centroid = sums.weight[from] > 0 ? sums.moment[from] / sums.weight[from] : middle;
      node.x[c] = float(centroid.x);
      node.y[c] = float(centroid.y);
      node.z[c] = float(centroid.z);
      node.flux[c] = float(sums.weight[c]);
    }
    node.center = Vec3f(middle);
    // Up to the farther side of the rounded middle.
    node.half = component_max(sums.high - node.center, node.center - sums.low);
    node.spread = central_moment(sums);
    node.skip = std::uint32_t(tree_.nodes.size());
    node.first = begin;
    node.count = end - begin;
    node.leaf = leaf;
  }

  Octree& tree_;
  const std::vector<Keyed>& order_;
};

float unit_of_flux(std::span<const FluxSample> samples) {
  float largest = 0;
  for (const FluxSample& s : samples) largest = std::max(largest, max_component(s.irradiance));
  return largest > 0 && std::isfinite(largest) ? std::exp2(std::floor(std::log2(largest)) + 1) : 1.0f;
}

}  // namespace

std::size_t Octree::bytes() const {
  return nodes.size() * sizeof(OctreeNode) + samples.size() * (sizeof(TreeSample) + sizeof(Vec3f));
}

Octree build_octree(std::span<const FluxSample> samples) {
  Octree tree;
  if (samples.empty()) return tree;
  const std::vector<Keyed> order = morton_order(samples);
  tree.flux_unit = unit_of_flux(samples);
  tree.samples.resize(samples.size());
  tree.normals.resize(samples.size());
  parallel_chunks(samples.size(), 4096, [&](std::size_t begin, std::size_t end, std::size_t) {
    for (std::size_t i = begin; i < end; ++i) {
      const FluxSample& s = samples[order[i].sample];
      const RgbF flux = s.irradiance / tree.flux_unit * s.area;
      tree.samples[i] = {s.position.x, s.position.y, s.position.z, s.area, {flux.x, flux.y, flux.z, 0}};
      tree.normals[i] = s.normal;
    }
  });
  tree.nodes.reserve(samples.size() / 2);
  Builder(tree, order).build(0, std::uint32_t(samples.size()), 0);
  tree.nodes.shrink_to_fit();
  return tree;
}

}  // namespace opaline
