// SPDX-License-Identifier: GPL-3.0-or-later
#include "volume/crossing_light.h"

#include <algorithm>
#include <cmath>

#include "core/parallel.h"
#include "transport/smooth_boundary.h"
#include "volume/body_paths.h"
#include "volume/entry_directions.h"
#include "volume/nearest_sample.h"

namespace opaline {
namespace {

constexpr float kNarrowest = 2;       // reach of an exit, spacings of the samples
constexpr float kWidest = 1.5f;       // the same, lattice cells
constexpr std::size_t kNearest = 12;  // exits within its reach, per direction of the light
constexpr float kSameSheet = .5f;     // least cosine between normals of one sheet
constexpr double kFarthest = 8;       // mean free paths
constexpr double kLeastShare = 1e-4;  // least flux of a ray, over the largest

struct Exit {
  Vec3f position, normal;
  RgbF flux;         // transmitted, W
  float reach = 0;   // world units
  float weight = 0;  // 1 over the sum of areas times weights
};

float weight_at(float distance2, float reach) {
  return std::max(0.f, 1 - distance2 / (reach * reach));
}

class Crossing {
 public:
  explicit Crossing(const DiffusionSpace& space)
      : space_(space),
        paths_(space_),
        spacing_(spacing_of(space.samples)),
        samples_(points(space.samples, spacing_)) {
    widest_ = std::max(kNarrowest * spacing_, kWidest * float(space.lattice.cell));
    for (const std::array<CalibratedMedium, 3>& media : space.media)
      for (const CalibratedMedium& medium : media)
        if (medium.albedo > 0) longest_ = std::max(longest_, 1 / medium.extinction);
  }

  /// Adds one light's exitance to `result`.
  /// flux: transmitted at each sample, W
  void add(std::span<const Rgb> flux, const Light& light, Monitor* monitor, std::vector<RgbF>& result) const {
    double least = 0;
    for (const Rgb& one : flux) least = std::max(least, kLeastShare * max_component(one));
    std::vector<Exit> exits = exits_of(flux, least, light, monitor);
    if (exits.empty()) return;
    const auto lit =
        std::size_t(std::ranges::count_if(flux, [&](const Rgb& one) { return max_component(one) > least; }));
    const std::size_t count = kNearest * ((exits.size() + lit - 1) / lit);
    const NearestSample grid(points(exits, spacing_));
    float widest = 0;
    parallel_chunks(exits.size(), 256, [&](std::size_t begin, std::size_t end, std::size_t) {
      std::vector<float> distances;
      for (std::size_t i = begin; i < end; ++i) {
        exits[i].reach = reach_of(exits[i], exits, grid, count, distances);
        exits[i].weight = weight_of(exits[i]);
      }
    });
    for (const Exit& exit : exits) widest = std::max(widest, exit.reach);
    parallel_chunks(result.size(), 256, [&](std::size_t begin, std::size_t end, std::size_t) {
      for (std::size_t s = begin; s < end; ++s) {
        const BoundaryElement& sample = space_.samples[s];
        grid.for_near(sample.position, widest, [&](const NearestSample::Member& member) {
          const Exit& exit = exits[member.sample];
          const Vec3f apart = exit.position - sample.position;
          const float near = weight_at(dot(apart, apart), exit.reach);
          if (near > 0 && dot(exit.normal, sample.normal) > kSameSheet)
            result[s] += exit.flux * (near * exit.weight);
        });
      }
    });
  }

 private:
  static float spacing_of(std::span<const BoundaryElement> samples) {
    double area = 0;
    for (const BoundaryElement& sample : samples) area += double(sample.area);
    return float(std::sqrt(area / double(samples.size())));
  }

  template <class Points>
  static std::vector<SurfaceSample> points(const Points& of, float spacing) {
    std::vector<SurfaceSample> result(of.size());
    for (std::size_t i = 0; i < of.size(); ++i) {
      result[i].position = of[i].position;
      result[i].normal = of[i].normal;
      result[i].area = spacing * spacing;
    }
    return result;
  }

