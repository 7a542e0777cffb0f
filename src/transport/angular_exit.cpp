// SPDX-License-Identifier: GPL-3.0-or-later
#include "transport/angular_exit.h"

#include <algorithm>

#include "transport/half_space.h"
#include "transport/smooth_boundary.h"

namespace opaline {
namespace {

constexpr std::size_t kPlaces = 65;

}  // namespace

AngularExit::AngularExit(const Rgb& absorbed, double eta) : table_(kPlaces, RgbF(1)) {
  for (std::size_t c = 0; c < 3; ++c) {
    const HalfSpace half_space(absorbed[c], eta);
    if (!(half_space.diffuse_share() > 0)) continue;
    for (std::size_t i = 0; i < kPlaces; ++i)
      table_[i][c] = float(half_space.share(refracted_cosine(double(i) / double(kPlaces - 1), 1 / eta)) /
                           half_space.diffuse_share());
  }
}

RgbF AngularExit::at(float cosine) const {
  const float place = std::clamp(cosine, 0.f, 1.f) * float(kPlaces - 1);
  const std::size_t i = std::min(kPlaces - 2, std::size_t(place));
  return table_[i] + (table_[i + 1] - table_[i]) * (place - float(i));
}

}  // namespace opaline
