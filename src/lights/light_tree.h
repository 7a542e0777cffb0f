// SPDX-License-Identifier: GPL-3.0-or-later
// Hierarchical importance sampling of many lights.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "lights/light.h"

namespace opaline {

class LampTable;

/// Point, spot, sphere and quad lights, or emitting shapes, in a binary tree. Each node bounds the positions, directions and
/// intensities of its lights. These bounds give the importance of a node at a point: the unshadowed
/// contribution of its lights, positive wherever one of them contributes. Lights are sampled by importance. A
/// light with an expected number of n draws has the weight 1 / n for each draw, so the estimate is unbiased.
/// If delta lights are few enough, the importance of each one is computed at each point, instead of that of
/// nodes.
/// from  Conty Estevez & Kulla 2018, Importance Sampling of Many Lights with Adaptive Tree Splitting: bounds,
///       importance and splitting; Madow 1949, systematic sampling: no light is drawn twice needlessly;
///       single lights are drawn one per stratum, so draws are independent
class LightTree {
 public:
  /// in    lights: recentred, of the kinds above; all of them is_delta, or none; at least one
  explicit LightTree(std::vector<Light> lights);

  const std::vector<Light>& lights() const { return lights_; }
  /// Common emission, if those of all lights are grey multiples of it; none: their colours differ.
  const std::optional<Rgb>& common_emission() const { return common_emission_; }
  /// Emission of a light, over the common one if it exists.
  const RgbF& colour(std::uint32_t light) const { return colours_[light]; }
  bool has_area() const { return has_area_; }
  /// Hash of all lights.
  std::uint64_t hash() const { return hash_; }
  /// Bounding sphere.
  LightExtent extent() const;

  /// Shading point.
  struct Place {
    Vec3f point, normal;         ///< normal: unit
    const Lobe* lobe = nullptr;  ///< for reflected light; null: for irradiance
  };

  struct Drawn {
    std::uint32_t light = 0;
    float expected = 0;  ///< expected number of samples; 0: not sampled
    float rest = 0;      ///< uniform in [0, 1), for a point of the light
    /// Unshadowed irradiance by `colour`, without a boundary, of lights with their own importance: of this
    /// light over `expected`, and its mean over all draws in this position of `drawn`. Black for other
    /// lights.
    RgbF unshadowed{}, mean_unshadowed{};
  };
  /// Samples drawn.size() lights, or fewer if fewer contribute, in a similar order for neighbouring points. A
  /// delta light with an expected number of 1 is sampled once; if they are no more than drawn.size(), each is
  /// sampled.
  /// in    random: in [0, 1); key: shared by draws with stratified `random`, selects the positions in the
  ///       strata
  void draw(const Place& at, double random, std::uint64_t key, std::span<Drawn> drawn) const;

  /// Expected number of draws of this light in one draw.
  double share(const Place& at, std::uint32_t light) const;

  /// Nearest area light on a ray before `far`.
  std::optional<std::uint32_t> first_met(const Vec3f& origin, const Vec3f& direction, float far) const;

  struct Node {
    Vec3f center{};
    float radius = 0;  ///< radius of a bounding sphere of its lights
    /// Axis of the cone of its lights' directions; a half angle of pi: all directions.
    Vec3f axis{};
    float cos_half = -1, sin_half = 0;
    /// Emission is full within one angle from the axis and 0 beyond another. In between it falls with the
    /// cosine, for spots with its square.
    float cos_full = -1, cos_reach = -1;
    bool fades_by_square = false;
    double brightness = 0;  ///< sum of intensities in the brightest direction, W/sr, mean of the channels
    std::uint32_t first = 0, count = 0;  ///< its lights, of those in the leaves' order
    std::uint32_t children = 0;          ///< the first of two nodes following each other; 0: a leaf
  };
  /// Bound of the contribution of a node's lights at a point: irradiance, W/mm^2, or a measure of reflected
  /// light.
  static double importance(const Node& node, const Place& at);
  /// Nodes, the root first.
  const std::vector<Node>& nodes() const { return nodes_; }

 private:
  void draw_weighed(const Place& at, double random, std::uint64_t key, std::span<Drawn> drawn) const;

  class Cut;
  class Slots;

  /// Maximum number of draws from a node, out of a total.
  double most(const Node& node, double rays) const { return has_area_ ? rays : double(node.count); }
  void collect(std::uint32_t node, const Place& at, Cut& cut) const;
  void descend(std::uint32_t node, double begin, double end, Slots& slots) const;

  std::vector<Light> lights_;
  std::vector<RgbF> colours_;
  std::optional<Rgb> common_emission_;
  bool has_area_ = false;
  std::uint64_t hash_ = 0;
  std::vector<std::uint32_t> order_,
      places_;  ///< lights in the order of the leaves, and each light's index there
  std::vector<Node> nodes_;
  std::shared_ptr<const LampTable> lamps_;  ///< in the leaves' order; null: weighted by nodes
};

/// Number of delta lights, and of area lights, up to which each is traced.
inline constexpr std::size_t kMostTraced = 16;

/// True if with_trees changes the lights.
bool are_many(std::span<const Light> lights);

/// Lights, with more than kMostTraced of a kind replaced by a tree of them (ManyLights): one light if they
/// share one colour, otherwise one per channel. Other lights are unchanged and precede the trees.
/// in    lights: recentred
std::vector<Light> with_trees(std::vector<Light> lights);

}  // namespace opaline
