// SPDX-License-Identifier: GPL-3.0-or-later
// Irradiance at points that are not samples.
#include <gtest/gtest.h>

#include <complex>
#include <numbers>
#include <set>

#include "core/random.h"
#include "irradiance/sample_key.h"
#include "support/clouds.h"
#include "support/lighting.h"

namespace opaline {
namespace {

using namespace test;

struct PointsOfASphere {
  LitWorld lit{world_of({SphereShape{{}, 10}, BoxShape{{3, 12, 0}, {6, 13, 4}}})};
  std::vector<std::uint32_t> sphere_only = {0};
  std::vector<SurfaceSample> samples = sample_surface({lit.world, sphere_only, 500}).samples;
  std::vector<SurfacePoint> points;
  std::vector<std::uint64_t> keys;
  std::vector<Light> lights = {light_of(PointLight{{5, 20, 3}, {100, 200, 300}}),
                               light_of(DirectionalLight{normalized(Vec3d(.2, -1, .1)), {1, 0, 2}}),
                               light_of(SphereLight{{-15, 10, 0}, 3, {0, 3, 1}}),
                               light_of(QuadLight{{-4, 15, -4}, {8, 0, 0}, {0, 0, 8}, {1, 1, 0}}),
                               light_of(Surroundings{{.1, .2, .3}})};

