// SPDX-License-Identifier: GPL-3.0-or-later
// Random walks through flat layers of isotropic scattering, along the depth alone.
#pragma once

#include <cmath>
#include <cstdint>
#include <span>

#include "core/random.h"
#include "diffusion/layered_medium.h"
#include "transport/fresnel.h"

namespace opaline::test {

struct WalkedReflectance {
  double value = 0, error = 0;
};

/// Reflected share of light entering along the normal; the same index outside below the last layer as above the first.
inline WalkedReflectance walked_reflectance(std::span<const FlatLayer> layers, double eta,
                                            std::uint64_t walks) {
  double sum = 0, square = 0;
  for (std::uint64_t w = 0; w < walks; ++w) {
    std::uint64_t count = 0;
    const auto random = [&] { return unit_double(hash_bits(w + 77, count++)); };
    double depth = 0, cosine = 1, weight = 1, reflected = 0;  // below the top of the layer
    std::size_t layer = 0;
    double left = -std::log(1 - random());
    while (weight > 0) {
      const FlatLayer& here = layers[layer];
      const double extinction = here.sigma_a + here.sigma_s_prime;
      const double ahead = cosine > 0 ? (here.thickness - depth) / cosine : depth / -cosine;
      if (left < extinction * ahead) {
        depth += cosine * left / extinction;
        weight *= here.sigma_s_prime / extinction;
        if (weight < .1) weight = random() < .5 ? 2 * weight : 0;
        cosine = 2 * random() - 1;
        left = -std::log(1 - random());
        continue;
      }
      left -= extinction * ahead;
      const bool is_up = cosine < 0;
      if (is_up ? layer > 0 : layer + 1 < layers.size()) {
        layer += is_up ? std::size_t(-1) : 1;
        depth = is_up ? layers[layer].thickness : 0;
        continue;
      }
      const double inside = std::abs(cosine), sine2 = (1 - inside * inside) * eta * eta;
      const double through = sine2 >= 1 ? 0 : fresnel_transmittance(std::sqrt(1 - sine2), eta);
      if (is_up) reflected += weight * through;
      weight *= 1 - through;
      depth = is_up ? 0 : here.thickness;
      cosine = -cosine;
    }
    sum += reflected;
    square += reflected * reflected;
  }
  const double mean = sum / double(walks);
  return {mean, std::sqrt((square / double(walks) - mean * mean) / double(walks))};
}

}  // namespace opaline::test
