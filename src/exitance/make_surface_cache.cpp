// SPDX-License-Identifier: GPL-3.0-or-later
// Nodes of a surface cache.
#include <algorithm>
#include <bit>
#include <cmath>
#include <unordered_map>
#include <utility>

#include "core/random.h"
#include "exitance/make_patches.h"
#include "exitance/surface_patch.h"

namespace opaline {
namespace {

// Fractions of the tolerance: for the evaluation at the nodes, and for the estimated interpolation error.
constexpr double kEvaluationShare = 0.6, kInterpolationShare = 0.4;
// Remaining fractions of the interpolation error (test_surface_cache): of the slopes' contribution at the
// middle of an edge; of the previous lattice's error at new nodes; and of the same at the finest lattice,
// where only large errors leave a patch to points.
constexpr float kRiseError = 0.6f, kRest = 0.6f, kRestAtFinest = 0.05f;
// Least cosine between two vertices' normals for using slopes between them; README.md has the comparison.
constexpr float kBent = 0.95f;
// In near-field radii: longest patch, as longer ones could hide variation of the far kernel; smallest
// distance of nodes, as closer ones resolve the samples' noise; largest distance of vertices that detects a
// shadow edge blurred by the near field.
constexpr double kReach = 2, kFinest = 0.25, kBlur = 0.5;

// Change of the own contribution between two vertices, over the sum of their exitance, above which a shadow
// edge may be between them.
constexpr float kJump = 0.02f;

// Position of a node shared by patches: k of n segments along the edge of two vertices, or at one of them (n is 0).
struct EdgePlace {
  std::uint64_t where = 0;
  std::uint32_t k = 0, n = 0;
  friend bool operator==(const EdgePlace&, const EdgePlace&) = default;
};
struct EdgeHash {
  std::size_t operator()(const EdgePlace& place) const noexcept {
    return hash_bits(place.where, std::uint64_t(place.k) << 32 | place.n);
  }
};

EdgePlace edge_place(std::uint32_t a, std::uint32_t b, std::uint32_t k, std::uint32_t n) {
  if (k == 0) return {a, 0, 0};
  if (k == n) return {b, 0, 0};
  if (a > b) std::swap(a, b), k = n - k;
  const int common = std::countr_zero(k | n);
  return {std::uint64_t(a) << 32 | b, k >> common, n >> common};
}

// A patch not resolved by its vertices alone.
struct Refined {
  std::uint32_t patch, segments;
  bool edge;  // may contain a shadow edge
  std::vector<std::uint32_t> nodes;
};

class Builder {
 public:
  explicit Builder(const SurfaceCacheInput& input) : input_(input) {
    if (!input.add_own_light) cache_.own_irradiance = input.kernel.own_irradiance;
    normals_ = make_patches(input.world, input.meshes, kReach * double(input.kernel.radius), cache_);
  }

  std::optional<SurfaceCache> build() {
    for (std::size_t v = 0; v < normals_.size(); ++v)
      queries_.push_back({cache_.vertices[v].position, normals_[v]});
    vertex_doubts_.resize(normals_.size());
    evaluate_queued([&](std::size_t v, const Exitance& value, const PlaceDoubt& doubt) {
      cache_.vertices[v].value = value;
      vertex_doubts_[v] = doubt;
    });
    set_floor();
    set_slopes();
    leave_sharp_to_points();
    std::vector<Refined> active = ill_told_patches();
    while (!active.empty()) {
      for (Refined& r : active) set_nodes(r);
      if (cache_.vertices.size() + node_count_ > input_.most_places) return {};
      add_nodes();
      evaluate_queued([&](std::size_t i, const Exitance& value, const PlaceDoubt& doubt) {
        cache_.nodes[new_nodes_[i]] = value;
        node_doubts_[new_nodes_[i]] = doubt;
      });
      new_nodes_.clear();
      std::erase_if(active, [&](Refined& r) { return !wants_more(r); });
    }
    return std::move(cache_);
  }

