// SPDX-License-Identifier: GPL-3.0-or-later
#include "exitance/far_side.h"

#include <emmintrin.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <utility>
#include <vector>

#include "core/parallel.h"
#include "sampling/sample_surface.h"

namespace opaline {
namespace {

// Neglected fraction of both sides' exitance beyond the reach.
constexpr double kNeglected = 3e-4;
// Maximum area over squared distance of a node as a point.
constexpr float kSolidAngle = 0.06f;
constexpr float kNarrow = 0.85f;  // cosine of such a node's cone

double thickness_of(const ChannelProfile& profile) {
  const auto& plate = std::get<Multipole>(profile);
  return plate.thickness * plate.mean_free_path;
}

// Smallest distance beyond which the difference of both sides is negligible.
double reach_of(const ChannelProfile& profile, double r_min, double r_max) {
  const double both =
      total_diffuse_reflectance(profile) + total_diffuse_transmittance(profile, thickness_of(profile));
  const double step = std::pow(2., 1. / 8);
  double beyond = 0, r = r_max;
  for (; r > r_min; r /= step) {
    const double difference = far_side_profile(profile, r) - diffuse_reflectance_profile(profile, r);
    beyond += 2 * std::numbers::pi * r * r * std::log(step) * std::abs(difference);
    if (beyond > kNeglected * both) break;
  }
  return std::min(r_max, r * step);
}

// Successive queries, with bounds of their positions and normals.
struct QueryBounds {
  Vec3f low, high, axis;
  float cosine = 0, sine = 1;  // cosine and sine of the angle around the axis; cosine 0: any direction

  explicit QueryBounds(std::span<const Query> queries) : low(queries[0].position), high(low) {
    Vec3f sum;
    for (const Query& q : queries) {
      widen(low, high, q.position);
      sum += q.normal;
    }
    axis = normalized(sum);
    float least = 1;
    for (const Query& q : queries) least = std::min(least, dot(axis, q.normal));
    if (!(least > 0)) return;
    cosine = least;
    sine = std::sqrt(std::max(0.0f, 1 - least * least));
  }
};

enum class Sheets { same, other, both };  // both: mixed or unknown

// Sheets of all normals in a cone, seen from all queries: the angle to them is at most that of the axes plus
// both cones' half-angles; beyond 120 degrees it is another sheet (same_sheet).
Sheets sheets_of(const QueryBounds& queries, const Vec3f& axis, float cosine, float sine) {
  if (cosine == 0 || queries.cosine == 0) return Sheets::both;
  const float c = cosine * queries.cosine - sine * queries.sine,  // cosine and sine of the sum of both angles
      s = sine * queries.cosine + cosine * queries.sine;
  constexpr float kCosine = -0.5f, kSine = 0.8660254f;  // cosine and sine of 120 degrees
  const float between = dot(axis, queries.axis);
  if (c > kCosine && between > kCosine * c + kSine * s) return Sheets::same;
  // More than 60 degrees reach back to the same sheet.
  if (c > 0.5f && between < kCosine * c - kSine * s) return Sheets::other;
  return Sheets::both;
}

// Sum over neighbouring queries: nodes on other sheets as points, and samples.
class CrossingLight {
 public:
  CrossingLight(const EvaluateInput& input, std::span<const Query> queries)
      : octree_(input.octree),
        near_(input.kernel.table),
        far_(input.kernel.far_side->table),
        reach2_(input.kernel.far_side->reach * input.kernel.far_side->reach) {
    const QueryBounds bounds(queries);
    const std::vector<OctreeNode>& nodes = octree_.nodes;
    for (std::uint32_t i = 0; i < nodes.size();) {
      const OctreeNode& node = nodes[i];
      const Vec3f gap = component_max(
          component_max(bounds.low - (node.center + node.half), (node.center - node.half) - bounds.high),
          Vec3f{});
      const float gap2 = dot(gap, gap);
      const NormalCone cone = octree_.normal_cones.empty() ? NormalCone{} : octree_.normal_cones[i];
      const Sheets sheets = sheets_of(bounds, cone.axis, cone.cosine, cone.sine);
      if (gap2 <= reach2_ && sheets != Sheets::same) {
        // A node across the limit of 120 degrees belongs to the sheet of its mean normal.
        const bool is_point = gap2 > 0 && node.flux[3] < kSolidAngle * gap2 && cone.cosine > kNarrow;
        if (!is_point && !node.leaf) {
          ++i;
          continue;
        }
        if (is_point)
          (sheets == Sheets::other ? other_nodes_ : unknown_nodes_).push_back(i);
        else
          take_samples(bounds, node);
      }
      i = node.skip;
    }
  }

