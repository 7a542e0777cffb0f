// SPDX-License-Identifier: GPL-3.0-or-later
// Equal and nearly equal vertices are joined; doubles, triangles without area and unused vertices are dropped.
#include <cmath>
#include <ctime>

#include "mesh_test.h"

namespace opaline {
namespace {

using namespace mesh_test;

// Claim: a fine mesh flattened to nothing is refused at once. Found by fuzz_render: 24 s of CPU went into its parts. Fails if: its winding is
// looked for first.
TEST(MeshWelding, FineMeshesWithoutAreaAreRefusedAtOnce) {
  Shape shape;
  shape.source = TorusShape{{}, 6, 2};
  shape.medium = 0;
  shape.to_world = {{6.755620101586546, -1.6594690901176243, -9.420134426784022},
                    {-4.9510263245126215e-09, 9.096232606497089e-09, 4.067959597537321e-09},
                    {-2.289435736956102e+15, 37518996972236.9, 2.5218591728572415e+15},
                    {0, 0, 0.0007673434894550469}};
  const std::clock_t start = std::clock();
  try {
    make_mesh(shape, MeshUvs::unread);
    ADD_FAILURE() << "no error";
  } catch (const Error& failure) {
    EXPECT_EQ(failure.message, "the mesh has no area");
  }
  EXPECT_LT(double(std::clock() - start) / CLOCKS_PER_SEC, 2);
}

// Claim: triangles that share no vertices, only positions, are joined, zeros of either sign being the same.
// Source: check_mesh.h. Tolerance: none. Fails if: vertices are not welded.
TEST(MeshWelding, EqualPositionsAreOneVertex) {
  const Soup whole = cube(1, {1, 1, 1});
  Soup apart;
  for (const auto& triangle : whole.triangles) {
    const auto first = std::uint32_t(apart.positions.size());
    for (const std::uint32_t v : triangle) {
      apart.positions.push_back(whole.positions[v]);
      if (first % 2 == 1)
        for (std::size_t i = 0; i < 3; ++i)
          if (apart.positions.back()[i] == 0) apart.positions.back()[i] = -0.0;
    }
    apart.triangles.push_back({first, first + 1, first + 2});
  }
  const CheckedMesh joined = load(apart);
  EXPECT_EQ(joined.mesh.positions.size(), 8u);
  EXPECT_EQ(joined.report.open_edges, 0u);
}

// Claim: a sphere of sines and cosines, whose last meridian is the first but for sin(2 pi) = -2.4e-16, is closed. Source:
// what programs write as GLB and OBJ. Tolerance: none. Fails if: the seam is a row of boundary edges.
TEST(MeshWelding, SeamOfASphereOfSinesIsClosed) {
  constexpr std::uint32_t kAround = 16, kDown = 8;
  Soup soup;
  for (std::uint32_t row = 0; row <= kDown; ++row)
    for (std::uint32_t column = 0; column <= kAround; ++column) {
      const double u = 2 * M_PI * column / kAround, v = M_PI * row / kDown;
      soup.positions.push_back(Vec3d(-std::cos(u) * std::sin(v), std::cos(v), std::sin(u) * std::sin(v)) *
                               .02);
    }
  for (std::uint32_t row = 0; row < kDown; ++row)
    for (std::uint32_t column = 0; column < kAround; ++column) {
      const std::uint32_t a = row * (kAround + 1) + column, b = a + kAround + 1;
      if (row > 0) soup.triangles.push_back({a + 1, a, b + 1});
      if (row + 1 < kDown) soup.triangles.push_back({a, b, b + 1});
    }
  const CheckedMesh checked = load(soup);
  EXPECT_EQ(checked.report.open_edges, 0u);
  EXPECT_GT(signed_volume(checked.mesh), 0);
}

/// A torus or, of tube 0, a sphere of sines and cosines whose ends are not the same vertices as its beginnings.
Soup seamed(bool is_torus, const Vec3d& center) {
  constexpr std::uint32_t kAround = 24, kAcross = 12;
  Soup soup;
  for (std::uint32_t i = 0; i <= kAround; ++i)
    for (std::uint32_t j = 0; j <= kAcross; ++j) {
      const double u = 2 * M_PI * i / kAround, v = (is_torus ? 2 : 1) * M_PI * j / kAcross;
      const double r = is_torus ? 10 + 4 * std::cos(v) : 10 * std::sin(v);
      soup.positions.push_back(
          center + Vec3d(r * std::cos(u), (is_torus ? 4 * std::sin(v) : 10 * std::cos(v)), r * std::sin(u)));
    }
  for (std::uint32_t i = 0; i < kAround; ++i)
    for (std::uint32_t j = 0; j < kAcross; ++j) {
      const std::uint32_t a = i * (kAcross + 1) + j, b = a + kAcross + 1;
      soup.triangles.push_back({a, b, b + 1});
      soup.triangles.push_back({a, b + 1, a + 1});
    }
  return soup;
}

Transform turned_by(double degrees, double scale) {
  const double c = std::cos(degrees * M_PI / 180) * scale, s = std::sin(degrees * M_PI / 180) * scale;
  return {{c, s, 0}, {-s, c, 0}, {0, 0, scale}, {}};
}

// Claim: a mesh whose seams are open by rounding is closed wherever it stands: turned, scaled, sheared, mirrored, moved, fitted,
// away from its file's origin, with normals of its own, as a GLB is. Source: what programs write. Tolerance: none. Fails if:
// seams are looked for where the mesh is placed, or near zero alone.
TEST(MeshWelding, SeamsAreClosedBeforeAMeshIsPlaced) {
  std::vector<Transform> places{{}, turned_by(33.75, 1), turned_by(71, 1e-3), turned_by(12.5, 1000)};
  places.push_back({{1, .3, .2}, {.1, .9, -.4}, {0, .2, 1.1}, {1, 2, 3}});
  places.push_back({{-.7, .3, .2}, {.1, .9, -.4}, {0, .2, 1.1}, {1e4, 2, 3}});
  const ScratchFolder folder;
  for (const bool is_torus : {true, false})
    for (const Vec3d& center : {Vec3d{}, Vec3d{3.3, -.7, 101.9}})
      for (const bool has_normals : {false, true}) {
        const Soup soup = seamed(is_torus, center);
        put_bytes(
            folder.file("seam.obj"),
            has_normals ? obj_with_normals(soup, [&](const Vec3d& p) { return p - center; }) : obj(soup));
        for (std::size_t i = 0; i < places.size(); ++i) {
          Shape shape = file_shape(folder.file("seam.obj"));
          shape.to_world = places[i];
          if (i == 1) std::get<MeshFile>(shape.source).fit_size = 33;
          const CheckedMesh mesh = make_mesh(shape);
          EXPECT_EQ(mesh.report.open_edges, 0u) << is_torus << center.x << has_normals << i;
          EXPECT_GT(signed_volume(mesh.mesh), 0) << i;
        }
      }
  Shape torus = file_shape(OPALINE_TEST_INPUTS "/torus_three.obj");
  torus.to_world = turned_by(33.75, 1);
  EXPECT_EQ(make_mesh(torus).report.open_edges, 0u);
}

// Claim: vertices are not joined for being close on the scale of a mesh that reaches far: a cube beside a triangle that ends 1e16
// cubes away keeps its triangles. Source: check_mesh.h. Tolerance: none. Fails if: what is joined is not compared with triangles.
TEST(MeshWelding, FineMeshesBesideFarVerticesAreNotJoined) {
  Soup soup = cube();
  soup.positions.push_back({1e16, 0, 0});
  soup.triangles.push_back({0, 1, 8});
  EXPECT_EQ(load(soup).mesh.triangles.size(), 12u);
}

// Claim: doubles, also those wound the other way or with vertices of their own, and triangles without area
// are dropped and counted; the closed cube is left. Source: check_mesh.h. Tolerance: none. Fails if:
// duplicates are looked for before equal positions are welded, or the area test is a difference of indices
// alone.
TEST(MeshWelding, DoublesAndTrianglesWithoutAreaAreDropped) {
  Soup soup = cube();
  const auto [a, b, c] = soup.triangles[3];
  soup.triangles.push_back({b, c, a});
  soup.triangles.push_back({c, b, a});
  const auto copy = std::uint32_t(soup.positions.size());
  soup.positions.push_back(soup.positions[a]);
  soup.positions.push_back({-0.0, 0, 0});
  soup.positions.push_back({0, 0, 0});
  soup.triangles.push_back({copy, b, c});
  soup.triangles.push_back({a, copy, b});
  soup.triangles.push_back({copy + 1, copy + 2, b});
  soup.triangles.push_back({a, a, b});
  const CheckedMesh mesh = load(soup);
  EXPECT_EQ(triangle_set(mesh.mesh), triangle_set(load(cube()).mesh));
  EXPECT_EQ(mesh.report.duplicates_dropped, 3u);
  EXPECT_EQ(mesh.report.zero_area_dropped, 3u);
  EXPECT_TRUE(warns(mesh.report, "3 duplicate triangles were removed"));
  EXPECT_TRUE(warns(mesh.report, "3 triangles with zero area were removed"));
  EXPECT_EQ(mesh.report.open_edges, 0u);
}

// Claim: a double is one also if it brings normals of its own. Source, tolerance as above. Fails if: doubles
// are looked for by vertices instead of positions.
TEST(MeshWelding, DoublesWithOtherNormalsAreDropped) {
  const std::string vertices = "v 0 0 0\nv 1 0 0\nv 0 1 0\nvn 0 0 1\nvn 0 0.6 0.8\n";
  const CheckedMesh mesh = load("a.obj", vertices + "f 1//1 2//1 3//1\nf 2//2 3//2 1//2\n");
  EXPECT_EQ(mesh.mesh.triangles.size(), 1u);
  EXPECT_EQ(mesh.report.duplicates_dropped, 1u);
}

// Claim: a triangle of three points in a line is dropped but does not count as a leak. Source:
// check_mesh.cpp. Tolerance: none. Fails if: such triangles are dropped before edges are counted.
TEST(MeshWelding, SliverLeavesNoHole) {
  Soup soup = cube();
  soup.positions.push_back({0, -1, -1});             // the middle of edge 0-1
  soup.triangles.erase(soup.triangles.begin() + 1);  // 0 3 1 becomes 0 3 8, 8 3 1 ...
  soup.triangles.push_back({0, 3, 8});
  soup.triangles.push_back({8, 3, 1});
  soup.triangles.push_back({0, 8, 1});  // ... and a sliver joins them to 0 1 5
  const CheckedMesh mesh = load(soup);
  EXPECT_EQ(mesh.report.zero_area_dropped, 1u);
  EXPECT_EQ(mesh.report.open_edges, 0u);
  EXPECT_DOUBLE_EQ(surface_area(mesh.mesh), 24);
}

// Claim: vertices that no triangle uses do not survive, and do not count for fit_size. Source: make_mesh.cpp.
// Tolerance: none. Fails if: the box is taken over all positions.
TEST(MeshWelding, UnusedVerticesAreLeftOut) {
  Soup soup = cube();
  soup.positions.push_back({100, 100, 100});
  const CheckedMesh mesh = load(soup);
  EXPECT_EQ(mesh.mesh.positions.size(), 8u);
}

}  // namespace
}  // namespace opaline
