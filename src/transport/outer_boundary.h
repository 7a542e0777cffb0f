// SPDX-License-Identifier: GPL-3.0-or-later
// Boundary of a surface, for light from outside.
#pragma once

#include <memory>

#include "opaline/scene.h"
#include "transport/fresnel.h"
#include "transport/fuzz_layer.h"

namespace opaline {

/// A smooth dielectric boundary or none, below fuzz or not. A rough boundary transmits as a smooth one.
class OuterBoundary {
 public:
  /// in    eta: inside / outside; 0: none, an opaque surface
  OuterBoundary(double eta = 0) : eta_(float(eta)) {}
  OuterBoundary(double eta, const Fuzz& fuzz) : eta_(float(eta)) {
    if (!(fuzz.weight > 0)) return;
    fuzz_ = shared_fuzz(fuzz.roughness);
    weight_ = float(fuzz.weight);
  }
  friend bool operator==(const OuterBoundary&, const OuterBoundary&) = default;

  float eta() const { return eta_; }
  bool has_fuzz() const { return fuzz_ != nullptr; }

  /// Light transmitted by both, over the incident light.
  /// in    cosine: of its direction, [0, 1]
  float transmittance(float cosine) const {
    const float entering = eta_ > 0 ? fresnel_transmittance(cosine, eta_) : 1.0f;
    return fuzz_ == nullptr ? entering : entering * past_fuzz(cosine);
  }
  /// Fraction of light not scattered back by the fuzz.
  float past_fuzz(float cosine) const {
    return fuzz_ == nullptr ? 1 : 1 - weight_ * fuzz_->reflectance(cosine);
  }
  /// Its average over uniform light.
  float past_fuzz() const { return fuzz_ == nullptr ? 1 : 1 - weight_ * fuzz_->average_reflectance(); }
  /// BRDF of the fuzz if its fibres are white, 1/sr; as FuzzLayer::value.
  float fuzz_value(float view, float light, float between) const {
    return fuzz_ == nullptr ? 0 : weight_ * fuzz_->value(view, light, between);
  }

  /// The same, >= 0, for equal boundaries; seldom for others.
  float number() const { return fuzz_ == nullptr ? eta_ : eta_ + 1e3f * (weight_ + fuzz_->reflectance(.5f)); }

 private:
  float eta_, weight_ = 0;
  std::shared_ptr<const FuzzLayer> fuzz_ = {};
};

inline OuterBoundary boundary_of(const Medium& medium) {
  return {medium.eta, medium.fuzz};
}
inline OuterBoundary boundary_of_opaque(const Shape& shape) {
  return {shape.gloss ? shape.gloss->eta : 0, shape.fuzz};
}

}  // namespace opaline
