// SPDX-License-Identifier: GPL-3.0-or-later
// Ten million samples in bounded memory.
#include <gtest/gtest.h>

#include <cmath>

#include "core/stopwatch.h"
#include "input/load_scene.h"
#include "support/scenes.h"

namespace opaline::test {
namespace {

// Claim: a picture of bunny-marble by the tree from 10 million samples takes at most 2 GiB, libraries and mesh included,
// and the samples keep the bars of rho and area though their rounds are thrown in parts. Source: the
// project's target. Measured: 1.82 GiB; per sample 56 bytes of itself, 20 of irradiance, 44 + about 50 in the
// tree, 8 while that is built. Tolerance: the bound itself. Fails if: a round's candidates, all pieces of the
// shares, or the tree's input beside its nodes are kept at once (2.9 GiB). The peak is that of the process:
// run it alone.
TEST(LongMemory, TenMillionSamplesFitInTwoGiB) {
  const std::vector<std::string> overrides{"film.resolution=[64,64]", "settings.samples=10000000",
                                           "settings.max_samples=10000000", "settings.method=hierarchical",
                                           "settings.bounces=0"};
  const Prepared prepared(load_scene(std::string(OPALINE_SCENES_DIR) + "/bunny-marble.json", overrides));
  EXPECT_GT(prepared.picture().pixels.size(), 0u);
  RecordProperty("peak_bytes", std::to_string(peak_memory()));
  EXPECT_LT(peak_memory(), std::size_t(2) << 30);
  const SurfaceSamples& surface = prepared.bodies[0].surface;
  const double n = double(surface.samples.size());
  EXPECT_NEAR(n / 1e7, 1, 0.05);
  EXPECT_GE(surface.radius / std::sqrt(2 / std::sqrt(3.) * surface.area / n), 0.65);
  double area = 0;
  for (const SurfaceSample& s : surface.samples) area += double(s.area);
  EXPECT_NEAR(area / surface.area, 1, 1e-6);
}

}  // namespace
}  // namespace opaline::test
