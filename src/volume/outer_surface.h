// SPDX-License-Identifier: GPL-3.0-or-later
// Which pieces of a body's meshes bound the solid that they enclose: meshes may cross themselves, fold back or lie
// within each other.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <vector>

#include "geometry/line_query.h"
#include "geometry/ray_scene.h"

namespace opaline {

/// A small flat piece of a body's meshes.
struct BoundaryPiece {
  Vec3f middle;  ///< world units
  Vec3d normal;  ///< unit, by the winding of its triangle
  std::uint32_t mesh = 0, triangle = 0;
};

/// A piece of the meshes as a boundary of the solid, where the winding number is not 0.
struct Boundedness {
  /// Fraction of the piece's area that counts: 0 inside the solid, 1/2 of two sheets nearer than rays tell.
  float share = 1;
  bool is_turned = false;  ///< its triangle faces into the solid

  friend bool operator==(const Boundedness&, const Boundedness&) = default;
};

class OuterSurface {
 public:
  /// in    meshes: the body's, closed
  ///       least_gap: sheets nearer than this facing each other touch; world units
  OuterSurface(const RayScene& rays, const World& world, std::span<const std::uint32_t> meshes,
               double least_gap);

  Boundedness of(const BoundaryPiece& piece) const;
  /// Returns whether the solid is behind the piece and the outside in front of it, whatever other sheets are near.
  bool is_plain(const BoundaryPiece& piece) const;
  /// Tests a few thousand of the pieces; returns whether any of them is not plain.
  bool has_inner(std::size_t pieces, const std::function<BoundaryPiece(std::size_t)>& piece_of) const;

 private:
  struct Windings;
  Windings windings_at(const BoundaryPiece& piece) const;
  Windings windings_at(const BoundaryPiece& piece, const Vec3d& direction) const;
  template <class Crossed>
  void follow_to_end(const Vec3d& from, const Vec3d& direction, const Crossed& crossed) const;
  bool touches(const BoundaryPiece& piece, const Vec3d& outward) const;
  double offset(const BoundaryPiece& piece) const { return double(rays_.offset(piece.mesh, piece.middle)); }

  const RayScene& rays_;
  std::optional<LineQuery> lines_;  ///< where meshes may coincide, which rays that go on behind a hit miss
  std::vector<bool> is_body_;
  double least_gap_;
};

}  // namespace opaline
