// SPDX-License-Identifier: GPL-3.0-or-later
// Radiant exitance over the surfaces of a body, for interpolation; independent of the view.
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

/// Exitance at vertices, interpolated to second order with slopes from their triangles; across creases and
/// shadow edges, from a lattice of nodes on the triangle. Triangles large compared with the near field are
/// divided first. Irradiance, near field and error are interpolated likewise.
struct SurfaceCache {
  static constexpr std::uint32_t kNone = ~0u, kLeftToPoints = ~0u - 1;
  struct Vertex {
    Exitance value;
    Vec3f position;
    std::array<Vec3f, 3> slope;  ///< slope of the exitance along the surface, per channel, 1/mm
  };
  struct Patch {
    std::array<std::uint32_t, 3> vertices;
    std::uint32_t lattice = kNone;  ///< kNone: vertices suffice; kLeftToPoints: too sharp for a lattice
  };
  /// Nodes at (i, j) / segments of a patch's second and third corner, row after row of constant j.
  struct Lattice {
    std::uint32_t first = 0;     ///< its first entry in lattice_nodes
    std::uint32_t segments = 0;  ///< even
  };
  /// The patches of a triangle: segments^2, row after row between lines of constant third barycentric.
  struct Split {
    std::uint32_t first = 0, segments = 0;
  };

  /// SplitKernel's if the nodes exclude the exitance depending on the point's own irradiance, with its shadow
  /// edges; 0 if they include all of it.
  std::array<float, 3> own_irradiance{};
  /// True if the exitance at a point depends on the irradiance at the point itself.
  bool needs_irradiance() const { return own_irradiance[0] + own_irradiance[1] + own_irradiance[2] > 0; }
  std::vector<std::vector<Split>>
      splits;  ///< one per mesh of the world (empty outside the body) and triangle
  std::vector<Patch> patches;
  std::vector<Vertex> vertices;
  std::vector<Lattice> lattices;
  std::vector<std::uint32_t> lattice_nodes;
  std::vector<Exitance> nodes;

  /// Points of evaluation.
  std::size_t places() const { return vertices.size() + nodes.size(); }

  /// True if the exitance is too sharp for the cache here, beside a shadow edge. `at` then interpolates the
  /// vertices; images should evaluate their points instead.
  bool is_left_to_points(std::uint32_t mesh, std::uint32_t triangle, float u, float v) const;

  /// Exitance at a point of a triangle of the body, as from `evaluate`; irradiance: the point's own, if the
  /// cache needs it, or null to interpolate it.
  /// error p99 of the difference from brute force over max(it, 1e-3 of its p99) <= tolerance, per channel,
  ///       over the surface (test_surface_cache), without AddOwnLight; with it, where nothing sharper is
  ///       cached (test_surface_caches), otherwise the mean is, and beside shadow edges it is as close to
  ///       `direct` as shadow rays at each point (test_shadow_edge)
  Exitance at(std::uint32_t mesh, std::uint32_t triangle, float u, float v,
              const RgbF* irradiance = nullptr) const;
};

/// Uncertainty of the light at a cached point.
struct PlaceDoubt {
  RgbF noise{};               ///< standard deviation, W/mm^2; smaller differences do not refine the lattice
  bool beside_edge = false;   ///< possibly a shadow edge between this point and the next
  bool is_too_sharp = false;  ///< too sharp for any lattice: left to the image's points
};

/// Adds the exitance depending on the points' own irradiance, and stores that irradiance. doubts: one per
/// point, to be filled.
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
  std::size_t most_places = std::numeric_limits<std::size_t>::max();  ///< maximum points to evaluate
  AddOwnLight add_own_light = {};                                     ///< empty: the cache excludes it
  Monitor* monitor = nullptr;
};

/// None if it needs more than input.most_places points.
std::optional<SurfaceCache> make_surface_cache(const SurfaceCacheInput& input);

/// Minimum points of make_surface_cache, for its cost.
std::size_t least_cache_places(const World& world, std::span<const std::uint32_t> meshes,
                               const SplitKernel& kernel);

}  // namespace opaline
