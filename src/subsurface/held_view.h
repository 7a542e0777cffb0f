// SPDX-License-Identifier: GPL-3.0-or-later
// Cached results of an image depending on the camera, the surfaces and the positions of lights, but not on
// colours and media.
#pragma once

#include <atomic>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "exitance/evaluate.h"
#include "geometry/ray_scene.h"
#include "irradiance/irradiance.h"

namespace opaline {

class IrradianceLattice;
class NearestSample;

/// Maximum size of cached gathered hits, bytes.
inline constexpr std::size_t kMostGatheredBytes = std::size_t(256) << 20;

/// Cached from image to image by Session::hold_view. Bytes: 20 per camera ray; per hit 4, 4 per light (8 with
/// an estimated error), and 60 if memory allows; some 100 more for a rough boundary reflecting lights and
/// surfaces, up to kMostCoatBytes in total; some 60 for each gathered ray with a hit, up to
/// kMostGatheredBytes in total; and some 60 for each lattice point of near fields beside shadow edges, up to
/// IrradianceLattice::kMostBytes per body.
struct HeldView {
  struct Coat;
  struct Gathering;
  struct CameraHit {
    std::uint32_t mesh, triangle;  ///< Hit::kMiss: none
    float u, v, far;
  };
  /// Hits of the camera rays of a batch on one kind of surface.
  struct Surface {
    std::vector<PointTransfers> lights;  ///< one per light, without weights if still to be traced
    QueryPackets packets;
    std::shared_ptr<const NearestSample> cells;  ///< null: the nearest ones are still to be found
    std::vector<std::uint32_t> nearest;          ///< index of each hit's nearest cell, of a gathered ray
    std::unique_ptr<Coat> coat;                  ///< null: its reflection is still to be computed
    /// For hits without cache points around them (BouncedLight), and for further bounces at gathered hits.
    std::unique_ptr<Gathering> gathering;
  };
  /// Camera rays shaded together.
  struct Batch {
    bool is_traced = false;
    std::vector<CameraHit> hits;       ///< empty: all missed
    std::vector<SurfacePoint> points;  ///< surface points of the hits, in their order; empty: to be computed
    std::vector<Surface> surfaces;     ///< by kind; empty: to be computed

    /// Excludes the specular reflection and the gathering of its surfaces.
    std::size_t bytes() const {
      std::size_t sum = hits.size() * sizeof(CameraHit) + points.size() * sizeof(SurfacePoint);
      for (const Surface& surface : surfaces)
        for (const PointTransfers& light : surface.lights)
          sum += (light.weights.size() + light.deviations.size()) * sizeof(float);
      return sum;
    }
  };
  /// Specular reflection of a rough boundary of one eta and roughness, without the colours of lights and
  /// surfaces.
  struct Coat {
    /// Adds emission of the light * unit * weight to the radiance along a camera ray.
    struct OfLight {
      std::uint32_t ray, light;
      float unit, weight;
    };
    std::vector<OfLight> lights;
    std::vector<TracedRay> mirrored;  ///< reflected rays with hits
    std::vector<std::uint32_t> rays;  ///< camera rays of the reflected rays
    std::vector<RgbF> shares;         ///< weights of their radiance
    std::vector<std::uint64_t> keys;  ///< for its light samples
    Batch seen;                       ///< surfaces hit by the reflected rays; its hits are theirs

    std::size_t bytes() const {
      return seen.bytes() + lights.size() * sizeof(OfLight) +
             mirrored.size() *
                 (sizeof(TracedRay) + sizeof(RgbF) + sizeof(std::uint32_t) + sizeof(std::uint64_t));
    }
  };
  /// Hits of rays from some points over the hemisphere (for_each_gathered).
  struct Gathered {
    struct Met {
      Vec3f direction;
      float far, cosine;  ///< cosine: with the normal of the gathering point
      std::uint32_t mesh, triangle;
      float u, v;
      std::uint32_t point, number;  ///< index of the gathering point, and of its ray
    };
    bool is_traced = false;
    std::vector<Met> met;
    Batch seen;  ///< light at the gathered hits; without hits and points

    std::size_t bytes() const {
      std::size_t sum = met.size() * sizeof(Met) + seen.bytes();
      for (const Surface& surface : seen.surfaces)
        sum += (surface.packets.order.size() + surface.nearest.size()) * sizeof(std::uint32_t) +
               surface.packets.cuts.size() * sizeof(PacketCut);
      return sum;
    }
  };
  struct Gathering {
    std::vector<std::uint32_t> points;  ///< indices of the gathering points in their batch
    std::vector<Gathered> parts;        ///< parts of a few points each, in their order
  };
  std::vector<std::vector<Batch>> tiles;  ///< in the order of their batches
  bool has_room = false;                  ///< enough memory for the points
  bool keeps_further_bounces = true;      ///< false: traces them again, to save memory
  std::unique_ptr<std::atomic<std::size_t>> coat_bytes = std::make_unique<std::atomic<std::size_t>>(0);

  /// Gathering for the points of BouncedPlaces, by chunk and field, and for the samples of each body, by
  /// chunk, independent of the camera (bounced_at_samples).
  std::vector<std::vector<Gathering>> at_places, at_samples;
  std::unique_ptr<std::atomic<std::size_t>> gathered_bytes = std::make_unique<std::atomic<std::size_t>>(0);

  /// Lookup of a sharp near field, one per body; null: not cached. Independent of the camera.
  std::vector<std::shared_ptr<IrradianceLattice>> lattices;

  std::vector<std::size_t> field_of_mesh;  ///< index of HeldView::Batch::surfaces
  std::vector<OuterBoundary> boundary_of_field;

  /// Sets the fields. Results for the same meshes with the same boundary remain valid.
  void set_fields(const std::vector<std::size_t>& of_mesh, const std::vector<OuterBoundary>& boundaries);

  /// Discards all results depending on the camera.
  void forget_camera();

  /// Discards all results depending on the kinds of surfaces.
  void forget_surfaces();

  /// Discards specular reflection.
  void forget_coats();

  /// Sets the lights. before: index of each light in the previous ones; none: it must be traced
  void set_lights(std::span<const std::optional<std::size_t>> before);

  /// Updates gathered_bytes after discarding results.
  void count_gathered();

  /// Call before each image, after its lights are set.
  void next_picture();
};

}  // namespace opaline
