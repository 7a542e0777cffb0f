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

/// The kernel between the two sides of a plate or body: between samples and points belonging to other sheets
/// (same_sheet). Nothing else parts a node of the tree by sides, so it comes as a correction (far_side.h).
struct FarSide {
  KernelTable table;  ///< far_side_profile
  float reach = 0;    ///< mm; farther away what leaves is alike on both sides
};

/// The kernel split near the shading point: R_d = R_near + R_far with R_far = R_d w(r/h). The far part is
/// summed over the samples; the near part, too steep for them, is an integral times the irradiance around the
/// point.
struct SplitKernel {
  KernelTable table;
  bool split = true;
  float radius = 0;              ///< h, 2.5 sample spacings, mm
  std::array<float, 3> near{};   ///< integral of R_near over the plane
  std::array<float, 3> total{};  ///< total of the profile
  /// Near a border of the surface only part of the near field is there. Rows: how much of a plane's area lies
  /// around the point, from 1/2 (on the border) to 1, weighted by (1 - r^2/h^2)^2; values: the share of
  /// `near` that a half plane with that much area gives, per channel.
  static constexpr std::size_t kBorderRows = 65;
  std::array<std::array<float, 3>, kBorderRows> border{};
  std::shared_ptr<const LaneTable> lanes;  ///< the far kernel for dual_tree
  /// The near field multiplies a blend of two irradiances: the one at the point itself, with this share, and
  /// the samples' mean around it, with the rest. The mean alone would blur shadows. The share is chosen so
  /// that the blend has the near kernel's mean square radius. It is 1 for a vanishing mean free path, and
  /// about .45 (dipole) or .65 (normalized diffusion) where the mean free path equals the sample spacing. It
  /// is 0 where less than 2 % of the light depends on it.
  std::array<float, 3> own_irradiance{};
  std::shared_ptr<const FarSide> far_side = {};  ///< far side of profiles that have one (has_far_side)
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
  /// the spread of neighbouring samples, the variation of E nearby, the roughness and noise of E, samples of
  /// other sheets within h, and the nodes taken as points (CloudError; bench_error_estimate).
  RgbF error{};
};

/// How many queries each packet of a chunk of neighbours holds, in their order.
struct PacketCut {
  static constexpr std::size_t kMost = 32;
  std::size_t packets = 0;
  std::array<std::uint8_t, kMost> counts{};
};

/// Which queries walk the tree together: it depends on where they lie, and on nothing else.
struct QueryPackets {
  float radius = 0;                  ///< h of the kernel that they were cut for
  std::vector<std::uint32_t> order;  ///< order of the finite queries; empty: not known
  std::vector<PacketCut> cuts;       ///< one a chunk
};

/// How far off sums over a cloud of samples are: what one query cannot see, per channel. tell_cloud_error
/// finds it by trial sums at a few samples.
struct CloudError {
  /// Rms difference between a sample's irradiance and the mean of its neighbours', over the rms irradiance.
  /// The noise of its shadow rays is part of it.
  std::array<float, 3> roughness{};
  std::array<float, 3> far_squares{};  ///< sum of squares of the samples' flux over the square of their sum
  /// Factor on the error that is usually expected from how much neighbours differ in contribution and in
  /// irradiance: the error that the trial sums show, over that expectation.
  std::array<float, 3> scale{1, 1, 1};
  std::array<float, 3> hierarchy{.1f, .1f, .1f};  ///< mean error of the tree's nodes over the tolerance
  /// `classic` only: the measured error of nodes taken as points, over what their solid angles suggest.
  std::array<float, 3> flattened{1, 1, 1};
  std::array<float, 3> light_shift{};  ///< systematic relative error of the irradiance
  float other_sheets = 1;              ///< 0: without the samples of other sheets within h
};

struct EvaluateInput {
  const Octree& octree;
  const SplitKernel& kernel;
  std::span<const Query> queries;
  /// Entered irradiance at each query, for the channels that need it; empty: interpolated ones everywhere.
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
/// `dual_tree`: clusters of queries walk the tree together. A node is either added to a series around the
/// cluster's centre or replaced by its centroid and second moment. Either is allowed if, in each channel, a
/// bound on the error that it makes is below a fraction of the cluster's exitance.
/// Accuracy, per channel (test_dual_tree): p99 of |result - brute force| / max(|brute force|, 1e-3 P) <=
/// tolerance, with P the p99 of brute force over all queries. This holds if P is over 1e-3 of the brightest
/// possible exitance and the tolerance is over the error of the far kernel's table, which is 1e-3, or 2.5e-3
/// where the mean free path is below the sample spacing. Non-finite queries get 0.
/// `classic`: each query walks
/// the tree from its root and takes a node as one flux at its centroid when the node's area over its squared
/// distance is at most max_solid_angle and it lies wholly beyond h; leaves are summed sample by sample.
/// `brute_force`: every sample, the limit of max_solid_angle -> 0 but for the order of sums.
/// from  Jensen & Buhler 2002 sec. 3; near field: see SplitKernel
std::vector<Exitance> evaluate(const EvaluateInput& input);

}  // namespace opaline
