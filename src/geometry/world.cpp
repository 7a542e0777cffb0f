// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/world.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "geometry/mesh.h"
#include "geometry/shape_label.h"
#include "opaline/error.h"
#include "scene/scene_properties.h"
#include "scene/source_place.h"

namespace opaline {
namespace {

constexpr double kSmallestForItsPlace = 0x1p-16, kSmallestForTheWorld = 0x1p-30, kMostAreaLost = 0.1;

double twice_area(const Vec3d& a, const Vec3d& b, const Vec3d& c) {
  return length(cross(b - a, c - a));
}

/// Absolute change of the triangles' area by rounding, over their sum.
double area_lost(const Mesh& mesh) {
  double sum = 0, lost = 0;
  for (const auto& [a, b, c] : mesh.triangles) {
    const Vec3d &p = mesh.positions[a], &q = mesh.positions[b], &r = mesh.positions[c];
    const double exact = twice_area(p, q, r);
    sum += exact;
    lost += std::abs(twice_area(Vec3d(Vec3f(p)), Vec3d(Vec3f(q)), Vec3d(Vec3f(r))) - exact);
  }
  return lost / sum;
}

/// in    mesh: of a world, in its space; diagonal: World::diagonal; unit: World::unit
/// error Error{bad_input} with the name and the bound: the mesh is smaller than 2^-16 of its distance from
///       the middle of the world or 2^-30 of the world's size, or so thin that rounding its vertices to
///       floats changes its area by more than a tenth
void check_precision(const Mesh& mesh, const std::string& name, double diagonal, double unit) {
  const Bounds box = bounds(mesh);
  const double side = max_component(box.high - box.low);
  const double far = max_component(component_max(box.high, -box.low));
  if (side < kSmallestForItsPlace * far)
    throw bad_file(name, "is too small for its distance from the centre of the scene",
                   fmt::format("at least {:.4g} mm (distance / 65536), the limit of single precision",
                               kSmallestForItsPlace * far * unit),
                   fmt::format("{:.4g} mm", side * unit));
  if (side < kSmallestForTheWorld * diagonal)
    throw bad_file(name, "is too small for the scene",
                   fmt::format("at least {:.4g} mm (diagonal of the scene / 2^30)",
                               kSmallestForTheWorld * diagonal * unit),
                   fmt::format("{:.4g} mm", side * unit));
  const double lost = area_lost(mesh);
  if (lost > kMostAreaLost)
    throw bad_file(name, "is too thin or too fine for its extent",
                   "vertices for which rounding to single precision (2^-24 times the distance from the "
                   "centre of the scene) changes the area by at most 10 %",
                   fmt::format("{:.3g} %", 100 * lost));
}

Vec3d stable_middle(const Bounds& all, double diagonal) {
  if (!(diagonal > 0)) return all.low;
  const double step = std::scalbn(1.0, std::ilogb(diagonal) - 2);
  const Vec3d middle = 0.5 * (all.low + all.high);
  return {step * std::round(middle.x / step), step * std::round(middle.y / step),
          step * std::round(middle.z / step)};
}

/// Reports an error of a shape at its position in the scene file.
CheckedMesh load_mesh(const Scene& scene, const Shape& shape, MeshMemory* memory) {
  const MeshUvs uvs = uvs_of(scene, shape);
  try {
    return memory == nullptr ? make_mesh(shape, uvs) : make_mesh(shape, *memory, uvs);
  } catch (const Error& failure) {
    throw told_at(shape.place, failure);
  }
}

void check_shape(const World& world, const Shape& shape, std::size_t index) {
  try {
    check_precision(world.meshes[index], shape_label(shape), world.diagonal, world.unit);
  } catch (const Error& failure) {
    throw told_at(shape.place, failure);
  }
}

double power_of_1024(double length) {
  return length > 0 ? std::exp2(10 * std::floor(std::ilogb(length) / 10.0)) : 1;
}

/// Unit between the smallest and the largest translucent body, because derivatives of their profiles contain
/// up to the eighth power of a length. The scene's size if no shape is translucent.
double unit_of(const Scene& scene, std::span<const Bounds> boxes, double diagonal) {
  double least = INFINITY, largest = 0;
  for (std::size_t i = 0; i < boxes.size(); ++i) {
    const double size = length(boxes[i].high - boxes[i].low);
    if (!scene.shapes[i].medium || !(size > 0)) continue;
    least = std::min(least, size);
    largest = std::max(largest, size);
  }
  return power_of_1024(largest > 0 ? std::sqrt(least) * std::sqrt(largest) : diagonal);
}

}  // namespace

double area_of(const World& world, std::span<const std::uint32_t> meshes) {
  double area = 0;
  for (const std::uint32_t m : meshes) area += world.measures[m].area;
  return area;
}

Bounds bounds(const World& world, std::span<const std::uint32_t> meshes) {
  Bounds box;
  for (const std::uint32_t m : meshes)
    for (const Vec3d& p : world.meshes[m].positions) widen(box.low, box.high, p);
  return box;
}

bool boxes_meet(const World& world, std::span<const std::uint32_t> meshes) {
  std::vector<Bounds> boxes;
  for (const std::uint32_t m : meshes) {
    const Bounds box = bounds(world.meshes[m]);
    if (std::ranges::any_of(boxes, [&](const Bounds& other) { return meet(box, other); })) return true;
    boxes.push_back(box);
  }
  return false;
}

World make_world(const Scene& scene) {
  std::size_t loaded = 0;
  return update_world(scene, {}, std::vector<std::optional<std::size_t>>(scene.shapes.size()), loaded);
}

World update_world(const Scene& scene, const World& old, std::span<const std::optional<std::size_t>> kept,
                   std::size_t& loaded, std::span<MeshMemory* const> memories) {
  World world;
  const auto load = [&](std::size_t shape) {
    CheckedMesh checked = load_mesh(scene, scene.shapes[shape], memories.empty() ? nullptr : memories[shape]);
    world.meshes[shape] = std::move(checked.mesh);
    world.reports[shape] = std::move(checked.report);
    world.boxes[shape] = bounds(world.meshes[shape]);
    ++loaded;
  };
  const auto move = [&](Mesh& mesh) {
    for (Vec3d& p : mesh.positions) p = into_world(world, p);
  };
  const std::size_t count = scene.shapes.size();
  world.meshes.resize(count);
  world.reports.resize(count);
  world.boxes.resize(count);
  world.measures.resize(count);
  loaded = 0;
  if (std::ranges::any_of(scene.shapes, [](const Shape& shape) { return shape.opacity.has_value(); }))
    for (const Shape& shape : scene.shapes) world.opacities.push_back(shape.opacity);
  if (count == 0) return world;
  Bounds all;
  for (std::size_t i = 0; i < count; ++i) {
    if (kept[i])
      world.boxes[i] = old.boxes[*kept[i]];
    else
      load(i);
    all.low = component_min(all.low, world.boxes[i].low);
    all.high = component_max(all.high, world.boxes[i].high);
  }
  const double diagonal = length(all.high - all.low);
  world.unit = unit_of(scene, world.boxes, diagonal);
  world.diagonal = diagonal / world.unit;
  world.origin = stable_middle(all, diagonal);
  for (std::size_t i = 0; i < count; ++i) {
    if (kept[i] && world.origin == old.origin && world.unit == old.unit) {
      world.meshes[i] = old.meshes[*kept[i]];
      world.reports[i] = old.reports[*kept[i]];
      world.measures[i] = old.measures[*kept[i]];
    } else {
      if (kept[i]) load(i);
      move(world.meshes[i]);
      check_shape(world, scene.shapes[i], i);
      world.measures[i] = measures_of(world.meshes[i]);
    }
  }
  return world;
}
std::vector<Vec3f> moved_vertices(const Scene& scene, const World& world, std::size_t shape,
                                  const Shape& moved) {
  const Mesh& mesh = world.meshes[shape];
  const Shape& now = scene.shapes[shape];
  const Transform& from = now.to_world;
  const double volume = dot(from.x, cross(from.y, from.z));
  std::vector<Vec3f> vertices;
  if (moved.source == now.source && !now.displacement && !moved.displacement && volume != 0) {
    for (const Vec3d& p : mesh.positions) {
      const Vec3d v = out_of_world(world, p) - from.translation,
                  inside{dot(v, cross(from.y, from.z)), dot(v, cross(from.z, from.x)),
                         dot(v, cross(from.x, from.y))};
      vertices.emplace_back(into_world(world, transform_point(moved.to_world, inside * (1 / volume))));
    }
    return vertices;
  }
  const CheckedMesh checked = load_mesh(scene, moved, nullptr);
  if (checked.mesh.triangles != mesh.triangles || checked.mesh.positions.size() != mesh.positions.size())
    return {};
  for (const Vec3d& p : checked.mesh.positions) vertices.emplace_back(into_world(world, p));
  return vertices;
}

}  // namespace opaline
