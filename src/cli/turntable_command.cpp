// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cmath>
#include <numbers>
#include <utility>

#include "cli/commands.h"
#include "input/load_scene.h"

namespace opaline {
namespace {

/// v turned about a unit axis through the origin, counter-clockwise against the axis.
/// from  Rodrigues
Vec3d turned(const Vec3d& v, const Vec3d& axis, double angle) {
  const double c = std::cos(angle), s = std::sin(angle);
  return v * c + cross(axis, v) * s + axis * (dot(axis, v) * (1 - c));
}

/// Keys of the camera's position, one each frame, in scene units.
std::string positions_around(const Scene& scene, int frames) {
  const Vec3d axis = normalized(scene.camera.up), center = scene.camera.look_at;
  std::vector<std::string> keys;
  for (int frame = 0; frame < frames; ++frame) {
    const Vec3d position =
        (center + turned(scene.camera.position - center, axis, 2 * std::numbers::pi * frame / frames)) /
        scene.mm_per_unit;
    keys.push_back(fmt::format("\"{}\":[{},{},{}]", frame + 1, position.x, position.y, position.z));
  }
  return fmt::format("camera.position={{\"keyed\":{{{}}}}}", fmt::join(keys, ","));
}

}  // namespace

void turntable_command(const TurntableArguments& arguments) {
  RenderArguments render = arguments.render;
  const Scene scene = load_scene(render.scene, render.overrides);
  render.overrides.push_back(positions_around(scene, int(render.frames.size())));
  render_command(std::move(render));
}

}  // namespace opaline
