// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/coincident_shapes.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <optional>

#include "geometry/coplanar_faces.h"
#include "geometry/nearest_on_triangle.h"
#include "geometry/winding_number.h"

namespace opaline {
namespace {

constexpr double kRounding = 1e-6;  // fraction of a shape's diagonal
constexpr std::size_t kPoints = 16;
constexpr std::size_t kMostNamed = 3;

/// Bounds in integer steps of the rounding.
using BoundsKey = std::array<double, 6>;

BoundsKey key_of(const Bounds& box, double step) {
  BoundsKey key;
  for (std::size_t i = 0; i < 3; ++i) {
    key[i] = std::floor(box.low[i] / step);
    key[i + 3] = std::floor(box.high[i] / step);
  }
  return key;
}

bool is_on(const Vec3d& point, const Mesh& mesh, double reach) {
  return std::ranges::any_of(mesh.triangles, [&](const auto& t) {
    const std::array<Vec3d, 3> corners{mesh.positions[t[0]], mesh.positions[t[1]], mesh.positions[t[2]]};
    return nearest_on(corners, point).square <= reach * reach;
  });
}

/// True if the middles of some triangles of one mesh lie on the other.
bool coincide(const Mesh& a, const Mesh& b, double reach) {
  const std::size_t step = std::max(a.triangles.size() / kPoints, std::size_t(1));
  for (std::size_t t = 0; t < a.triangles.size(); t += step) {
    Vec3d middle;
    for (const std::uint32_t v : a.triangles[t]) middle += a.positions[v] / 3.;
    if (!is_on(middle, b, reach)) return false;
  }
  return true;
}

bool has_one_color(const Shape& shape, const Mesh& mesh) {
  bool is_textured = !mesh.colors.empty();
  for_each_textured(
      shape, [&](const auto&, const auto& texture, SurfacePart) { is_textured |= texture.has_value(); });
  return !is_textured;
}

/// True if shapes a and b look the same at each point of a common face.
bool look_alike(const Scene& scene, const World& world, std::size_t a, std::size_t b) {
  const Shape &one = scene.shapes[a], &other = scene.shapes[b];
  if (one.medium || other.medium)
    return one.medium == other.medium && one.group == other.group && !one.group.empty();
  return one.reflectance == other.reflectance && one.gloss == other.gloss && one.fuzz == other.fuzz &&
         has_one_color(one, world.meshes[a]) && has_one_color(other, world.meshes[b]);
}

/// Sides of surfaces seen by the camera.
class SeenSides {
 public:
  SeenSides(const Scene& scene, const World& world)
      : world_(world), camera_(scene.camera.position), position_(into_world(world, camera_)) {
    if (scene.camera.orthographic_height) backwards_ = scene.camera.position - scene.camera.look_at;
  }

  /// True unless one of the closed shapes hides both faces: the camera is behind its face, and outside.
  bool are_seen(const CoplanarFaces& faces) {
    for (std::size_t i = 0; i < 2; ++i) {
      const std::size_t mesh = faces.meshes[i];
      const bool is_behind = dot(faces.normals[i], backwards_.value_or(position_ - faces.point)) <= 0;
      if (is_behind && world_.reports[mesh].open_edges == 0 && !is_around_camera(mesh)) return false;
    }
    return true;
  }

 private:
  bool is_around_camera(std::size_t mesh) {
    const Bounds& box = world_.boxes[mesh];
    if (!meet(box, {camera_, camera_})) return false;
    const auto [place, is_new] = around_camera_.try_emplace(mesh, false);
    if (is_new) place->second = encloses(world_.meshes[mesh], position_);
    return place->second;
  }

  const World& world_;
  Vec3d camera_, position_;         // in the scene, and in the world
  std::optional<Vec3d> backwards_;  // for parallel rays
  std::map<std::size_t, bool> around_camera_;
};

/// For each shape the first of those in its place; none: it is alone, or the first.
std::vector<std::optional<std::size_t>> firsts_of(const World& world) {
  std::map<BoundsKey, std::vector<std::size_t>> by_bounds;  // first of several coincident shapes
  std::vector<std::optional<std::size_t>> firsts(world.meshes.size());
  for (std::size_t i = 0; i < world.meshes.size(); ++i) {
    const Bounds& box = world.boxes[i];
    const double diagonal = length(box.high - box.low);
    if (!(diagonal > 0)) continue;
    const double step = kRounding * std::exp2(std::ilogb(diagonal)), reach = step / world.unit;
    std::vector<std::size_t>& others = by_bounds[key_of(box, step)];
    const auto same = std::ranges::find_if(others, [&](std::size_t other) {
      return coincide(world.meshes[i], world.meshes[other], reach) &&
             coincide(world.meshes[other], world.meshes[i], reach);
    });
    if (same == others.end())
      others.push_back(i);
    else
      firsts[i] = *same;
  }
  return firsts;
}

std::string names_of(const Scene& scene, std::size_t a, std::size_t b) {
  return "the shapes '" + scene.shapes[a].name + "' and '" + scene.shapes[b].name + "' have coincident ";
}

}  // namespace

std::vector<std::string> warnings_of_coincident_shapes(const Scene& scene, const World& world) {
  std::vector<std::string> warnings;
  std::size_t count = 0;
  const std::vector<std::optional<std::size_t>> firsts = firsts_of(world);
  for (std::size_t i = 0; i < firsts.size(); ++i)
    if (firsts[i] && ++count <= kMostNamed)
      warnings.push_back(names_of(scene, *firsts[i], i) +
                         "surfaces, so rounding decides which one a ray hits; remove one of them");
  if (count > kMostNamed)
    warnings.push_back(std::to_string(count - kMostNamed) + " more shapes coincide with another shape");
  return warnings;
}

std::vector<std::string> warnings_of_coincident_faces(const Scene& scene, const World& world) {
  std::vector<std::string> warnings;
  if (world.meshes.size() < 2) return warnings;
  SeenSides sides(scene, world);
  std::size_t count = 0;
  const std::vector<std::optional<std::size_t>> firsts = firsts_of(world);
  find_coplanar_faces(
      world, kRounding,
      [&](std::size_t a, std::size_t b) { return firsts[a] || firsts[b] || look_alike(scene, world, a, b); },
      [&](const CoplanarFaces& faces) {
        if (!sides.are_seen(faces)) return false;
        if (++count <= kMostNamed)
          warnings.push_back(names_of(scene, faces.meshes[0], faces.meshes[1]) +
                             "faces, so rounding decides which one a ray hits; move or resize one of them");
        return true;
      });
  if (count > kMostNamed)
    warnings.push_back(std::to_string(count - kMostNamed) + " more pairs of shapes have coincident faces");
  return warnings;
}

}  // namespace opaline
