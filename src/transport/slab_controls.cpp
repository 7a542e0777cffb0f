// SPDX-License-Identifier: GPL-3.0-or-later
#include "transport/slab_controls.h"

#include <algorithm>
#include <cmath>

namespace opaline {
namespace {

// The boundary layer: a larger rate would make flights along the gradient diverge.
constexpr double kFastRate = .97, kSteepestSlowRate = .9;

using Orders = std::array<double, SlabControls::kOrders>;

Orders legendre(double cosine) {
  Orders p{1, cosine};
  for (std::size_t l = 2; l < p.size(); ++l)
    p[l] = (double(2 * l - 1) * cosine * p[l - 1] - double(l - 1) * p[l - 2]) / double(l);
  return p;
}

/// Decay of diffusion far from the faces, per mean free path (Grosjean's diffusion coefficient).
double diffusion_rate(const HomogeneousMedium& medium) {
  const double albedo = medium.albedo(), anisotropic = albedo * medium.g;
  const double absorbed = (1 - albedo) / (1 - anisotropic);  // 1 - reduced albedo
  return std::sqrt(3 * absorbed / (1 + absorbed)) * (1 - anisotropic);
}

}  // namespace

SlabControls::SlabControls(const HomogeneousMedium& medium, double thickness)
    : medium_(medium),
      is_half_space_(!std::isfinite(thickness)),
      optical_thickness_(medium.sigma_t() * thickness),
      rates_used_(is_half_space_ ? 3 : kRates) {
  double slow = diffusion_rate(medium);
  if (!is_half_space_) slow = std::max(slow, .5 / optical_thickness_);  // about linear across the slab
  slow = std::min(slow, kSteepestSlowRate);
  rates_ = {0, -slow, -kFastRate, slow, kFastRate};
  near_ = exponentials(0);
  far_ = is_half_space_ ? Exponentials{1} : exponentials(optical_thickness_);
  damping_[0] = 1;
  for (std::size_t l = 1; l < kOrders; ++l) damping_[l] = damping_[l - 1] * medium.g;
}

SlabControls::Exponentials SlabControls::exponentials(double depth) const {
  const double slow = std::exp(rates_[1] * depth), fast = std::exp(rates_[2] * depth);
  if (is_half_space_) return {1, slow, fast, 0, 0};
  const double height = std::max(0.0, optical_thickness_ - depth);  // above the far face
  return {1, slow, fast, std::exp(rates_[1] * height), std::exp(rates_[2] * height)};
}

/// A flight from depth t with upward cosine mu: exp(rate t) becomes the mean over free paths s of exp(rate (t
/// - mu s)); a collision damps order l by albedo g^l; a reflection negates mu.
void SlabControls::visit(const WalkState& walk, const Crossing& crossing, Sums& sums) const {
  const double cosine = walk.direction.z, uncollided = 1 - crossing.collided;
  const Exponentials here = exponentials(-walk.position.z * medium_.sigma_t());
  const Exponentials& face = cosine > 0 ? near_ : far_;
  const Orders p = legendre(cosine);
  for (std::size_t m = 0; m < rates_used_; ++m) {
    const double before = walk.weight * here[m];
    const double collided =
        walk.weight * medium_.albedo() * (here[m] - uncollided * face[m]) / (1 + rates_[m] * cosine);
    const double reflected = walk.weight * uncollided * crossing.reflectance * face[m];
    for (std::size_t l = 0; l < kOrders; ++l)
      sums[m * kOrders + l] +=
          p[l] * (before - damping_[l] * collided - (l % 2 == 0 ? reflected : -reflected));
  }
}

void SlabControls::add(const WalkState& walk, double weight, Sums& sums) const {
  const Exponentials here = exponentials(-walk.position.z * medium_.sigma_t());
  const Orders p = legendre(walk.direction.z);
  for (std::size_t m = 0; m < rates_used_; ++m)
    for (std::size_t l = 0; l < kOrders; ++l) sums[m * kOrders + l] += weight * here[m] * p[l];
}

}  // namespace opaline
