// SPDX-License-Identifier: GPL-3.0-or-later
// What random walks say of their own error, against the spread over seeds.
#include "support/statistics.h"
#include "volume/lit_body.h"

namespace opaline {
namespace {

using namespace test;

LitBody lit_torus() {
  LitBody body(TorusShape{{}, 3, 1.2, 4}, 150);
  body.medium = {.03, 1, .3, 1.4};
  body.light({PointLight{{0, 20, 5}, Rgb(100)}});
  return body;
}

/// Rms over the surface of a cell's figure over its scale, as VolumeExitance::relative_error has it.
template <class Figure>
double relative_rms(const LitBody& body, const std::vector<double>& truth, const Figure& figure) {
  const double largest = *std::ranges::max_element(truth);
  double sum = 0, area = 0;
  for (std::size_t i = 0; i < truth.size(); ++i) {
    const double a = double(body.surface.samples[i].area);
    sum += a * std::pow(figure(i), 2) / (truth[i] * truth[i] + 1e-4 * largest * largest);
    area += a;
  }
  return std::sqrt(sum / area);
}

// Claim: the standard errors of cells are the spread of their values over seeds, and the one figure of them all is right
// too, with a fixed number of walks and where walks end at an error. Source: the definition of a standard error.
// Tolerance: of 40 seeds a spread is known to 11 % in each of 150 cells, 1 % in all of them; 6 %, and 10 % where walks end
// by what they estimate. Fails if: passes depend on each other, or the variance of the mean is that of a pass.
TEST(WalkErrors, AreTheSpreadOverSeeds) {
  const LitBody body = lit_torus();
  const std::size_t cells = body.surface.samples.size();
  for (const std::optional<double> until_error : {std::optional<double>(), std::optional<double>(.12)}) {
    std::vector<Mean> values(cells), variances(cells);
    Mean stated;
    for (std::uint64_t seed = 0; seed < 40; ++seed) {
      const VolumeExitance walked = body.walked(seed, until_error);
      stated.add(walked.relative_error);
      for (std::size_t i = 0; i < cells; ++i) {
        values[i].add(double(walked.exitance[i].x));
        variances[i].add(std::pow(double(walked.error[i].x), 2));
      }
    }
    std::vector<double> truth;
    for (const Mean& value : values) truth.push_back(value.mean());
    const double spread = relative_rms(body, truth,
                                       [&](std::size_t i) { return std::sqrt(values[i].variance()); }),
                 error =
                     relative_rms(body, truth, [&](std::size_t i) { return std::sqrt(variances[i].mean()); });
    const double tolerance = until_error ? .1 : .06;
    EXPECT_NEAR(error / spread, 1, tolerance);
    EXPECT_NEAR(stated.mean() / spread, 1, tolerance + .04);  // its scale is each seed's own exitance
    if (until_error) {
      EXPECT_LE(stated.mean(), *until_error);
      EXPECT_GT(stated.mean(), .85 * *until_error);
    }
  }
}

// Claim: twice the passes have an error less by the root of two. Source: independence of passes. Tolerance: 5 %. Fails
// if: passes repeat each other's random numbers.
TEST(WalkErrors, FallWithTheRootOfWalks) {
  const LitBody body = lit_torus();
  const VolumeExitance some = body.walked(1, .2), more = body.walked(1, .1);
  const double walks = double(more.walks) / double(some.walks);
  EXPECT_NEAR(some.relative_error / more.relative_error, std::sqrt(walks), .08 * std::sqrt(walks));
}

// Claim: what is said to be done of walks until an error never falls by more than a tenth, and is unknown before there
// is a noise to tell it by. Source: Monitor. Fails if: the least number of passes is taken for all of them (98 %, then 1).
TEST(WalkErrors, ProgressGoesForwards) {
  LitBody body = lit_torus();
  Monitor monitor;
  VolumeInput input = body.input(7, .03);
  input.monitor = &monitor;
  VolumeSums sums;
  double last = 0;
  std::size_t passes = 0;
  walk_volume(input, sums, [&](const VolumeSums&) {
    const double total = double(monitor.total), fraction = total > 0 ? double(monitor.done) / total : 0;
    EXPECT_GE(fraction, last - .1) << passes;
    last = fraction;
    ++passes;
  });
  EXPECT_GT(passes, 9u);
  EXPECT_GT(last, .8);
}

// Claim: stopped after any pass and gone on with, sums and exitance are those of walks in one go. Source: the header.
// Tolerance: none. Fails if: the sums leave out what decides which light and channel comes next.
TEST(WalkErrors, StoppedWalksGoOn) {
  LitBody body = lit_torus();
  body.light({DirectionalLight{{0, 0, -1}, Rgb(.1)}});
  const VolumeInput input = body.input(7, .2);
  VolumeSums whole, part;
  walk_volume(input, whole);
  struct Stop {};
  for (std::size_t passes = 0; passes < 3; ++passes) {
    std::size_t left = 2;
    try {
      walk_volume(input, part, [&](const VolumeSums&) {
        if (--left == 0) throw Stop();
      });
    } catch (const Stop&) {
    }
  }
  walk_volume(input, part);
  ASSERT_EQ(part.sources.size(), whole.sources.size());
  for (std::size_t s = 0; s < whole.sources.size(); ++s)
    for (std::size_t c = 0; c < 3; ++c) {
      EXPECT_EQ(part.sources[s].channels[c].passes, whole.sources[s].channels[c].passes);
      EXPECT_EQ(part.sources[s].channels[c].flux, whole.sources[s].channels[c].flux);
      EXPECT_EQ(part.sources[s].channels[c].roots, whole.sources[s].channels[c].roots);
    }
  EXPECT_EQ(exitance_of(input, part).exitance, volume_exitance(input).exitance);
}

}  // namespace
}  // namespace opaline
