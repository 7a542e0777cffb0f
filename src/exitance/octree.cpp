// SPDX-License-Identifier: GPL-3.0-or-later
#include "exitance/octree.h"

#include <tbb/parallel_sort.h>

#include <algorithm>
#include <cmath>
#include <span>
#include <tuple>
#include <utility>

#include "core/cancel_check.h"
#include "core/morton.h"
#include "core/parallel.h"

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

// Sorts the samples along the Morton curve; content breaks ties, so the input order has no effect.
std::vector<Keyed> morton_order(std::span<const FluxSample> samples) {
  Vec3f low = samples[0].position, high = low;
  for (const FluxSample& s : samples) widen(low, high, s.position);
  const double side = double(max_component(high - low));
  const double scale = side > 0 ? double(1 << kLevels) / side : 0;
  const auto integer = [&](float p, float origin) {
    return std::min(std::uint64_t((double(p) - double(origin)) * scale), std::uint64_t((1 << kLevels) - 1));
  };
  const CancelCheck check;
  std::vector<Keyed> order(samples.size());
  parallel_chunks(samples.size(), 4096, [&](std::size_t begin, std::size_t end, std::size_t) {
    check();
    for (std::size_t i = begin; i < end; ++i) {
      const Vec3f& p = samples[i].position;
      order[i] = {morton_key(integer(p.x, low.x), integer(p.y, low.y), integer(p.z, low.z)),
                  std::uint32_t(i)};
    }
  });
  tbb::parallel_sort(order, [&](const Keyed& a, const Keyed& b) {
    check();
    return a.key != b.key ? a.key < b.key : content(samples[a.sample]) < content(samples[b.sample]);
  });
  return order;
}

// Sums of a node, in double: per lane R, G, B, area.
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

// Writes the nodes in depth-first order. Parts of the tree are counted and built in parallel; the nodes above
// them are summed last. The division depends on the samples alone.
class Builder {
 public:
  Builder(Octree& tree, std::vector<std::uint64_t> keys) : tree_(tree), keys_(std::move(keys)) {}

  void build() {
    cut(0, std::uint32_t(keys_.size()), 0, kNoParent);
    parallel_chunks(parts_.size(), 1, [&](std::size_t i, std::size_t, std::size_t) {
      check_();
      Part& part = parts_[i];
      part.nodes = part.is_inner ? 1 : count(part.begin, part.end, part.level);
    });
    std::uint32_t nodes = 0;
    for (Part& part : parts_) {
      part.index = nodes;
      nodes += part.nodes;
    }
    tree_.nodes.resize(nodes);
    parallel_chunks(parts_.size(), 1, [&](std::size_t i, std::size_t, std::size_t) {
      check_();
      Part& part = parts_[i];
      std::uint32_t next = part.index;
      if (!part.is_inner) part.sums = build(part.begin, part.end, part.level, next);
    });
    // Children follow their parents.
    for (std::size_t i = parts_.size(); i-- > 0;) {
      const Part& part = parts_[i];
      if (part.is_inner)
        store(part.index, part.sums, part.begin, part.end, false,
              part.past < parts_.size() ? parts_[part.past].index : nodes);
      if (part.parent != kNoParent) parts_[part.parent].sums.add(part.sums);
    }
  }

 private:
  static constexpr std::uint32_t kPart = 4096;  // samples of one task
  static constexpr std::size_t kNoParent = ~std::size_t(0);

  // A subtree, or one inner node above subtrees; in depth-first order.
  struct Part {
    std::uint32_t begin, end;  // its samples
    int level;
    std::size_t parent, past;  // the part above, the first one outside this
    bool is_inner;
    std::uint32_t nodes = 0, index = 0;  // number, and index of the first
    Sums sums{};
  };

  void cut(std::uint32_t begin, std::uint32_t end, int level, std::size_t parent) {
    level = branching_level(begin, end, level);
    const bool is_inner = end - begin > kPart && level < kLevels;
    const std::size_t index = parts_.size();
    parts_.push_back({begin, end, level, parent, index + 1, is_inner});
    if (!is_inner) return;
    for_children(begin, end, level,
                 [&](std::uint32_t first, std::uint32_t last) { cut(first, last, level + 1, index); });
    parts_[index].past = parts_.size();
  }

  std::uint32_t count(std::uint32_t begin, std::uint32_t end, int level) const {
    level = branching_level(begin, end, level);
    std::uint32_t nodes = 1;
    if (!is_leaf(begin, end, level))
      for_children(begin, end, level,
                   [&](std::uint32_t first, std::uint32_t last) { nodes += count(first, last, level + 1); });
    return nodes;
  }

  // next: index of the first node not yet written.
  Sums build(std::uint32_t begin, std::uint32_t end, int level, std::uint32_t& next) {
    level = branching_level(begin, end, level);
    const std::uint32_t index = next++;
    Sums sums;
    const bool leaf = is_leaf(begin, end, level);
    if (leaf)
      for (std::uint32_t i = begin; i < end; ++i) sums.add(sums_of(tree_.samples[i]));
    else
      for_children(begin, end, level, [&](std::uint32_t first, std::uint32_t last) {
        sums.add(build(first, last, level + 1, next));
      });
    store(index, sums, begin, end, leaf, next);
    return sums;
  }

