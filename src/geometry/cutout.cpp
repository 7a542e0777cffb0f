// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/cutout.h"

#include "image/texture_file.h"
#include "image/uv_lookup.h"

namespace opaline {

bool Cutout::is_hole(std::uint32_t triangle, float u, float v) const {
  const CornerUvs& corners = uvs[triangle];
  if (corners == CornerUvs{}) return false;  // fills a hole of the mesh, without UVs
  std::array<float, 2> uv{};
  for (std::size_t i = 0; i < 2; ++i)
    uv[i] = corners[0][i] * (1 - u - v) + corners[1][i] * u + corners[2][i] * v;
  constexpr std::array<std::array<double, 2>, 2> kPoint{};
  const auto texel = opacity.source->image()->at(uv_lookup(opacity, uv, kPoint));
  return texel[opacity.channel] * float(opacity.scale.x) < kHoleOpacity;
}

void pass_holes(const RTCFilterFunctionNArguments* arguments) {
  const auto& cutout = *static_cast<const Cutout*>(arguments->geometryUserPtr);
  const unsigned count = arguments->N;
  for (unsigned i = 0; i < count; ++i)
    if (arguments->valid[i] != 0 &&
        cutout.is_hole(RTCHitN_primID(arguments->hit, count, i), RTCHitN_u(arguments->hit, count, i),
                       RTCHitN_v(arguments->hit, count, i)))
      arguments->valid[i] = 0;
}

}  // namespace opaline
