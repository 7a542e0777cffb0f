// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/world.h"

#include <algorithm>
#include <cmath>

#include "geometry/check_world.h"
#include "geometry/shape_label.h"
#include "scene/scene_properties.h"
#include "scene/source_place.h"

namespace opaline {

namespace {

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

/// Between the least and the largest translucent body: derivatives of their profiles have up to the eighth
/// power of a length in them. Of the scene where nothing is translucent.
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

}  // namespace opaline
