// SPDX-License-Identifier: GPL-3.0-or-later
// Weights depend on the scene and the seed alone.
#include <gtest/gtest.h>
#include <tbb/task_arena.h>
#include <xmmintrin.h>

#include "support/lighting.h"

namespace opaline {
namespace {

using namespace test;

struct SampledTorus {
  LitWorld lit;
  std::vector<SurfaceSample> samples;
  std::vector<Light> lights;

  explicit SampledTorus(double k = 1)
      : lit(scaled(world_of({TorusShape{{}, 10, 4}, BoxShape{{3, 12, 0}, {6, 13, 4}}}), k)) {
    const std::vector<std::uint32_t> torus_only = {0};
    samples = sample_surface({lit.world, torus_only, 3000}).samples;
    lights = {unit_point(Vec3d(5, 20, 3) * k), unit_directional({.2, -1, .1}),
              unit_sphere_light(Vec3d(-15, 10, 0) * k, 3 * k),
              unit_quad_light(Vec3d(-4, 15, -4) * k, Vec3d(8, 0, 0) * k, Vec3d(0, 0, 8) * k),
              unit_surroundings()};
  }
  std::vector<LightTransfer> transfers(std::uint64_t seed = 0) const {
    return lit.transfers(samples, lights, 1.5, 64, seed);
  }
};

void expect_same(const std::vector<LightTransfer>& a, const std::vector<LightTransfer>& b) {
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t l = 0; l < a.size(); ++l) {
    EXPECT_TRUE(same_bytes(a[l].weights, b[l].weights)) << "light " << l;
    EXPECT_EQ(a[l].relative_error, b[l].relative_error) << "light " << l;
  }
}

// Claim: the same bytes with one thread, two, four in an arena of their own, and in a second run; another
// seed changes area lights' weights and leaves delta lights' alone. Source: the project's promise. Tolerance:
// none. Fails if: random numbers come from a generator per thread, or errors are summed in any order.
TEST(WeightBytes, AreTheSameForAnyThreads) {
  const SampledTorus scene;
  const auto run = [&] { return scene.transfers(); };
  const auto one = with_threads(1, run);
  expect_same(one, with_threads(2, run));
  expect_same(one, with_threads(2, run));
  expect_same(one, with_threads(4, [&] { return tbb::task_arena(4).execute(run); }));
  const auto other = scene.transfers(1);
  for (std::size_t l = 0; l < one.size(); ++l)
    EXPECT_EQ(same_bytes(one[l].weights, other[l].weights), is_delta(scene.lights[l])) << "light " << l;
}

// Claim: the caller's float mode neither changes the result nor is changed: weights have the same bytes with
// denormals flushed or not before the call, and the mode after the call is the one before. Source: every
// worker sets its mode deliberately; Embree asks for flushing. Tolerance: none. Fails if: the mode is set
// once for the first thread, or not restored.
TEST(WeightBytes, DoNotDependOnTheFloatMode) {
  const SampledTorus scene;
  const unsigned before = _mm_getcsr();
  std::vector<std::vector<LightTransfer>> results;
  for (const unsigned mode : {before & ~0x8040u, before | 0x8040u}) {
    _mm_setcsr(mode);
    results.push_back(with_threads(1, [&] { return scene.transfers(); }));
    EXPECT_EQ(_mm_getcsr() & 0xFFC0u, mode & 0xFFC0u);
  }
  _mm_setcsr(before);
  expect_same(results[0], results[1]);
}

// Claim: all lengths times a power of two leave every weight's bits, but point lights' which fall by exactly
// k^2. Source: the extremes that must hold. Tolerance: none. Fails if: an offset or a smallest distance in mm
// is written down.
TEST(WeightBytes, ScaleByAPowerOfTwoIsExact) {
  const auto plain = SampledTorus().transfers();
  for (const double k : {16., 1. / 256}) {
    SCOPED_TRACE(k);
    auto transfers = SampledTorus(k).transfers();
    for (float& weight : transfers[0].weights) weight *= float(k * k);
    expect_same(plain, transfers);
  }
}

// Claim: a scene 1e6 mm from the origin has the weights of the centred one. Source: the extremes that must
// hold. Tolerance: .1 % of the mean, rms; for area lights plus nothing, as the same points are drawn. Fails
// if: lights are not moved with the world, or positions pass through floats before they are centred.
TEST(WeightBytes, FarFromTheOriginIsTheSame) {
  const auto at = [](const Vec3d& o) {
    const LitWorld scene(world_of({SphereShape{o, 10}}));
    return scene.transfers(samples_at_centroids(scene.world, 7),
                           {unit_point(o + Vec3d(5, 20, 3)), unit_sphere_light(o + Vec3d(-15, 10, 0), 3),
                            unit_quad_light(o + Vec3d(-4, 15, -4), {8, 0, 0}, {0, 0, 8})},
                           1.5);
  };
  const auto centred = at({}), far = at({1e6, -1e6, 1e6});
  for (std::size_t l = 0; l < centred.size(); ++l)
    EXPECT_LE(rms_error(far[l].weights, {centred[l].weights.begin(), centred[l].weights.end()}), .001) << l;
}

}  // namespace
}  // namespace opaline
