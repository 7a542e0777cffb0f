// SPDX-License-Identifier: GPL-3.0-or-later
#include "plan/shapes_inside.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <set>
#include <utility>

#include "bodies/opaque_inside.h"
#include "core/random.h"
#include "scene/names.h"
#include "subsurface/method.h"

namespace opaline {
namespace {

constexpr std::size_t kTested = 64;                // points per shape
constexpr std::size_t kMostPairs = 1'000'000;      // bodies times shapes
constexpr std::size_t kMostTriangles = 5'000'000;  // sum over tested pairs
constexpr std::size_t kMostNamed = 3;              // pairs

bool is_of(const BodyPlan& body, std::size_t mesh) {
  return std::ranges::find(body.meshes, mesh) != body.meshes.end();
}

/// The part of a convex polygon in a box.
std::vector<Vec3d> clipped(std::vector<Vec3d> polygon, const Bounds& box) {
  for (std::size_t plane = 0; plane < 6; ++plane) {
    const std::size_t axis = plane / 2;
    const auto outside = [&](const Vec3d& p) {
      return plane % 2 == 0 ? box.low[axis] - p[axis] : p[axis] - box.high[axis];
    };
    std::vector<Vec3d> kept;
    for (std::size_t i = 0; i < polygon.size(); ++i) {
      const Vec3d &a = polygon[i], &b = polygon[(i + 1) % polygon.size()];
      if (outside(a) <= 0) kept.push_back(a);
      if ((outside(a) <= 0) != (outside(b) <= 0))
        kept.push_back(a + (b - a) * (outside(a) / (outside(a) - outside(b))));
    }
    polygon = std::move(kept);
  }
  return polygon;
}

/// Points spread over the part of a mesh in a box by area, `depth` below the surface.
std::vector<Vec3d> points_below(const Mesh& mesh, const Bounds& box, double depth) {
  std::vector<std::array<Vec3d, 3>> pieces;
  std::vector<double> sums;  // cumulative areas
  double area = 0;
  for (const auto& [i, j, k] : mesh.triangles) {
    const Vec3d &a = mesh.positions[i], &b = mesh.positions[j], &c = mesh.positions[k];
    const Bounds own{component_min(a, component_min(b, c)), component_max(a, component_max(b, c))};
    if (!meet(own, box)) continue;
    std::vector<Vec3d> polygon{a, b, c};
    if (!contains(box, own)) polygon = clipped(std::move(polygon), box);
    for (std::size_t corner = 2; corner < polygon.size(); ++corner) {
      pieces.push_back({polygon[0], polygon[corner - 1], polygon[corner]});
      area += length(cross(polygon[corner - 1] - polygon[0], polygon[corner] - polygon[0]));
      sums.push_back(area);
    }
  }
  std::vector<Vec3d> points;
  if (!(area > 0)) return points;
  for (std::size_t i = 0; i < kTested; ++i) {
    const auto at = std::ranges::upper_bound(sums, area * (double(i) + .5) / kTested);
    const auto& [a, b, c] = pieces[std::min(std::size_t(at - sums.begin()), pieces.size() - 1)];
    const auto [square, v] = r2_point(i, {.5, .5});
    const double u = std::sqrt(square);
    points.push_back(a + (b - a) * (u * (1 - v)) + (c - a) * (u * v) -
                     normalized(cross(b - a, c - a)) * depth);
  }
  return points;
}

class ShapesInside {
 public:
  ShapesInside(const Scene& scene, const World& world, const RayScene& rays, const Plan& plan)
      : scene_(scene), world_(world), rays_(rays), plan_(plan), body_of_(world.meshes.size()) {
    for (const Mesh& mesh : world.meshes) boxes_.push_back(bounds(mesh));
    for (std::size_t i = 0; i < plan.groups.size(); ++i)
      for (const std::uint32_t mesh : plan.groups[i].meshes) body_of_[mesh] = i;
  }

