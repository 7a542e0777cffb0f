// SPDX-License-Identifier: GPL-3.0-or-later
#include "lights/light_tree.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>

#include "core/random.h"
#include "lights/build_light_tree.h"
#include "lights/lamp_table.h"

namespace opaline {
namespace {

// Largest ratio of a node's radius to its distance without splitting.
constexpr float kWide = .5f;
// Fraction of the largest reflected contribution above which nodes are split to the width of the lobe.
constexpr float kMirrored = .03f;
// Weight of the cosine bound at the surface in a node's importance; the rest is the cosine of its centre.
// src/irradiance/README.md has the comparison.
constexpr float kBound = .25f;
// Added to cosines as a bound of rounding, so visible lights keep a nonzero probability.
constexpr float kRounding = 1e-3f;
// Maximum of lights without an area for individual weights: they take as long as the nodes of a cut.
constexpr std::size_t kMostWeighed = WeighedDraw::kMost;
// Maximum nodes of a cut, and reserve for the siblings on the last path.
constexpr std::size_t kMostInCut = 448, kMostDepth = 64;

/// Cosine and sine of an angle in [0, pi].
struct Angle {
  double cosine, sine;

  static Angle of_cosine(double cosine) { return {cosine, std::sqrt(std::max(0.0, 1 - cosine * cosine))}; }
  /// max(0, this - other)
  Angle less(const Angle& other) const {
    if (cosine >= other.cosine) return {1, 0};
    return {cosine * other.cosine + sine * other.sine, sine * other.cosine - cosine * other.sine};
  }
};

std::uint64_t hash_of(std::span<const Light> lights) {
  constexpr std::uint64_t kVersion = 4;  // raise on changes of the sampling: results are cached by the hash
  std::uint64_t hash = hash_bits(kVersion, lights.size());
  const auto add = [&](double value) { hash = hash_bits(hash, std::bit_cast<std::uint64_t>(value)); };
  for (const Light& light : lights) {
    hash = hash_bits(hash, light.source.index());
    for (const double value : geometry(light)) add(value);
    for (std::size_t c = 0; c < 3; ++c) add(emission(light)[c]);
  }
  return hash;
}

/// Upper bound of the lights' emission towards a point, over their maximum.
/// in    cosine: of the angle between the node's axis and the point, from its centre; ball: sine of half the
///       angle subtended by the node's ball
double facing(const LightTree::Node& node, float cosine, float ball) {
  const Angle off = Angle::of_cosine(std::clamp(double(cosine), -1.0, 1.0))
                        .less({double(node.cos_half), double(node.sin_half)})
                        .less({std::sqrt(std::max(0.0, 1 - double(ball) * double(ball))), double(ball)});
  const double reach = double(node.cos_reach) - double(kRounding), fading = double(node.cos_full) - reach,
               share = std::clamp((off.cosine - reach) / fading, 0.0, 1.0);
  return node.fades_by_square ? share * share : share;
}

/// True if a node's lights are equivalent at a point.
bool is_narrow(const LightTree::Node& node, const LightTree::Place& at) {
  const Vec3f to = node.center - at.point;
  const float d2 = dot(to, to), r2 = node.radius * node.radius;
  if (r2 > kWide * kWide * d2) return false;
  if (at.lobe == nullptr || r2 <= at.lobe->alpha * at.lobe->alpha * d2) return true;
  const float per_d = 1 / std::sqrt(d2);
  return mirrored(*at.lobe, (dot(at.lobe->mirrored, to) + node.radius) * per_d) < kMirrored;
}

/// Emission of the brightest light, if all others are multiples of it.
std::optional<Rgb> common_emission_of(std::span<const Light> lights) {
  Rgb common{};
  for (const Light& light : lights)
    if (max_component(emission(light)) > max_component(common)) common = emission(light);
  for (const Light& light : lights)
    for (std::size_t c = 0; c < 3; ++c)
      if (emission(light)[c] * max_component(common) != common[c] * max_component(emission(light))) return {};
  return common;
}

}  // namespace

/// Nodes partitioning all lights, and the number of samples of each.
class LightTree::Cut {
 public:
  struct Part {
    std::uint32_t node;
    double importance, expected;
  };
  bool is_full() const { return size_ + kMostDepth >= parts_.size(); }
  void add(std::uint32_t node, double importance) { parts_[size_++] = {node, importance, 0}; }
  std::span<Part> parts() { return {parts_.data(), size_}; }

  /// Distributes samples by importance, with at most most(node) of each.
  void share_out(double rays, const auto& most) {
    for (bool has_changed = true; has_changed;) {
      has_changed = false;
      double left = rays, importance = 0;
      for (const Part& part : parts())
        if (part.expected > 0)
          left -= part.expected;
        else
          importance += part.importance;
      if (!(importance > 0)) return;
      for (Part& part : parts())
        if (const double limit = most(part.node);
            !(part.expected > 0) && part.importance * left >= limit * importance) {
          part.expected = limit;
          has_changed = true;
        }
      if (has_changed) continue;
      for (Part& part : parts())
        if (!(part.expected > 0)) part.expected = left * part.importance / importance;
    }
  }

