// SPDX-License-Identifier: GPL-3.0-or-later
#include "exitance/cloud_error.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/parallel.h"
#include "core/random.h"
#include "exitance/near_samples.h"
#include "exitance/point_sums.h"
#include "exitance/refined_stake.h"
#include "sampling/sample_surface.h"

namespace opaline {
namespace {

constexpr std::size_t kRuns = 16,
                      kRun = 4;  // samples per trial sum, next to samples in octree order
constexpr std::size_t kRoughnessTrials = 512;
constexpr double kFineTolerance = 1.5e-3;
// Largest distance of neighbours, in spacings.
constexpr float kNeighbours = 1.6f;
// Creases: a neighbour with a normal's cosine below kCrease is on another face if the other neighbours' mean
// cosine is at least kFlat; otherwise the samples are too sparse for the curvature.
constexpr float kCrease = 0.7f;
constexpr double kFlat = 0.99;
// Shadow edges: neighbours' irradiance differs by kStep or more. Samples store the mean over their cell, so
// for lights without area only the fraction kStepLeft of the difference is an error. A neighbour at a steeper
// sine than kStacked belongs to another sheet.
constexpr float kStep = 0.5f, kStepLeft = 0.2f, kStacked = 0.3f;
// Least determinant of neighbours' moments over the squared trace; collinear neighbours define no slope.
constexpr float kDegenerate = 1e-3f;
// Scale of errors: kAtCreases at creases, less with a fraction of samples beside creases below kManyCreases.
// On smooth surfaces down to kLeast, but at least kRough times the roughness, up to 1, as few trials meet a
// shadow edge.
constexpr double kAtCreases = 1.6, kManyCreases = 0.02, kLeast = 0.03, kMost = 10, kRough = 4;
// Mean error of the nodes over the tolerance, minimum and maximum.
constexpr double kLeastHierarchy = 0.005, kMostHierarchy = 0.15;
// Mean error of the nodes of `classic` over the estimate from solid angles, minimum and maximum.
constexpr double kLeastFlattened = 0.02, kMostFlattened = 4;
// Fraction of the brightest exitance below which errors are absolute.
constexpr float kDark = 1e-3f;

struct Roughness {
  RgbF residual{}, square{};  // sums of squares
  double creased = 0, trials = 0;
};

/// Neighbourhood of a sample.
struct Neighbours {
  RgbF mean{}, low{}, high{};  // irradiance: weighted by nearness; with the sample's own
  float weights = 0;
  double cosines = 0, same_face = 0;  // over samples on the sample's own face: sum and number
  bool other_face = false, stacked = false;

  bool creased() const { return other_face && cosines >= kFlat * same_face; }
  /// True at a shadow edge, on a surface without other sheets nearby.
  bool has_step(std::size_t c) const { return !creased() && !stacked && low[c] < kStep * high[c]; }
};

Neighbours neighbours_of(const Octree& tree, std::uint32_t sample, float spacing) {
  const TreeSample& own = tree.samples[sample];
  const Vec3f position{own.x, own.y, own.z};
  const float reach = kNeighbours * spacing;
  Neighbours found;
  found.low = found.high = irradiance_of(own);
  for_each_near(tree, position, reach, [&](std::uint32_t s) {
    const TreeSample& other = tree.samples[s];
    const Vec3f apart = Vec3f{other.x, other.y, other.z} - position;
    const float r2 = dot(apart, apart), cosine = dot(tree.normals[s], tree.normals[sample]);
    if (s == sample || r2 >= reach * reach || cosine <= -kCrease) return;
    if (cosine < kCrease)
      found.other_face = true;
    else
      found.cosines += double(cosine), found.same_face += 1;
    if (cosine <= 0) return;
    const RgbF e = irradiance_of(other);
    const float weight = 1 / (r2 + 0.1f * spacing * spacing), across = dot(apart, tree.normals[sample]);
    found.stacked = found.stacked || across * across > kStacked * kStacked * r2;
    widen(found.low, found.high, e);
    found.mean += e * weight;
    found.weights += weight;
  });
  if (found.weights > 0) found.mean = found.mean / found.weights;
  return found;
}

/// Adds the deviation of a sample from its neighbours' mean.
void add_roughness(const Octree& tree, std::uint32_t sample, float spacing,
                   const std::array<float, 3>& from_points, Roughness& sums) {
  const Neighbours near = neighbours_of(tree, sample, spacing);
  sums.trials += 1;
  sums.creased += near.creased() ? 1 : 0;
  if (!(near.weights > 0)) return;
  const TreeSample& own = tree.samples[sample];
  const RgbF e = irradiance_of(own), off = e - near.mean;
  for (std::size_t c = 0; c < 3; ++c) {
    const float left = near.has_step(c) ? 1 - from_points[c] * (1 - kStepLeft * kStepLeft) : 1;
    sums.residual[c] += left * off[c] * off[c] * own.area;
  }
  sums.square += e * e * own.area;
}

struct Trials {
  std::vector<Query> queries;
  std::vector<RgbF> irradiance;
};

/// Random step from a sample within the disc of its cell, in the tangent plane's axes.
struct Step {
  Vec3f u, v;
  float along_u, along_v;

