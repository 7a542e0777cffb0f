// SPDX-License-Identifier: GPL-3.0-or-later
#include "exitance/evaluate.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "core/parallel.h"
#include "exitance/dual_tree.h"
#include "exitance/far_side.h"
#include "exitance/gather.h"
#include "exitance/simd/lane_table.h"

namespace opaline {
namespace {

constexpr int kBorderRings = 192;

// Radii over h of the rings' edges, dense near the point, where steep profiles have most of their mass.
double ring_radius(int i) {
  return std::pow(double(i) / kBorderRings, 4);
}

// Weight of each ring around the point over the sum of all, from the cumulative integral up to each ring's
// border.
std::vector<double> ring_shares(const std::vector<double>& within) {
  std::vector<double> shares;
  for (int i = 0; i < kBorderRings; ++i) {
    const double ring = within[std::size_t(i) + 1] - within[std::size_t(i)];
    shares.push_back(within.back() > 0 ? ring / within.back() : 0);
  }
  return shares;
}

// Part of the rings on this side of a straight border at distance t h.
double inside_border(const std::vector<double>& shares, double t) {
  double sum = 0;
  for (int i = 0; i < kBorderRings; ++i) {
    const double radius = 0.5 * (ring_radius(i) + ring_radius(i + 1));
    const double outside = radius > t ? std::acos(t / radius) / std::numbers::pi : 0;
    sum += shares[std::size_t(i)] * (1 - outside);
  }
  return sum;
}

// Fractions of the weight (1 - t^2)^2, used for the sum of the samples' areas.
std::vector<double> area_shares() {
  std::vector<double> within;
  for (int i = 0; i <= kBorderRings; ++i)
    within.push_back(1 - std::pow(1 - ring_radius(i) * ring_radius(i), 3));
  return ring_shares(within);
}

// Near fractions of 2 pi r R_d (1 - w(r/h)), integrated by parts: bounded even for steep profiles.
std::vector<double> near_shares(const ChannelProfile& profile, double h) {
  std::vector<double> within{0};
  double by_parts = 0;
  for (int i = 0; i < kBorderRings; ++i) {
    const double a = ring_radius(i), b = ring_radius(i + 1), m = 0.5 * (a + b);
    by_parts += (b - a) * diffuse_reflectance_within(profile, m * h) * 30 * m * m * (1 - m) * (1 - m);
    within.push_back(diffuse_reflectance_within(profile, b * h) * (1 - far_weight(b)) + by_parts);
  }
  return ring_shares(within);
}

// For each row, the distance over h of the border leaving its fraction of the areas.
std::array<double, SplitKernel::kBorderRows> border_distances() {
  const std::vector<double> area = area_shares();
  std::array<double, SplitKernel::kBorderRows> distances{};
  for (std::size_t row = 0; row < SplitKernel::kBorderRows; ++row) {
    const double wanted = 0.5 + 0.5 * double(row) / (SplitKernel::kBorderRows - 1);
    double low = 0, high = 1;  // the area increases with the border's distance
    for (int i = 0; i < 20; ++i)
      (inside_border(area, 0.5 * (low + high)) < wanted ? low : high) = 0.5 * (low + high);
    distances[row] = 0.5 * (low + high);
  }
  return distances;
}

/// Table SplitKernel::border for a profile split at h: the remaining fraction of the near field beside the
/// straight edge of a half plane. Each row is for the edge leaving the row's fraction of the area, with the
/// samples' weight. Numerical, error below 1e-3.
std::array<std::array<float, 3>, SplitKernel::kBorderRows> border_shares(const DiffuseProfile& profile,
                                                                         double h) {
  static const std::array<double, SplitKernel::kBorderRows> distances = border_distances();  // takes 5 ms
  std::array<std::vector<double>, 3> near;
  for (std::size_t c = 0; c < 3; ++c) near[c] = near_shares(profile.channels[c], h);
  std::array<std::array<float, 3>, SplitKernel::kBorderRows> rows{};
  for (std::size_t row = 0; row < SplitKernel::kBorderRows; ++row)
    for (std::size_t c = 0; c < 3; ++c) rows[row][c] = float(inside_border(near[c], distances[row]));
  return rows;
}

// True if a node may be one point: small at this distance and entirely outside the near field.
bool is_far(const OctreeNode& node, const Vec3f& p, __m128 r2, float max_solid_angle, float near2) {
  const __m128 limit = _mm_mul_ps(_mm_set1_ps(max_solid_angle), r2);
  if (_mm_movemask_ps(_mm_cmpgt_ps(_mm_set1_ps(node.flux[3]), limit)) != 0) return false;
  const Vec3f d = p - node.center;
  const Vec3f gap = component_max(Vec3f{std::abs(d.x), std::abs(d.y), std::abs(d.z)} - node.half, Vec3f{});
  const float gap2 = dot(gap, gap);
  return gap2 > 0 && gap2 >= near2;
}

void walk(const EvaluateInput& input, const Query& query, Gather& gather) {
  const std::vector<OctreeNode>& nodes = input.octree.nodes;
  const float max_solid_angle = float(input.max_solid_angle);
  const float near2 = input.kernel.radius * input.kernel.radius;
  const __m128 px = _mm_set1_ps(query.position.x), py = _mm_set1_ps(query.position.y),
               pz = _mm_set1_ps(query.position.z);
  for (std::uint32_t i = 0; i < nodes.size();) {
    const OctreeNode& node = nodes[i];
    const __m128 dx = _mm_sub_ps(_mm_load_ps(node.x.data()), px),
                 dy = _mm_sub_ps(_mm_load_ps(node.y.data()), py),
                 dz = _mm_sub_ps(_mm_load_ps(node.z.data()), pz);
    const __m128 r2 = _mm_add_ps(_mm_mul_ps(dx, dx), _mm_add_ps(_mm_mul_ps(dy, dy), _mm_mul_ps(dz, dz)));
    if (is_far(node, query.position, r2, max_solid_angle, near2)) {
      gather.add_node(node, r2);
      i = node.skip;
    } else if (node.leaf) {
      gather.add_samples(node.first, node.first + node.count);
      i = node.skip;
    } else {
      ++i;
    }
  }
}

// Weight of the point's own irradiance. Its mixture with the samples' mean (weight (1 - t^2)^2, mean square
// radius h^2/4) has the near kernel's mean square radius.
double own_share(const ChannelProfile& profile, double h) {
  double flux = 0, moment = 0;
  constexpr int kRings = 1000;
  for (int i = 0; i < kRings; ++i) {
    const double t = (i + 0.5) / kRings, ring = near_ring(profile, h, t);
    flux += ring;
    moment += ring * t * t;
  }
  return flux > 0 ? std::clamp(1 - 4 * moment / flux, 0.0, 1.0) : 0;
}

// SplitKernel::own_irradiance; near: the near field's fraction of the total.
float own_irradiance(const ChannelProfile& profile, double h, double near, NearIrradiance wanted) {
  if (wanted != NearIrradiance::mixed) return wanted == NearIrradiance::point ? 1.0f : 0.0f;
  // Fades to zero where little light depends on it: the irradiance at the point is then not worth its shadow
  // rays, and spacings vary with the seed.
  const double own = own_share(profile, h), t = std::clamp((own * near - 0.02) / 0.02, 0.0, 1.0);
  return float(own * t * t * (3 - 2 * t));
}

Exitance evaluate_one(const EvaluateInput& input, std::size_t q) {
  Gather gather(input, input.queries[q]);
  if (input.evaluator == EvaluatorKind::classic)
    walk(input, input.queries[q], gather);
  else
    gather.add_samples(0, std::uint32_t(input.octree.samples.size()));
  return gather.result(input.irradiance.empty() ? nullptr : &input.irradiance[q]);
}

}  // namespace

SplitKernel make_split_kernel(const DiffuseProfile& profile, double spacing, double extent, bool split,
                              NearIrradiance near_irradiance) {
  // Closer than a quarter of the spacing, R_d w is negligible; without the split, R_d is constant there.
  const double r_min = spacing / 4, radius = 2.5 * spacing;
  SplitKernel kernel{KernelTable(profile, r_min, std::max(extent, 2 * radius)),
                     split,
                     float(radius),
                     {},
                     {},
                     {},
                     {},
                     {},
                     {}};
  kernel.lanes = std::make_shared<const LaneTable>(
      make_lane_table(profile, radius, std::max(extent, 2 * radius), split));
  if (profile.has_far_side) kernel.far_side = make_far_side(profile, r_min, std::max(extent, 2 * radius));
  if (split) kernel.border = border_shares(profile, radius);
  for (std::size_t c = 0; c < 3; ++c) kernel.total[c] = float(profile.total[c]);
  for (std::size_t c = 0; split && c < 3; ++c) {
    kernel.near[c] = float(near_field_reflectance(profile.channels[c], radius));
    if (kernel.near[c] > 0)
      kernel.own_irradiance[c] = own_irradiance(profile.channels[c], radius,
                                                double(kernel.near[c]) / profile.total[c], near_irradiance);
  }
  return kernel;
}

std::vector<Exitance> evaluate(const EvaluateInput& input) {
  std::vector<Exitance> result(input.queries.size());
  if (input.octree.nodes.empty()) return result;
  if (input.evaluator != EvaluatorKind::classic && input.evaluator != EvaluatorKind::brute_force) {
    evaluate_dual_tree(input, result);
  } else {
    parallel_chunks(input.queries.size(), 64, [&](std::size_t begin, std::size_t end, std::size_t) {
      for (std::size_t q = begin; q < end; ++q) result[q] = evaluate_one(input, q);
      advance(input.monitor, end - begin);
    });
  }
  if (input.kernel.far_side != nullptr) add_far_side(input, result);
  return result;
}
}  // namespace opaline