 private:
  // Evaluates the queued queries, with own irradiance zero until it is added, in parts for bounded memory.
  // use: called with the index of a query, its exitance and its doubt (AddOwnLight)
  template <class Use>
  void evaluate_queued(const Use& use) {
    constexpr std::size_t kAtOnce = 1 << 16;
    const std::vector<RgbF> dark(std::min(kAtOnce, queries_.size()));
    for (std::size_t begin = 0; begin < queries_.size(); begin += kAtOnce) {
      const auto part = std::span(queries_).subspan(begin, std::min(kAtOnce, queries_.size() - begin));
      std::vector<Exitance> result = evaluate({.octree = input_.octree,
                                               .kernel = input_.kernel,
                                               .queries = part,
                                               .irradiance = std::span(dark).first(part.size()),
                                               .tolerance = kEvaluationShare * input_.tolerance,
                                               .instruction_set = input_.instruction_set,
                                               .cloud = input_.cloud,
                                               .monitor = input_.monitor});
      std::vector<PlaceDoubt> doubts(part.size());
      if (input_.add_own_light) {
        std::vector<SurfacePoint> points;
        for (const Query& q : part) points.push_back({q.position, q.normal, q.normal});
        input_.add_own_light(points, result, doubts);
      }
      for (std::size_t i = 0; i < part.size(); ++i) use(begin + i, result[i], doubts[i]);
    }
    queries_.clear();
  }

  RgbF whole(const Exitance& e) const {
    return e.exitance + own_part(cache_.own_irradiance, e, e.irradiance);
  }

  // Below 1e-3 of the p99 errors are absolute.
  void set_floor() {
    std::vector<float> values(cache_.vertices.size());
    if (values.empty()) return;
    const std::size_t p99 = (values.size() * 99 + 99) / 100 - 1;
    for (std::size_t c = 0; c < 3; ++c) {
      std::ranges::transform(cache_.vertices, values.begin(),
                             [&](const auto& v) { return whole(v.value)[c]; });
      std::ranges::nth_element(values, values.begin() + std::ptrdiff_t(p99));
      floor_[c] = 1e-3f * values[p99];
    }
  }

  // Slope of a vertex: mean over its patches, weighted by area.
  void set_slopes() {
    std::vector<float> areas(cache_.vertices.size());
    for (const SurfaceCache::Patch& patch : cache_.patches) {
      const auto& [ia, ib, ic] = patch.vertices;
      const SurfaceCache::Vertex &a = cache_.vertices[ia], &b = cache_.vertices[ib], &c = cache_.vertices[ic];
      const Vec3f ab = b.position - a.position, ac = c.position - a.position, normal = cross(ab, ac);
      const float area = length(normal);
      if (!(area > 0)) continue;
      const Vec3f towards_b = cross(ac, normal) / area,
                  towards_c = cross(normal, ab) / area;  // slopes x area
      const RgbF rise_b = b.value.exitance - a.value.exitance, rise_c = c.value.exitance - a.value.exitance;
      for (const std::uint32_t v : patch.vertices) {
        areas[v] += area;
        for (std::size_t k = 0; k < 3; ++k)
          cache_.vertices[v].slope[k] += towards_b * rise_b[k] + towards_c * rise_c[k];
      }
    }
    for (std::size_t v = 0; v < areas.size(); ++v)
      for (Vec3f& slope : cache_.vertices[v].slope) slope *= areas[v] > 0 ? 1 / areas[v] : 0;
  }

  bool is_too_much(const RgbF& error, const RgbF& exitance, const RgbF& noise) const {
    for (std::size_t c = 0; c < 3; ++c)
      if (std::abs(error[c]) >
          float(kInterpolationShare * input_.tolerance) * std::max(exitance[c], floor_[c]) + noise[c])
        return true;
    return false;
  }

  void leave_sharp_to_points() {
    for (SurfaceCache::Patch& patch : cache_.patches)
      if (std::ranges::any_of(patch.vertices,
                              [&](std::uint32_t v) { return vertex_doubts_[v].is_too_sharp; }))
        patch.lattice = SurfaceCache::kLeftToPoints;
  }

  std::vector<Refined> ill_told_patches() const {
    std::vector<Refined> all;
    for (std::uint32_t p = 0; p < cache_.patches.size(); ++p) {
      if (cache_.patches[p].lattice == SurfaceCache::kLeftToPoints) continue;
      const bool is_long = longest_side(p) > float(kBlur) * input_.kernel.radius;
      const bool edge = is_long && any_edge(p, [&](std::uint32_t a, std::uint32_t b) {
                          return may_hide_shadow_edge(a, b);
                        });
      const bool is_bent = any_edge(
          p, [&](std::uint32_t a, std::uint32_t b) { return dot(normals_[a], normals_[b]) < kBent; });
      if (is_long || is_bent ||
          any_edge(p, [&](std::uint32_t a, std::uint32_t b) { return is_ill_told(a, b); }))
        all.push_back({p, 2, edge, {}});
    }
    return all;
  }

