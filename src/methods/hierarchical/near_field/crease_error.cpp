// SPDX-License-Identifier: GPL-3.0-or-later
#include "methods/hierarchical/near_field/crease_error.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "core/random.h"
#include "exitance/near_samples.h"
#include "exitance/refined_stake.h"

namespace opaline {
namespace {

// Points beside creases with an error estimate.
constexpr std::size_t kTrials = 32;
// Cosines of normals: below kCrease, and above its negative, of faces meeting in a crease; above kSameFace,
// of one face.
constexpr float kCrease = 0.7f, kSameFace = 0.9f;
// Least mean cosine between a normal and those of its face for the face to be flat.
constexpr double kFlat = 0.97;
// Least fraction of a face on each side of another face's plane for the two to cross.
constexpr double kCrossing = 0.2;
// Least fraction of an infinite wall for a wall to count as infinite. The difference is noise of few samples,
// and would leave a small spurious error under uniform light.
constexpr double kWhole = 0.8;
// Fraction of the brightest trial's exitance below which errors are absolute. Relative errors are limited to
// kMost.
constexpr float kDark = 1e-3f;
constexpr double kMost = 2;

Vec3f position_of(const TreeSample& s) {
  return {s.x, s.y, s.z};
}

bool is_other_face(const Vec3f& a, const Vec3f& b) {
  return std::abs(dot(a, b)) < kCrease;
}

std::vector<std::uint32_t> samples_within(const Octree& tree, std::uint32_t sample, float distance) {
  std::vector<std::uint32_t> near;
  const Vec3f p = position_of(tree.samples[sample]);
  for_each_near(tree, p, distance, [&](std::uint32_t s) {
    const Vec3f apart = position_of(tree.samples[s]) - p;
    if (dot(apart, apart) < distance * distance) near.push_back(s);
  });
  return near;
}

/// Cosine between a sample's normal and the camera direction, proportional to its pixels; 0 for back faces.
double facing(const Octree& tree, std::uint32_t sample, const Vec3f& eye) {
  const Vec3f towards = eye - position_of(tree.samples[sample]);
  return double(std::max(0.0f, dot(tree.normals[sample], towards) / length(towards)));
}

/// Samples of the leaves crossed by a crease.
std::vector<std::uint32_t> samples_at_creases(const Octree& tree) {
  std::vector<std::uint32_t> found;
  for (const OctreeNode& node : tree.nodes) {
    if (!node.leaf) continue;
    bool creased = false;
    for (std::uint32_t s = node.first + 1; s < node.first + node.count; ++s)
      creased = creased || is_other_face(tree.normals[node.first], tree.normals[s]);
    for (std::uint32_t s = node.first; creased && s < node.first + node.count; ++s) found.push_back(s);
  }
  return found;
}

/// A sample within h of a crease, with the number of samples it represents.
struct Trial {
  std::uint32_t sample;
  double weight;
};

// Samples a neighbour of a sample at a crease. Its probability is proportional to the number of such samples
// around it, so the weight divides by that number.
std::vector<Trial> draw_trials(const Octree& tree, float radius) {
  const std::vector<std::uint32_t> creased = samples_at_creases(tree);
  std::vector<bool> is_creased(tree.samples.size());
  for (const std::uint32_t s : creased) is_creased[s] = true;
  const std::size_t count = std::min(kTrials, creased.size());
  std::vector<Trial> trials;
  for (std::size_t k = 0; k < count; ++k) {
    const std::uint32_t seed = creased[(2 * k + 1) * creased.size() / (2 * count)];
    const std::vector<std::uint32_t> near = samples_within(tree, seed, radius);
    const std::uint32_t drawn = near[hash_bits(4000, k) % near.size()];
    const std::vector<std::uint32_t> around = samples_within(tree, drawn, radius);
    const auto seeds = std::ranges::count_if(around, [&](std::uint32_t s) { return is_creased[s]; });
    trials.push_back({drawn, double(near.size()) / double(std::max<std::ptrdiff_t>(1, seeds)) *
                                 double(creased.size()) / double(count)});
  }
  return trials;
}

/// Part of another face within h of a point.
struct Face {
  Vec3f normal;
  bool above = false;   // the point's own plane
  double distance = 0;  // distance of the point below its plane: weighted sum, then mean
  double weight = 0;    // area times (1 - r^2/h^2)^2
  std::array<double, 3> flux{};
  double area = 0;
};

// Removes hidden parts. Where two bodies cross, each has a part inside the other: nothing on it is visible,
// and a point outside does not see faces above its own plane.
std::vector<Face> visible_faces(std::vector<Face> faces) {
  std::vector<Face> visible;
  for (const Face& f : faces) {
    const bool crosses = std::ranges::any_of(faces, [&](const Face& g) {
      return g.above != f.above && g.weight > kCrossing * f.weight && f.weight > kCrossing * g.weight &&
             dot(f.normal, g.normal) > kSameFace;
    });
    if (crosses && f.distance > 0) return {};
    if (!crosses || f.above) visible.push_back(f);
  }
  for (Face& f : visible) f.distance = std::abs(f.distance);
  return visible;
}

// Returns nothing if the point's own face is not flat: a curved surface is not a crease.
std::vector<Face> other_faces(const Octree& tree, std::uint32_t sample, float radius) {
  std::vector<Face> faces;
  const Vec3f p = position_of(tree.samples[sample]);
  double cosines = 0, count = 0;
  for (const std::uint32_t s : samples_within(tree, sample, radius)) {
    const float cosine = dot(tree.normals[s], tree.normals[sample]);
    if (cosine >= kCrease) cosines += double(cosine), count += 1;
    if (std::abs(cosine) >= kCrease) continue;
    const TreeSample& other = tree.samples[s];
    const Vec3f apart = position_of(other) - p;
    const bool above = dot(apart, tree.normals[sample]) > 0;
    auto face = std::ranges::find_if(
        faces, [&](const Face& f) { return f.above == above && dot(f.normal, tree.normals[s]) > kSameFace; });
    if (face == faces.end()) {
      faces.push_back({tree.normals[s], above});
      face = faces.end() - 1;
    }
    const double rest = 1 - double(dot(apart, apart) / (radius * radius)),
                 w = double(other.area) * rest * rest;
    face->weight += w;
    face->distance += w * double(dot(apart, tree.normals[s]));
    face->area += double(other.area);
    for (std::size_t c = 0; c < 3; ++c) face->flux[c] += double(other.flux[c]);
  }
  if (cosines < kFlat * count) return {};
  for (Face& f : faces) f.distance /= f.weight;
  return visible_faces(std::move(faces));
}

/// Fraction of a perpendicular half plane, cut at the near field's radius, covered by a face.
double part_there(const Face& face, double radius) {
  const double t = std::min(1.0, face.distance / radius), rest = 1 - t * t;
  const double whole = std::numbers::pi * radius * radius / 6 * rest * rest * rest;
  if (!(whole > 0)) return 0;
  return face.weight > kWhole * whole ? 1 : face.weight / whole;
}

/// Contributions to a near field: fraction of the plane on the point's own face, and the weighted transmitted
/// irradiance of other faces, flux units.
struct NearLight {
  std::array<double, 3> plane{1, 1, 1}, walls{};
};

NearLight near_light(const std::vector<Face>& faces, const NearRings& rings, double radius) {
  NearLight light;
  for (const Face& face : faces) {
    const std::array<double, 3> beyond = rings.beyond_border(face.distance),
                                wall = rings.on_wall(face.distance);
    const double there = part_there(face, radius);
    for (std::size_t c = 0; c < 3; ++c) {
      light.plane[c] = std::max(0.0, light.plane[c] - beyond[c]);
      light.walls[c] += there * wall[c] * face.flux[c] / face.area;
    }
  }
  return light;
}

struct TrialError {
  double error = 0, truth = 0;  // exitance: error, and exact value
};

// e: evaluated with the point's own irradiance.
TrialError error_of(const SplitKernel& kernel, const NearLight& light, const Exitance& e,
                    const RgbF& irradiance, double flux_unit, std::size_t c) {
  const double own = double(irradiance[c]), share = double(kernel.own_irradiance[c]),
               taken = double(e.near[c]);
  double used = share * own + (1 - share) * double(e.irradiance[c]), exitance = double(e.exitance[c]);
  if (taken * share * std::abs(own - used) > double(kRefinedStake) * exitance) {
    exitance += taken * (own - used);
    used = own;
  }
  const double error =
      taken * used - double(kernel.near[c]) * (light.plane[c] * own + light.walls[c] * flux_unit);
  return {error, exitance - error};
}

}  // namespace

NearRings::NearRings(const DiffuseProfile& profile, double radius) {
  std::array<double, 3> sums{};
  for (std::size_t i = 0; i < kRings; ++i) {
    const double low = double(i) / kRings, high = double(i + 1) / kRings;
    const double t = (low * low + high * high) / 2, width = high * high - low * low;
    distances_[i] = t * radius;
    for (std::size_t c = 0; c < 3; ++c) {
      masses_[i][c] = near_ring(profile.channels[c], radius, t) * width;
      sums[c] += masses_[i][c];
    }
  }
  for (auto& ring : masses_)
    for (std::size_t c = 0; c < 3; ++c) ring[c] = sums[c] > 0 ? ring[c] / sums[c] : 0;
}

std::array<double, 3> NearRings::beyond_border(double distance) const {
  std::array<double, 3> sum{};
  for (std::size_t i = 0; i < kRings; ++i) {
    if (distances_[i] <= distance) continue;
    const double part = std::acos(distance / distances_[i]) * std::numbers::inv_pi;
    for (std::size_t c = 0; c < 3; ++c) sum[c] += masses_[i][c] * part;
  }
  return sum;
}

std::array<double, 3> NearRings::on_wall(double distance) const {
  std::array<double, 3> sum{};
  for (std::size_t i = 0; i < kRings; ++i)
    for (std::size_t c = 0; c < 3 && distances_[i] > distance; ++c) sum[c] += masses_[i][c] / 2;
  return sum;
}

std::array<float, 3> crease_error(const CreaseErrorInput& input) {
  const Octree& tree = input.octree;
  std::array<float, 3> result{};
  if (!input.kernel.split || tree.nodes.empty()) return result;
  const std::vector<Trial> trials = draw_trials(tree, input.kernel.radius);
  std::vector<Query> queries;
  std::vector<RgbF> irradiance;
  for (const Trial& trial : trials) {
    queries.push_back({position_of(tree.samples[trial.sample]), tree.normals[trial.sample]});
    irradiance.push_back(irradiance_of(tree.samples[trial.sample]) * tree.flux_unit);
  }
  const std::vector<Exitance> sums = evaluate({.octree = tree,
                                               .kernel = input.kernel,
                                               .queries = queries,
                                               .irradiance = irradiance,
                                               .instruction_set = input.instruction_set});
  const NearRings rings(input.profile, double(input.kernel.radius));
  RgbF brightest{};
  for (const Exitance& e : sums) brightest = component_max(brightest, e.exitance);
  std::array<double, 3> total{};
  for (std::size_t i = 0; i < trials.size(); ++i) {
    const std::vector<Face> faces = other_faces(tree, trials[i].sample, input.kernel.radius);
    if (faces.empty()) continue;
    const NearLight light = near_light(faces, rings, double(input.kernel.radius));
    for (std::size_t c = 0; c < 3; ++c) {
      const TrialError e = error_of(input.kernel, light, sums[i], irradiance[i], double(tree.flux_unit), c);
      const double truth = std::max(e.truth, double(kDark * brightest[c]));
      if (truth > 0)
        total[c] += trials[i].weight * facing(tree, trials[i].sample, input.eye) *
                    std::min(kMost, std::abs(e.error) / truth);
    }
  }
  double whole = 0;
  for (std::uint32_t s = 0; s < tree.samples.size(); ++s) whole += facing(tree, s, input.eye);
  for (std::size_t c = 0; c < 3 && whole > 0; ++c) result[c] = float(total[c] / whole);
  return result;
}

}  // namespace opaline
