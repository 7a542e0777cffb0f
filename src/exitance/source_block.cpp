// SPDX-License-Identifier: GPL-3.0-or-later
#include "exitance/source_block.h"

#include <xmmintrin.h>

#include <algorithm>
#include <cstddef>

namespace opaline {
namespace {

static_assert(offsetof(OctreeNode, flux) == 48 && offsetof(OctreeNode, center) == 64 &&
                  offsetof(OctreeNode, half) == 76 && offsetof(OctreeNode, spread) == 88,
              "rows of four floats are read across members");

// Floats [4 row, 4 row + 4) of four nodes, as four vectors of one field each.
struct Fields {
  __m128 a, b, c, d;

  Fields(const OctreeNode* nodes, const std::uint32_t* list, std::size_t row) {
    const auto load = [&](std::size_t i) {
      return _mm_load_ps(reinterpret_cast<const float*>(nodes + list[i]) + 4 * row);
    };
    a = load(0), b = load(1), c = load(2), d = load(3);
    _MM_TRANSPOSE4_PS(a, b, c, d);
  }
};

// Centroid of all channels, and largest distance of one from it, for four lanes.
void set_middle(SourceBlock& block, std::size_t lane) {
  for (std::size_t i = lane; i < lane + 4; ++i) {
    const float flux = block.flux[0][i] + block.flux[1][i] + block.flux[2][i];
    if (flux == 0) continue;
    const auto mean = [&](const float(&p)[3][kLanes]) {
      return (block.flux[0][i] * p[0][i] + block.flux[1][i] * p[1][i] + block.flux[2][i] * p[2][i]) / flux;
    };
    const Vec3f middle{mean(block.x), mean(block.y), mean(block.z)};
    for (std::size_t c = 0; c < 3; ++c) {
      block.all[c][i] = middle[c];
      if (block.flux[c][i] > 0)
        block.aside[i] =
            std::max(block.aside[i], length(Vec3f{block.x[c][i], block.y[c][i], block.z[c][i]} - middle));
    }
  }
  block.one_colour = false;
}

void gather_four(const OctreeNode* nodes, const std::uint32_t* list, std::size_t lane, SourceBlock& block) {
  const Fields x(nodes, list, 0), y(nodes, list, 1), z(nodes, list, 2), flux(nodes, list, 3),
      center(nodes, list, 4), half(nodes, list, 5), spread(nodes, list, 6);
  const auto store = [&](float(*to)[kLanes], const __m128& a, const __m128& b, const __m128& c) {
    _mm_store_ps(to[0] + lane, a);
    _mm_store_ps(to[1] + lane, b);
    _mm_store_ps(to[2] + lane, c);
  };
  store(block.x, x.a, x.b, x.c);
  store(block.y, y.a, y.b, y.c);
  store(block.z, z.a, z.b, z.c);
  store(block.all, x.a, y.a, z.a);
  store(block.flux, flux.a, flux.b, flux.c);
  store(block.center, center.a, center.b, center.c);
  store(block.half, center.d, half.a, half.b);
  store(block.spread, half.c, half.d, spread.a);
  store(block.spread + 3, spread.b, spread.c, spread.d);
  _mm_store_ps(block.size + lane, _mm_sqrt_ps(_mm_add_ps(half.c, _mm_add_ps(half.d, spread.a))));
  _mm_store_ps(block.aside + lane, _mm_setzero_ps());
  const auto differ = [](const Fields& p) {
    return _mm_or_ps(_mm_cmpneq_ps(p.a, p.b), _mm_cmpneq_ps(p.a, p.c));
  };
  if (_mm_movemask_ps(_mm_or_ps(differ(x), _mm_or_ps(differ(y), differ(z)))) != 0) set_middle(block, lane);
}

}  // namespace

void gather(const OctreeNode* nodes, std::span<const std::uint32_t> list, SourceBlock& block) {
  const std::size_t count = std::min<std::size_t>(kLanes, list.size());
  for (std::size_t i = 0; i < kLanes; ++i) block.node[i] = list[std::min(i, count - 1)];
  block.one_colour = true;
  for (std::size_t lane = 0; lane < kLanes; lane += 4) gather_four(nodes, block.node + lane, lane, block);
  for (std::size_t i = count; i < kLanes; ++i)
    for (auto& flux : block.flux) flux[i] = 0;
}

}  // namespace opaline