  PointsOfASphere() {
    for (Light& light : lights) light = recentred(light, lit.world.origin);
    for (const SurfaceSample& s : samples) {
      points.push_back(point_of(lit.world, s));
      keys.push_back(points.size());
    }
  }
  std::vector<RgbF> at_points(double eta, int rays = 64) const {
    return irradiance_at({lit.rays, points, keys, lights, eta, rays});
  }
};

// Claim: at the samples' own places it is what compute_irradiance and combine_lights give for each sample
// alone; among others it would hold its whole cell's beside a shadow's edge (test_shadow_edges). Source: one
// integral. Tolerance: 1e-5 for delta lights; rms within 3 times the summed stated errors for area lights.
// Fails if: one of the two forgets Ft, shadows or a light.
TEST(IrradianceAtPoints, AgreesWithTheSamples) {
  PointsOfASphere scene;
  const std::vector<Light> all = scene.lights;
  for (const std::size_t kept : {2u, 5u}) {
    scene.lights.assign(all.begin(), all.begin() + std::ptrdiff_t(kept));
    const auto transfers = compute_irradiance({scene.lit.rays, scene.samples, scene.lights, 1.5, 256});
    const std::vector<RgbF> at = scene.at_points(1.5, 256);
    std::vector<RgbF> by_samples;
    for (const SurfaceSample& s : scene.samples)
      by_samples.push_back(combine_lights(
          compute_irradiance({scene.lit.rays, {&s, 1}, scene.lights, 1.5, 256}), scene.lights)[0]);
    double error = 1e-5;
    for (const LightTransfer& transfer : transfers) error += 3 * transfer.relative_error;
    ASSERT_EQ(at.size(), by_samples.size());
    for (std::size_t c = 0; c < 3; ++c) {
      std::vector<float> left;
      std::vector<double> right;
      for (std::size_t i = 0; i < at.size(); ++i) {
        left.push_back(at[i][c]);
        right.push_back(double(by_samples[i][c]));
      }
      EXPECT_LE(rms_error(left, right), error) << kept << " lights, channel " << c;
    }
  }
}

// Claim: eta 0 means no boundary: the cosine alone, as for eta 1 exactly; and not a division by 0. Source:
// irradiance.h. Tolerance: 3e-4 relative: at eta 1 Fresnel's formula in floats still reflects a little at
// grazing angles, where 1 - cos^2 rounds. Fails if: eta 0 goes into Fresnel's formula.
TEST(IrradianceAtPoints, EtaZeroIsNoBoundary) {
  const PointsOfASphere scene;
  const std::vector<RgbF> none = scene.at_points(0), matched = scene.at_points(1);
  for (std::size_t i = 0; i < none.size(); ++i)
    for (std::size_t c = 0; c < 3; ++c) ASSERT_NEAR(none[i][c], matched[i][c], 3e-4f * matched[i][c]);
}

// Claim: a point's value hangs on the point and its key, not on its place in the list or the threads: a
// reversed list gives reversed bytes. Source: irradiance.h. Tolerance: none. Fails if: the index in the list
// is the key.
TEST(IrradianceAtPoints, OrderAndThreadsDoNotMatter) {
  PointsOfASphere scene;
  const std::vector<RgbF> forward = with_threads(1, [&] { return scene.at_points(1.5); });
  EXPECT_TRUE(same_bytes(forward, with_threads(2, [&] { return scene.at_points(1.5); })));
  std::reverse(scene.points.begin(), scene.points.end());
  std::reverse(scene.keys.begin(), scene.keys.end());
  std::vector<RgbF> backward = scene.at_points(1.5);
  std::reverse(backward.begin(), backward.end());
  EXPECT_TRUE(same_bytes(forward, backward));
}

// Claim: the 16 rays of a pixel, with 4 light samples each, have together the light of one point with the 64 samples of
// one sequence; and no pixel that of another. Source: parts of a sequence are the whole. Tolerance: rounding. Fails if:
// each ray of a pixel begins its own sequence, as it did: its mean then has four times the variance and more.
TEST(IrradianceAtPoints, RaysOfAPixelShareASequence) {
  const PointsOfASphere scene;
  const auto at = [&](std::uint64_t key, int rays) {
    return irradiance_at({scene.lit.rays, {&scene.points[7], 1}, {&key, 1}, scene.lights, 1.5, rays})[0];
  };
  RgbF mean, last;
  for (const std::uint64_t pixel : {0u, 1u, 5000u}) {
    mean = {};
    for (std::uint64_t s = 0; s < 16; ++s) mean += at(key_in_pixel(16 * pixel + s, 16), 4) * (1.0f / 16);
    std::uint64_t first = 0;
    while (part_of(key_in_pixel(16 * pixel + first, 16)).part != 0) ++first;
    const RgbF whole = at(key_in_pixel(16 * pixel + first, 16), 64);
    for (std::size_t c = 0; c < 3; ++c) EXPECT_NEAR(mean[c] / whole[c], 1, 1e-5);
    EXPECT_NE(whole, last);
    last = whole;
  }
}

/// exp(2 pi i k v) of a place v in a square, for k of -2 to 2 along both sides.
std::array<std::complex<double>, 25> waves(const std::array<double, 2>& place) {
  std::array<std::complex<double>, 25> found;
  for (int i = 0; i < 25; ++i)
    found[std::size_t(i)] =
        std::polar(1.0, 2 * std::numbers::pi * ((i % 5 - 2) * place[0] + (i / 5 - 2) * place[1]));
  return found;
}

// Claim: where a camera ray goes through its pixel does not tell which way its light rays go: of pairs of waves over
// both squares the mean over a pixel's rays has an rms over pixels of at most 1.2 times that of as many random
// pairs, 1 / sqrt(rays); and a pixel's parts are all different. Source: independent draws. Fails if: parts are in the
// order of the rays, both points of the R2 sequence (sqrt(rays): 256 light rays had the noise of 64).
TEST(SampleKey, LightRaysDoNotHangOnTheirPlaceInThePixel) {
  constexpr std::uint64_t kPixels = 500;
  constexpr std::size_t kEven = 12;  // the wave that is 1
  for (const std::uint64_t rays : {16u, 49u, 64u, 256u}) {
    std::array<std::array<double, 25>, 25> squares{};
    for (std::uint64_t pixel = 0; pixel < kPixels; ++pixel) {
      std::array<std::array<std::complex<double>, 25>, 25> sums{};
      for (std::uint64_t s = 0; s < rays; ++s) {
        const auto place = waves(r2_point(s, {})),
                   light = waves(r2_point(part_of(key_in_pixel(rays * pixel + s, rays)).part, {}));
        for (std::size_t i = 0; i < 25; ++i)
          for (std::size_t j = 0; j < 25; ++j) sums[i][j] += place[i] * light[j];
      }
      for (std::size_t i = 0; i < 25; ++i)
        for (std::size_t j = 0; j < 25; ++j) squares[i][j] += std::norm(sums[i][j]);
    }
    double worst = 0;
    for (std::size_t i = 0; i < 25; ++i)
      for (std::size_t j = 0; j < 25; ++j)
        if (i != kEven && j != kEven) worst = std::max(worst, squares[i][j] / double(kPixels * rays));
    report(std::to_string(rays) + " rays, worst rms over that of random pairs", std::sqrt(worst));
    EXPECT_LT(std::sqrt(worst), 1.2) << rays;
    std::set<std::uint64_t> parts;
    for (std::uint64_t s = 0; s < rays; ++s) parts.insert(part_of(key_in_pixel(rays * 7 + s, rays)).part);
    EXPECT_EQ(parts.size(), rays);
    EXPECT_EQ(*parts.rbegin(), rays - 1);
  }
}

}  // namespace
}  // namespace opaline
