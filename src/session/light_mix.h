// SPDX-License-Identifier: GPL-3.0-or-later
// Pictures by single lights, from which those in other colours are mixed.
#pragma once

#include <functional>
#include <optional>
#include <vector>

#include "opaline/image/image.h"
#include "opaline/scene/scene.h"

namespace opaline {

/// Light adds up, and no channel knows of another: a picture by lights of other colours is a sum of pictures
/// by white ones. From the second edit in a row that changes colours alone, the lights that changed each have
/// a picture of their own, and the others one together; a further such edit is a sum, as is the first where
/// all were made ready before. A mixed picture differs from one rendered anew by what the evaluator's
/// tolerance allows, and its `error` layer is the sum of the parts', as if their errors went together.
class LightMix {
 public:
  /// The picture of a scene that differs from the one before by its lights' colours.
  using Render = std::function<Image(const Scene& scene)>;

  /// The mixed picture, or none where the scene is to be rendered: it differs by more than colours from the
  /// one asked for last, or this is the first edit of colours, or the pictures would take more than
  /// kMostMixBytes.
  std::optional<Image> mixed(const Scene& scene, const Render& render);

  /// A picture by each light of the scene, unless they would take too much memory.
  void get_ready(const Scene& scene, const Render& render);

  /// Lets go of everything.
  void clear() { *this = {}; }

 private:
  struct Part {
    std::size_t light;  // alone, white
    Image image;
  };
  bool is_single(std::size_t light) const;
  // Gives lights pictures of their own; false: there is no room.
  bool separate(const Scene& scene, const std::vector<std::size_t>& lights, const Render& render);

  std::optional<Scene> last_;
  std::size_t recoloured_ = 0;  // times in a row
  std::vector<Part> single_;
  std::optional<Image> others_;  // all other lights in their colours
};

inline constexpr std::size_t kMostMixBytes = std::size_t(1) << 30;

}  // namespace opaline
