// SPDX-License-Identifier: GPL-3.0-or-later
#include "bodies/surface_boundaries.h"

#include <algorithm>
#include <array>
#include <memory>
#include <optional>

#include "core/parallel.h"

namespace opaline {
namespace {

/// Layers at equal steps of roughness; between two, their mixture has an error below 0.003 of the albedo.
class FuzzSteps {
 public:
  FuzzSteps() {
    parallel_chunks(kCount, 1, [&](std::size_t i, std::size_t, std::size_t) {
      layers_[i] = shared_fuzz(FuzzLayer::kLeast + (1 - FuzzLayer::kLeast) * double(i) / double(kCount - 1));
    });
  }
  LocalFuzz at(float weight, float roughness) const {
    constexpr auto kLeast = float(FuzzLayer::kLeast);
    const float step = std::clamp((roughness - kLeast) / (1 - kLeast), 0.0f, 1.0f) * float(kCount - 1);
    const std::size_t low = std::min(std::size_t(step), kCount - 2);
    return {weight, layers_[low], layers_[low + 1], step - float(low)};
  }

 private:
  static constexpr std::size_t kCount = 16;
  std::array<const FuzzLayer*, kCount> layers_{};
};

std::uint64_t hash_of(const Scene& scene, const World& world, const Fuzz& fuzz,
                      std::span<const std::uint32_t> meshes) {
  KeyBuilder key("textures of fuzz", 1);
  for (const auto& texture : {&fuzz.weight_texture, &fuzz.roughness_texture})
    if (*texture) add_to_key(key.add(texture == &fuzz.weight_texture), **texture);
  add_spaces(key, scene, world, meshes);
  return key.key().low;
}

std::shared_ptr<const FuzzTextures> textures_of_fuzz(const Scene& scene, const World& world, const Fuzz& fuzz,
                                                     std::span<const std::uint32_t> meshes,
                                                     std::shared_ptr<const SurfaceTextures> surfaces) {
  const auto steps = fuzz.roughness_texture ? std::make_shared<const FuzzSteps>() : nullptr;
  const LocalFuzz even{float(fuzz.weight), shared_fuzz(fuzz.roughness)};
  const auto at = [fuzz, steps, even, surfaces = std::move(surfaces)](const SurfacePoint& point) {
    if (point.mesh == SurfacePoint::kNoMesh) return even;
    const SurfaceTextures::Place place =
        surfaces->place(point.mesh, point.triangle, point.u, point.v, footprint_of(point));
    const float weight = number_at(pointer_to(fuzz.weight_texture), place).value_or(even.weight);
    if (!(weight > 0)) return LocalFuzz{};
    if (steps) return steps->at(weight, *number_at(pointer_to(fuzz.roughness_texture), place));
    return LocalFuzz{weight, even.layer};
  };
  return std::make_shared<const FuzzTextures>(FuzzTextures{at, hash_of(scene, world, fuzz, meshes)});
}

}  // namespace

std::vector<OuterBoundary> boundaries_of(const Scene& scene, const World& world) {
  std::vector<OuterBoundary> boundaries;
  std::shared_ptr<const SurfaceTextures> surfaces;
  std::vector<std::optional<OuterBoundary>> of_media(scene.media.size());
  const auto boundary_of = [&](double eta, const Fuzz& fuzz, const auto& has_it) -> OuterBoundary {
    if (!(fuzz.weight > 0) || !(fuzz.weight_texture || fuzz.roughness_texture)) return {eta, fuzz};
    if (surfaces == nullptr) surfaces = std::make_shared<const SurfaceTextures>(scene, world);
    std::vector<std::uint32_t> meshes;
    for (std::uint32_t m = 0; m < scene.shapes.size(); ++m)
      if (has_it(m)) meshes.push_back(m);
    return {eta, fuzz, textures_of_fuzz(scene, world, fuzz, meshes, surfaces)};
  };
  for (std::uint32_t m = 0; m < scene.shapes.size(); ++m) {
    const Shape& shape = scene.shapes[m];
    if (!shape.medium) {
      boundaries.push_back(boundary_of(shape.gloss ? shape.gloss->eta : 0, shape.fuzz,
                                       [m](std::uint32_t other) { return other == m; }));
      continue;
    }
    std::optional<OuterBoundary>& known = of_media[*shape.medium];
    const Medium& medium = scene.media[*shape.medium];
    if (!known)
      known = boundary_of(medium.eta, medium.fuzz,
                          [&](std::uint32_t other) { return scene.shapes[other].medium == shape.medium; });
    boundaries.push_back(*known);
  }
  return boundaries;
}

}  // namespace opaline
