// SPDX-License-Identifier: GPL-3.0-or-later
// The mean irradiance around a point of a curved surface.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/random.h"
#include "methods/hierarchical/near_field/near_field_means.h"
#include "support/scenes.h"

namespace opaline::test {
namespace {

// Straight distance from the ball's top to the first lit place, over the ball's radius.
constexpr double kDarkWithin = 0.5;
constexpr std::size_t kPlaces = 1 << 14;

// A place on a ball whose top is the origin; cosine: of the angle from the top, seen from the ball's centre.
SurfacePoint on_ball(float radius, double cosine, double azimuth) {
  const double sine = std::sqrt(1 - cosine * cosine);
  const Vec3f normal(Vec3d{sine * std::cos(azimuth), sine * std::sin(azimuth), cosine});
  return {normal * radius - Vec3f{0, 0, radius}, normal, normal};
}

RgbF light_at(const SurfacePoint& place, float radius) {
  return RgbF(length(place.position) > float(kDarkWithin) * radius ? 1.0f : 0.0f);
}

// A ball's area within a straight distance r of a point is that of the disc, pi r^2 (Archimedes): the mean is
// the lit part of the near kernel's integral over the plane, out to where the ball turns away.
RgbF expected_mean(const NearKernel& kernel, float radius) {
  RgbF lit, all;
  for (std::size_t i = 0; i < NearKernel::kRings; ++i) {
    const float r = kernel.radius * (float(i) + 0.5f) / NearKernel::kRings;
    if (r > std::numbers::sqrt2_v<float> * radius) break;
    for (std::size_t c = 0; c < 3; ++c) {
      const float part = kernel.densities[i][c] * r;
      all[c] += part;
      lit[c] += r > float(kDarkWithin) * radius ? part : 0;
    }
  }
  return {lit.x / all.x, lit.y / all.y, lit.z / all.z};
}

Scene lit_ball() {
  Scene scene = single_shape(SphereShape{{}, 10}, marble(), 2000);
  scene.lights.push_back({"lamp", PointLight{{0, 0, 100}, {1, 1, 1}}});
  return scene;
}

class NearFieldMeansOnABall : public testing::Test {
 protected:
  NearFieldMeansOnABall() : prepared_(lit_ball()), kernel_(prepared_.bodies[0]) {}

  void expect_mean(const NearFieldMeans& means, float relative) const {
    const RgbF mean = means.mean(0), expected = expected_mean(kernel_, radius_);
    for (std::size_t c = 0; c < 3; ++c) {
      EXPECT_GT(expected[c], 0.1f);
      EXPECT_NEAR(mean[c], expected[c], relative * expected[c]) << c;
    }
  }

  const Prepared prepared_;
  const NearKernel kernel_;
  const float radius_ = 1.5f * std::max({kernel_.half.x, kernel_.half.y, kernel_.half.z});
  const std::vector<SurfacePoint> top_{on_ball(radius_, 1, 0)};
  const std::vector<std::uint32_t> chosen_{0};
};

// Claim: light that enters round a bend counts in full in means over a lattice. Source: expected_mean.
// Tolerance: 1 %, the noise of so many places. Fails if: steep places count for less than their area (by 1.5
// times the cosine, at most 1: 8 to 9 % too little).
TEST_F(NearFieldMeansOnABall, OfALattice) {
  IrradianceLattice::Cell cell;
  for (std::size_t i = 0; i < kPlaces; ++i) {
    const auto [u, v] = r2_point(i, {0.5, 0.5});
    cell.points.push_back(on_ball(radius_, u, 2 * std::numbers::pi * v));  // even over the upper half
    cell.areas.push_back(1);
    cell.entered.push_back(light_at(cell.points.back(), radius_));
  }
  cell.low = Vec3f(-radius_);
  cell.high = Vec3f(radius_);
  NearFieldMeans means(kernel_, top_, chosen_, {});
  const IrradianceLattice::Cell* const cells[]{&cell};
  means.add_lattice(cells);
  expect_mean(means, 0.01f);
}

// Claim: places that the point draws say the same, but for the most grazing ones. Source: as above;
// near_field_means.cpp, kGrazing. Tolerance: 3 %. Fails if: they count as drawn by their straight distance (10
// to 12 % too little), or with the density in the tangent plane (18 to 21 %).
TEST_F(NearFieldMeansOnABall, OfDrawnPlaces) {
  std::vector<SurfacePoint> places;
  std::vector<RgbF> entered;
  for (std::size_t i = 0; i < kPlaces; ++i) {
    const auto [u, v] = r2_point(i, {0.5, 0.5});
    const double sine = kernel_.drawn_distance(u) / double(radius_);
    if (sine >= 1) continue;
    places.push_back(on_ball(radius_, std::sqrt(1 - sine * sine), 2 * std::numbers::pi * v));
    entered.push_back(light_at(places.back(), radius_));
  }
  const std::vector<int> drawn{int(kPlaces)};
  NearFieldMeans means(kernel_, top_, chosen_, drawn);
  means.add_drawn(places, entered);
  expect_mean(means, 0.03f);
}

}  // namespace
}  // namespace opaline::test
