// SPDX-License-Identifier: GPL-3.0-or-later
// Random walks inside meshes.
#include "opaline/diffusion/fresnel.h"
#include "opaline/volume/laboratory.h"
#include "volume/lit_body.h"

namespace opaline {
namespace {

using namespace test;

// Claim: a body that absorbs nothing in the same light from everywhere sends out all that enters, all over its
// surface: a white furnace. Source: conservation; symmetry of the sphere. Tolerance: the mean within 4 standard
// errors and .5 %, cells by their stated errors (reduced chi-square .8 to 1.25 of 500 cells). Fails if: the way
// in has no Ft, reflected light is lost, or cells are not those of the samples' areas.
TEST(VolumeExitance, WhiteFurnace) {
  for (const double eta : {1.0, 1.5}) {
    const LitBody body(SphereShape{{}, 4}, 500);
    const VolumeExitance walked = body.walked({0, 1, 0, eta}, Surroundings{Rgb(1)});
    const double entered = std::numbers::pi * (1 - average_reflectance_outside(eta));
    const WalkedValue mean = body.mean_where(walked, everywhere);
    EXPECT_NEAR(mean.value / entered, 1, .005 + 4 * mean.error / entered) << eta;
    double chi_square = 0;
    for (std::size_t i = 0; i < walked.exitance.size(); ++i)
      chi_square += std::pow((double(walked.exitance[i].x) - entered) / double(walked.error[i].x), 2);
    EXPECT_NEAR(chi_square / double(walked.exitance.size()), 1, .25) << eta;
    EXPECT_EQ(max_component(walked.lost), 0);
  }
}

// Claim: the middle of a wide plate sends back and lets through what the laboratory's slab does. Source: the same
// walks between two planes. Tolerance: 4 standard errors of both, and 1 %: light that leaves by the rim. Fails
// if: light enters unrefracted, or what crosses unscattered is not counted.
TEST(VolumeExitance, PlateIsTheLaboratorysSlab) {
  const HomogeneousMedium medium{.05, 1, 0, 1.3};
  const double thickness = 2;
  const LitBody body(SlabShape{{}, 60, 60, thickness}, 4000, NormalMode::faceted);
  const VolumeExitance walked = body.walked(medium, DirectionalLight{{0, -1, 0}, Rgb(1)});
  const auto is_inner = [&](const SurfaceSample& s) {
    const double x = double(s.position.x) * body.world.unit, z = double(s.position.z) * body.world.unit;
    return std::abs(x) < 20 && std::abs(z) < 20;
  };
  const auto top = [&](const SurfaceSample& s) { return s.normal.y > .5f && is_inner(s); };
  const auto bottom = [&](const SurfaceSample& s) { return s.normal.y < -.5f && is_inner(s); };
  const double entered = fresnel_transmittance(1.0, medium.eta);
  LaboratorySettings settings;
  settings.walks = 200000;
  const SlabWalks slab = walk_slab(medium, {thickness}, kNormalEntry, settings);
  const WalkedValue back = body.mean_where(walked, top), through = body.mean_where(walked, bottom);
  const double R = slab.back.total.value, T = slab.through.total.value;
  EXPECT_NEAR(back.value / entered, R, 4 * std::hypot(back.error, slab.back.total.error) + .01 * R);
  EXPECT_NEAR(through.value / entered, T, 4 * std::hypot(through.error, slab.through.total.error) + .01 * T);
}

// Claim: as many walks as an error takes, and the same bytes for 1 and 3 threads. Source: the header. Tolerance:
// none. Fails if: batches are summed as they end.
TEST(VolumeExitance, UntilErrorAndThreads) {
  const LitBody body(SphereShape{{}, 4}, 200);
  const auto run = [&](std::size_t threads) {
    const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
    return body.walked({.1, 1, .5, 1.4}, PointLight{{0, 20, 0}, Rgb(1)}, .2);
  };
  const VolumeExitance one = run(1), three = run(3);
  EXPECT_LE(one.relative_error, .2);
  EXPECT_EQ(one.exitance, three.exitance);
  EXPECT_EQ(one.error, three.error);
}

}  // namespace
}  // namespace opaline
