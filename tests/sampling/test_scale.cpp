// SPDX-License-Identifier: GPL-3.0-or-later
// The unit of length does not matter.
#include <gtest/gtest.h>

#include "support/surfaces.h"

namespace opaline {
namespace {

using namespace test;

// Claim: with all coordinates times a power of two, the same triangles and barycentrics to the bit, positions
// and radius times k, areas times k^2, exactly. Source: scaling by a power of two changes exponents
// only. Tolerance: none. Fails if: a length in mm (an epsilon, a smallest cell) is written into the sampler.
TEST(SampleScale, ByAPowerOfTwoIsExact) {
  for (const auto& [name, world] : table_of_worlds()) {
    const SurfaceSamples plain = samples_on(world, 3000);
    for (const double k : {8., 1. / 1024}) {
      SCOPED_TRACE(name + " x " + std::to_string(k));
      SurfaceSamples surface = samples_on(scaled(world, k), 3000);
      EXPECT_EQ(surface.radius, plain.radius * k);
      EXPECT_EQ(surface.area, plain.area * k * k);
      for (SurfaceSample& s : surface.samples) {
        s.position *= float(1 / k);
        s.centroid *= float(1 / k);
        s.area *= float(1 / k / k);
      }
      EXPECT_TRUE(same_bytes(plain.samples, surface.samples));
    }
  }
}

}  // namespace
}  // namespace opaline
