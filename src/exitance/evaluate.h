// SPDX-License-Identifier: GPL-3.0-or-later
// Radiant exitance from the tree of transmitted flux.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "diffusion/diffuse_profile.h"
#include "diffusion/kernel_table.h"
#include "exitance/octree.h"
#include "opaline/monitor.h"
#include "opaline/scene.h"

namespace opaline {

struct LaneTable;

/// Kernel between the two sides of a plate or body: between samples and points on different sheets
/// (same_sheet). Applied as a correction (far_side.h), as nodes of the tree may contain both sides.
struct FarSide {
  KernelTable table;  ///< far_side_profile
  float reach = 0;    ///< mm; beyond it, both sides have the same exitance
};

/// Kernel split near the shading point: R_d = R_near + R_far with R_far = R_d w(r/h). The far part is summed
/// over the samples. The near part, too steep for them, is an integral times the irradiance around the point.
struct SplitKernel {
  KernelTable table;
  bool split = true;
  float radius = 0;              ///< h, 2.5 sample spacings, mm
  std::array<float, 3> near{};   ///< integral of R_near over the plane
  std::array<float, 3> total{};  ///< total of the profile
  /// Fraction of `near` beside a border of the surface, per channel, for the straight edge of a half plane.
  /// Rows: fraction of a plane's area around the point, from 1/2 (on the border) to 1, weighted by (1 -
  /// r^2/h^2)^2.
  static constexpr std::size_t kBorderRows = 65;
  std::array<std::array<float, 3>, kBorderRows> border{};
  std::shared_ptr<const LaneTable> lanes;  ///< the far kernel for dual_tree
  /// Weight of the point's own irradiance in the near field; the rest is the samples' mean around it, which
  /// alone would blur shadows. The mixture has the near kernel's mean square radius. 1 for a vanishing mean
  /// free path, about 0.45 (dipole) or 0.65 (normalized diffusion) for a mean free path of one sample
  /// spacing, and 0 if less than 2 % of the light depends on it.
  std::array<float, 3> own_irradiance{};
  std::shared_ptr<const FarSide> far_side = {};  ///< if the profile has a far side (has_far_side)
  /// True if the exitance at a point depends on the irradiance at the point itself.
  bool needs_irradiance() const { return own_irradiance[0] + own_irradiance[1] + own_irradiance[2] > 0; }
};

/// in    spacing: sqrt(area / samples), mm; extent: largest distance between a query and a sample, mm
SplitKernel make_split_kernel(const DiffuseProfile& profile, double spacing, double extent, bool split,
                              NearIrradiance near_irradiance = NearIrradiance::mixed);

struct Query {
  Vec3f position;  ///< mm, recentred as the samples are
  Vec3f normal;
};

struct Exitance {
  RgbF exitance;    ///< M_o, W/mm^2
  RgbF irradiance;  ///< E interpolated from the samples within h, W/mm^2
  RgbF near;        ///< integral of the near field over the surface around the point
  /// Estimated standard error of the exitance against the converged diffusion of the same scene, W/mm^2: from
  /// the spread of neighbouring samples, the variation of E nearby, the roughness and noise of E, samples on
  /// other sheets within h, and nodes as points (CloudError; bench_error_estimate).
  RgbF error{};
};

/// Number of queries in each packet of a chunk of neighbours, in their order.
struct PacketCut {
  static constexpr std::size_t kMost = 32;
  std::size_t packets = 0;
  std::array<std::uint8_t, kMost> counts{};
};

/// Grouping of queries for the tree traversal; depends on their positions only.
struct QueryPackets {
  float radius = 0;                  ///< h of the kernel at the grouping
  std::vector<std::uint32_t> order;  ///< order of the finite queries; empty: not computed
  std::vector<PacketCut> cuts;       ///< one per chunk
};

/// Error model of a cloud of samples, per channel: the parts not visible to one query. See tell_cloud_error.
struct CloudError {
  /// Rms difference between a sample's irradiance and the mean of its neighbours', over the rms irradiance;
  /// includes the noise of its shadow rays.
  std::array<float, 3> roughness{};
  std::array<float, 3> far_squares{};  ///< sum of squares of the samples' flux over the square of their sum
  /// Measured error of trial sums over the estimate from neighbours' differences in contribution and
  /// irradiance.
  std::array<float, 3> scale{1, 1, 1};
  std::array<float, 3> hierarchy{.1f, .1f, .1f};  ///< mean error of the tree's nodes over the tolerance
  /// `classic` only: measured error of nodes as points, over the estimate from their solid angles.
  std::array<float, 3> flattened{1, 1, 1};
  std::array<float, 3> light_shift{};  ///< systematic relative error of the irradiance
  float other_sheets = 1;              ///< 0: without the samples on other sheets within h
};

struct EvaluateInput {
  const Octree& octree;
  const SplitKernel& kernel;
  std::span<const Query> queries;
  /// Transmitted irradiance at each query, for channels with own_irradiance; empty: interpolated everywhere.
  std::span<const RgbF> irradiance = {};
  EvaluatorKind evaluator = EvaluatorKind::dual_tree;          ///< automatic, surface_cache: dual_tree too
  double tolerance = 0.005;                                    ///< dual_tree
  double max_solid_angle = 0.05;                               ///< classic, sr
  InstructionSet instruction_set = InstructionSet::automatic;  ///< dual_tree
  CloudError cloud = {};  ///< error model of the samples, for Exitance::error
  Monitor* monitor = nullptr;
  QueryPackets* packets = nullptr;  ///< dual_tree: of an earlier evaluation of these queries, or to be filled
};

/// Radiant exitance at each query point, in their order; finite and >= 0.
/// `dual_tree`: clusters of queries traverse the tree together. A node is added to a series around the
/// cluster's centre, or replaced by its centroid and second moment, if a bound of its error is below a
/// fraction of the cluster's exitance in each channel.
/// Accuracy, per channel (test_dual_tree): p99 of |result - brute force| / max(|brute force|, 1e-3 P) <=
/// tolerance, with P the p99 of brute force over all queries. Requires P above 1e-3 of the largest possible
/// exitance, and a tolerance above the error of the far kernel's table: 1e-3, or 2.5e-3 for mean free paths
/// below the sample spacing. Non-finite queries get 0.
/// `classic`: each query traverses the tree from its root. A node is one flux at its centroid if its area
/// over its squared distance is at most max_solid_angle and it is entirely beyond h; leaves are summed sample
/// by sample.
/// `brute_force`: every sample; the limit of max_solid_angle -> 0 up to rounding.
/// from  Jensen & Buhler 2002 sec. 3; near field: see SplitKernel
std::vector<Exitance> evaluate(const EvaluateInput& input);

}  // namespace opaline
