// SPDX-License-Identifier: GPL-3.0-or-later
#include "assets/gltf_motion.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "assets/asset_scene.h"

namespace opaline {
namespace {

constexpr double kFramesPerSecond = 24;
constexpr double kMostFrames = 100'000;

double seconds_of(int frame) {
  return (frame - 1) / kFramesPerSecond;
}

}  // namespace

GltfMotion::GltfMotion(const GltfModel& gltf, std::size_t index)
    : gltf_(gltf), index_(index), animation_(gltf, index) {
  last_frame_ = 1 + int(std::clamp(std::round(animation_.duration() * kFramesPerSecond), 0., kMostFrames));
}

std::string GltfMotion::frames_text() const {
  return last_frame_ == 1 ? "one pose"
                          : fmt::format("frames 1 to {}, {} a second", last_frame_, kFramesPerSecond);
}

bool GltfMotion::moves_skin(std::uint32_t skin) const {
  return std::ranges::any_of(gltf_.record("skins", skin).indices("joints"),
                             [&](std::uint32_t joint) { return joint < gltf_.nodes.size() && moves(joint); });
}

Transform GltfMotion::first_place(std::size_t node) const {
  const GltfState state = at(0);
  return node_to_world(gltf_, node, &state);
}

GltfState GltfMotion::at(double share) const {
  return animation_.at(share * seconds_of(last_frame_));
}

void GltfMotion::add_to_shape(Json& shape) const {
  if (index_ > 0) shape["animation"] = std::to_string(index_);
  shape["animation_time"] = 0;
  if (last_frame_ > 1)
    shape["animation_time"] = {{"keyed", {{"1", 0}, {std::to_string(last_frame_), seconds_of(last_frame_)}}}};
}

void GltfMotion::add_to(Json& placed, std::size_t node) const {
  if (!moves(std::uint32_t(node))) return;
  const auto vector_of = [](const Json& triple) {
    return Vec3d(triple[0].get<double>(), triple[1].get<double>(), triple[2].get<double>());
  };
  const double distance =
      placed.contains("look_at") ? length(vector_of(placed["look_at"]) - vector_of(placed["position"])) : 0;
  constexpr int kMostKeys = 1000;
  const int step = (last_frame_ + kMostKeys - 1) / kMostKeys;
  const auto replace = [&](const char* key, const auto& value) {
    if (!placed.contains(key)) return;
    Json keyed = Json::object();
    for (int frame = 1;; frame = std::min(frame + step, last_frame_)) {
      const GltfState state = animation_.at(seconds_of(frame));
      keyed[std::to_string(frame)] = triple_json(value(node_to_world(gltf_, node, &state)));
      if (frame == last_frame_) break;
    }
    placed[key] = last_frame_ > 1 ? Json{{"keyed", keyed}} : keyed["1"];
  };
  const auto forward = [](const Transform& t) { return -normalized(t.z); };
  replace("position", [](const Transform& t) { return t.translation; });
  replace("direction", forward);
  replace("look_at", [&](const Transform& t) { return t.translation + forward(t) * distance; });
  replace("up", [](const Transform& t) { return normalized(t.y); });
}

}  // namespace opaline
