// SPDX-License-Identifier: GPL-3.0-or-later
// Irradiance at places spread evenly over a surface, found cell by cell where somebody asks for it.
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

/// Reorders what each light sends to some points.
/// in    before: index of each light in `lights`; none: it must be traced
void set_held_lights(std::vector<PointTransfers>& lights, std::span<const std::optional<std::size_t>> before);

/// The places are where lines parallel to the axes cross the surface, one line in each square of a grid.
/// Every triangle is crossed by the lines of the axis nearest to its normal n alone, so a place stands for
/// spacing^2 / |n_axis| of the surface, wherever it lies and whoever sees it. All threads share the cells;
/// what is in one depends on nothing but its key and the scene. One that holds what each light sends to its places
/// serves picture after picture: in other colours no ray is traced.
class IrradianceLattice {
 public:
  struct Key {
    std::array<std::int64_t, 3> corner;  ///< in cells
    std::uint32_t level;                 ///< each halves the spacing's square
    friend bool operator==(const Key&, const Key&) = default;
  };
  struct Cell {
    Vec3f low, high;  ///< corners of the box around the points
    std::vector<SurfacePoint> points;
    std::vector<float> areas;                 ///< that each point stands for, mm^2
    std::vector<RgbF> entered;                ///< by all lights
    std::vector<PointTransfers> lights = {};  ///< one a light, where they are held
    std::uint64_t seed = 0, picture = 0;      ///< seeds of the points' keys; image of `entered`
  };

  /// in    spacing: of the lines of level 0, mm; eta: of the boundary, as PointIrradianceInput's; light_samples: shadow rays from a place to each light with an area;
  ///       holds_lights: for more than one picture
  IrradianceLattice(std::vector<bool> is_own_mesh, double spacing, double eta, int light_samples,
                    bool holds_lights);

  /// True if a new one with these would be the same.
  bool is_of(const std::vector<bool>& is_own_mesh, double spacing, double eta, int light_samples) const;
  /// To be called between pictures of other lights, as HeldView::set_lights.
  void set_lights(std::span<const std::optional<std::size_t>> before);
  /// To be called between pictures: cells are in the colours of the first one's lights otherwise. Lets go of all of
  /// them where they take more than kMostBytes.
  void next_picture();
  static constexpr std::size_t kMostBytes = std::size_t(64) << 20;

  double spacing(std::uint32_t level) const;
  /// Keys of the cells within reach, mm, of any of some points.
  std::vector<Key> keys_near(std::span<const SurfacePoint> points, std::span<const std::uint32_t> chosen,
                             double reach, std::uint32_t level) const;
  /// in    lighting: its points, boundary and number of rays are not looked at; the same at each call but for them
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
  double spacing_, eta_;
  int light_samples_;
  bool holds_lights_;
  std::uint64_t picture_ = 0;
  std::atomic<std::size_t> bytes_{0};
  std::array<Shard, 64> shards_;
};

}  // namespace opaline