  template <class Predicate>
  bool any_edge(std::uint32_t patch, const Predicate& is_true) const {
    const auto& [a, b, c] = cache_.patches[patch].vertices;
    return is_true(a, b) || is_true(b, c) || is_true(c, a);
  }

  bool is_ill_told(std::uint32_t ia, std::uint32_t ib) const {
    const SurfaceCache::Vertex &a = cache_.vertices[ia], &b = cache_.vertices[ib];
    const RgbF middle = (whole(a.value) + whole(b.value)) * 0.5f,
               noise = (vertex_doubts_[ia].noise + vertex_doubts_[ib].noise) * 0.5f;
    return is_too_much(rise_between(a, b) * kRiseError, middle, noise);
  }

  // Slopes cannot detect an edge midway: they are equal on both sides.
  bool may_hide_shadow_edge(std::uint32_t ia, std::uint32_t ib) const {
    if (vertex_doubts_[ia].beside_edge || vertex_doubts_[ib].beside_edge) return true;
    if (!input_.add_own_light) return false;
    const Exitance &a = cache_.vertices[ia].value, &b = cache_.vertices[ib].value;
    const RgbF own_a = own_part(input_.kernel.own_irradiance, a, a.irradiance),
               own_b = own_part(input_.kernel.own_irradiance, b, b.irradiance);
    for (std::size_t c = 0; c < 3; ++c)
      if (std::abs(own_a[c] - own_b[c]) > kJump * (a.exitance[c] + b.exitance[c])) return true;
    return false;
  }

  // Even nodes are those of the coarser lattice.
  void set_nodes(Refined& r) {
    const std::vector<std::uint32_t> coarse = std::exchange(r.nodes, {});
    r.nodes.reserve(lattice_size(r.segments));
    for (std::uint32_t j = 0; j <= r.segments; ++j)
      for (std::uint32_t i = 0; i + j <= r.segments; ++i)
        r.nodes.push_back(!coarse.empty() && i % 2 == 0 && j % 2 == 0
                              ? coarse[lattice_index(r.segments / 2, i / 2, j / 2)]
                              : node(r, i, j));
  }

  std::optional<EdgePlace> on_edge(const Refined& r, std::uint32_t i, std::uint32_t j) const {
    const auto& [a, b, c] = cache_.patches[r.patch].vertices;
    if (j == 0) return edge_place(a, b, i, r.segments);
    if (i == 0) return edge_place(a, c, j, r.segments);
    if (i + j == r.segments) return edge_place(b, c, j, r.segments);
    return {};
  }

  std::uint32_t node(const Refined& r, std::uint32_t i, std::uint32_t j) {
    if (const std::optional<EdgePlace> place = on_edge(r, i, j)) {
      const auto [known, is_new] = on_edges_.try_emplace(*place, node_count_);
      if (!is_new) return known->second;
      if (place->n == 0) {
        at_vertices_.push_back({node_count_, std::uint32_t(place->where)});
        return node_count_++;
      }
    }
    new_nodes_.push_back(node_count_);
    queries_.push_back(place_of(r, i, j));
    return node_count_++;
  }

  // All new nodes at once, in exactly the memory they need.
  void add_nodes() {
    cache_.nodes.reserve(node_count_);
    cache_.nodes.resize(node_count_);
    node_doubts_.reserve(node_count_);
    node_doubts_.resize(node_count_);
    for (const auto& [node, vertex] : at_vertices_) {
      cache_.nodes[node] = cache_.vertices[vertex].value;
      node_doubts_[node] = vertex_doubts_[vertex];
    }
    at_vertices_.clear();
  }

  Query place_of(const Refined& r, std::uint32_t i, std::uint32_t j) const {
    const auto& [a, b, c] = cache_.patches[r.patch].vertices;
    const float u = float(i) / float(r.segments), v = float(j) / float(r.segments), w = 1 - u - v;
    return {
        cache_.vertices[a].position * w + cache_.vertices[b].position * u + cache_.vertices[c].position * v,
        normalized(normals_[a] * w + normals_[b] * u + normals_[c] * v)};
  }

