// SPDX-License-Identifier: GPL-3.0-or-later
// An animation of a glTF asset as values by frame.
#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "asset_files/gltf_animation.h"

namespace opaline {

class GltfMotion {
 public:
  /// error as GltfAnimation
  GltfMotion(const GltfModel& gltf, std::size_t index);

  std::size_t index() const { return index_; }
  std::string name() const { return animation_name(gltf_, index_); }
  bool is_empty() const { return animation_.is_empty(); }
  std::string frames_text() const;  ///< "frames 1 to 49, 24 a second"

  bool moves(std::uint32_t node) const { return animation_.moves(node); }
  bool moves_skin(std::uint32_t skin) const;
  bool changes_weights(std::uint32_t node) const { return animation_.changes_weights(node); }

  /// Transform of a node at the start.
  Transform first_place(std::size_t node) const;
  /// in    share: of the duration
  GltfState at(double share) const;

  /// Adds the time by frame.
  void add_to_shape(nlohmann::ordered_json& shape) const;

  /// Replaces the position and the directions of a camera or light by their values by frame, if its node moves.
  void add_to(nlohmann::ordered_json& placed, std::size_t node) const;

 private:
  const GltfModel& gltf_;
  std::size_t index_;
  GltfAnimation animation_;
  int last_frame_ = 1;
};

}  // namespace opaline