  // Exits of all samples' rays, in order.
  std::vector<Exit> exits_of(std::span<const Rgb> flux, double least, const Light& light,
                             Monitor* monitor) const {
    constexpr std::size_t kChunk = 256;
    std::vector<std::vector<Exit>> parts((flux.size() + kChunk - 1) / kChunk);
    parallel_chunks(flux.size(), kChunk, [&](std::size_t begin, std::size_t end, std::size_t) {
      advance(monitor, 0);
      std::vector<Exit>& part = parts[begin / kChunk];
      for (std::size_t s = begin; s < end; ++s) {
        if (!(max_component(flux[s]) > least)) continue;
        const EntryDirections entry = towards_light(light, space_.samples[s], space_.eta(), s);
        for (const EntryDirection& from : entry.all())
          if (const std::optional<Exit> exit = exit_of(s, Vec3d(from.outward), flux[s] * from.share))
            part.push_back(*exit);
      }
    });
    std::vector<Exit> exits;
    for (const std::vector<Exit>& part : parts) exits.insert(exits.end(), part.begin(), part.end());
    return exits;
  }

  std::optional<Exit> exit_of(std::size_t sample, const Vec3d& outward, Rgb flux) const {
    const BoundaryElement& from = space_.samples[sample];
    const std::uint32_t cell = space_.attached[space_.boundary.of_sample[sample]].cell;
    if (cell == DiffusionGrid::kNone) return {};
    for (std::size_t c = 0; c < 3; ++c)
      if (!(space_.media_of(cell)[c].albedo > 0)) flux[c] = 0;
    const Way way{space_.in_lattice(from.position),
                  refracted_inward(-outward, Vec3d(from.normal), space_.eta())};
    const BodyPaths::End end =
        paths_.follow(way, 0, kFarthest * longest_, cell, [&](double, double step, std::uint32_t at) {
          for (std::size_t c = 0; c < 3; ++c) flux[c] *= std::exp(-step * space_.media_of(at)[c].extinction);
        });
    if (!end.exit) return {};
    const Vec3d at = paths_.at(way, end.exit->length);
    const Vec3f position(at * space_.lattice.cell + space_.lattice.low);
    const Vec3f plane = space_.boundary.elements[end.exit->element].normal;
    const Vec3f normal = space_.samples[samples_.at(position, plane)].normal;
    const double cosine = std::clamp(dot(way.along, Vec3d(normal)), BodyPaths::kLeastCosine, 1.);
    const RgbF leaves(flux * (1 - inside_reflectance(cosine, space_.eta())));
    if (!(max_component(leaves) > 0)) return {};
    return Exit{position, normal, leaves};
  }

  // Distance of another exit on the same sheet: the number `count` of the nearest.
  float reach_of(const Exit& exit, std::span<const Exit> exits, const NearestSample& grid, std::size_t count,
                 std::vector<float>& distances) const {
    for (float radius = 2 * spacing_; radius < widest_; radius *= 2) {
      distances.clear();
      grid.for_near(exit.position, radius, [&](const NearestSample::Member& member) {
        const Vec3f apart = exit.position - member.position;
        const float distance2 = dot(apart, apart);
        if (distance2 < radius * radius && dot(exits[member.sample].normal, exit.normal) > kSameSheet)
          distances.push_back(distance2);
      });
      if (distances.size() <= count) continue;
      std::ranges::nth_element(distances, distances.begin() + std::ptrdiff_t(count));
      return std::clamp(std::sqrt(distances[count]), kNarrowest * spacing_, widest_);
    }
    return widest_;
  }

  float weight_of(const Exit& exit) const {
    double sum = 0;
    samples_.for_near(exit.position, exit.reach, [&](const NearestSample::Member& member) {
      const Vec3f apart = exit.position - member.position;
      if (dot(member.normal, exit.normal) > kSameSheet)
        sum += double(weight_at(dot(apart, apart), exit.reach) * space_.samples[member.sample].area);
    });
    return sum > 0 ? float(1 / sum) : 0;
  }

  const DiffusionSpace& space_;
  BodyPaths paths_;
  float spacing_, widest_ = 0;
  NearestSample samples_;
  double longest_ = 0;  // mean free path
};

}  // namespace

std::vector<RgbF> crossing_light(const DiffusionSpace& space, const EnteringLight& light, Monitor* monitor) {
  const Crossing crossing(space);
  std::vector<RgbF> result(space.samples.size());
  std::vector<Rgb> flux(result.size());
  for (std::size_t l = 0; l < light.lights.size(); ++l) {
    if (!is_focused(light.lights[l])) continue;
    for (std::size_t s = 0; s < flux.size(); ++s) flux[s] = flux_of(space, light, l, s);
    crossing.add(flux, light.lights[l], monitor, result);
  }
  return result;
}

}  // namespace opaline
