// SPDX-License-Identifier: GPL-3.0-or-later
// Nearest samples on a surface.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "sampling/sample_surface.h"

namespace opaline {

/// Finds the samples on a point's sheet: those with normals not facing away from the point's (same_sheet).
class NearestSample {
 public:
  struct Member {
    Vec3f position, normal;
    std::uint32_t sample;
  };

  /// world: of the samples. With a world, triangles' normals identify sheets, as for the samples' areas, and
  /// the nearest sample's cell contains the point. Without, the samples' own normals identify them.
  /// cube_edge: of the cubes visited by for_near, in mean spacings of the samples; radii of its size are the
  /// fastest
  explicit NearestSample(std::span<const SurfaceSample> samples, const World* world = nullptr,
                         float cube_edge = 1);

  /// By the centroids of the samples' cells.
  /// least_area: smaller cells are left out; times their mean area, below 1
  static NearestSample by_centroids(std::span<const SurfaceSample> samples, float cube_edge,
                                    double least_area = 0);

  /// Index of the nearest sample on the point's sheet; on any sheet if there is none nearby.
  std::uint32_t at(const Vec3f& position, const Vec3f& normal) const;

  /// All samples, cube by cube.
  std::span<const Member> members() const { return members_; }

  /// Calls visit(member), an element of members(), for all samples, on any sheet, in the cubes intersecting
  /// the ball around a position.
  template <class Visit>
  void for_near(const Vec3f& position, float radius, const Visit& visit) const {
    const Place low = place_of(position - Vec3f(radius)), high = place_of(position + Vec3f(radius));
    for (std::int32_t z = low.z; z <= high.z; ++z)
      for (std::int32_t y = low.y; y <= high.y; ++y)
        for (std::int32_t x = low.x; x <= high.x; ++x)
          for (const Member& member : members_of({x, y, z})) visit(member);
  }

 private:
  struct Place {
    std::int32_t x, y, z;  ///< cell coordinates of a cube
  };
  struct Cube {
    std::uint64_t key = 0;
    std::uint32_t first = 0, count = 0;  ///< range of its members; empty: the slot is free
  };
  struct Found {
    float distance2;
    std::uint32_t sample;
  };

  Place place_of(const Vec3f& position) const;
  static std::uint64_t key_of(const Place& place);
  std::size_t slot_of(std::uint64_t key) const;
  std::span<const Member> members_of(const Place& place) const;
  void look_into(const Place& place, const Vec3f& position, const Vec3f* normal, Found& best) const;
  Found nearest(const Vec3f& position, const Vec3f* normal) const;

  Vec3f low_;
  float inverse_edge_ = 1, edge_ = 1;
  std::vector<Member> members_;  ///< cube by cube
  std::vector<Cube> slots_;      ///< a hash table, a power of two of them
  int shift_ = 0;                ///< 64 - log2(their number)
};

}  // namespace opaline