  // Interpolated value at an odd node of a patch's lattice, from the even nodes.
  RgbF predicted(const Refined& r, std::uint32_t i, std::uint32_t j) const {
    const float u = float(i) / float(r.segments), v = float(j) / float(r.segments);
    if (r.segments == 2) return between_vertices(cache_, cache_.patches[r.patch], u, v).exitance;
    const CellPlace cell = cell_place(r.segments / 4, u, v);
    const SixNodes six(cell.u, cell.v);
    RgbF sum;
    for (std::size_t k = 0; k < 6; ++k) {
      const auto [ci, cj] = cell.node(4, 2 * six.offsets[k][0], 2 * six.offsets[k][1]);
      sum += value(r, ci, cj).exitance * six.weights[k];
    }
    return sum;
  }

  const Exitance& value(const Refined& r, std::uint32_t i, std::uint32_t j) const {
    return cache_.nodes[r.nodes[lattice_index(r.segments, i, j)]];
  }

  // Keeps the lattice, doubles it if the previous one predicts its nodes badly, or leaves the patch to points
  // if it does at the finest lattice.
  bool wants_more(Refined& r) {
    const bool may_grow = longest_side(r.patch) > float(kFinest) * input_.kernel.radius * float(r.segments);
    // The one new node of two segments may be in the middle of a shadow edge.
    const bool may_hide_edge = r.edge && r.segments == 2;
    if (is_too_sharp(r) || (!may_grow && is_ill_predicted(r, kRestAtFinest))) {
      cache_.patches[r.patch].lattice = SurfaceCache::kLeftToPoints;
      return false;
    }
    if (may_grow && (may_hide_edge || is_ill_predicted(r, kRest))) {
      r.segments *= 2;
      return true;
    }
    cache_.patches[r.patch].lattice = std::uint32_t(cache_.lattices.size());
    cache_.lattices.push_back({std::uint32_t(cache_.lattice_nodes.size()), r.segments});
    cache_.lattice_nodes.insert(cache_.lattice_nodes.end(), r.nodes.begin(), r.nodes.end());
    return false;
  }

  float longest_side(std::uint32_t patch) const {
    const auto& corners = cache_.patches[patch].vertices;
    float longest = 0;
    for (std::size_t k = 0; k < 3; ++k)
      longest = std::max(longest, length(cache_.vertices[corners[k]].position -
                                         cache_.vertices[corners[(k + 1) % 3]].position));
    return longest;
  }

  bool is_too_sharp(const Refined& r) const {
    return std::ranges::any_of(r.nodes, [&](std::uint32_t node) { return node_doubts_[node].is_too_sharp; });
  }

  // rest: the remaining part of the predecessor's error
  bool is_ill_predicted(const Refined& r, float rest) const {
    for (std::uint32_t j = 0; j <= r.segments; ++j)
      for (std::uint32_t i = 0; i + j <= r.segments; ++i) {
        if (i % 2 == 0 && j % 2 == 0) continue;
        const Exitance& known = value(r, i, j);
        const RgbF& noise = node_doubts_[r.nodes[lattice_index(r.segments, i, j)]].noise;
        if (is_too_much((predicted(r, i, j) - known.exitance) * rest, whole(known), noise)) return true;
      }
    return false;
  }

  const SurfaceCacheInput& input_;
  SurfaceCache cache_;
  std::vector<Vec3f> normals_;  // normals of its vertices
  std::vector<Query> queries_;  // to evaluate: of vertices at first, then of nodes
  std::vector<PlaceDoubt> vertex_doubts_, node_doubts_;
  std::vector<std::uint32_t> new_nodes_;  // their indices
  std::uint32_t node_count_ = 0;          // with those to be added
  struct NodeAtVertex {
    std::uint32_t node, vertex;
  };
  std::vector<NodeAtVertex> at_vertices_;
  std::unordered_map<EdgePlace, std::uint32_t, EdgeHash> on_edges_;
  RgbF floor_{};
};

}  // namespace

std::optional<SurfaceCache> make_surface_cache(const SurfaceCacheInput& input) {
  if (least_cache_places(input.world, input.meshes, input.kernel) > input.most_places) return {};
  return Builder(input).build();
}

std::size_t least_cache_places(const World& world, std::span<const std::uint32_t> meshes,
                               const SplitKernel& kernel) {
  std::size_t places = 0;
  for (const std::uint32_t m : meshes) {
    const Mesh& mesh = world.meshes[m];
    places += mesh.positions.size();
    for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t)
      if (const std::uint32_t n = segments_of(mesh, t, kReach * double(kernel.radius)); n > 1)
        places += lattice_size(n) - 3;
  }
  return places;
}

}  // namespace opaline
