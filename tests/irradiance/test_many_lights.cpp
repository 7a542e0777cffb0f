// SPDX-License-Identifier: GPL-3.0-or-later
// Lights drawn from a tree in place of all of them.
#include <gtest/gtest.h>

#include "core/random.h"
#include "lights/light_tree.h"
#include "support/lighting.h"
#include "support/statistics.h"

namespace opaline {
namespace {

using namespace test;

double random_at(std::uint64_t i, std::uint64_t of = 0) {
  return unit_double(hash_bits(of, i));
}

Vec3d random_place(std::uint64_t i, double side) {
  return Vec3d{random_at(3 * i), random_at(3 * i + 1), random_at(3 * i + 2)} * side - Vec3d(side / 2);
}

Vec3d random_way(std::uint64_t i) {
  return normalized(random_place(i + 1'000'000, 2));
}

enum class Kind { point, spot, sphere, quad };

// Of very different brightness and all colours, in a box of 100 mm.
std::vector<Light> random_lights(Kind kind, std::size_t count) {
  std::vector<Light> lights;
  for (std::uint64_t i = 0; i < count; ++i) {
    const Rgb colour = Rgb{random_at(i, 1), random_at(i, 2), random_at(i, 3)} * std::exp(6 * random_at(i, 4));
    const Vec3d place = random_place(i, 100), way = random_way(i);
    Vec3d x, y;
    tangent_frame(way, x, y);
    if (kind == Kind::point) lights.push_back(light_of(PointLight{place, colour}));
    if (kind == Kind::spot)
      lights.push_back(light_of(SpotLight{place, way, colour, 10 + 70 * random_at(i, 5), 5}));
    if (kind == Kind::sphere) lights.push_back(light_of(SphereLight{place, 2 * random_at(i, 5), colour}));
    if (kind == Kind::quad)
      lights.push_back(light_of(QuadLight{place, x * 3, y * (5 * random_at(i, 5)), colour}));
  }
  return lights;
}

constexpr std::array kKinds{Kind::point, Kind::spot, Kind::sphere, Kind::quad};

/// Irradiance in green at a surface of a sample of a light.
double brought(const Light& light, const Vec3f& point, const Vec3f& normal, std::array<double, 2> square) {
  const LightSample sample = sample_light(light, point, normal, square, 1);
  return double(sample.weight) * std::max(0.0, double(dot(normal, sample.direction))) * emission(light).y;
}

// Claim: what a tree's draw brings is in the mean what all lights bring together, whatever their kind, the number of
// places, and the point: among the lights, outside, facing away from most. Source: each light counts by the inverse of
// how often it is drawn. Tolerance: 4 standard errors, once over 8 of 96. Fails when: a light counts by the importance
// of its node, or the places left over by lights that are drawn surely go to nobody and are not counted.
TEST(LightTree, DrawsHaveTheMeanOfAllLights) {
  constexpr std::uint64_t kDraws = 1500;
  for (const Kind kind : kKinds) {
    const LightTree tree(random_lights(kind, 90));
    for (const std::size_t places : {1u, 6u, 40u})
      for (std::uint64_t p = 0; p < 6; ++p) {
        const Vec3f point(random_place(p + 500, p < 3 ? 100 : 300)), normal(random_way(p));
        Mean drawn_mean, all_mean;
        std::vector<LightTree::Drawn> drawn(places);
        for (std::uint64_t k = 0; k < kDraws; ++k) {
          tree.draw({point, normal}, random_at(k, p + 10), k, drawn);
          double sum = 0, all = 0;
          for (std::size_t i = 0; i < places; ++i)
            if (drawn[i].expected > 0)
              sum += brought(tree.lights()[drawn[i].light], point, normal,
                             {double(drawn[i].rest), random_at(k, 900 + i)}) /
                     double(drawn[i].expected);
          for (std::size_t l = 0; l < tree.lights().size(); ++l)
            all += brought(tree.lights()[l], point, normal, {random_at(k, 2000 + l), random_at(k, 3000 + l)});
          drawn_mean.add(sum);
          all_mean.add(all);
        }
        const double error = std::hypot(drawn_mean.error(), all_mean.error()) + 1e-6 * all_mean.mean();
        EXPECT_LT(std::abs(drawn_mean.mean() - all_mean.mean()), 4 * error)
            << int(kind) << ' ' << places << ' ' << p << ": " << drawn_mean.mean() << ' ' << all_mean.mean();
      }
  }
}

// Claim: wherever a light brings light, every node that holds it is important there, and a draw may take it. Source:
// the bounds are of all places, ways and cones of a node's lights. Tolerance: none. Fails when: a node's ball is that of
// its lights' centres alone, or its cone leaves out the angle within which its lights shine.
TEST(LightTree, IsImportantWhereverALightShines) {
  std::size_t lit = 0;
  for (const Kind kind : kKinds) {
    const LightTree tree(random_lights(kind, 60));
    for (std::uint64_t p = 0; p < 300; ++p) {
      const Vec3f point(random_place(p + 9000, p % 2 == 0 ? 100 : 250)), normal(random_way(p + 9000));
      std::vector<bool> shines(tree.lights().size());
      for (std::size_t l = 0; l < shines.size(); ++l)
        for (std::uint64_t k = 0; k < 8; ++k)
          shines[l] = shines[l] ||
                      brought(tree.lights()[l], point, normal, {random_at(k, l), random_at(k + 50, l)}) > 0;
      for (std::uint32_t l = 0; l < shines.size(); ++l) {
        lit += shines[l];
        EXPECT_TRUE(!shines[l] || tree.share({point, normal}, l) > 0) << int(kind) << ' ' << p << ' ' << l;
      }
    }
  }
  EXPECT_GT(lit, 10'000u);
}

// Claim: without shadows every draw of grey lights without an area brings what all of them bring, whatever they are and
// wherever the point is. Source: each is drawn by what it brings. Tolerance: 1e-3, of lights at the rim of what they shine
// on. Fails when: nodes of the tree are weighed in place of lights (4 % of points, 30 % of spots), or a block of weights is
// passed over.
TEST(LightTree, DrawsWhatLightsBring) {
  for (const Kind kind : {Kind::point, Kind::spot}) {
    std::vector<Light> lights = random_lights(kind, 1000);
    for (Light& light : lights) light = with_emission(light, Rgb(emission(light).y));
    const LightTree tree(lights);
    std::vector<LightTree::Drawn> drawn(22);
    for (std::uint64_t p = 0; p < 200; ++p) {
      const Vec3f point(random_place(p + 700, p < 100 ? 100 : 400)), normal(random_way(p + 700));
      tree.draw({point, normal}, random_at(p, 41), p, drawn);
      double sum = 0, all = 0;
      for (const auto& [light, expected, rest, unshadowed, mean_unshadowed] : drawn)
        if (expected > 0) sum += brought(lights[light], point, normal, {}) / double(expected);
      for (const Light& light : lights) all += brought(light, point, normal, {});
      EXPECT_NEAR(sum, all, 1e-3 * all) << int(kind) << ' ' << p;
    }
  }
}

// Claim: where there are as many places as lights without an area, each that matters is drawn exactly once, and stands
// for itself alone. Source: places beyond the first are of no use to a light without an area. Tolerance: rounding. Fails
// when: lights are drawn with replacement.
TEST(LightTree, DrawsAllWhereItCan) {
  const LightTree tree(random_lights(Kind::point, 40));
  std::vector<LightTree::Drawn> drawn(40);
  for (std::uint64_t p = 0; p < 20; ++p) {
    const Vec3f point(random_place(p + 77, 200)), normal(random_way(p + 77));
    tree.draw({point, normal}, random_at(p), p, drawn);
    std::vector<int> times(40);
    for (const auto& [light, expected, rest, unshadowed, mean_unshadowed] : drawn)
      if (expected > 0) {
        ++times[light];
        EXPECT_FLOAT_EQ(expected, 1);
      }
    for (std::uint32_t l = 0; l < 40; ++l)
      EXPECT_EQ(times[l], tree.share({point, normal}, l) > 0 ? 1 : 0) << l;
  }
}

// Claim: up to 16 lights without an area, and as many with one, stay as they are; more become a tree, which forgets
// those without light; suns and rooms stay. Source: the threshold. Fails when: few lights are drawn, or black lamps,
// which hide what is behind them, are lost.
TEST(ManyLights, AreMoreThanSixteenOfAKind) {
  std::vector<Light> lights = random_lights(Kind::point, 16);
  lights.push_back(unit_directional({0, -1, 0}));
  for (const Light& light : random_lights(Kind::sphere, 16)) lights.push_back(light);
  EXPECT_EQ(with_trees(lights), lights);
  lights.push_back(unit_point({}));
  std::vector<Light> gathered = with_trees(lights);
  ASSERT_EQ(gathered.size(), 17u + 3u);
  EXPECT_EQ(std::get<ManyLights>(gathered[17].source).tree->lights().size(), 17u);
  for (std::size_t l = 0; l < 4; ++l) lights[l] = with_emission(lights[l], {});
  gathered = with_trees(lights);
  EXPECT_EQ(gathered.size(), 17u + 13u);  // those that shine, one by one
  std::vector<Light> lamps = random_lights(Kind::quad, 20);
  for (Light& lamp : lamps) lamp = with_emission(lamp, Rgb(1));
  lamps[7] = with_emission(lamps[7], {});
  gathered = with_trees(lamps);
  ASSERT_EQ(gathered.size(), 1u);  // of one colour
  EXPECT_EQ(std::get<ManyLights>(gathered[0].source).tree->lights().size(), 20u);
}

// Claim: at a sphere that emits, few draws go to it, as it does not light itself. Source: no part of a ball is in front
// of its surface. Tolerance: half of the draws, of a thousandth of its importance. Fails if a light is as important anywhere in
// its bounding ball.
TEST(LightTree, LeavesOutTheLightThatAPointIsOn) {
  std::vector<Light> lights;
  for (int i = 0; i < 8; ++i) lights.push_back(light_of(SphereLight{{20. * i, 0, 0}, 3, Rgb(1)}));
  const LightTree tree(lights);
  for (std::uint64_t p = 0; p < 100; ++p) {
    const Vec3d way = random_way(p);
    const LightTree::Place at{Vec3f(Vec3d{60, 0, 0} + way * 2.9999), Vec3f(way)};
    EXPECT_LT(tree.share(at, 3), .5) << p;
  }
}

// A torus below a box that shades it.
struct Place {
  LitWorld lit{world_of({TorusShape{{}, 10, 4}, BoxShape{{3, 12, 0}, {6, 13, 4}}})};
  std::vector<SurfaceSample> samples;

  Place() {
    const std::vector<std::uint32_t> torus_only = {0};
    samples = sample_surface({lit.world, torus_only, 1500}).samples;
  }
  std::vector<RgbF> entered(const std::vector<Light>& lights, int light_samples,
                            std::uint64_t seed = 0) const {
    const std::vector<Light> traced = with_trees(lights);
    return combine_lights(lit.transfers(samples, traced, 1.5, light_samples, seed), traced);
  }
};

double mean_green(const std::vector<RgbF>& irradiance) {
  double sum = 0;
  for (const RgbF& e : irradiance) sum += double(e.y);
  return sum / double(irradiance.size());
}

// Claim: light that enters from 600 point lights has the mean over seeds of what enters from each, traced by itself;
// with as many shadow rays as lights it is that. Source: linearity. Tolerance: 4 standard errors of 24 seeds; .1 % of
// the mean, each sample: means beside shadow edges are of one light in the one, of all in the other. Fails when: the
// shadow of one light is taken for another's.
TEST(ManyLights, EnterAsEachByItself) {
  const Place place;
  std::vector<Light> lights = random_lights(Kind::point, 600);
  for (Light& light : lights) std::get<PointLight>(light.source).position.y += 60;
  const double expected = mean_green(combine_lights(place.lit.transfers(place.samples, lights, 1.5), lights));
  Mean mean;
  for (std::uint64_t seed = 0; seed < 24; ++seed) mean.add(mean_green(place.entered(lights, 16, seed)));
  EXPECT_LT(std::abs(mean.errors_from(expected)), 4) << mean.mean() << ' ' << expected;
  EXPECT_LT(mean.error(), .01 * expected);
  EXPECT_NEAR(mean_green(place.entered(lights, 2400)) / expected, 1, .001);
}

// Claim: where nothing is in the way, points have what all coloured bulbs bring, though each draws 22 of them. Source: the
// control of ShadowBatch. Tolerance: .1 % of the mean. Fails when: one ray's colour counts for all channels (3 %).
TEST(ManyLights, ColoursAreNoNoise) {
  const LitWorld lit(world_of({QuadShape{{-50, 0, 50}, {100, 0, 0}, {0, 0, -100}}}));
  std::vector<Light> lights;
  for (std::uint64_t i = 0; i < 300; ++i)
    lights.push_back(light_of(PointLight{random_place(i, 200) * Vec3d{1, .3, 1} + Vec3d{0, 40, 0},
                                         {random_at(i, 1), random_at(i, 2), random_at(i, 3)}}));
  const std::vector<std::uint32_t> floor = {0};
  const std::vector<SurfaceSample> samples = sample_surface({lit.world, floor, 500}).samples;
  const auto entered = [&](int light_samples) {
    const std::vector<Light> traced = with_trees(lights);
    return combine_lights(lit.transfers(samples, traced, 0, light_samples, 0), traced);
  };
  const std::vector<RgbF> drawn = entered(64), all = entered(900);
  double off = 0, whole = 0;
  for (std::size_t i = 0; i < all.size(); ++i)
    for (std::size_t c = 0; c < 3; ++c) {
      off += std::abs(double(drawn[i][c] - all[i][c]));
      whole += double(all[i][c]);
    }
  EXPECT_LT(off, .001 * whole);
}

// Claim: behind a wall that shades red bulbs, and not the green ones beside them, each channel has in the mean over seeds
// what all bulbs bring, also of two that are drawn. Source: a draw's control has the mean of its stratum, and counts as
// far as the others are lit. Tolerance: 4 standard errors of 40 seeds. Fails when: the control has the mean of all
// strata, or counts as far as the draw itself is lit.
TEST(ManyLights, ShadowsKeepTheirColour) {
  const LitWorld lit(world_of({QuadShape{{-10, 0, 10}, {20, 0, 0}, {0, 0, -20}},
                               QuadShape{{-12, 0, 100}, {0, 60, 0}, {0, 0, -200}}}));
  std::vector<Light> lights;
  for (std::uint64_t i = 0; i < 40; ++i) {
    const bool is_red = i % 2 == 0;
    const Vec3d place = random_place(i, 30) + Vec3d{is_red ? -60. : 60., 30, 0};
    lights.push_back(light_of(PointLight{place, is_red ? Rgb{1, .2, .1} : Rgb{.1, 1, .3}}));
  }
  const std::vector<Light> traced = with_trees(lights);
  std::vector<SurfacePoint> points;
  std::vector<std::uint64_t> keys;
  for (std::uint64_t i = 0; i < 200; ++i) {
    points.push_back(lit.rays.surface_point(0, std::uint32_t(i % 2), float(.5 * random_at(i, 8)),
                                            float(.5 * random_at(i, 9))));
    keys.push_back(i);
  }
  const auto mean_entered = [&](int light_samples, std::uint64_t seed) {
    RgbF sum;
    for (const RgbF& e : irradiance_at({lit.rays, points, keys, traced, 0, light_samples, seed})) sum += e;
    return sum;
  };
  const RgbF all = mean_entered(120, 0);
  std::array<Mean, 3> drawn;
  for (std::uint64_t seed = 0; seed < 40; ++seed) {
    const RgbF sum = mean_entered(6, seed);
    for (std::size_t c = 0; c < 3; ++c) drawn[c].add(double(sum[c]));
  }
  for (std::size_t c = 0; c < 3; ++c) {
    EXPECT_LT(std::abs(drawn[c].errors_from(double(all[c]))), 4)
        << c << ": " << drawn[c].mean() << ' ' << all[c];
    EXPECT_LT(drawn[c].error(), .05 * double(all[c])) << c;
  }
}

// Claim: the weights have the same bytes on one thread and three, and channels have those of a light alone. Source: the
// project's promise. Tolerance: none. Fails when: what is drawn hangs on the order of the points.
TEST(ManyLights, AreTheSameForAnyThreads) {
  const Place place;
  const std::vector<Light> traced = with_trees(random_lights(Kind::spot, 100));
  const auto run = [&] { return place.lit.transfers(place.samples, traced, 1.5); };
  const auto one = with_threads(1, run), three = with_threads(3, run);
  ASSERT_EQ(one.size(), 3u);
  for (std::size_t c = 0; c < 3; ++c) {
    EXPECT_TRUE(same_bytes(one[c].weights, three[c].weights)) << c;
    EXPECT_GT(mean_of(one[c].weights), 0) << c;
    EXPECT_TRUE(same_bytes(one[c].weights, place.lit.transfer(place.samples, traced[c], 1.5).weights)) << c;
  }
}

// Claim: the stated standard error of points' irradiance is within a factor of 1.5 of the true one, for few places and
// many, and 0 but for rounding where all lights are drawn. Source: what enters in two halves of a draw. Tolerance: the
// mean over points. Fails when: lights drawn surely count as noise, or neighbours in the draw go to the same half.
TEST(ManyLights, StateTheirError) {
  const Place place;
  const std::vector<Light> traced = with_trees(random_lights(Kind::point, 300));
  std::vector<SurfacePoint> points;
  std::vector<std::uint64_t> keys;
  for (const SurfaceSample& s : place.samples) {
    points.push_back(place.lit.rays.surface_point(s.mesh, s.triangle, s.u, s.v));
    keys.push_back(keys.size());
  }
  const auto at = [&](int light_samples, std::vector<Rgb>& variance) {
    variance.assign(points.size(), {});
    return irradiance_at({place.lit.rays, points, keys, traced, 1.5, light_samples, 5, variance});
  };
  std::vector<Rgb> variance, none;
  const std::vector<RgbF> exact = at(1200, none);
  double rounding = 0, whole = 0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    rounding += std::sqrt(none[i].y);
    whole += double(exact[i].y);
  }
  EXPECT_LT(rounding, 1e-4 * whole);
  for (const int light_samples : {16, 64, 256}) {
    const std::vector<RgbF> drawn = at(light_samples, variance);
    double stated = 0, squares = 0;
    for (std::size_t i = 0; i < points.size(); ++i) {
      stated += variance[i].y;
      squares += std::pow(double(drawn[i].y) - double(exact[i].y), 2);
    }
    EXPECT_LT(std::abs(std::log(stated / squares)), 2 * std::log(1.5)) << light_samples;
    EXPECT_LT(squares, std::pow(whole / double(points.size()), 2) * double(points.size())) << light_samples;
  }
}

// Claim: a ray meets of a tree's lamps the nearest, or none where it meets none. Source: lamp by lamp. Tolerance: none.
// Fails when: a subtree is passed over that the ray crosses.
TEST(LightTree, FindsTheNearestLamp) {
  const std::vector<Light> lamps = random_lights(Kind::sphere, 200);
  const LightTree tree(lamps);
  int met = 0;
  for (std::uint64_t i = 0; i < 8000; ++i) {
    const Vec3f origin(random_place(i + 31, 150)), way(random_way(i + 31));
    const float far = float(200 * random_at(i, 31));
    EmitterHit nearest;
    for (const Light& lamp : lamps) {
      const EmitterHit hit = intersect_emitter(lamp, origin, way, nearest.hit ? nearest.t : far);
      if (hit.hit) nearest = hit;
    }
    const auto found = tree.first_met(origin, way, far);
    ASSERT_EQ(found.has_value(), nearest.hit) << i;
    if (found) {
      EXPECT_EQ(intersect_emitter(lamps[*found], origin, way, far).t, nearest.t);
    }
    met += nearest.hit;
  }
  EXPECT_GT(met, 60);
}

}  // namespace
}  // namespace opaline
