// SPDX-License-Identifier: GPL-3.0-or-later
#include "image/view_transform.h"

#include <algorithm>
#include <cmath>

#include "core/rgb_primaries.h"

namespace opaline {
namespace {

/// Compresses values above `start` towards 1, and desaturates those far above.
Vec3d with_soft_highlights(const Vec3d& color, double start) {
  constexpr double kDesaturation = .15;
  const double peak = max_component(color), room = 1 - start;
  if (peak < start) return color;
  const double shown = 1 - room * room / (peak + room - start);
  const double kept = 1 / (kDesaturation * (peak - shown) + 1);
  return color * (shown / peak * kept) + Vec3d(shown * (1 - kept));
}

/// Subtracts the specular reflection of a dielectric in a white environment, so base colours are unchanged.
Vec3d neutral(const Vec3d& color) {
  constexpr double kMirrored = .04;
  const double least = min_component(color);
  const double off = least < 2 * kMirrored ? least - least * least / (4 * kMirrored) : kMirrored;
  return with_soft_highlights(color - Vec3d(off), .8 - kMirrored);
}

/// The sigmoid of AgX's default look, to 6th order.
double agx_contrast(double x) {
  constexpr double kPowers[] = {15.5, -40.14, 31.96, -6.868, .4298, .1191, -.00232};
  double sum = 0;
  for (const double factor : kPowers) sum = sum * x + factor;
  return sum;
}

Vec3d agx(const Vec3d& color) {
  constexpr ColorMatrix kInset{{{.842479062253094, .0784335999999992, .0792237451477643},
                                {.0423282422610123, .878468636469772, .0791661274605434},
                                {.0423756549057051, .0784336, .879142973793104}}};
  constexpr ColorMatrix kOutset{{{1.19687900512017, -.0980208811401368, -.0990297440797205},
                                 {-.0528968517574562, 1.15190312990417, -.0989611768448433},
                                 {-.0529716355144438, -.0980434501171241, 1.15107367264116}}};
  constexpr double kDarkest = -12.47393, kBrightest = 4.026069;  // stops
  Vec3d logarithmic = kInset * color;
  for (std::size_t c = 0; c < 3; ++c) {
    const double stops = std::clamp(std::log2(std::max(logarithmic[c], 1e-10)), kDarkest, kBrightest);
    logarithmic[c] = agx_contrast((stops - kDarkest) / (kBrightest - kDarkest));
  }
  Vec3d shown = kOutset * logarithmic;  // encoded for a display of gamma 2.2
  for (std::size_t c = 0; c < 3; ++c) shown[c] = std::pow(std::max(shown[c], 0.0), 2.2);
  return shown;
}

Vec3d shown(ViewTransform view, const Vec3d& color) {
  switch (view) {
    case ViewTransform::soft:
      return with_soft_highlights(color, .8);
    case ViewTransform::neutral:
      return neutral(color);
    case ViewTransform::agx:
      return agx(color);
    case ViewTransform::srgb:
      return color;
  }
  return color;
}

}  // namespace

RgbF shown_color(ViewTransform view, const RgbF& linear) {
  return RgbF(
      component_min(component_max(shown(view, component_max(Vec3d(linear), Vec3d(0))), Vec3d(0)), Vec3d(1)));
}

}  // namespace opaline
