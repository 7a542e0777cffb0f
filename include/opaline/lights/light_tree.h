// SPDX-License-Identifier: GPL-3.0-or-later
// Many lights in a tree, from which every point draws the few that matter most to it.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "opaline/lights/light.h"

namespace opaline {

class LampTable;

/// Point, spot, sphere and quad lights in a binary tree. Each node bounds where its lights are, which way they shine
/// and how brightly. From that follows the importance of a node at a point: what its lights could bring there if
/// nothing were in the way; it is positive wherever one of them brings light. Lights are drawn by importance. One that
/// is drawn n times in the mean stands for 1 / n of what it brings each time, so that the mean of what is drawn is the
/// sum over all lights. Lights without an area that are not very many are all weighed at each point in place of nodes.
/// from  Conty Estevez & Kulla 2018, Importance Sampling of Many Lights with Adaptive Tree Splitting: bounds,
///       importance and splitting; Madow 1949, systematic sampling: no light is drawn twice in vain; of lights that are
///       weighed one of each stratum is drawn, so that draws do not depend on each other
class LightTree {
 public:
  /// in    lights: recentred, of the kinds above; all of them is_delta, or none; at least one
  explicit LightTree(std::vector<Light> lights);

  const std::vector<Light>& lights() const { return lights_; }
  /// The emission that those of all lights are grey multiples of; none: their colours differ.
  const std::optional<Rgb>& common_emission() const { return common_emission_; }
  /// Emission of a light; over the common one, if there is one.
  const RgbF& colour(std::uint32_t light) const { return colours_[light]; }
  bool has_area() const { return has_area_; }
  /// Hash of all that the lights are.
  std::uint64_t hash() const { return hash_; }
  /// A ball around them.
  LightExtent extent() const;

  /// Shading point.
  struct Place {
    Vec3f point, normal;         ///< normal: unit
    const Lobe* lobe = nullptr;  ///< in which it mirrors light; null: its irradiance is wanted
  };

  struct Drawn {
    std::uint32_t light = 0;
    float expected = 0;  ///< how often it is drawn in the mean; 0: nothing was drawn
    float rest = 0;      ///< uniform in [0, 1), for a point of the light
    /// Irradiance by `colour` of lights that are weighed, were nothing in the way and no boundary there: of this light over
    /// `expected`, and its mean over all draws in this place of `drawn`. Black for other lights.
    RgbF unshadowed{}, mean_unshadowed{};
  };
  /// Draws drawn.size() lights, or fewer where fewer matter, in an order in which neighbours are alike. A light without
  /// an area that is expected once is drawn once; where there are no more of them than places, each is drawn.
  /// in    random: in [0, 1); key: one for draws whose `random` are spread evenly, chooses where in each stratum they lie
  void draw(const Place& at, double random, std::uint64_t key, std::span<Drawn> drawn) const;

  /// How often a draw of one takes this light, in the mean.
  double share(const Place& at, std::uint32_t light) const;

  /// The light with an area that a ray meets before `far`; of several the nearest.
  std::optional<std::uint32_t> first_met(const Vec3f& origin, const Vec3f& direction, float far) const;

  struct Node {
    Vec3f center{};
    float radius = 0;  ///< radius of a ball around its lights
    /// Axis of a cone around the ways its lights face; a half angle of pi: they shine all around.
    Vec3f axis{};
    float cos_half = -1, sin_half = 0;
    /// Off their way its lights shine fully within an angle, and not at all beyond another. Between them they fade with
    /// the cosine, spots with its square.
    float cos_full = -1, cos_reach = -1;
    bool fades_by_square = false;
    double brightness = 0;  ///< sum of intensities in the brightest direction, W/sr, mean of the channels
    std::uint32_t first = 0, count = 0;  ///< its lights, of those in the leaves' order
    std::uint32_t children = 0;          ///< the first of two nodes that follow each other; 0: a leaf
  };
  /// Bound of the contribution of a node's lights at a point: irradiance, W/mm^2, or a measure of reflected light.
  static double importance(const Node& node, const Place& at);
  /// The root first.
  const std::vector<Node>& nodes() const { return nodes_; }

 private:
  void draw_weighed(const Place& at, double random, std::uint64_t key, std::span<Drawn> drawn) const;

  class Cut;
  class Slots;

  /// How many of a node's lights may be drawn, of so many.
  double most(const Node& node, double rays) const { return has_area_ ? rays : double(node.count); }
  void collect(std::uint32_t node, const Place& at, Cut& cut) const;
  void descend(std::uint32_t node, double begin, double end, Slots& slots) const;

  std::vector<Light> lights_;
  std::vector<RgbF> colours_;
  std::optional<Rgb> common_emission_;
  bool has_area_ = false;
  std::uint64_t hash_ = 0;
  std::vector<std::uint32_t> order_,
      places_;  ///< lights in the order of the leaves, and where each of them is there
  std::vector<Node> nodes_;
  std::shared_ptr<const LampTable> lamps_;  ///< in the leaves' order; null: nodes are weighed
};

/// Maximum number of delta lights, and of area lights, that are all traced.
inline constexpr std::size_t kMostTraced = 16;

/// True if with_trees changes the lights.
bool are_many(std::span<const Light> lights);

/// The lights with those that are more than kMostTraced replaced by a tree of them (ManyLights), as one light where all
/// have one colour, else as one a channel. The others stay as they are, before the trees.
/// in    lights: recentred
std::vector<Light> with_trees(std::vector<Light> lights);

}  // namespace opaline
