// SPDX-License-Identifier: GPL-3.0-or-later
// Balls on which vertices were dragged across their neighbours, as in scans, against the same balls without folds.
#include <cmath>
#include <sstream>

#include "../core/scratch_folder.h"
#include "core/random.h"
#include "volume/cell_fit.h"
#include "volume/cut_outer_surface.h"
#include "volume/diffused_body.h"

namespace opaline {
namespace {

using namespace test;

constexpr double kBallRadius = 10;

Mesh ball(int fineness) {
  Shape shape;
  shape.source = SphereShape{{}, kBallRadius, fineness};
  return make_mesh(shape).mesh;
}

/// Twelve vertices are dragged, each by 2.5 edges along one of its own.
Mesh folded(Mesh mesh) {
  const std::vector<Vec3d> before = mesh.positions;
  for (std::size_t i = 0; i < 12; ++i) {
    const auto& [a, b, c] = mesh.triangles[(2 * i + 1) * mesh.triangles.size() / 24];
    mesh.positions[a] = before[a] + (before[b] - before[a]) * 2.5;
  }
  return mesh;
}

/// The world of a file without normals.
World world_of_file(const Mesh& mesh, NormalMode normals) {
  std::ostringstream text;
  text.precision(17);
  for (const Vec3d& p : mesh.positions) text << "v " << p.x << ' ' << p.y << ' ' << p.z << '\n';
  for (const auto& [a, b, c] : mesh.triangles) text << "f " << a + 1 << ' ' << b + 1 << ' ' << c + 1 << '\n';
  const ScratchFolder folder;
  put_bytes(folder.file("ball.obj"), text.str());
  MeshFile file;
  file.path = folder.file("ball.obj");
  return world_of({file}, normals);
}

/// Exitance at the elements of a ball's cells, lit by a point.
struct LitBall {
  LitBody body;
  VolumeExitance exitance;

  explicit LitBall(World world) : body(std::move(world), 1) {
    constexpr double kCell = .33;  // mm
    const double unit = body.world.unit;
    CutSurface cut = cut_outer_surface(body.rays, body.world, body.meshes, kCell / unit, 1);
    body.surface = std::move(cut.surface);
    const PointLight light{{20, 35, 30}, Rgb(1)};
    const HomogeneousMedium marble{.01 * unit, 6 * unit, 0, 1.5};
    const VolumeDiffusion cells(
        {body.world, body.meshes, body.surface.samples, cut.normals, grey(marble), kCell / unit});
    exitance = cells.exitance(lights_of(body, light), transfers_of(body, light, marble.eta));
  }
};

struct FoldDifference {
  double mean = 0, largest = 0;  ///< over the clean ball's mean exitance
};

/// Compares what images show at the elements of the clean ball.
FoldDifference difference_of_folds(const LitBall& folded, const LitBall& clean) {
  const auto fit_of = [](const LitBall& lit) {
    return CellFit(lit.body.surface.samples, lit.exitance.exitance, lit.exitance.error);
  };
  const CellFit folded_fit = fit_of(folded), clean_fit = fit_of(clean);
  CellFit::Reader folded_reader(folded_fit), clean_reader(clean_fit);
  FoldDifference difference;
  double mean = 0;
  for (const SurfaceSample& s : clean.body.surface.samples) {
    const double expected = double(clean_reader.at(s.position, s.normal).value.x),
                 off = std::abs(double(folded_reader.at(s.position, s.normal).value.x) - expected),
                 share = double(s.area) / clean.body.surface.area;
    mean += share * expected;
    difference.mean += share * off;
    difference.largest = std::max(difference.largest, off);
  }
  return {difference.mean / mean, difference.largest / mean};
}

// Claim: a ball with folds sends out what the ball without them does: no discs, with computed normals and without. Source:
// the clean ball by the same cells. Tolerance: twice the differences of .004 and 1.4 %. Fails if: sheets under the top one count, which
// are dark; or light does not enter at a reversed triangle that lies on top.
TEST(Folds, BallIsLitAsWithoutThem) {
  for (const NormalMode normals : {NormalMode::smooth, NormalMode::faceted}) {
    const Mesh clean = ball(6);
    const FoldDifference difference = difference_of_folds(LitBall(world_of_file(folded(clean), normals)),
                                                          LitBall(world_of_file(clean, normals)));
    EXPECT_LT(difference.mean, .0001) << int(normals);
    EXPECT_LT(difference.largest, .03) << int(normals);
  }
}

// Claim: rays from outside meet a folded ball on surfaces that face outward, in their computed normals too. Source: the
// ball. Tolerance: a fold tilts the surface by a fifth. Fails if: reversed triangles count in the normals of
// vertices, or keep their own side.
TEST(Folds, FaceOutward) {
  const World world = world_of_file(folded(ball(6)), NormalMode::smooth);
  const RayScene rays(world);
  for (std::size_t i = 0; i < 100000; ++i) {
    const auto [u, v] = r2_point(i, {.5, .5});
    const double height = 2 * u - 1, angle = 2 * std::numbers::pi * v,
                 across = std::sqrt(1 - height * height);
    const Vec3d outward(across * std::cos(angle), height, across * std::sin(angle));
    TracedRay traced{Ray(Vec3f(outward * (2 * kBallRadius / world.unit)), Vec3f(-outward)), {}};
    rays.intersect_one(traced);
    ASSERT_NE(traced.hit.mesh, Hit::kMiss);
    const SurfacePoint point =
        rays.surface_point(traced.hit.mesh, traced.hit.triangle, traced.hit.u, traced.hit.v);
    ASSERT_GT(dot(Vec3d(point.normal), outward), .9) << i;
    ASSERT_GT(dot(Vec3d(point.geometric), outward), 0) << i;
  }
}

// Claim: of coincident sheets one counts, of two that face each other none. Source: by hand. Tolerance: the triangles'
// .1 %, doubled. Fails if: rays that go on behind a sheet miss those in the same place; or samples cover each copy.
TEST(Folds, CoincidentSheetsCountOnce) {
  const SphereShape one{{}, kBallRadius, 4};
  const BoxShape left{{-4, -4, -4}, {0, 4, 4}}, right{{0, -4, -4}, {4, 4, 4}};
  const auto expect_area = [](const std::vector<ShapeSource>& shapes, double area, bool sampled) {
    const World world = world_of(shapes);
    const RayScene rays(world);
    std::vector<std::uint32_t> meshes(shapes.size());
    std::iota(meshes.begin(), meshes.end(), 0u);
    area /= world.unit * world.unit;
    EXPECT_NEAR(cut_outer_surface(rays, world, meshes, .8 / world.unit, 1).surface.area / area, 1, .002);
    if (!sampled) return;
    EXPECT_NEAR(sample_surface({world, meshes, 2000}).area / area, 1, .002);
  };
  expect_area({one, one}, 4 * std::numbers::pi * kBallRadius * kBallRadius, true);
  expect_area({left, right}, 6 * 64, false);
}

}  // namespace
}  // namespace opaline
