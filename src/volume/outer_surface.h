// SPDX-License-Identifier: GPL-3.0-or-later
// Pieces of a body's meshes bounding the solid, for meshes with self-intersections, folds or nested shells.
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

/// Role of a piece as boundary of the solid, the region of nonzero winding number.
struct Boundedness {
  /// Counting fraction of the piece's area: 0 inside the solid, 1/2 for each of two sheets closer than the
  /// resolution of rays.
  float share = 1;
  bool is_turned = false;  ///< its triangle faces into the solid

  friend bool operator==(const Boundedness&, const Boundedness&) = default;
};

class OuterSurface {
 public:
  /// in    meshes: the body's, closed
  ///       least_gap: sheets facing each other at a smaller distance touch; world units
  OuterSurface(const RayScene& rays, const World& world, std::span<const std::uint32_t> meshes,
               double least_gap);

  Boundedness of(const BoundaryPiece& piece) const;
  /// True if the solid is behind the piece and the outside in front of it, whatever other sheets are near.
  bool is_plain(const BoundaryPiece& piece) const;
  /// Tests a few thousand of the pieces; true if any of them is not plain.
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
  std::optional<LineQuery> lines_;  ///< if meshes may coincide: rays continuing behind a hit miss them
  std::vector<bool> is_body_;
  double least_gap_;
};

}  // namespace opaline