  std::vector<std::string> run() {
    for (std::size_t i = 0; i < plan_.groups.size(); ++i) {
      const BodyPlan& body = plan_.groups[i];
      if (!method_of(body.method).has_model() || !(body.thickness > 0)) continue;
      Bounds box = bounds(world_, body.meshes);
      const Vec3d margin = (box.high - box.low) * 1e-5;  // surfaces that touch
      box = {box.low + margin, box.high - margin};
      const bool has_cells = body.method == Method::volume_diffusion;  // opaque solids absorb light there
      for (std::uint32_t other = 0; other < world_.meshes.size(); ++other)
        if (!is_of(body, other) && meet(box, boxes_[other]) &&
            !(has_cells && is_opaque_solid(scene_, world_, other)))
          test(i, box, other);
    }
    if (count_ > kMostNamed)
      warnings_.push_back(fmt::format("{}{} more shapes lie inside or overlap bodies",
                                      triangles_ > kMostTriangles ? "at least " : "", count_ - kMostNamed));
    return std::move(warnings_);
  }

 private:
  void test(std::size_t i, const Bounds& box, std::uint32_t other) {
    const BodyPlan& body = plan_.groups[i];
    if (body_of_[other] && named_.contains(std::minmax(i, *body_of_[other]))) return;
    if (triangles_ > kMostTriangles) return;
    triangles_ += world_.meshes[other].triangles.size();
    if (!reaches_inside(body, box, other)) return;
    if (body_of_[other]) named_.insert(std::minmax(i, *body_of_[other]));
    if (++count_ > kMostNamed) return;
    warnings_.push_back(fmt::format("{}: the shape '{}' {}, but the method {} ignores it there; {}",
                                    body.name, scene_.shapes[other].name,
                                    contains(box, boxes_[other]) ? "lies inside" : "lies partly inside",
                                    name_of(body.method), way_out(body, other)));
  }

  const char* way_out(const BodyPlan& body, std::size_t other) const {
    if (!body_of_[other])
      return body.method == Method::volume_diffusion ? "close its mesh, or use --method volume"
                                                     : "--method volume and volume_diffusion do not";
    return scene_.shapes[other].medium == body.medium ? "put both into one group, or move them apart"
                                                      : "no method mixes media; move them apart";
  }

  /// True if a considerable part of the shape is inside the body. The surface of another body is tested, but vertices of
  /// opaque shapes: a body sunk into a large floor is usual.
  bool reaches_inside(const BodyPlan& body, const Bounds& box, std::uint32_t other) const {
    if (!body_of_[other]) return has_vertices_inside(world_, rays_, body, other);
    constexpr double kConsiderable = .2;  // fraction of the diagonal
    constexpr double kDepth = .005;       // the same; bodies overlapping less are in contact
    const double diagonal = length(box.high - box.low);
    Bounds inside;
    for (const Vec3d& point : points_below(world_.meshes[other], box, kDepth * diagonal))
      if (is_inside(rays_, body, point)) widen(inside.low, inside.high, point);
    return inside.low.x <= inside.high.x && length(inside.high - inside.low) > kConsiderable * diagonal;
  }

  const Scene& scene_;
  const World& world_;
  const RayScene& rays_;
  const Plan& plan_;
  std::vector<Bounds> boxes_;  // one per mesh, world units
  std::vector<std::optional<std::size_t>> body_of_;
  std::set<std::pair<std::size_t, std::size_t>> named_;  // bodies, ascending
  std::size_t triangles_ = 0, count_ = 0;
  std::vector<std::string> warnings_;
};

}  // namespace

std::vector<std::string> warnings_of_shapes_inside(const Scene& scene, const World& world,
                                                   const RayScene& rays, const Plan& plan) {
  if (plan.groups.size() * world.meshes.size() > kMostPairs) return {};
  return ShapesInside(scene, world, rays, plan).run();
}

}  // namespace opaline
