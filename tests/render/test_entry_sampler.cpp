// SPDX-License-Identifier: GPL-3.0-or-later
// Where light that leaves a point may have entered.
#include "render/direct_test.h"
#include "support/quadrature.h"

namespace opaline::test {
namespace {

/// Calls use(entries) for `count` samples at one exit; exits of different seeds have other numbers.
template <class Use>
void for_each_sample(const EntrySampler& sampler, const SurfacePoint& exit, std::uint64_t count,
                     const Use& use, std::uint64_t seed = 0) {
  std::vector<Hit> crossings;
  std::vector<Entry> entries;
  for (std::uint64_t i = 0; i < count; ++i) {
    entries.clear();
    sampler.sample(exit, random_of(i, seed), crossings, entries);
    use(entries);
  }
}

/// Mean over samples of the sum over a sample's entries of value(entry).
template <class Value>
Mean mean_over_samples(const EntrySampler& sampler, const SurfacePoint& exit, std::uint64_t count,
                       const Value& value) {
  Mean mean;
  for_each_sample(sampler, exit, count, [&](const std::vector<Entry>& entries) {
    double sum = 0;
    for (const Entry& entry : entries) sum += value(entry);
    mean.add(sum);
  });
  return mean;
}

// Claim: with E = 1 the mean sum of weights on a sphere of radius R is total x CDF(2R): .9724 for the dipole
// of mean free path .38, eta 1.5, nothing absorbed. Source: chord lengths on a sphere. Tolerance: 4 standard
// errors over all six means, and .1 % for the inscribed polyhedron, which has so much less area. Fails if:
// the density forgets the cosine, the share of an axis, or the half of the chords.
TEST(EntrySampler, WeightsOnASphere) {
  for (const ProfileKind kind : {ProfileKind::dipole, ProfileKind::normalized_diffusion}) {
    const DirectScene ball(single_shape(SphereShape{{}, 25}, grey_medium(.38, 0, 1.5, kind), 1));
    const double expected = diffuse_reflectance_within(ball.profile().channels[0], 50);
    if (kind == ProfileKind::dipole) {
      EXPECT_NEAR(expected, .9724, 5e-5);
    }
    for (const EntryStrategy strategy : kStrategies) {
      const EntrySampler sampler = ball.sampler(strategy);
      Mean mean;
      for (std::uint32_t t = 0; t < 100; ++t) {
        const SurfacePoint exit = ball.rays.surface_point(0, 7919 * t % ball.triangles(0), .3f, .3f);
        for_each_sample(
            sampler, exit, 1000,
            [&](const std::vector<Entry>& entries) {
              double sum = 0;
              for (const Entry& entry : entries) sum += double(entry.weight.y);
              mean.add(sum);
            },
            100 * t);
      }
      report(name_of(kind, strategy) + ", sum of weights", mean.mean());
      report(name_of(kind, strategy) + ", its standard error", mean.error());
      EXPECT_NEAR(mean.mean(), expected, 4 * mean.error() + .001) << name_of(kind, strategy);
    }
  }
}

// Claim: 1 / density adds up to area: that within a distance rho of a point is pi rho^2 on a sphere, whatever
// the profile. Source: chord lengths. Tolerance: 4 standard errors and .1 % as above. Fails if: as above; and
// if the weight's kernel is not the one of the entry's distance.
TEST(EntrySampler, InverseDensityIsArea) {
  for (const ProfileKind kind : {ProfileKind::dipole, ProfileKind::normalized_diffusion}) {
    const DirectScene ball(single_shape(SphereShape{{}, 25}, grey_medium(3, .05, 1.3, kind), 1));
    const ChannelProfile profile = ball.profile().channels[0];
    const SurfacePoint exit = ball.rays.surface_point(0, 1234 % ball.triangles(0), .3f, .3f);
    for (const EntryStrategy strategy : kStrategies)
      for (const double rho : {2., 8.}) {
        const Mean area = mean_over_samples(ball.sampler(strategy), exit, 40000, [&](const Entry& entry) {
          const double r = double(length(entry.point.position - exit.position));
          return r < rho ? double(entry.weight.x) / diffuse_reflectance_profile(profile, r) : 0;
        });
        report(name_of(kind, strategy) + ", area within " + std::to_string(rho) + " over pi rho^2",
               area.mean() / (kPi * rho * rho));
        EXPECT_NEAR(area.mean() / (kPi * rho * rho), 1, 4 * area.error() / (kPi * rho * rho) + .001);
      }
  }
}

/// Integral of R_d over each face of the cube of side 20 around zero, from a point (10 - d, .3, 10) on it:
/// own face, the next beyond the edge, then those at y = 10, y = -10, x = -10, z = -10.
std::array<double, 6> cube_integrals(const ChannelProfile& profile, double d) {
  const auto within = [&](double r) { return diffuse_reflectance_within(profile, r); };
  const std::array<double, 4> own = {d, 10 - .3, 20 - d, 10 + .3};
  const auto side = [&](std::size_t i) {
    return rectangle_integral(within, {0, own[(i + 1) % 4], 20, own[(i + 3) % 4]}, own[i]);
  };
  return {rectangle_integral(within, own),    side(0), side(1), side(3), side(2),
          rectangle_integral(within, own, 20)};
}

std::size_t cube_face(const Vec3f& n) {
  return n.z > .5f ? 0 : n.x > .5f ? 1 : n.y > .5f ? 2 : n.y < -.5f ? 3 : n.x < -.5f ? 4 : 5;
}

// Claim: every face of a cube gets its own share from every axis and channel together: near a 90 degree edge,
// where all axes meet surfaces, the mean sums of weights on the six faces are the integrals of R_d over them,
// for three channels of very different mean free paths. So weights of multiple importance sampling sum to
// one. Source: polar quadrature of the faces. Tolerance: 36 means a strategy at 4 standard errors each (a
// right program fails one of them with probability .5 %; seeds are fixed). Fails if: a tangent's share is
// wrong in the density alone, the channels' mean is taken over three where two scatter, or crossings behind
// the exit are left out.
TEST(EntrySampler, EveryFaceOfACube) {
  for (const ProfileKind kind : {ProfileKind::dipole, ProfileKind::normalized_diffusion}) {
    Scene scene = single_shape(BoxShape{Vec3d(-10), Vec3d(10)},
                               {"m", PhysicalMedium{{.01, .02, .05}, {.2, 2, 0}}, 1.3, kind}, 1);
    std::get<PhysicalMedium>(scene.media[0].coefficients).sigma_a.z = 1;  // blue only absorbs
    scene.shapes[0].normals = NormalMode::faceted;
    const DirectScene cube(scene);
    for (const double d : {.05, .7, 4.}) {
      SurfacePoint exit;
      exit.position = Vec3f(Vec3d{10 - d, .3, 10});
      exit.normal = exit.geometric = {0, 0, 1};
      for (const EntryStrategy strategy : kStrategies) {
        std::array<std::array<Mean, 6>, 2> sums;
        for_each_sample(cube.sampler(strategy), exit, 40000, [&](const std::vector<Entry>& entries) {
          std::array<std::array<double, 6>, 2> sample{};
          for (const Entry& entry : entries) {
            EXPECT_EQ(entry.weight.z, 0);
            for (std::size_t c = 0; c < 2; ++c)
              sample[c][cube_face(entry.point.geometric)] += double(entry.weight[c]);
          }
          for (std::size_t c = 0; c < 2; ++c)
            for (std::size_t f = 0; f < 6; ++f) sums[c][f].add(sample[c][f]);
        });
        for (std::size_t c = 0; c < 2; ++c) {
          const std::array<double, 6> expected = cube_integrals(cube.profile().channels[c], d);
          for (std::size_t f = 0; f < 6; ++f)
            // 1e-5: what no sample may find of a far face.
            EXPECT_NEAR(sums[c][f].mean(), expected[f], 4 * sums[c][f].error() + 1e-5)
                << name_of(kind, strategy) << ", " << d << " mm from the edge, channel " << c << ", face "
                << f;
        }
      }
    }
  }
}

/// The largest weight over total, of any channel; of `count` samples over points all over the mesh.
double largest_weight(const DirectScene& scene, EntryStrategy strategy, std::uint64_t count) {
  const EntrySampler sampler = scene.sampler(strategy);
  const RgbF total(scene.profile().total);
  std::vector<Hit> crossings;
  std::vector<Entry> entries;
  float largest = 0;
  for (std::uint64_t i = 0; i < count; ++i) {
    entries.clear();
    const auto triangle = std::uint32_t(hash_bits(77, i) % scene.triangles(0));
    const float u = float(unit_double(hash_bits(78, i)));
    const SurfacePoint exit =
        scene.rays.surface_point(0, triangle, u, (1 - u) * float(unit_double(hash_bits(79, i))));
    sampler.sample(exit, random_of(i), crossings, entries);
    for (const Entry& entry : entries)
      for (std::size_t c = 0; c < 3; ++c) {
        if (!std::isfinite(entry.weight[c])) return INFINITY;
        if (total[c] > 0) largest = std::max(largest, entry.weight[c] / total[c]);
      }
  }
  return double(largest);
}

Scene crease() {
  Scene scene = single_shape(BoxShape{Vec3d(-1), Vec3d(1)}, marble(), 1);
  scene.shapes[0].normals = NormalMode::faceted;
  return scene;
}

// Claim: no weight of disc_axes exceeds total x 4 sqrt(3) x channels, and none of chords 2 x total x
// channels: there are no fireflies. Source: the header. Tolerance: 1e-3, of the table's cubics. Fails if: the
// distance from the axis is replaced by one that may be longer than the entry's own.
TEST(EntrySampler, WeightsAreBoundedOnACrease) {
  const DirectScene box(crease());
  const double axes = largest_weight(box, EntryStrategy::disc_axes, 1000000),
               chords = largest_weight(box, EntryStrategy::chords, 200000);
  report("largest weight over total, disc_axes", axes);
  report("largest weight over total, chords", chords);
  EXPECT_LE(axes, 4 * std::sqrt(3) * 3 * 1.001);
  EXPECT_LE(chords, 2 * 3 * 1.001);
  EXPECT_GT(axes, 1.9);
}

// The same on the bunny, whose normals take all directions.
TEST(LongEntrySampler, WeightsAreBoundedOnTheBunny) {
  const DirectScene bunny(single_shape(bunny_file(), marble(), 1));
  const double axes = largest_weight(bunny, EntryStrategy::disc_axes, 1000000),
               chords = largest_weight(bunny, EntryStrategy::chords, 1000000);
  report("largest weight over total, disc_axes", axes);
  report("largest weight over total, chords", chords);
  EXPECT_LE(axes, 4 * std::sqrt(3) * 3 * 1.001);
  EXPECT_LE(chords, 2 * 3 * 1.001);
}

// Claim: for one channel a weight of chords is 2 x total, whatever the surface. Source: the header.
// Tolerance: 1e-5, floats. Fails if: the table's kernel and the density's differ.
TEST(EntrySampler, WeightOfChordsIsConstant) {
  Scene scene = crease();
  scene.media[0].coefficients = PhysicalMedium{{.1, 1, 1}, {2, 0, 0}};
  const DirectScene box(scene);
  const double total = box.profile().total.x;
  const SurfacePoint exit = box.rays.surface_point(0, 3, .4f, .3f);
  std::size_t seen = 0;
  for_each_sample(box.sampler(EntryStrategy::chords), exit, 20000, [&](const std::vector<Entry>& entries) {
    for (const Entry& entry : entries) {
      EXPECT_NEAR(double(entry.weight.x) / (2 * total), 1, 1e-5);
      EXPECT_EQ(entry.weight.y, 0);
      ++seen;
    }
  });
  EXPECT_GT(seen, 1000u);
}

}  // namespace
}  // namespace opaline::test
