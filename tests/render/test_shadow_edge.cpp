// SPDX-License-Identifier: GPL-3.0-or-later
// The whole renderer across a shadow's edge, against the same diffusion sampled at random.
#include <gtest/gtest.h>

#include <algorithm>
#include <ostream>

#include "support/shadow_edge_line.h"

namespace opaline::test {
namespace {

struct EdgeBound {
  const char* name;
  bool wide;
  ProfileKind profile;
  double mean, max;  ///< of the error, over the brightest pixel of the line
};

/// In the test's name; without it the bytes of the struct would be.
void PrintTo(const EdgeBound& bound, std::ostream* out) {
  *out << bound.name;
}

class ShadowEdge : public testing::TestWithParam<EdgeBound> {};

// Claim: across the edge of a shadow on a floor, at the default of 10,000 samples, .2 mm or .4 mean free
// paths apart, `hierarchical` is within the bounds below of `direct`, point by point and by a surface cache:
// narrower than the mean free path (0 mm) and wider (4.2 mm), both profiles. Source: the same BSSRDF sampled
// at random, 262k entries a pixel; error over the brightest pixel. Tolerance: 1.5 times the measured mean and
// max, in which direct's own noise, below .15 % rms, is contained. Fails if: the near field takes no E from
// around the point (NearFieldSampler; mean .30 to .35 %), or samples beside the edge keep their own point's E
// (narrow: mean .56 %, max 2.7 % before the former was mended).
TEST_P(ShadowEdge, IsWithinItsBounds) {
  const EdgeBound& bound = GetParam();
  const EdgeLine line = shadow_edge_line(shadow_edge_scene(bound.wide, bound.profile), 262144);
  const double brightest = std::ranges::max(line.direct), darkest = std::ranges::min(line.direct);
  double noise = 0;
  for (const double n : line.noise) noise += std::pow(n / brightest, 2) / double(line.x.size());
  RecordProperty("noise", std::to_string(std::sqrt(noise)));
  EXPECT_LT(darkest, .2 * brightest);  // the line does cross the edge
  EXPECT_LE(std::sqrt(noise), .005);
  for (const std::vector<double>* picture : {&line.hierarchical, &line.cached}) {
    const std::string name = picture == &line.cached ? "cached_" : "";
    double mean = 0, max = 0;
    for (std::size_t i = 0; i < line.x.size(); ++i) {
      const double error = std::abs((*picture)[i] - line.direct[i]) / brightest;
      mean += error / double(line.x.size());
      max = std::max(max, error);
    }
    RecordProperty(name + "mean", std::to_string(mean));
    RecordProperty(name + "max", std::to_string(max));
    EXPECT_LE(mean, bound.mean) << name;
    EXPECT_LE(max, bound.max) << name;
  }
}

const auto name_of = [](const testing::TestParamInfo<EdgeBound>& edge) { return edge.param.name; };

// A minute each of a core: one narrow and one wide, one of each profile; the others are of the slow tier.
INSTANTIATE_TEST_SUITE_P(Edges, ShadowEdge,
                         testing::Values(EdgeBound{"NarrowDipole", false, ProfileKind::dipole, .0022, .0103},
                                         EdgeBound{"WideNormalizedDiffusion", true,
                                                   ProfileKind::normalized_diffusion, .0033, .0147}),
                         name_of);
INSTANTIATE_TEST_SUITE_P(LongEdges, ShadowEdge,
                         testing::Values(EdgeBound{"NarrowNormalizedDiffusion", false,
                                                   ProfileKind::normalized_diffusion, .0028, .0175},
                                         EdgeBound{"WideDipole", true, ProfileKind::dipole, .0021, .0062}),
                         name_of);

}  // namespace
}  // namespace opaline::test
