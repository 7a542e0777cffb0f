// SPDX-License-Identifier: GPL-3.0-or-later
#include "volume/entry_directions.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/random.h"
#include "transport/fresnel.h"

namespace opaline {
namespace {

constexpr std::size_t kOfLight = 8;    // per light that is not a point
constexpr std::size_t kAllAround = 5;  // uniform light, at an element with the mean flux or less

}  // namespace

EntryDirections towards_light(const Light& light, const BoundaryElement& element, double eta, std::size_t i) {
  const std::size_t tries = is_delta(light) ? 1 : kOfLight;
  EntryDirections found;
  double sum = 0;
  for (std::size_t t = 0; t < tries; ++t) {
    const LightSample sample =
        sample_light(light, element.position, element.normal, r2_point(i * tries + t, {.5, .5}), int(tries));
    const double cosine = double(dot(sample.direction, element.normal));
    if (!(sample.weight > 0 && cosine > 0)) continue;
    const double share = double(sample.weight) * cosine * fresnel_transmittance(std::min(cosine, 1.0), eta);
    found.add({sample.direction, share});
    sum += share;
  }
  if (!(sum > 0)) {
    found = {};
    found.add({element.normal, 1});
    sum = 1;
  }
  found.normalize(sum);
  return found;
}

EvenDirections::EvenDirections(std::span<const Rgb> flux, const Rgb& beside) {
  Rgb sum{};
  for (const Rgb& each : flux) sum += each;
  for (std::size_t c = 0; c < 3; ++c)
    if (sum[c] > 0) per_flux_[c] = double(flux.size()) / std::max(sum[c], beside[c]);
}

// In the channel with the largest share of all light. Doubled, as rounding of scaled lights then seldom matters.
std::size_t EvenDirections::count_for(const Rgb& flux) const {
  const double wanted = double(kAllAround) * max_component(flux * per_flux_);
  std::size_t count = kAllAround;
  while (double(count) * std::numbers::sqrt2 < wanted && count < EntryDirections::kMost) count *= 2;
  return count;
}

EntryDirections EvenDirections::at(const BoundaryElement& element, double eta, const Rgb& flux,
                                   std::size_t i) const {
  Vec3f x, y;
  tangent_frame(element.normal, x, y);
  EntryDirections found;
  double sum = 0;
  for (std::size_t n = 0, count = count_for(flux); n < count; ++n) {
    const auto [u, v] = r2_point(i * kAllAround + n, {.5, .5});
    const double sine = std::sqrt(u), cosine = std::sqrt(1 - u), angle = 2 * std::numbers::pi * v;
    const double share = fresnel_transmittance(cosine, eta);
    found.add({x * float(sine * std::cos(angle)) + y * float(sine * std::sin(angle)) +
                   element.normal * float(cosine),
               share});
    sum += share;
  }
  found.normalize(sum);
  return found;
}

}  // namespace opaline
