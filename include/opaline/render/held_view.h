// SPDX-License-Identifier: GPL-3.0-or-later
// Cached results of an image that depend on the camera, the surfaces and the positions of lights, but not on
// colours and media.
#pragma once

#include <atomic>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "opaline/exitance/evaluate.h"
#include "opaline/geometry/ray_scene.h"
#include "opaline/irradiance/irradiance.h"

namespace opaline {

class IrradianceLattice;

/// More is not held of what gathered rays met, bytes.
inline constexpr std::size_t kMostGatheredBytes = std::size_t(256) << 20;

/// Kept from one picture to the next by Session::hold_view: 20 bytes a camera ray, and where the ray met a
/// surface 4, 4 a light (8 where the light's error is estimated, too), and 40 where there is room for them; where a rough
/// coat mirrors lights and surfaces some 100 more, up to kMostCoatBytes in all; where surfaces light each other some 60 for
/// each gathered ray that met one, up to kMostGatheredBytes in all; and
/// of near fields beside shadows' edges some 60 for each place of a lattice, up to IrradianceLattice::kMostBytes a body.
struct HeldView {
  struct Coat;
  struct Gathering;
  struct CameraHit {
    std::uint32_t mesh, triangle;  ///< Hit::kMiss: none
    float u, v, far;
  };
  /// Where the camera rays of a batch met one kind of surface.
  struct Surface {
    std::vector<PointTransfers> lights;  ///< one a light, without weights where it is to be traced
    QueryPackets packets;
    std::unique_ptr<Coat> coat;            ///< null: what it mirrors is to be found
    std::unique_ptr<Gathering> gathering;  ///< gathering of hits without places around them (BouncedLight)
  };
  /// Camera rays that are shaded together.
  struct Batch {
    bool is_traced = false;
    std::vector<CameraHit> hits;       ///< empty: all missed
    std::vector<SurfacePoint> points;  ///< points of those that hit, in their order; empty: to be found
    std::vector<Surface> surfaces;     ///< by kind; empty: not known

    /// But for what coats in it mirror, and what is gathered for it.
    std::size_t bytes() const {
      std::size_t sum = hits.size() * sizeof(CameraHit) + points.size() * sizeof(SurfacePoint);
      for (const Surface& surface : surfaces)
        for (const PointTransfers& light : surface.lights)
          sum += (light.weights.size() + light.deviations.size()) * sizeof(float);
      return sum;
    }
  };
  /// Specular reflection of a rough boundary of one eta and roughness, without the colours of lights and surfaces.
  struct Coat {
    /// Adds emission of the light * unit * weight to what a camera ray sees.
    struct OfLight {
      std::uint32_t ray, light;
      float unit, weight;
    };
    std::vector<OfLight> lights;
    std::vector<TracedRay> mirrored;  ///< rays that met surfaces
    std::vector<std::uint32_t> rays;  ///< rays of the camera, one a mirrored ray
    std::vector<RgbF> shares;         ///< shares of what it sees
    std::vector<std::uint64_t> keys;  ///< for its light samples
    Batch seen;                       ///< where the mirrored rays met surfaces; its hits are theirs

    std::size_t bytes() const {
      return seen.bytes() + lights.size() * sizeof(OfLight) +
             mirrored.size() *
                 (sizeof(TracedRay) + sizeof(RgbF) + sizeof(std::uint32_t) + sizeof(std::uint64_t));
    }
  };
  /// Where rays from some points, over the hemispheres around them, met surfaces (for_each_gathered).
  struct Gathered {
    struct Met {
      Vec3f direction;
      float far, cosine;  ///< cosine: with the normal of the point that gathers
      std::uint32_t mesh, triangle;
      float u, v;
      std::uint32_t point, number;  ///< index of the gathering point, and of its ray
    };
    bool is_traced = false;
    std::vector<Met> met;
    Batch seen;  ///< how lights reach these places; it has no hits or points

    std::size_t bytes() const {
      std::size_t sum = met.size() * sizeof(Met) + seen.bytes();
      for (const Surface& surface : seen.surfaces)
        sum += surface.packets.order.size() * sizeof(std::uint32_t) +
               surface.packets.cuts.size() * sizeof(PacketCut);
      return sum;
    }
  };
  struct Gathering {
    std::vector<std::uint32_t> points;  ///< which of their batch gather
    std::vector<Gathered> parts;        ///< parts of a few points each, in their order
  };
  std::vector<std::vector<Batch>> tiles;  ///< in the order of their batches
  bool has_room = false;                  ///< for the points
  std::unique_ptr<std::atomic<std::size_t>> coat_bytes = std::make_unique<std::atomic<std::size_t>>(0);

  /// For the places of BouncedPlaces, by chunk and field; and for the samples of each body, by chunk, whatever the camera
  /// sees (bounced_at_samples).
  std::vector<std::vector<Gathering>> at_places, at_samples;
  std::unique_ptr<std::atomic<std::size_t>> gathered_bytes = std::make_unique<std::atomic<std::size_t>>(0);

  /// Where a sharp near field is looked up, one a body; null: not known. Whatever the camera sees.
  std::vector<std::shared_ptr<IrradianceLattice>> lattices;

  std::vector<std::size_t> field_of_mesh;  ///< index of HeldView::Batch::surfaces
  std::vector<float> eta_of_field;         ///< eta of the transmitting boundary; 0: none

  /// Takes over other fields: where they shade the same meshes, what was found of those with the same boundary holds.
  void set_fields(const std::vector<std::size_t>& of_mesh, const std::vector<float>& eta);

  /// Lets go of all that depends on the camera.
  void forget_camera();

  /// Lets go of all that depends on which surfaces are of which kind.
  void forget_surfaces();

  /// Lets go of what coats mirror.
  void forget_coats();

  /// Takes over other lights. before: which of those held each of them is; none: it is to be traced
  void set_lights(std::span<const std::optional<std::size_t>> before);

  /// Brings gathered_bytes up to date with what was let go of.
  void count_gathered();

  /// To be called before each picture, once its lights are set.
  void next_picture();
};

/// HeldView::set_lights of what one set of points has from each light.
void set_held_lights(std::vector<PointTransfers>& lights, std::span<const std::optional<std::size_t>> before);

}  // namespace opaline
