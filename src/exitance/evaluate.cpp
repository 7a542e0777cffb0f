// SPDX-License-Identifier: GPL-3.0-or-later
#include "exitance/evaluate.h"

#include <algorithm>
#include <cmath>

#include "core/parallel.h"
#include "exitance/border_share.h"
#include "exitance/dual_tree.h"
#include "exitance/far_side.h"
#include "exitance/gather.h"
#include "exitance/simd/lane_table.h"

namespace opaline {
namespace {

// A node may stand as one point when it is small from here and wholly outside the near field.
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

// The fraction of the irradiance at the point itself for which it and the samples' mean around, weighted by
// (1 - t^2)^2 with mean square radius h^2/4, have the near kernel's mean square radius.
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
  // Where little of the light depends on it the irradiance at the point is not worth its shadow rays; faded,
  // for spacings differ a little with the seed.
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
  // Closer than a quarter of the spacing, R_d w is negligible; without the split R_d is held there.
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
