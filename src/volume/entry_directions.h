// SPDX-License-Identifier: GPL-3.0-or-later
// Directions of light entering a boundary element, as few as its smoothness allows.
#pragma once

#include <array>
#include <cstddef>
#include <span>

#include "lights/light.h"
#include "volume/boundary_elements.h"

namespace opaline {

struct EntryDirection {
  Vec3f outward;
  double share;  ///< fraction of the transmitted flux
};

class EntryDirections {
 public:
  static constexpr std::size_t kMost = 40;

  std::span<const EntryDirection> all() const { return std::span(some_).first(count_); }
  void add(const EntryDirection& one) { some_[count_++] = one; }
  /// Divides the shares by their sum.
  void normalize(double sum) {
    for (EntryDirection& one : std::span(some_).first(count_)) one.share /= sum;
  }

 private:
  std::array<EntryDirection, kMost> some_;
  std::size_t count_ = 0;
};

/// One direction to a point or directional light, several to others.
/// in    eta: relative index of refraction; i: index of the element, for directions different at neighbouring ones
EntryDirections towards_light(const Light& light, const BoundaryElement& element, double eta, std::size_t i);

/// Directions of uniform light, different at neighbouring elements, and more for elements brighter than the mean.
class EvenDirections {
 public:
  /// in    flux: transmitted uniform light of each element, W; beside: light leaving the body by other lights, W, which
  ///       hides noise
  EvenDirections(std::span<const Rgb> flux, const Rgb& beside);
  /// in    flux: of this element; others as for towards_light
  EntryDirections at(const BoundaryElement& element, double eta, const Rgb& flux, std::size_t i) const;

 private:
  std::size_t count_for(const Rgb& flux) const;

  Rgb per_flux_{};  // times the mean, per W
};

}  // namespace opaline
