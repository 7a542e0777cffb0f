// SPDX-License-Identifier: GPL-3.0-or-later
// Boundary of a surface, for light from outside.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>

#include "geometry/surface_point.h"
#include "opaline/scene.h"
#include "transport/fresnel.h"
#include "transport/fuzz_layer.h"

namespace opaline {

/// Fuzz at a point: a mixture of two layers.
struct LocalFuzz {
  float weight = 0;
  const FuzzLayer* layer = nullptr;  ///< null: no fuzz
  const FuzzLayer* other = nullptr;  ///< null: the layer alone
  float share = 0;                   ///< weight of the other
  friend bool operator==(const LocalFuzz&, const LocalFuzz&) = default;

  float reflectance(float cosine) const {
    return mixed([&](const FuzzLayer& of) { return of.reflectance(cosine); });
  }
  float average_reflectance() const {
    return mixed([](const FuzzLayer& of) { return of.average_reflectance(); });
  }
  float value(float view, float light, float between) const {
    return mixed([&](const FuzzLayer& of) { return of.value(view, light, between); });
  }

 private:
  template <class Value>
  float mixed(const Value& value) const {
    if (layer == nullptr) return 0;
    if (other == nullptr) return weight * value(*layer);
    return weight * ((1 - share) * value(*layer) + share * value(*other));
  }
};

/// Fuzz with another weight or roughness at other points.
struct FuzzTextures {
  std::function<LocalFuzz(const SurfacePoint&)> at;
  std::uint64_t hash = 0;  ///< hash of the textures and the coordinates of their meshes
};

/// A smooth dielectric boundary or none, below fuzz or not. A rough boundary transmits as a smooth one.
class OuterBoundary {
 public:
  /// in    eta: inside / outside; 0: none, an opaque surface
  OuterBoundary(double eta = 0) : eta_(float(eta)) {}
  /// in    textures: unless null, replace the weight and roughness of the fuzz at a point
  OuterBoundary(double eta, const Fuzz& fuzz, std::shared_ptr<const FuzzTextures> textures = {})
      : eta_(float(eta)) {
    if (!(fuzz.weight > 0)) return;
    fuzz_ = {float(fuzz.weight), shared_fuzz(fuzz.roughness)};
    textures_ = std::move(textures);
  }
  friend bool operator==(const OuterBoundary& a, const OuterBoundary& b) {
    return a.eta_ == b.eta_ && a.fuzz_ == b.fuzz_ && a.hash() == b.hash();
  }

  float eta() const { return eta_; }
  bool has_fuzz() const { return fuzz_.layer != nullptr; }
  bool is_textured() const { return textures_ != nullptr; }
  /// The boundary at a point, without textures.
  OuterBoundary at(const SurfacePoint& point) const {
    if (textures_ == nullptr) return *this;
    OuterBoundary here;
    here.eta_ = eta_;
    here.fuzz_ = textures_->at(point);
    return here;
  }

  /// Light transmitted by both, over the incident light; with textures, by the fuzz of largest weight.
  /// in    cosine: of its direction, [0, 1]
  float transmittance(float cosine) const {
    const float entering = eta_ > 0 ? fresnel_transmittance(cosine, eta_) : 1.0f;
    return has_fuzz() ? entering * past_fuzz(cosine) : entering;
  }
  /// Fraction of light not scattered back by the fuzz.
  float past_fuzz(float cosine) const { return 1 - fuzz_.reflectance(cosine); }
  /// Its average over uniform light.
  float past_fuzz() const { return 1 - fuzz_.average_reflectance(); }
  /// BRDF of the fuzz if its fibres are white, 1/sr; as FuzzLayer::value.
  float fuzz_value(float view, float light, float between) const { return fuzz_.value(view, light, between); }

  /// The same, >= 0, for equal boundaries; seldom for others.
  float number() const {
    if (!has_fuzz()) return eta_;
    const float plain = eta_ + 1e3f * (fuzz_.weight + fuzz_.layer->reflectance(.5f));
    return textures_ == nullptr ? plain : plain + float(textures_->hash % 1000);
  }

 private:
  std::uint64_t hash() const { return textures_ == nullptr ? 0 : textures_->hash; }

  float eta_;
  LocalFuzz fuzz_ = {};
  std::shared_ptr<const FuzzTextures> textures_ = {};
};

}  // namespace opaline
