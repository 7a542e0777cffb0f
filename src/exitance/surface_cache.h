// SPDX-License-Identifier: GPL-3.0-or-later
// Radiant exitance all over the surfaces of a group, interpolated: it does not depend on the view.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <limits>
#include <optional>
#include <span>
#include <vector>

#include "exitance/evaluate.h"
#include "geometry/surface_point.h"
#include "geometry/world.h"

namespace opaline {

/// Exitance evaluated at vertices and interpolated between them to second order with the slopes that their
/// triangles show; where that would not do (creases, shadow edges), from a lattice of nodes on the triangle.
/// Triangles that are large against the near field are split first. Irradiance, near field and error are
/// interpolated alike.
struct SurfaceCache {
  static constexpr std::uint32_t kNone = ~0u, kLeftToPoints = ~0u - 1;
  struct Vertex {
    Exitance value;
    Vec3f position;
    std::array<Vec3f, 3> slope;  ///< slope of the exitance along the surface, per channel, 1/mm
  };
  struct Patch {
    std::array<std::uint32_t, 3> vertices;
    std::uint32_t lattice = kNone;  ///< kNone: the vertices do; kLeftToPoints: no lattice would
  };
  /// Nodes at (i, j) / segments of a patch's second and third corner, row after row of constant j.
  struct Lattice {
    std::uint32_t first = 0;     ///< first of its entries in lattice_nodes
    std::uint32_t segments = 0;  ///< even
  };
  /// The patches of a triangle: segments^2, row after row between lines of constant third barycentric.
  struct Split {
    std::uint32_t first = 0, segments = 0;
  };

  /// SplitKernel's if the nodes' exitance is without the light depending on the irradiance at the place
  /// itself, which has the shadows' edges in it; 0 if they have it all.
  std::array<float, 3> own_irradiance{};
  /// True if the exitance at a point depends on the irradiance at the point itself.
  bool needs_irradiance() const { return own_irradiance[0] + own_irradiance[1] + own_irradiance[2] > 0; }
  std::vector<std::vector<Split>>
      splits;  ///< one a mesh of the world (empty if not of the group) and triangle
  std::vector<Patch> patches;
  std::vector<Vertex> vertices;
  std::vector<Lattice> lattices;
  std::vector<std::uint32_t> lattice_nodes;
  std::vector<Exitance> nodes;

  /// Where the exitance was evaluated.
  std::size_t places() const { return vertices.size() + nodes.size(); }

  /// True if the exitance is too sharp here to be held, beside a shadow's edge: `at` tells only what lies
  /// between the vertices, and what a picture shows is to be found at its points.
  bool is_left_to_points(std::uint32_t mesh, std::uint32_t triangle, float u, float v) const;

  /// As `evaluate` at a place of a triangle of the group; irradiance: there, if the cache needs it, or null
  /// to interpolate it.
  /// error p99 of the difference from brute force over max(it, 1e-3 of its p99) <= tolerance, per channel,
  ///       over the surface (test_surface_cache), of a cache without the light of AddOwnLight; with it where
  ///       nothing sharper is held (test_surface_caches), else the mean is, and beside shadow edges it is as
  ///       close to `direct` as shadow rays at each point (test_shadow_edge)
  Exitance at(std::uint32_t mesh, std::uint32_t triangle, float u, float v,
              const RgbF* irradiance = nullptr) const;
};

/// Uncertainty of the light at a cached point.
struct PlaceDoubt {
  RgbF noise{};               ///< noise of the exitance, W/mm^2: less is no reason for a finer lattice
  bool beside_edge = false;   ///< a shadow's edge is near, between this place and the next perhaps
  bool is_too_sharp = false;  ///< no lattice around this place holds what a picture shows: left to its points
};

/// Adds to the exitance of places what depends on the irradiance at the place itself, and puts that
/// irradiance into theirs. doubts: one a place, to be filled.
using AddOwnLight =
    std::function<void(std::span<const SurfacePoint>, std::span<Exitance>, std::span<PlaceDoubt> doubts)>;

struct SurfaceCacheInput {
  const World& world;
  std::span<const std::uint32_t> meshes;  ///< meshes of the group
  const Octree& octree;
  const SplitKernel& kernel;
  double tolerance = 0.005;
  InstructionSet instruction_set = InstructionSet::automatic;
  CloudError cloud = {};                                              ///< as EvaluateInput's
  std::size_t most_places = std::numeric_limits<std::size_t>::max();  ///< to evaluate at
  AddOwnLight add_own_light = {};  ///< none: the cache is without that light
  Monitor* monitor = nullptr;
};

/// None if it would take more places than input.most_places.
std::optional<SurfaceCache> make_surface_cache(const SurfaceCacheInput& input);

/// Places at which make_surface_cache evaluates at least: what it costs.
std::size_t least_cache_places(const World& world, std::span<const std::uint32_t> meshes,
                               const SplitKernel& kernel);

}  // namespace opaline
