// SPDX-License-Identifier: GPL-3.0-or-later
#include "volume/outer_surface.h"

#include <algorithm>
#include <cmath>

#include "geometry/follow_ray.h"

namespace opaline {
namespace {

constexpr double kEndless = std::numeric_limits<double>::infinity();
constexpr double kFacing = -.5;        // cosine between the normals of sheets touching
constexpr std::size_t kTested = 4096;  // pieces

/// True if the box of one of the meshes meets that of any other mesh of the world.
bool any_box_meets(const World& world, std::span<const std::uint32_t> meshes) {
  for (const std::uint32_t m : meshes)
    for (std::size_t other = 0; other < world.boxes.size(); ++other)
      if (other != m && meet(world.boxes[m], world.boxes[other])) return true;
  return false;
}

}  // namespace

/// Winding numbers of the meshes on both sides of a piece.
struct OuterSurface::Windings {
  int behind = 0, before = 0;  ///< before: on the side of its normal

  bool are_plain() const { return behind == 1 && before == 0; }
  friend bool operator==(const Windings&, const Windings&) = default;
};

OuterSurface::OuterSurface(const RayScene& rays, const World& world, std::span<const std::uint32_t> meshes,
                           double least_gap)
    : rays_(rays), least_gap_(least_gap) {
  if (any_box_meets(world, meshes)) lines_.emplace(rays, meshes);
  for (const std::uint32_t m : meshes) {
    if (m >= is_body_.size()) is_body_.resize(m + 1);
    is_body_[m] = true;
  }
}

/// Calls crossed(distance, step) for each triangle of the body along a ray; step: 1 where it leaves the body.
template <class Crossed>
void OuterSurface::follow_to_end(const Vec3d& from, const Vec3d& direction, const Crossed& crossed) const {
  if (lines_) {
    std::vector<Hit> hits;
    lines_->find(Ray(Vec3f(from), Vec3f(direction)), hits);
    for (const Hit& hit : hits) {
      const Vec3d met(rays_.surface_point(hit.mesh, hit.triangle, hit.u, hit.v).position);
      crossed(dot(met - from, direction), leaves(hit, direction) ? 1 : -1);
    }
    return;
  }
  follow_ray(rays_, from, direction, kEndless, [&](const TracedRay& traced) {
    if (traced.hit.mesh < is_body_.size() && is_body_[traced.hit.mesh])
      crossed(double(traced.ray.far), leaves(traced.hit, direction) ? 1 : -1);
    return true;
  });
}

// Winding numbers from a ray starting behind the piece; hits next to the piece count as coincident.
OuterSurface::Windings OuterSurface::windings_at(const BoundaryPiece& piece, const Vec3d& direction) const {
  const double offset = this->offset(piece), cosine = dot(piece.normal, direction);
  Windings windings;
  follow_to_end(Vec3d(piece.middle) - piece.normal * offset, direction, [&](double distance, int step) {
    windings.behind += step;
    if (distance * cosine > 2 * offset) windings.before += step;
  });
  return windings;
}

/// True if another sheet of the body faces it from nearby, so that outgoing light enters again.
bool OuterSurface::touches(const BoundaryPiece& piece, const Vec3d& outward) const {
  const Vec3d from = Vec3d(piece.middle) + outward * offset(piece);
  const auto faces_it = [&](const Hit& hit) {
    return std::abs(dot(normalized(Vec3d(hit.edges_cross)), outward)) > -kFacing;
  };
  if (lines_) {
    std::vector<Hit> hits;
    lines_->find(Ray(Vec3f(from), Vec3f(outward), float(least_gap_)), hits);
    return std::ranges::any_of(hits, faces_it);
  }
  bool found = false;
  follow_ray(rays_, from, outward, least_gap_, [&](const TracedRay& traced) {
    if (traced.hit.mesh >= is_body_.size() || !is_body_[traced.hit.mesh]) return true;
    found = faces_it(traced.hit);
    return !found;
  });
  return found;
}

// By two of three rays: one may run along an edge.
OuterSurface::Windings OuterSurface::windings_at(const BoundaryPiece& piece) const {
  const Vec3d& normal = piece.normal;
  const Windings first = windings_at(piece, normal);
  if (first.are_plain()) return first;
  Vec3d x, y;
  tangent_frame(normal, x, y);
  const Windings second = windings_at(piece, normalized(normal + .3 * x + .1 * y));
  if (second == first) return first;
  const Windings third = windings_at(piece, normalized(normal - .2 * x + .25 * y));
  return third == second ? second : first;
}

Boundedness OuterSurface::of(const BoundaryPiece& piece) const {
  const Windings windings = windings_at(piece);
  const bool is_turned = windings.before != 0;
  if ((windings.behind != 0) == is_turned) return {0, false};
  if (touches(piece, is_turned ? -piece.normal : piece.normal)) return {0, false};
  return {1 / float(std::abs(windings.behind - windings.before)), is_turned};
}

bool OuterSurface::is_plain(const BoundaryPiece& piece) const {
  return windings_at(piece).are_plain();
}

bool OuterSurface::has_inner(std::size_t pieces,
                             const std::function<BoundaryPiece(std::size_t)>& piece_of) const {
  const std::size_t step = std::max<std::size_t>(1, pieces / kTested);
  for (std::size_t i = 0; i < pieces; i += step)
    if (!is_plain(piece_of(i))) return true;
  return false;
}

}  // namespace opaline
