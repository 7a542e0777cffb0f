// SPDX-License-Identifier: GPL-3.0-or-later
#include "exitance/expansion.h"

namespace opaline {
Expansion Expansion::around(const Vec3f& e) const {
  Expansion out = *this;
  for (std::size_t c = 0; c < 3; ++c) {
    const std::array<float, 6>& h = hessian[c];
    const Vec3f s{slope[c][0], slope[c][1], slope[c][2]};
    const Vec3f he{h[0] * e.x + h[3] * e.y + h[4] * e.z, h[3] * e.x + h[1] * e.y + h[5] * e.z,
                   h[4] * e.x + h[5] * e.y + h[2] * e.z};
    const Vec3f change = e * bend[c] + he * 2.0f;
    out.value[c] += dot(change - s * 2.0f, e);
    for (std::size_t axis = 0; axis < 3; ++axis) out.slope[c][axis] -= change[axis];
  }
  return out;
}

}  // namespace opaline
