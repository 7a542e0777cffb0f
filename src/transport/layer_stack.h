// SPDX-License-Identifier: GPL-3.0-or-later
// Random walks through flat layers of different media.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <span>
#include <vector>

#include "transport/laboratory.h"
#include "transport/random_walk.h"

namespace opaline {

/// Layers from the face of entry at z = 0 downwards, without reflection between them.
class LayerStack {
 public:
  /// layers: at least one, all but the last of finite thickness
  explicit LayerStack(std::span<const SlabLayer> layers) : layers_(layers.begin(), layers.end()) {
    double depth = 0;
    for (const SlabLayer& layer : layers_) bottoms_.push_back(depth += layer.thickness);
  }

  /// The outer face along a ray, and the optical distance to it, in mean free paths.
  struct Ahead {
    BoundaryAhead face;
    double optical = 0;
  };
  Ahead ahead(const Vec3d& position, const Vec3d& direction) const {
    const double cosine = direction.z, depth = std::max(0., -position.z);
    const bool is_upwards = cosine > 0;
    Ahead result{{std::numeric_limits<double>::infinity(), {0, 0, is_upwards ? 1. : -1.}}, 0};
    const std::size_t here = layer_at(depth, is_upwards);
    if (cosine == 0) {
      result.optical = optical(here, result.face.distance);
    } else if (is_upwards) {
      result.face.distance = depth / cosine;
      for (std::size_t i = 0; i <= here; ++i)
        result.optical += optical(i, (std::min(depth, bottoms_[i]) - top_of(i)) / cosine);
    } else {
      if (std::isfinite(bottoms_.back()))
        result.face.distance = std::max(0., bottoms_.back() - depth) / -cosine;
      for (std::size_t i = here; i < layers_.size(); ++i)
        result.optical += optical(i, (bottoms_[i] - std::max(depth, top_of(i))) / -cosine);
    }
    return result;
  }

  /// Point along a ray at an optical distance, at most the end's, and its layer.
  struct Place {
    double distance;
    std::size_t layer;
  };
  Place place(const Vec3d& position, const Vec3d& direction, double optical_distance) const {
    const double cosine = direction.z;
    const bool is_upwards = cosine > 0;
    double depth = std::max(0., -position.z), left = optical_distance, distance = 0;
    std::size_t i = layer_at(depth, is_upwards), latest = i;
    if (cosine == 0) return {left / layers_[i].medium.sigma_t(), i};
    for (;;) {
      const double extinction = layers_[i].medium.sigma_t();
      const double across = (is_upwards ? depth - top_of(i) : bottoms_[i] - depth) / std::abs(cosine),
                   within = optical(i, across);
      const bool is_last = is_upwards ? i == 0 : i + 1 == layers_.size();
      if (extinction > 0) latest = i;
      // By rounding, the end of the last layer with matter may be passed.
      if (is_last && !(extinction > 0)) return {distance, latest};
      if (left < within || is_last) return {distance + std::min(across, left / extinction), i};
      left -= within;
      distance += across;
      depth = is_upwards ? top_of(i) : bottoms_[i];
      i += is_upwards ? std::size_t(-1) : 1;
    }
  }

  const HomogeneousMedium& medium(std::size_t layer) const { return layers_[layer].medium; }

 private:
  double top_of(std::size_t i) const { return i > 0 ? bottoms_[i - 1] : 0; }
  double optical(std::size_t i, double distance) const {
    const double extinction = layers_[i].medium.sigma_t();
    return extinction > 0 ? extinction * std::max(0., distance) : 0;
  }
  // On a face between two layers, the one ahead.
  std::size_t layer_at(double depth, bool is_upwards) const {
    const auto found =
        is_upwards ? std::ranges::lower_bound(bottoms_, depth) : std::ranges::upper_bound(bottoms_, depth);
    return std::min(std::size_t(found - bottoms_.begin()), layers_.size() - 1);
  }

  std::vector<SlabLayer> layers_;
  std::vector<double> bottoms_;  ///< depths
};

/// random_walk (random_walk.h) in a stack. Light unable to collide or to reach a face is unfinished.
template <class Watcher>
WalkEnd layered_walk(const LayerStack& stack, double eta, std::uint64_t most_collisions, WalkNumbers& numbers,
                     WalkState& walk, Watcher&& watcher) {
  constexpr double kLeastShare = .2;
  const double least = kLeastShare * walk.weight;
  WalkEnd end;
  for (;;) {
    if (walk.collisions >= most_collisions) {
      end.unfinished += walk.weight;
      return end;
    }
    const auto [face, optical] = stack.ahead(walk.position, walk.direction);
    const bool is_endless = !std::isfinite(face.distance);
    Crossing crossing{-std::expm1(-optical), 1};
    if (!is_endless && crossing.collided < 1)
      crossing.reflectance = inside_reflectance(dot(walk.direction, face.normal), eta);
    watcher.visit(walk, face, crossing);
    const double passing = 1 - crossing.collided,
                 leaving = is_endless ? passing : passing * (1 - crossing.reflectance);
    if (is_endless) {
      end.unfinished += walk.weight * passing;
    } else if (leaving > 0) {
      watcher.leave(WalkExit{walk.position + walk.direction * face.distance, walk.direction, face.normal,
                             walk.weight * leaving, walk.collisions});
    }
    walk.weight *= 1 - leaving;
    if (!(walk.weight > 0)) return end;
    const double share = numbers.next() * (1 - leaving);
    const bool collides = share < crossing.collided;
    if (collides) {
      const LayerStack::Place place = stack.place(walk.position, walk.direction, -std::log1p(-share));
      const HomogeneousMedium& medium = stack.medium(place.layer);
      walk.position += walk.direction * place.distance;
      ++walk.collisions;
      end.absorbed += walk.weight * (1 - medium.albedo());
      walk.weight *= medium.albedo();
      if (!survives_long(walk.weight, walk.collisions, numbers)) return end;
      if (!survives(walk.weight, least, numbers)) return end;
      walk.direction = scattered(walk.direction, medium.g, numbers);
    } else {
      walk.position += walk.direction * face.distance;
      if (!survives(walk.weight, least, numbers)) return end;
      walk.direction = mirrored(walk.direction, face.normal);
    }
  }
}

}  // namespace opaline
