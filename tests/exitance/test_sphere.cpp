// SPDX-License-Identifier: GPL-3.0-or-later
// A uniformly lit sphere has an exact answer.
#include "support/clouds.h"

namespace opaline {
namespace {

using namespace test;

const Cloud& samples() {
  static const Cloud cloud(SphereShape{{}, 25}, 40000);
  return cloud;
}

// Claim: on a sphere of radius R under E = 1, M_o = total x CDF(2R) everywhere, for any profile: .9724 for
// the dipole (mean free path .38, eta 1.5, nothing absorbed). Brute force, the classic traversal and the dual
// tree all get there. Source: chord lengths on a sphere, dA = 2 pi r dr. Tolerance: mean .5 %, of which the
// inscribed polyhedron's missing area is up to .1 %; any place 2 % (40,000 samples, mean free path .86
// spacings; measured figures are printed). Fails if: areas miss, the near part is counted twice, or A stands
// for eta outside / inside.
TEST(Sphere, IsExact) {
  double mesh_area = surface_area(samples().world.meshes[0]) / (4 * kPi * 625);
  report("mesh area / sphere area", mesh_area);
  EXPECT_NEAR(mesh_area, 1, 1e-3);
  for (const ProfileKind kind : {ProfileKind::dipole, ProfileKind::normalized_diffusion}) {
    const DiffuseProfile profile = make_diffuse_profile(grey_medium(.38, 0, 1.5, kind));
    const double expected = diffuse_reflectance_within(profile.channels[0], 50);
    if (kind == ProfileKind::dipole) {
      EXPECT_NEAR(expected, .9724, 5e-5);
    }
    const Octree octree = samples().tree(RgbF(1));
    const SplitKernel kernel = samples().kernel(profile);
    const std::string name = kind == ProfileKind::dipole ? "dipole, " : "normalized diffusion, ";
    const auto check = [&](const std::string& how, const std::vector<Exitance>& values, double mean,
                           double any) {
      const Difference d = difference(values, [&](std::size_t) { return expected; });
      report(name + how + ", bias %", 100 * d.bias);
      report(name + how + ", largest %", 100 * d.largest);
      EXPECT_LT(std::abs(d.bias), mean);
      EXPECT_LT(d.largest, any);
    };
    check("brute force", brute_force(octree, kernel, places_on_sphere()), .005, .02);
    check("classic .01", classic(octree, kernel, places_on_sphere(), .01), .005, .02);
    check("classic .1", classic(octree, kernel, places_on_sphere(), .1), .01, .03);
    check("dual tree .005", dual_tree(octree, kernel, places_on_sphere(), .005), .005, .02);
  }
}

// Claim: E interpolated from the samples is E where they all agree. Source: it is a normalised interpolation.
// Tolerance: 1e-6. Fails if: its weights are not normalised.
TEST(Sphere, InterpolatesConstantIrradianceExactly) {
  const DiffuseProfile profile = make_diffuse_profile(grey_medium(.38, 0, 1.5));
  for (const Exitance& e :
       brute_force(samples().tree(RgbF{1, .3f, 7}), samples().kernel(profile), places_on_sphere())) {
    EXPECT_NEAR(e.irradiance.x, 1, 1e-6);
    EXPECT_NEAR(e.irradiance.y, .3, 3e-7);
    EXPECT_NEAR(e.irradiance.z, 7, 7e-6);
  }
}

}  // namespace
}  // namespace opaline
