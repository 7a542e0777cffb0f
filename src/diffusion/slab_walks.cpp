// SPDX-License-Identifier: GPL-3.0-or-later
#include "diffusion/slab_walks.h"

#include <cmath>

#include "core/random.h"
#include "transport/fresnel.h"

namespace opaline {
namespace {

/// Numbers of one walk.
class WalkNumbers {
 public:
  explicit WalkNumbers(std::uint64_t walk) : walk_(hash_bits(3003, walk)) {}
  double next() { return unit_double(hash_bits(walk_, count_++)); }

 private:
  std::uint64_t walk_, count_ = 0;
};

/// Samples the cosine inside of transmitted diffuse light.
double entering_cosine(double eta, WalkNumbers& numbers) {
  for (;;) {
    const double cosine = std::sqrt(1 - numbers.next());
    if (numbers.next() >= fresnel_transmittance(cosine, eta)) continue;
    const double sine = std::sqrt(1 - cosine * cosine) / eta;
    return std::sqrt(std::max(0.0, 1 - sine * sine));
  }
}

enum class End { absorbed, back, through };

End walk_through_slab(double reduced_albedo, double thickness, double eta, WalkNumbers& numbers) {
  double depth = 0, cosine = entering_cosine(eta, numbers);
  for (;;) {
    depth -= std::log(1 - numbers.next()) * cosine;
    while (depth < 0 || depth > thickness) {
      // Light meets the boundary from within, so the ratio of the indices is 1 / eta.
      if (numbers.next() >= fresnel_reflectance(std::abs(cosine), 1 / eta))
        return depth < 0 ? End::back : End::through;
      depth = depth < 0 ? -depth : 2 * thickness - depth;
      cosine = -cosine;
    }
    if (numbers.next() >= reduced_albedo) return End::absorbed;
    cosine = 1 - 2 * numbers.next();
  }
}

}  // namespace

SlabLight slab_by_walks(double reduced_albedo, double optical_thickness, double eta, std::size_t walks) {
  std::size_t back = 0, through = 0;
  for (std::size_t walk = 0; walk < walks; ++walk) {
    WalkNumbers numbers(walk);
    const End end = walk_through_slab(reduced_albedo, optical_thickness, eta, numbers);
    back += end == End::back ? 1 : 0;
    through += end == End::through ? 1 : 0;
  }
  return {double(back) / double(walks), double(through) / double(walks)};
}

SlabLight slab_by_profile(const ChannelProfile& profile, double thickness) {
  return {total_diffuse_reflectance(profile), total_diffuse_transmittance(profile, thickness)};
}

}  // namespace opaline