 private:
  std::array<Part, kMostInCut + kMostDepth> parts_;
  std::size_t size_ = 0;
};

/// Systematic sampling at random, random + 1, ... of the lights in order, with lengths equal to their
/// expected samples.
class LightTree::Slots {
 public:
  Slots(const Place& place_, double random, std::span<Drawn> drawn)
      : place(place_), random_(random), drawn_(drawn) {}

  bool any_before(double end) const { return next_ < drawn_.size() && random_ + double(next_) < end; }
  void take(std::uint32_t light, double begin, double end) {
    const double within = (random_ + double(next_) - begin) / (end - begin);
    drawn_[next_++] = {light, float(end - begin), std::clamp(float(within), 0.f, 0x1.fffffep-1f)};
  }
  /// Skips a sample.
  void skip() { ++next_; }

  const Place& place;

 private:
  double random_;
  std::span<Drawn> drawn_;
  std::size_t next_ = 0;
};

LightTree::LightTree(std::vector<Light> lights)
    : lights_(std::move(lights)),
      common_emission_(common_emission_of(lights_)),
      has_area_(!is_delta(lights_[0])),
      hash_(hash_of(lights_)) {
  for (const Light& light : lights_) {
    const Rgb own = emission(light);
    const double brightest = common_emission_ ? max_component(*common_emission_) : 0;
    colours_.push_back(brightest > 0 ? RgbF(Rgb(max_component(own) / brightest)) : RgbF(own));
  }
  BuiltLightTree built = build_light_tree(lights_);
  nodes_ = std::move(built.nodes);
  order_ = std::move(built.order);
  places_.resize(order_.size());
  for (std::uint32_t i = 0; i < order_.size(); ++i) places_[order_[i]] = i;
  if (!has_area_ && lights_.size() <= kMostWeighed)
    lamps_ = std::make_shared<const LampTable>(lights_, order_, colours_);
}

LightExtent LightTree::extent() const {
  const Node& root = nodes_[0];
  return {.center = Vec3d(root.center), .radius = double(root.radius), .width = 2 * double(root.radius)};
}

// The cosine at the surface is interpolated between that of the ball's centre and an upper bound over its
// lights. The bound alone is positive for all visible lights, but overestimates wide nodes. Inside the ball, only its
// part in front of the surface counts: at an emitting sphere itself, almost none.
double LightTree::importance(const Node& node, const Place& at) {
  const Vec3f to = node.center - at.point;
  const float d2 = dot(to, to), r2 = node.radius * node.radius;
  if (d2 <= r2) {
    constexpr float kLeast = 1e-3f;  // bounds the weights of lights concentrated in front
    if (!(r2 > 0)) return 0;
    const float in_front = std::clamp(1 + dot(at.normal, to) / node.radius, kLeast, 1.f);
    return node.brightness / double(r2) * double(in_front);
  }
  const float per_d = 1 / std::sqrt(d2),
              ball = node.radius * per_d;  // sine of half the subtended angle
  const float middle = dot(at.normal, to) * per_d, bound = std::min(1.0f, middle + ball + kRounding);
  if (!(bound > 0)) return 0;
  const float cosine = at.lobe != nullptr ? mirrored(*at.lobe, dot(at.lobe->mirrored, to) * per_d + ball)
                                          : kBound * bound + (1 - kBound) * std::max(0.0f, middle);
  const double weight = node.brightness * double(cosine * per_d) * double(per_d);
  return node.cos_half > -1 ? weight * facing(node, -dot(node.axis, to) * per_d, ball) : weight;
}

void LightTree::collect(std::uint32_t node, const Place& at, Cut& cut) const {
  const Node& own = nodes_[node];
  const double weight = importance(own, at);
  if (!(weight > 0)) return;
  if (own.children == 0 || cut.is_full() || is_narrow(own, at)) return cut.add(node, weight);
  collect(own.children, at, cut);
  collect(own.children + 1, at, cut);
}

void LightTree::draw(const Place& at, double random, std::uint64_t key, std::span<Drawn> drawn) const {
  std::ranges::fill(drawn, Drawn{});
  if (lamps_ != nullptr && at.lobe == nullptr) return draw_weighed(at, random, key, drawn);
  Cut cut;
  collect(0, at, cut);
  const double rays = double(drawn.size());
  cut.share_out(rays, [&](std::uint32_t node) { return most(nodes_[node], rays); });
  Slots slots(at, random, drawn);
  double begin = 0;
  for (const Cut::Part& part : cut.parts()) {
    descend(part.node, begin, begin + part.expected, slots);
    begin += part.expected;
  }
}

/// Samples a node's lights, with total length [begin, end).
void LightTree::descend(std::uint32_t node, double begin, double end, Slots& slots) const {
  if (!slots.any_before(end)) return;
  const Node& own = nodes_[node];
  if (own.children == 0) {
    while (slots.any_before(end)) slots.take(order_[own.first], begin, end);
    return;
  }
  const Node &left = nodes_[own.children], &right = nodes_[own.children + 1];
  const double of_left = importance(left, slots.place), of_right = importance(right, slots.place),
               both = of_left + of_right, length = end - begin;
  if (both > 0) {
    const double most_left = of_left > 0 ? most(left, length) : 0,
                 most_right = of_right > 0 ? most(right, length) : 0,
                 at_left = std::min(length * of_left / both, most_left),
                 right_length = std::min(length - at_left, most_right),
                 left_length = std::min(length - right_length, most_left);
    descend(own.children, begin, begin + left_length, slots);
    descend(own.children + 1, begin + left_length, begin + left_length + right_length, slots);
  }
  while (slots.any_before(end)) slots.skip();
}

// Certain lights first.
void LightTree::draw_weighed(const Place& at, double random, std::uint64_t key,
                             std::span<Drawn> drawn) const {
  std::array<float, kMostWeighed> values;
  const std::span<float> weights(values.data(), lamps_->weights());
  lamps_->weigh(at.point, at.normal, weights);
  const WeighedDraw weighed(*lamps_, weights, double(drawn.size()));
  std::vector<WeighedDraw::Stratum> strata(drawn.size());
  const std::size_t sure = weighed.take_sure(strata);
  for (std::size_t s = sure; s < strata.size(); ++s) {
    const double place = random + unit_double(hash_bits(key, s));
    strata[s].place = place - std::floor(place);
  }
  weighed.take_others(std::span(strata).subspan(sure));
  for (std::size_t s = 0; s < strata.size(); ++s) {
    const auto& [place, lamp, expected, brought] = strata[s];
    if (expected > 0)
      drawn[s] = {order_[lamp], expected, .5f, lamps_->brought(lamp, weights[lamp]) * (1 / expected),
                  brought};
  }
}

double LightTree::share(const Place& at, std::uint32_t light) const {
  if (lamps_ != nullptr && at.lobe == nullptr) {
    std::vector<float> weights(lamps_->weights());
    lamps_->weigh(at.point, at.normal, weights);
    return WeighedDraw(*lamps_, weights, 1).expected(places_[light]);
  }
  Cut cut;
  collect(0, at, cut);
  const std::uint32_t place = places_[light];
  const auto has_it = [&](const Node& node) { return place - node.first < node.count; };
  double all = 0, share = 0;
  std::uint32_t node = 0;
  for (const Cut::Part& part : cut.parts()) {
    all += part.importance;
    if (has_it(nodes_[part.node])) node = part.node, share = part.importance;
  }
  if (!(share > 0)) return 0;
  share /= all;
  while (nodes_[node].children != 0) {
    const std::uint32_t left = nodes_[node].children, right = left + 1;
    const double of_left = importance(nodes_[left], at), of_right = importance(nodes_[right], at),
                 both = of_left + of_right;
    const bool is_left = has_it(nodes_[left]);
    if (!(both > 0)) return 0;
    share *= (is_left ? of_left : of_right) / both;
    node = is_left ? left : right;
  }
  return share;
}

std::optional<std::uint32_t> LightTree::first_met(const Vec3f& origin, const Vec3f& direction,
                                                  float far) const {
  std::optional<std::uint32_t> met;
  if (!has_area_) return met;
  const double per_square = 1 / double(dot(direction, direction));
  std::array<std::uint32_t, kMostDepth + 1> open{0};
  for (std::size_t count = 1; count > 0;) {
    const std::uint32_t index = open[--count];
    const Node& node = nodes_[index];
    const Vec3d to(node.center - origin);
    const double along = dot(to, Vec3d(direction)) * per_square,
                 r2 = double(node.radius) * double(node.radius);
    const Vec3d apart = to - Vec3d(direction) * along;
    const bool is_behind = along < 0 && dot(to, to) > r2 * (1 + double(kRounding));
    if (is_behind || dot(apart, apart) > r2 * (1 + double(kRounding))) continue;
    if (node.children != 0) {
      open[count++] = node.children + 1;
      open[count++] = node.children;
      continue;
    }
    const EmitterHit hit = intersect_emitter(lights_[order_[node.first]], origin, direction, far);
    if (!hit.hit) continue;
    met = order_[node.first];
    far = hit.t;
  }
  return met;
}

}  // namespace opaline
