// SPDX-License-Identifier: GPL-3.0-or-later
// Exitance by sampled entry points against integrals.
#include "render/direct_test.h"
#include "support/lighting.h"
#include "support/quadrature.h"

namespace opaline::test {
namespace {

constexpr ProfileKind kProfiles[] = {ProfileKind::dipole, ProfileKind::normalized_diffusion};

struct Estimates {
  int entry_samples = 16;
  std::size_t count = 4000;
};

/// Independent estimates of M_o at one point, one channel.
Mean exitance_at(const DirectScene& direct, EntryStrategy strategy, const SurfacePoint& exit,
                 std::size_t channel, const Estimates& how = {}) {
  const std::vector<SurfacePoint> points(how.count, exit);
  std::vector<std::uint64_t> keys(how.count);
  std::iota(keys.begin(), keys.end(), 0u);
  std::vector<Light> lights;
  for (const Light& light : direct.scene.lights) lights.push_back(recentred(light, direct.world.origin));
  const EntrySampler sampler = direct.sampler(strategy);
  const PointIrradianceInput exits{direct.rays, points, keys, lights, direct.profile().eta, 1, 5};
  Mean mean;
  for (const RgbF& m : direct_exitance({sampler, exits, how.entry_samples})) mean.add(double(m[channel]));
  return mean;
}

void expect_near(const Mean& mean, double expected, double systematic, const std::string& name) {
  report(name + ", over the integral", mean.mean() / expected);
  report(name + ", standard error %", 100 * mean.error() / expected);
  EXPECT_NEAR(mean.mean(), expected, 4 * mean.error() + systematic * expected) << name;
  EXPECT_LT(mean.error(), .015 * expected) << name << ": too noisy to tell";
}

/// Integral of R_d over the sphere of radius R times the E of parallel light of irradiance 1, seen from a
/// point at this cosine from the light: rings of chord length r, dA = r dr dphi.
double lit_sphere(const ChannelProfile& profile, double R, double cosine, double eta) {
  const auto ring = [&](double r) {
    const double c = 1 - r * r / (2 * R * R), s = std::sqrt(std::max(0., 1 - c * c)),
                 sine = std::sqrt(1 - cosine * cosine);
    double sum = 0;
    constexpr int n = 400;
    for (int i = 0; i < n; ++i)
      sum += entering(cosine * c + sine * s * std::cos(2 * kPi * (i + .5) / n), eta) / n;
    return sum * diffuse_reflectance_profile(profile, r) * 2 * kPi * r;
  };
  // r = l sinh t resolves the profile's middle and its tail.
  const double l = .05;
  return integral([&](double t) { return ring(l * std::sinh(t)) * l * std::cosh(t); }, 0,
                  std::asinh(2 * R / l), 16);
}

// Claim: on a sphere under parallel light the exitance is the integral of R_d E over the sphere: in full
// light, near the shadow's edge and beyond it, for both profiles and strategies. Source: quadrature over
// rings of chord length, Fresnel by Snell's angles. Tolerance: 4 standard errors (below 1.5 %), and .2 % for
// the polyhedron: .1 % of its area, normals between vertices. Fails if: E lacks Ft, roulette forgets to make
// up for the dropped, or entries count the far side's crossings from inside.
TEST(DirectExitance, SphereInParallelLight) {
  for (const ProfileKind kind : kProfiles) {
    Scene scene = single_shape(SphereShape{{}, 10}, grey_medium(1, .01, 1.4, kind), 1);
    scene.lights = {unit_directional({0, 0, -1})};
    const DirectScene ball(scene);
    for (const double angle : {20., 80., 100.}) {
      const Vec3d n{std::sin(angle * kPi / 180), 0, std::cos(angle * kPi / 180)};
      const double expected = lit_sphere(ball.profile().channels[1], 10, n.z, 1.4);
      for (const EntryStrategy strategy : kStrategies) {
        const Mean mean =
            exitance_at(ball, strategy, point_at(n * 10, n), 1, {16, angle > 90 ? 15000u : 5000u});
        expect_near(mean, expected, .002,
                    name_of(kind, strategy) + ", " + std::to_string(int(angle)) + " degrees");
      }
    }
  }
}

/// Integral of R_d E over the square |x|, |z| < half at y = 0 seen from (x, z), E of a point light of
/// intensity 1: polar, each ray to the border.
double lit_square(const ChannelProfile& profile, double half, double x, double z, const Vec3d& light,
                  double eta) {
  constexpr int n = 720;
  double sum = 0;
  for (int i = 0; i < n; ++i) {
    const double phi = 2 * kPi * (i + .5) / n, cx = std::cos(phi), cz = std::sin(phi);
    const double border = std::min((half - std::copysign(x, x * cx)) / std::abs(cx),
                                   (half - std::copysign(z, z * cz)) / std::abs(cz));
    const auto at = [&](double r) {
      const Vec3d to = light - Vec3d{x + r * cx, 0, z + r * cz};
      const double d = length(to);
      return diffuse_reflectance_profile(profile, r) * r * entering(to.y / d, eta) / (d * d);
    };
    const double l = .05;
    sum += integral([&](double t) { return at(l * std::sinh(t)) * l * std::cosh(t); }, 0,
                    std::asinh(border / l), 4) *
           2 * kPi / n;
  }
  return sum;
}

// Claim: on a square under a point light the exitance is the integral of R_d E over it, in the middle, near
// an edge, and half a mean free path from a corner. Source: polar quadrature. Tolerance: 4 standard errors.
// Fails if: crossings outside the triangles are kept, or the light is not recentred with the world.
TEST(DirectExitance, SquareUnderAPointLight) {
  for (const ProfileKind kind : kProfiles) {
    Scene scene = single_shape(floor_quad(5), grey_medium(1, .02, 1.3, kind), 1);
    scene.lights = {unit_point({2, 4, 1})};
    const DirectScene square(scene);
    for (const auto& [x, z] : {std::pair{.5, -.3}, {4.8, 1.}, {-4.5, -4.5}}) {
      const double expected = lit_square(square.profile().channels[1], 5, x, z, {2, 4, 1}, 1.3);
      for (const EntryStrategy strategy : kStrategies)
        expect_near(exitance_at(square, strategy, point_at({x, 0, z}, {0, 1, 0}), 1, {16, 6000}), expected,
                    1e-5, name_of(kind, strategy) + ", x " + std::to_string(x));
    }
  }
}

// Claim: near the edge of a cube of which three faces are lit alike the exitance is E times the integral of
// R_d over these faces. Source: polar quadrature of the faces. Tolerance: 4 standard errors. Fails if: the
// face beyond the edge is missed by every axis (half of the light at the edge), or counted by two.
TEST(DirectExitance, CreaseOf90Degrees) {
  for (const ProfileKind kind : kProfiles) {
    Scene scene = single_shape(BoxShape{Vec3d(-10), Vec3d(10)}, grey_medium(1, .01, 1.3, kind), 1);
    scene.shapes[0].normals = NormalMode::faceted;
    scene.lights = {unit_directional({-1, -1, -1})};
    const DirectScene cube(scene);
    const double E = entering(1 / std::sqrt(3.), 1.3);
    const ChannelProfile profile = cube.profile().channels[1];
    const auto within = [&](double r) { return diffuse_reflectance_within(profile, r); };
    for (const double d : {.02, .3, 2.}) {
      const std::array<double, 4> own = {d, 10 - .3, 20 - d, 10 + .3};
      const double expected =
          E * (rectangle_integral(within, own) + rectangle_integral(within, {0, own[1], 20, own[3]}, own[0]) +
               rectangle_integral(within, {0, own[2], 20, own[0]}, own[1]));
      for (const EntryStrategy strategy : kStrategies)
        expect_near(exitance_at(cube, strategy, point_at({10 - d, .3, 10}, {0, 0, 1}), 1, {16, 4000}),
                    expected, 1e-5, name_of(kind, strategy) + ", " + std::to_string(d) + " mm from the edge");
    }
  }
}

// Claim: through a slab 6 mean free paths thick lit from behind comes E times the integral of R_d over its
// far face, of which lines near the exit meet a part with weights far below the usual. Source: polar
// quadrature. Tolerance: 4 standard errors. Fails if: roulette does not make up for the entries that it
// drops.
TEST(DirectExitance, SlabLitFromBehind) {
  for (const ProfileKind kind : kProfiles) {
    Scene scene = single_shape(BoxShape{{-10, -10, -3}, {10, 10, 0}}, grey_medium(.5, .01, 1.3, kind), 1);
    scene.shapes[0].normals = NormalMode::faceted;
    scene.lights = {unit_directional({0, 0, 1})};
    const DirectScene slab(scene);
    const ChannelProfile profile = slab.profile().channels[1];
    const auto within = [&](double r) { return diffuse_reflectance_within(profile, r); };
    const double expected = reference_transmittance(1, 1.3) * rectangle_integral(within, {10, 10, 10, 10}, 3);
    const SurfacePoint exit = point_at(-slab.world.origin, {0, 0, 1});
    for (const EntryStrategy strategy : kStrategies)
      expect_near(exitance_at(slab, strategy, exit, 1, {16, 10000}), expected, 1e-5, name_of(kind, strategy));
  }
}

// Claim: with lights that have an area, one random light sample an entry, the exitance of a sphere under
// uniform radiance 1 is pi (1 - F_bar) x total x CDF(2R). Source: as EntrySampler.WeightsOnASphere.
// Tolerance: 4 standard errors and .2 % of the polyhedron. Fails if: all entries share one light sample's
// number, or the light sample's weight is over settings.light_samples.
TEST(DirectExitance, SphereUnderSurroundings) {
  for (const ProfileKind kind : kProfiles) {
    Scene scene = single_shape(SphereShape{{}, 10}, grey_medium(1, .01, 1.4, kind), 1);
    scene.lights = {unit_surroundings()};
    const DirectScene ball(scene);
    const double expected = kPi * (1 - ball.profile().average_reflectance) *
                            diffuse_reflectance_within(ball.profile().channels[1], 20);
    for (const EntryStrategy strategy : kStrategies)
      expect_near(exitance_at(ball, strategy, point_at({0, 6, 8}, {0, .6, .8}), 1, {16, 4000}), expected,
                  .002, name_of(kind, strategy));
  }
}

// Claim: as the mean free path vanishes M becomes total x E at the point itself, also where it is exactly 0,
// next to channels that carry light far. Source: limit. Tolerance: .5 %, and 4 standard errors. Fails if: a
// channel whose lengths are below the floats' resolution of places is sampled.
TEST(DirectExitance, VanishingMeanFreePath) {
  for (const ProfileKind kind : kProfiles)
    for (const double l : {1e-3, 1e-5, 1e-7, 1e-9, 0.}) {
      Scene scene = single_shape(floor_quad(20), grey_medium(1, 0, 1.3), 1);
      scene.media[0] = {"m", ArtistMedium{{.8, .6, .7}, {l, l, 1}, 0}, 1.3, kind};
      scene.lights = {unit_directional({0, -1, 0})};
      const DirectScene square(scene);
      const double E = reference_transmittance(1, 1.3);
      for (const EntryStrategy strategy : kStrategies) {
        const SurfacePoint exit = point_at({9.123, 0, 13.7}, {0, 1, 0});
        const std::string name =
            name_of(kind, strategy) + ", mean free path " + std::to_string(l * 1e9) + " pm";
        for (const auto& [channel, total] : {std::pair{0u, .8}, {1u, .6}})
          expect_near(exitance_at(square, strategy, exit, channel, {16, 2000}), total * E, .005,
                      name + ", channel " + std::to_string(channel));
      }
    }
}

}  // namespace
}  // namespace opaline::test