  // Skips levels with all samples in one child.
  int branching_level(std::uint32_t begin, std::uint32_t end, int level) const {
    while (level < kLevels && digit(begin, level) == digit(end - 1, level)) ++level;
    return level;
  }

  static bool is_leaf(std::uint32_t begin, std::uint32_t end, int level) {
    return end - begin <= kLeafSamples || level == kLevels;
  }

  template <class Use>
  void for_children(std::uint32_t begin, std::uint32_t end, int level, const Use& use) const {
    for (std::uint32_t first = begin; first < end;) {
      const auto rest = std::span(keys_).subspan(first, end - first);
      const unsigned child = digit(first, level);
      const auto last =
          std::ranges::partition_point(rest, [&](std::uint64_t key) { return digit(key, level) == child; });
      const auto past = first + std::uint32_t(last - rest.begin());
      use(first, past);
      first = past;
    }
  }

  static unsigned digit(std::uint64_t key, int level) { return key >> (3 * (kLevels - 1 - level)) & 7; }
  unsigned digit(std::uint32_t i, int level) const { return digit(keys_[i], level); }

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

  // Central moments; negative rounding errors on the diagonal become zero.
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

  void store(std::uint32_t index, const Sums& sums, std::uint32_t begin, std::uint32_t end, bool leaf,
             std::uint32_t skip) {
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
    // Half size up to the farther side of the rounded middle.
    node.half = component_max(sums.high - node.center, node.center - sums.low);
    node.spread = central_moment(sums);
    node.skip = skip;
    node.first = begin;
    node.count = end - begin;
    node.leaf = leaf;
  }

  const CancelCheck check_;
  Octree& tree_;
  std::vector<std::uint64_t> keys_;
  std::vector<Part> parts_;
};

float unit_of_flux(std::span<const FluxSample> samples) {
  float largest = 0;
  for (const FluxSample& s : samples) largest = std::max(largest, max_component(s.irradiance));
  return largest > 0 && std::isfinite(largest) ? std::exp2(std::floor(std::log2(largest)) + 1) : 1.0f;
}

}  // namespace

void list_children(Octree& tree) {
  tree.first_child.reserve(tree.nodes.size() + 1);
  tree.children.reserve(tree.nodes.size());
  const CancelCheck check;
  for (std::uint32_t i = 0; i < tree.nodes.size(); ++i) {
    check();
    tree.first_child.push_back(std::uint32_t(tree.children.size()));
    for (std::uint32_t child = i + 1; child < tree.nodes[i].skip; child = tree.nodes[child].skip)
      tree.children.push_back(child);
  }
  tree.first_child.push_back(std::uint32_t(tree.children.size()));
}

void bound_normals(Octree& tree) {
  tree.normal_cones.resize(tree.nodes.size());
  parallel_chunks(tree.nodes.size(), 1024, [&](std::size_t begin, std::size_t end, std::size_t) {
    constexpr float kRounding = 1e-3f;
    for (std::size_t i = begin; i < end; ++i) {
      const OctreeNode& node = tree.nodes[i];
      const std::span<const Vec3f> normals(tree.normals.data() + node.first, node.count);
      Vec3f sum;
      for (const Vec3f& n : normals) sum += n;
      const Vec3f axis = normalized(sum);
      float cosine = 1 - kRounding;
      for (const Vec3f& n : normals) cosine = std::min(cosine, dot(n, axis) - kRounding);
      tree.normal_cones[i] =
          cosine > 0 ? NormalCone{axis, cosine, std::sqrt(1 - cosine * cosine)} : NormalCone{};
    }
  });
}

Octree build_octree(std::vector<FluxSample> samples) {
  Octree tree;
  if (samples.empty()) return tree;
  const CancelCheck check;
  std::vector<Keyed> order = morton_order(samples);
  tree.flux_unit = unit_of_flux(samples);
  tree.samples.resize(samples.size());
  tree.normals.resize(samples.size());
  parallel_chunks(samples.size(), 4096, [&](std::size_t begin, std::size_t end, std::size_t) {
    check();
    for (std::size_t i = begin; i < end; ++i) {
      const FluxSample& s = samples[order[i].sample];
      const RgbF flux = s.irradiance / tree.flux_unit * s.area;
      tree.samples[i] = {s.position.x, s.position.y, s.position.z, s.area, {flux.x, flux.y, flux.z, 0}};
      tree.normals[i] = s.normal;
    }
  });
  std::vector<FluxSample>().swap(samples);  // frees memory for the nodes
  std::vector<std::uint64_t> keys(order.size());
  std::ranges::transform(order, keys.begin(), &Keyed::key);
  std::vector<Keyed>().swap(order);
  Builder(tree, std::move(keys)).build();
  list_children(tree);
  return tree;
}

}  // namespace opaline
