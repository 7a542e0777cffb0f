// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <utility>

#include "cli/commands.h"
#include "input/readers.h"

namespace opaline {
namespace {

/// Keys of the camera's position, one each frame, in scene units.
std::string positions_around(const Scene& scene, int frames) {
  const Vec3d axis = normalized(scene.camera.up), center = scene.camera.look_at;
  std::vector<std::string> keys;
  for (int frame = 0; frame < frames; ++frame) {
    const Transform turn = rotation(axis, 360. * frame / frames);
    const Vec3d position =
        (center + transform_point(turn, scene.camera.position - center)) / scene.mm_per_unit;
    keys.push_back(fmt::format("\"{}\":[{},{},{}]", frame + 1, position.x, position.y, position.z));
  }
  return fmt::format("camera.position={{\"keyed\":{{{}}}}}", fmt::join(keys, ","));
}

}  // namespace

void turntable_command(const TurntableArguments& arguments) {
  RenderArguments render = arguments.render;
  const Scene scene = load_scene(render.scene, render.overrides);
  for (const auto& [key, v] :
       {std::pair("look_at", scene.camera.look_at / scene.mm_per_unit), {"up", scene.camera.up}})
    render.overrides.push_back(
        fmt::format("camera.{}=[{},{},{}]", key, v.x, v.y, v.z));  // they may have keys
  render.overrides.push_back(positions_around(scene, int(render.frames.size())));
  render_command(std::move(render));
}

}  // namespace opaline