  Step(const Octree& tree, std::size_t sample) {
    tangent_frame(tree.normals[sample], u, v);
    const double angle = 2 * std::numbers::pi * unit_double(hash_bits(5000, sample)),
                 r = std::sqrt(double(tree.samples[sample].area) * std::numbers::inv_pi *
                               unit_double(hash_bits(5001, sample)));
    along_u = float(r * std::cos(angle));
    along_v = float(r * std::sin(angle));
  }
};

/// Change of irradiance along a step: least-squares slope through a sample and its neighbours.
RgbF change_of_irradiance(const Octree& tree, std::uint32_t sample, const Step& step, float spacing) {
  const TreeSample& own = tree.samples[sample];
  const Vec3f position{own.x, own.y, own.z};
  const float reach = kNeighbours * spacing;
  const RgbF e = irradiance_of(own);
  float uu = 0, uv = 0, vv = 0;
  RgbF u{}, v{};
  for_each_near(tree, position, reach, [&](std::uint32_t s) {
    const TreeSample& other = tree.samples[s];
    const Vec3f apart = Vec3f{other.x, other.y, other.z} - position;
    if (dot(apart, apart) >= reach * reach || dot(tree.normals[s], tree.normals[sample]) < kCrease) return;
    const float x = dot(apart, step.u), y = dot(apart, step.v);
    uu += x * x, uv += x * y, vv += y * y;
    const RgbF off = irradiance_of(other) - e;
    u += off * x;
    v += off * y;
  });
  const float determinant = uu * vv - uv * uv;
  if (!(determinant > kDegenerate * (uu + vv) * (uu + vv))) return {};
  const RgbF slope_u = (u * vv - v * uv) / determinant, slope_v = (v * uu - u * uv) / determinant;
  return slope_u * step.along_u + slope_v * step.along_v;
}

// Queries avoid the samples: each is in the middle of a gap between the others, where sums are low.
Trials trials_beside_samples(const Octree& tree, float spacing) {
  Trials trials;
  const std::size_t n = tree.samples.size(), run = std::min(kRun, n);
  for (std::size_t r = 0; r < kRuns; ++r)
    for (std::size_t k = 0; k < run; ++k) {
      const std::size_t i = (2 * r + 1) * (n - run) / (2 * kRuns) + k;
      const TreeSample& s = tree.samples[i];
      const Step step(tree, i);
      trials.queries.push_back(
          {Vec3f{s.x, s.y, s.z} + step.u * step.along_u + step.v * step.along_v, tree.normals[i]});
      const RgbF e = irradiance_of(s) + change_of_irradiance(tree, std::uint32_t(i), step, spacing);
      trials.irradiance.push_back(component_max(e, RgbF{}) * tree.flux_unit);
    }
  return trials;
}

/// Means over the trials, relative, of a channel.
struct Differences {
  double wider = 0, finer = 0, expected = 0;
};

/// Evaluates with `classic` and the errors of its nodes alone.
std::vector<Exitance> classic_sums(const CloudErrorInput& input, const Trials& trials) {
  return evaluate({.octree = input.octree,
                   .kernel = input.kernel,
                   .queries = trials.queries,
                   .irradiance = trials.irradiance,
                   .evaluator = EvaluatorKind::classic,
                   .max_solid_angle = input.max_solid_angle,
                   .cloud = {.scale = {}, .other_sheets = 0}});
}

/// Error of `classic` against finer sums, over the estimate of its nodes' error; 1 without nodes.
float flattened_part(const std::vector<Exitance>& fine, const std::vector<Exitance>& classic, std::size_t c) {
  double off = 0, expected = 0;
  for (std::size_t i = 0; i < fine.size(); ++i) {
    const float m = fine[i].exitance[c];
    if (!(m > 0)) continue;
    off += double(std::abs(classic[i].exitance[c] - m) / m);
    expected += double(classic[i].error[c] / m) / double(kDeviationOfMean);
  }
  return expected > 0 ? float(std::clamp(off / expected, kLeastFlattened, kMostFlattened)) : 1;
}

Differences differences(const std::vector<Exitance>& fine, const std::vector<Exitance>& coarse,
                        const std::vector<Exitance>& wide, const std::vector<bool>& refined, std::size_t c) {
  float brightest = 0;
  for (const Exitance& e : fine) brightest = std::max(brightest, e.exitance[c]);
  Differences sums;
  for (std::size_t i = 0; i < fine.size(); ++i) {
    const float m = fine[i].exitance[c], scale = std::max(m, kDark * brightest);
    if (!(scale > 0)) continue;
    sums.finer += double(std::abs(coarse[i].exitance[c] - m) / scale);
    sums.expected += double(fine[i].error[c] / scale);
    if (!refined[i]) sums.wider += double(std::abs(wide[i].exitance[c] - m) / scale);
  }
  return sums;
}

}  // namespace

CloudError tell_cloud_error(const CloudErrorInput& input) {
  CloudError result;
  const Octree& tree = input.octree;
  const std::size_t n = tree.samples.size();
  if (tree.nodes.empty()) return result;
  const double spacing = double(input.kernel.radius) / 2.5;
  Roughness rough;
  const std::size_t tried = std::min(n, kRoughnessTrials);
  for (std::size_t k = 0; k < tried; ++k)
    add_roughness(tree, std::uint32_t((2 * k + 1) * n / (2 * tried)), float(spacing), input.light_from_points,
                  rough);
  const Trials trials = trials_beside_samples(tree, float(spacing));
  const double fine_tolerance = std::min(input.tolerance, kFineTolerance);
  const auto sums = [&](const SplitKernel& kernel, double tolerance) {
    const CloudError none{.hierarchy = {}, .other_sheets = 0};
    return evaluate({.octree = tree,
                     .kernel = kernel,
                     .queries = trials.queries,
                     .irradiance = trials.irradiance,
                     .tolerance = tolerance,
                     .instruction_set = input.instruction_set,
                     .cloud = none});
  };
  // Each evaluates too few queries for more than one thread.
  std::vector<Exitance> fine, coarse, wide, classic;
  parallel_chunks(4, 1, [&](std::size_t trial, std::size_t, std::size_t) {
    if (trial == 0) fine = sums(input.kernel, fine_tolerance);
    if (trial == 1 && fine_tolerance < input.tolerance) coarse = sums(input.kernel, input.tolerance);
    if (trial == 2) wide = sums(input.wider, fine_tolerance);
    if (trial == 3 && input.evaluator == EvaluatorKind::classic) classic = classic_sums(input, trials);
  });
  if (coarse.empty()) coarse = fine;
  std::vector<bool> refined;
  for (std::size_t i = 0; i < fine.size(); ++i)
    refined.push_back(stake_of(input.kernel.own_irradiance, trials.irradiance[i], fine[i]) > kRefinedStake);
  const double creases = kAtCreases * std::min(1.0, rough.creased / rough.trials / kManyCreases);
  for (std::size_t c = 0; c < 3; ++c) {
    double sum = 0, squares = 0;
    for (const TreeSample& s : tree.samples) {
      sum += double(s.flux[c]);
      squares += double(s.flux[c]) * double(s.flux[c]);
    }
    if (!(sum > 0)) continue;
    result.far_squares[c] = float(squares / (sum * sum));
    if (rough.square[c] > 0) result.roughness[c] = std::sqrt(rough.residual[c] / rough.square[c]);
    const Differences d = differences(fine, coarse, wide, refined, c);
    const double least = std::max({kLeast, creases, std::min(1.0, kRough * double(result.roughness[c]))});
    if (input.kernel.split && d.expected > 0)
      result.scale[c] = float(std::clamp(d.wider / d.expected, least, kMost));
    if (!classic.empty()) result.flattened[c] = flattened_part(fine, classic, c);
    if (fine_tolerance < input.tolerance)
      result.hierarchy[c] =
          float(std::clamp(d.finer / double(fine.size()) / input.tolerance, kLeastHierarchy, kMostHierarchy));
  }
  return result;
}

}  // namespace opaline
