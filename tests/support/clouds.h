// SPDX-License-Identifier: GPL-3.0-or-later
// Samples with irradiance on one shape, and what `evaluate` makes of them.
#pragma once

#include <gtest/gtest.h>

#include <array>
#include <cstdio>
#include <functional>
#include <string>
#include <vector>

#include "core/random.h"
#include "exitance/evaluate.h"
#include "exitance/octree.h"
#include "support/scenes.h"
#include "support/surfaces.h"

namespace opaline::test {

/// A measured figure, into the log and the test's XML.
inline void report(const std::string& name, double value) {
  std::printf("             %s: %.4g\n", name.c_str(), value);
  std::string key = name;
  std::replace_if(
      key.begin(), key.end(), [](unsigned char c) { return !std::isalnum(c); }, '_');
  testing::Test::RecordProperty(key, std::to_string(value));
}

/// In the middle of both faces of a horizontal plate 1 mm thick.
inline std::vector<Query> places_on_plate() {
  std::vector<Query> queries;
  for (std::uint64_t i = 0; i < 400; ++i) {
    const auto [u, v] = r2_point(i, {.5, .5});
    const float up = i % 2 ? 1.f : -1.f;
    queries.push_back({Vec3f(Vec3d{10 * u - 5, .5 * double(up), 10 * v - 5}), {0, up, 0}});
  }
  return queries;
}

/// Samples of one shape, at most `count` or so.
struct Cloud {
  World world;
  SurfaceSamples surface;

  Cloud(const ShapeSource& source, std::size_t count, std::uint64_t seed = 0,
        NormalMode normals = NormalMode::smooth)
      : world(world_of({source}, normals)), surface(samples_on(world, count, seed)) {}

  std::vector<Query> queries() const {
    std::vector<Query> out;
    for (const SurfaceSample& s : surface.samples) out.push_back({s.position, s.normal});
    return out;
  }
  std::vector<FluxSample> flux(const std::function<RgbF(const SurfaceSample&)>& irradiance) const {
    std::vector<FluxSample> out;
    for (const SurfaceSample& s : surface.samples)
      out.push_back({s.position, s.area, irradiance(s), s.normal});
    return out;
  }
  Octree tree(const RgbF& irradiance) const { return tree_with_irradiance(surface, irradiance); }
  Octree tree(const std::function<RgbF(const SurfaceSample&)>& irradiance) const {
    return build_octree(flux(irradiance));
  }
  SplitKernel kernel(const DiffuseProfile& profile, bool split = true) const {
    return make_split_kernel(profile, surface.spacing(), world.diagonal, split);
  }
};

/// 2,000 places on a sphere of radius 25 mm around the origin that are no samples of another cloud.
inline const std::vector<Query>& places_on_sphere() {
  static const std::vector<Query> queries = Cloud(SphereShape{{}, 25}, 2000, 7).queries();
  return queries;
}

/// A coloured irradiance that varies smoothly, and by a hard shadow in green.
inline RgbF coloured_light(const SurfaceSample& s) {
  const Vec3f& p = s.position;
  return {1 + .5f * std::sin(p.x), p.y > 0 ? 1.f : 0.f, .2f + .1f * std::cos(p.z)};
}

inline std::vector<Exitance> brute_force(const Octree& octree, const SplitKernel& kernel,
                                         const std::vector<Query>& queries) {
  EvaluateInput input{octree, kernel, queries};
  input.evaluator = EvaluatorKind::brute_force;
  return evaluate(input);
}

inline std::vector<Exitance> classic(const Octree& octree, const SplitKernel& kernel,
                                     const std::vector<Query>& queries, double max_solid_angle) {
  EvaluateInput input{octree, kernel, queries};
  input.evaluator = EvaluatorKind::classic;
  input.max_solid_angle = max_solid_angle;
  return evaluate(input);
}

inline std::vector<Exitance> dual_tree(const Octree& octree, const SplitKernel& kernel,
                                       const std::vector<Query>& queries, double tolerance = .005) {
  EvaluateInput input{octree, kernel, queries};
  input.evaluator = EvaluatorKind::dual_tree;
  input.tolerance = tolerance;
  return evaluate(input);
}

/// The evaluators, for claims that hold for each.
inline constexpr std::array kEvaluators = {EvaluatorKind::brute_force, EvaluatorKind::classic,
                                           EvaluatorKind::dual_tree};

inline const char* name_of(EvaluatorKind evaluator) {
  switch (evaluator) {
    case EvaluatorKind::classic:
      return "classic";
    case EvaluatorKind::dual_tree:
      return "dual tree";
    default:
      return "brute force";
  }
}

/// max_solid_angle: of the classic one; tolerance: of the dual tree.
inline std::vector<Exitance> evaluated_by(EvaluatorKind evaluator, const Octree& octree,
                                          const SplitKernel& kernel, const std::vector<Query>& queries,
                                          double max_solid_angle, double tolerance = .005) {
  switch (evaluator) {
    case EvaluatorKind::classic:
      return classic(octree, kernel, queries, max_solid_angle);
    case EvaluatorKind::dual_tree:
      return dual_tree(octree, kernel, queries, tolerance);
    default:
      return brute_force(octree, kernel, queries);
  }
}

inline bool finite_and_not_negative(const Exitance& e) {
  return is_finite(e.exitance) && is_finite(e.irradiance) && min_component(e.exitance) >= 0 &&
         min_component(e.irradiance) >= 0;
}

/// Mean of a - b over mean of b, mean and largest |a - b| / b, of one channel.
struct Difference {
  double bias = 0, mean = 0, largest = 0;
};

template <class Reference>
Difference difference(const std::vector<Exitance>& values, const Reference& reference,
                      std::size_t channel = 0) {
  Difference d;
  double sum = 0, reference_sum = 0;
  for (std::size_t i = 0; i < values.size(); ++i) {
    const double r = double(reference(i)), error = double(values[i].exitance[channel]) - r;
    sum += error;
    reference_sum += r;
    d.mean += std::abs(error) / r / double(values.size());
    d.largest = std::max(d.largest, std::abs(error) / r);
  }
  d.bias = sum / reference_sum;
  return d;
}

}  // namespace opaline::test
