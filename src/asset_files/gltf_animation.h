// SPDX-License-Identifier: GPL-3.0-or-later
// Animations of a glTF asset (glTF 2.0, 3.11).
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "asset_files/gltf_model.h"

namespace opaline {

/// Nodes changed by an animation, at one time.
struct GltfState {
  std::map<std::uint32_t, Transform> placed;             ///< transforms in the parent, by node
  std::map<std::uint32_t, std::vector<double>> weights;  ///< weights of morph targets, by node
};

class GltfAnimation {
 public:
  /// error Error{bad_input} naming the record: a dangling reference, decreasing times, the wrong number of values, a
  ///       node with a matrix
  GltfAnimation(const GltfModel& gltf, std::size_t index);

  bool is_empty() const { return channels_.empty(); }  ///< true if no node changes
  double duration() const { return duration_; }        ///< time of the last key, seconds
  /// Before the first key and after the last, values are constant.
  GltfState at(double seconds) const;
  /// True if the node, or one above it, has keys of its own transform.
  bool moves(std::uint32_t node) const;
  bool changes_weights(std::uint32_t node) const;

 private:
  enum class Path { translation, rotation, scale, weights };
  enum class Between { step, linear, spline };

  struct Channel {
    std::uint32_t node;
    Path path;
    Between between;
    std::vector<double> times;   ///< seconds, ascending
    std::vector<double> values;  ///< by key; splines: in-tangent, value, out-tangent
    std::size_t width;           ///< numbers of a value

    std::vector<double> at(double seconds) const;
  };

  void add_channel(const GltfRecord& channel, std::span<const GltfRecord> samplers);
  void read_sampler(const GltfRecord& sampler, Channel& channel) const;

  const GltfModel& gltf_;
  std::vector<Channel> channels_;
  double duration_ = 0;
  std::size_t numbers_ = 0;  // all channels together
};

/// The animation's name, or its index.
std::string animation_name(const GltfModel& gltf, std::size_t index);

/// Keeps the last one read.
/// error as GltfAnimation
std::shared_ptr<const GltfAnimation> load_animation(const std::shared_ptr<const GltfModel>& gltf,
                                                    std::size_t index);

/// Index of the animation with a name or index; empty: the first.
/// error Error{bad_input} naming the file: no such animation
std::size_t find_animation(const GltfModel& gltf, const std::string& name);

}  // namespace opaline
