// SPDX-License-Identifier: GPL-3.0-or-later
// Irradiance at points spread evenly over a surface, computed cell by cell on demand.
#pragma once

#include <array>
#include <atomic>
#include <cstdint>
#include <mutex>
#include <optional>
#include <span>
#include <unordered_map>
#include <vector>

#include "geometry/line_query.h"
#include "irradiance/irradiance.h"

namespace opaline {

/// Reorders the cached transfers of lights to points after a change of the lights.
/// in    before: index of each light's transfers in `lights`; none: must be traced
void set_held_lights(std::vector<PointTransfers>& lights, std::span<const std::optional<std::size_t>> before);

/// Points of a surface on a lattice: intersections with lines parallel to the axes, one line per square of a
/// grid. A triangle is intersected by the lines along the axis nearest to its normal n only, so each point
/// represents an area of spacing^2 / |n_axis|, independent of the view. All threads share the cells; a cell's
/// content depends on its key and the scene alone. With the transfer of each light cached, later images with
/// other light colours trace no rays.
class IrradianceLattice {
 public:
  struct Key {
    std::array<std::int64_t, 3> corner;  ///< in cells
    std::uint32_t level;                 ///< each level halves the spacing's square
    friend bool operator==(const Key&, const Key&) = default;
  };
  struct Cell {
    Vec3f low, high;  ///< corners of the box around the points
    std::vector<SurfacePoint> points;
    std::vector<float> areas;                 ///< area represented by each point, mm^2
    std::vector<RgbF> entered;                ///< transmitted irradiance of all lights
    std::vector<PointTransfers> lights = {};  ///< one per light, if cached
    std::uint64_t seed = 0, picture = 0;      ///< seeds of the points' keys; image of `entered`
  };

  /// in    spacing: of the lines of level 0, mm; boundary: as PointIrradianceInput's;
  ///       light_samples: shadow rays per point and light with an area; holds_lights: caches the transfer of
  ///       each light for later images
  IrradianceLattice(std::vector<bool> is_own_mesh, double spacing, const OuterBoundary& boundary,
                    int light_samples, bool holds_lights);

  /// True if these inputs would make the same lattice.
  bool is_of(const std::vector<bool>& is_own_mesh, double spacing, const OuterBoundary& boundary,
             int light_samples) const;
  /// Matches the cached lights to those of a new image, as HeldView::set_lights.
  void set_lights(std::span<const std::optional<std::size_t>> before);
  /// Begins an image with other light colours. Drops all cells if they exceed kMostBytes.
  void next_picture();
  static constexpr std::size_t kMostBytes = std::size_t(64) << 20;

  double spacing(std::uint32_t level) const;
  /// Keys of the cells within reach, mm, of any of some points.
  std::vector<Key> keys_near(std::span<const SurfacePoint> points, std::span<const std::uint32_t> chosen,
                             double reach, std::uint32_t level) const;
  /// in    lighting: its points and number of rays are ignored; otherwise equal at each call
  const Cell& cell(const Key& key, const PointIrradianceInput& lighting);

 private:
  struct Hash {
    std::size_t operator()(const Key& key) const;
  };
  struct Shard {
    std::mutex mutex;
    std::unordered_map<Key, Cell, Hash> cells;
  };
  Cell make_cell(const Key& key, const PointIrradianceInput& lighting) const;
  void light(Cell& cell, const PointIrradianceInput& lighting) const;
  struct Crossings;
  void add_crossings(const RayScene& rays, const LineQuery::Triangle& triangle, Crossings& crossings) const;

  std::vector<bool> is_own_mesh_;
  double spacing_;
  OuterBoundary boundary_;
  int light_samples_;
  bool holds_lights_;
  std::uint64_t picture_ = 0;
  std::atomic<std::size_t> bytes_{0};
  std::array<Shard, 64> shards_;
};

}  // namespace opaline
