// SPDX-License-Identifier: GPL-3.0-or-later
// Profiles in `direct` that know more than a distance: the multipole's two sides, the directional dipole's light.
#include "opaline/error.h"
#include "plan/make_plan.h"
#include "render/direct_test.h"
#include "support/lighting.h"
#include "support/quadrature.h"

namespace opaline::test {
namespace {

/// A plate of 40 x 40 mm, 1 mm thick, in the light of one parallel beam of irradiance 1 across it.
DirectScene plate_scene(ProfileKind kind, double mean_free_path, const Vec3d& beam) {
  Medium medium = grey_medium(mean_free_path, .02, 1.4, kind);
  medium.thickness = 1;
  Scene scene = single_shape(SlabShape{{}, 40, 40, 1}, medium, 1);
  scene.settings.method = Method::direct;
  scene.lights = {unit_directional(beam)};
  return DirectScene(scene);
}

Mean exitance_in_the_middle(const DirectScene& direct, EntryStrategy strategy, std::size_t count) {
  const std::vector<SurfacePoint> points(count, point_at({0, .5, 0}, {0, 1, 0}));
  std::vector<std::uint64_t> keys(count);
  std::iota(keys.begin(), keys.end(), 0u);
  std::vector<Light> lights;
  for (const Light& light : direct.scene.lights) lights.push_back(recentred(light, direct.world.origin));
  const EntrySampler sampler = direct.sampler(strategy);
  const PointIrradianceInput exits{direct.rays, points, keys, lights, 1.4, 1, 5};
  Mean mean;
  for (const RgbF& m : direct_exitance({sampler, exits, 16})) mean.add(double(m[0]));
  return mean;
}

// Claim: a plate lit from behind sends out the transmitted total times what enters, by both strategies; lit from the
// front the reflected total. Source: multipole.h; the rim is 20 mm away. Tolerance: four standard errors, below 1 % (chords: 4 %).
// Fails if: sides are not told, or the far side is asked for at the distance along the plate.
TEST(DirectPlates, BothSidesOfAMultipole) {
  const double entered = entering(1, 1.4);
  for (const double mean_free_path : {.2, 1.})
    for (const bool from_behind : {true, false}) {
      const DirectScene direct =
          plate_scene(ProfileKind::multipole, mean_free_path, {0, from_behind ? 1. : -1., 0});
      const ChannelProfile profile = direct.profile().channels[0];
      const double expected = entered * (from_behind ? total_diffuse_transmittance(profile, 1)
                                                     : total_diffuse_reflectance(profile));
      for (const EntryStrategy strategy : kStrategies) {
        const bool is_slow = strategy == EntryStrategy::chords;
        const Mean mean = exitance_in_the_middle(direct, strategy, is_slow ? 1500 : 5000);
        report(name_of(ProfileKind::dipole, strategy) + ", over the total", mean.mean() / expected);
        EXPECT_NEAR(mean.mean(), expected, 4 * mean.error() + 2e-3 * expected)
            << mean_free_path << " " << from_behind;
        EXPECT_LT(mean.error(), (is_slow ? .04 : .01) * expected);
      }
    }
}

// Claim: a wide plane in a slanted beam sends out the total of its angle times what enters, not the mean's over diffuse
// light. Source: total_directional_reflectance. Tolerance: four standard errors, below 1.5 %. Fails if: the direction
// is the light's way, or weights of the mean are used beside those of the direction.
TEST(DirectPlates, DirectionalDipoleByAngle) {
  for (const double cosine : {1., .6, .25}) {
    const double sine = std::sqrt(1 - cosine * cosine);
    const DirectScene direct =
        plate_scene(ProfileKind::directional_dipole, .1, Vec3d{.6 * sine, -cosine, .8 * sine});
    const DirectionalDipole profile = std::get<DirectionalDipole>(direct.profile().channels[0]);
    const double expected = entering(cosine, 1.4) * total_directional_reflectance(profile, cosine);
    for (const EntryStrategy strategy : kStrategies) {
      const Mean mean = exitance_in_the_middle(direct, strategy, 4000);
      report("cosine " + std::to_string(cosine) + ", over the total", mean.mean() / expected);
      // Some per cent go through the plate and are not in the total of a half space: little at ten mean free paths.
      EXPECT_NEAR(mean.mean(), expected, 4 * mean.error() + .01 * expected) << cosine;
      EXPECT_LT(mean.error(), .015 * expected);
    }
  }
}

// Claim: `hierarchical` refuses the directional dipole with a line naming the medium and the remedy; the other
// methods plan it. Source: bodies/plan.h. Fails if: its mean silently replaces it.
TEST(DirectPlates, HierarchicalRefusesDirections) {
  Scene scene =
      single_shape(SphereShape{{}, 5}, grey_medium(1, .01, 1.3, ProfileKind::directional_dipole), 1);
  scene.media[0].name = "wax";
  try {
    make_plan(scene, make_world(scene));
    ADD_FAILURE() << "planned";
  } catch (const Error& error) {
    const std::string text = error.what();
    EXPECT_NE(text.find("wax: the profile directional_dipole"), std::string::npos) << text;
    EXPECT_NE(text.find("--method direct"), std::string::npos) << text;
    EXPECT_EQ(text.find('\n'), std::string::npos) << text;
  }
  for (const Method method : {Method::direct, Method::lambert, Method::volume}) {
    scene.settings.method = method;
    EXPECT_EQ(make_plan(scene, make_world(scene)).groups.size(), 1u);
  }
}

}  // namespace
}  // namespace opaline::test