  RgbF sum_at(const Query& query) const {
    __m128 sum = _mm_setzero_ps();
    for (const std::uint32_t i : other_nodes_) add_node(i, query, sum);
    for (const std::uint32_t i : unknown_nodes_)
      if (!same_sheet(octree_.normal_cones[i].axis, query.normal)) add_node(i, query, sum);
    for (const std::uint32_t i : others_) add_sample(i, query, sum);
    for (const std::uint32_t i : unknown_)
      if (!same_sheet(octree_.normals[i], query.normal)) add_sample(i, query, sum);
    alignas(16) std::array<float, 4> rgb;
    _mm_store_ps(rgb.data(), sum);
    return {rgb[0], rgb[1], rgb[2]};
  }

 private:
  void take_samples(const QueryBounds& bounds, const OctreeNode& node) {
    for (std::uint32_t i = node.first; i < node.first + node.count; ++i) {
      const Sheets sheets =
          sheets_of(bounds, octree_.normals[i], 1 - 1e-6f, 1.5e-3f);  // a unit vector, about
      if (sheets == Sheets::other) others_.push_back(i);
      if (sheets == Sheets::both) unknown_.push_back(i);
    }
  }

  void add_node(std::uint32_t i, const Query& query, __m128& sum) const {
    const OctreeNode& node = octree_.nodes[i];
    std::array<float, 3> r2{};
    for (std::size_t c = 0; c < 3; ++c) {
      const Vec3f d = Vec3f{node.x[c], node.y[c], node.z[c]} - query.position;
      r2[c] = dot(d, d);
    }
    const __m128 change = r2[0] == r2[1] && r2[1] == r2[2]
                              ? _mm_sub_ps(far_(r2[0]), near_(r2[0]))
                              : _mm_sub_ps(far_(r2[0], r2[1], r2[2]), near_(r2[0], r2[1], r2[2]));
    sum = _mm_add_ps(sum, _mm_mul_ps(_mm_load_ps(node.flux.data()), change));
  }

  void add_sample(std::uint32_t i, const Query& query, __m128& sum) const {
    const TreeSample& s = octree_.samples[i];
    const Vec3f d = Vec3f{s.x, s.y, s.z} - query.position;
    const float r2 = dot(d, d);
    if (r2 < reach2_)
      sum = _mm_add_ps(sum, _mm_mul_ps(_mm_load_ps(s.flux.data()), _mm_sub_ps(far_(r2), near_(r2))));
  }

  const Octree& octree_;
  const KernelTable &near_, &far_;
  float reach2_;
  std::vector<std::uint32_t> other_nodes_, unknown_nodes_, others_, unknown_;  // nodes, and samples
};

bool is_finite(const Query& query) {
  return is_finite(query.position) && is_finite(query.normal);
}

}  // namespace

std::shared_ptr<const FarSide> make_far_side(const DiffuseProfile& profile, double r_min, double r_max) {
  FarSide side{KernelTable::of_far_side(profile, r_min, r_max), 0};
  for (const ChannelProfile& channel : profile.channels)
    if (has_far_side(channel)) side.reach = std::max(side.reach, float(reach_of(channel, r_min, r_max)));
  return std::make_shared<const FarSide>(std::move(side));
}

void add_far_side(const EvaluateInput& input, std::span<Exitance> result) {
  // Few enough to be neighbours in an image.
  constexpr std::size_t kTogether = 16;
  parallel_chunks(input.queries.size(), kTogether, [&](std::size_t begin, std::size_t end, std::size_t) {
    std::vector<Query> queries;
    for (std::size_t q = begin; q < end; ++q)
      if (is_finite(input.queries[q])) queries.push_back(input.queries[q]);
    if (queries.empty()) return;
    const CrossingLight light(input, queries);
    for (std::size_t q = begin; q < end; ++q)
      if (is_finite(input.queries[q]))
        result[q].exitance = component_max(
            RgbF{}, result[q].exitance + light.sum_at(input.queries[q]) * input.octree.flux_unit);
  });
}

}  // namespace opaline
