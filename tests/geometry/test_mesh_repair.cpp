// SPDX-License-Identifier: GPL-3.0-or-later
// What is wrong with a mesh is mended or said: winding, doubles, triangles without area, holes.
#include <algorithm>
#include <cmath>
#include <functional>
#include <set>

#include "mesh_test.h"

namespace opaline {
namespace {

using namespace mesh_test;

/// The triangles as a set, each starting at its lowest vertex: equal for equal meshes.
std::set<std::array<std::uint32_t, 3>> triangle_set(const Mesh& mesh) {
  std::set<std::array<std::uint32_t, 3>> set;
  for (auto triangle : mesh.triangles) {
    std::rotate(triangle.begin(), std::min_element(triangle.begin(), triangle.end()), triangle.end());
    set.insert(triangle);
  }
  return set;
}

// Claim: a closed mesh wound inward becomes the one wound outward, counted and said. Source: check_mesh.h.
// Tolerance: none. Fails if: the sign of the volume is not looked at.
TEST(MeshRepair, FlippedWindingGivesTheSameMesh) {
  const CheckedMesh good = load(cube()), bad = load(flipped(cube()));
  EXPECT_EQ(triangle_set(bad.mesh), triangle_set(good.mesh));
  EXPECT_EQ(bad.mesh.normals, good.mesh.normals);
  EXPECT_EQ(bad.report.flipped, 12u);
  EXPECT_TRUE(warns(bad.report, "12 triangles of closed parts wound inward were flipped"));
  EXPECT_EQ(good.report.flipped, 0u);
}

// Claim: whichever triangles are flipped, the same mesh comes out. Source, tolerance as above. Fails if:
// neighbours are not compared, or the relation is lost in the union-find's short cuts.
TEST(MeshRepair, MixedWindingGivesTheSameMesh) {
  const auto good = triangle_set(load(cube()).mesh);
  for (unsigned mask = 1; mask < 4095; mask += 37) {
    Soup soup = cube();
    std::size_t count = 0;
    for (std::size_t t = 0; t < 12; ++t) {
      if ((mask >> t & 1) == 0) continue;
      std::swap(soup.triangles[t][1], soup.triangles[t][2]);
      ++count;
    }
    const CheckedMesh mended = load(soup);
    EXPECT_EQ(triangle_set(mended.mesh), good) << mask;
    EXPECT_EQ(mended.report.flipped, count) << mask;
    EXPECT_TRUE(warns(mended.report, "wound against their neighbours")) << mask;
  }
}

// Claim: where neighbours disagree in an open mesh, which has no outside, the larger part wins. Source:
// orient.h. Tolerance: none. Fails if: the first triangle of a part always wins.
TEST(MeshRepair, MajorityDecidesInOpenMeshes) {
  Soup soup = cube();
  soup.triangles.pop_back();
  const CheckedMesh good = load(soup);
  std::swap(soup.triangles[0][1], soup.triangles[0][2]);
  const CheckedMesh mended = load(soup);
  EXPECT_EQ(triangle_set(mended.mesh), triangle_set(good.mesh));
  EXPECT_EQ(mended.report.flipped, 1u);
}

// Claim: triangles that share no vertices, only positions, are joined, zeros of either sign being the same.
// Source: check_mesh.h. Tolerance: none. Fails if: vertices are not welded.
TEST(MeshRepair, EqualPositionsAreOneVertex) {
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

// Claim: a cavity (a closed part wound inward inside another) stays one; a file that is inside out as a
// whole, cavity and all, is turned as a whole; parts side by side are judged each for itself. Source: the
// brief. Tolerance: rounding of volumes. Fails if: every closed part is wound outward, or boxes alone decide
// nesting.
TEST(MeshRepair, CavityIsKept) {
  Soup shell = cube(2);
  append(shell, flipped(cube(1)));
  EXPECT_DOUBLE_EQ(signed_volume(load(shell).mesh), 64 - 8);
  EXPECT_EQ(load(shell).report.flipped, 0u);
  EXPECT_DOUBLE_EQ(signed_volume(load(flipped(shell)).mesh), 64 - 8);
  EXPECT_EQ(load(flipped(shell)).report.flipped, 24u);

  Soup apart = cube(2);
  append(apart, flipped(cube(1, {5, 0, 0})));
  EXPECT_DOUBLE_EQ(signed_volume(load(apart).mesh), 64 + 8);
  EXPECT_EQ(load(apart).report.flipped, 12u);

  Soup beside_sphere = sphere(10);  // inside the sphere's box, outside the sphere
  const double sphere_volume = signed_volume(load(beside_sphere).mesh);
  append(beside_sphere, flipped(cube(0.5, {9, 9, 9})));
  EXPECT_NEAR(signed_volume(load(beside_sphere).mesh), sphere_volume + 1, 1e-9);
}

Soup without(Soup soup, const std::function<bool(const Vec3d&)>& is_dropped) {
  std::erase_if(soup.triangles, [&](const auto& t) {
    return std::ranges::all_of(t, [&](std::uint32_t v) { return is_dropped(soup.positions[v]); });
  });
  return soup;
}

Soup moved(Soup soup, const Vec3d& by) {
  for (Vec3d& p : soup.positions) p = p + by;
  return soup;
}

Soup joined(Soup a, const Soup& b) {
  append(a, b);
  return a;
}

/// A tube around y without ends.
Soup tube(double radius, double height) {
  constexpr std::uint32_t kAround = 24;
  Soup soup;
  for (std::uint32_t i = 0; i < kAround; ++i)
    for (const double y : {0., height})
      soup.positions.push_back(
          {radius * std::cos(2 * M_PI * i / kAround), y, -radius * std::sin(2 * M_PI * i / kAround)});
  for (std::uint32_t i = 0; i < 2 * kAround; i += 2) {
    const std::uint32_t a = i, b = (i + 2) % (2 * kAround);
    soup.triangles.push_back({a, b, b + 1});
    soup.triangles.push_back({a, b + 1, a + 1});
  }
  return soup;
}

/// The faces of a cube, a little apart.
Soup exploded_cube() {
  const Soup whole = cube();
  Soup soup;
  for (std::size_t t = 0; t < 12; t += 2) {
    Soup face{whole.positions, {whole.triangles[t], whole.triangles[t + 1]}};
    Vec3d middle;
    for (const auto& triangle : face.triangles)
      for (const std::uint32_t v : triangle) middle = middle + face.positions[v] / 6.;
    append(soup, moved(face, middle * 1e-4));
  }
  return soup;
}

CheckedMesh load_body(const std::string& name, const std::string& bytes,
                      NormalMode normals = NormalMode::smooth) {
  const ScratchFolder folder;
  put_bytes(folder.file(name), bytes);
  Shape shape = file_shape(folder.file(name));
  shape.medium = 0;
  shape.normals = normals;
  return make_mesh(shape);
}

CheckedMesh load_body(const Soup& soup) {
  return load_body("soup.obj", obj(soup));
}

/// Open surfaces of bodies, wound outward.
std::vector<std::pair<std::string, Soup>> open_bodies() {
  const Soup ball = sphere();
  Soup pierced = ball;
  pierced.triangles.pop_back();
  Soup mixed = pierced;
  for (std::size_t t = 0; t < mixed.triangles.size(); t += 5)
    std::swap(mixed.triangles[t][1], mixed.triangles[t][2]);
  const Soup half = without(ball, [](const Vec3d& p) { return p.y > -1e-9; });
  const Soup bust = without(ball, [](const Vec3d& p) { return p.y < -.6; });
  Soup open_cube = cube();
  open_cube.triangles.resize(10);
  Soup smaller = ball;
  for (Vec3d& p : smaller.positions) p *= .5;
  smaller.triangles.pop_back();
  Soup inner_half = half;
  for (Vec3d& p : inner_half.positions) p *= .9;
  return {{"one triangle missing", pierced},
          {"half a sphere", half},
          {"a bust", bust},
          {"a box without its lid", open_cube},
          {"a long tube", tube(1, 9)},
          {"a short tube", tube(1, 1)},
          {"two bodies", joined(pierced, moved(bust, {3, 0, 0}))},
          {"two bowls", joined(half, moved(half, {3, 0, 0}))},
          {"an open cavity in an open body", joined(pierced, flipped(smaller))},
          {"a closed cavity in an open body", joined(pierced, flipped(cube(.3)))},
          {"a bowl of two sheets", joined(half, flipped(inner_half))},
          {"faces apart", exploded_cube()}};
}

// Claim: an open body wound inward becomes the one wound outward, in words; one wound outward is left. Source: the same
// triangles turned round. Tolerance: none. Fails if: closed parts alone are decided, or open cavities are turned outward.
TEST(MeshRepair, OpenBodiesAreWoundOutward) {
  for (const auto& [what, soup] : open_bodies()) {
    SCOPED_TRACE(what);
    const CheckedMesh good = load_body(soup), bad = load_body(flipped(soup));
    EXPECT_EQ(good.report.flipped, 0u);
    EXPECT_FALSE(warns(good.report, "wound inward"));
    EXPECT_EQ(triangle_set(bad.mesh), triangle_set(good.mesh));
    EXPECT_EQ(bad.mesh.normals, good.mesh.normals);
    EXPECT_EQ(bad.report.flipped, soup.triangles.size());
    EXPECT_TRUE(warns(bad.report, "wound inward"));
    const CheckedMesh stl = load_body("soup.stl", binary_stl(flipped(soup)));
    EXPECT_EQ(stl.report.flipped, soup.triangles.size());
  }
}

// Claim: where some triangles of an open body are wound against the others, all of them end outward. Source, tolerance as
// above. Fails if: the larger half decides.
TEST(MeshRepair, OpenBodiesOfMixedWindingAreWoundOutward) {
  Soup soup = sphere();
  soup.triangles.pop_back();
  const auto good = triangle_set(load_body(soup).mesh);
  for (const std::size_t step : {2u, 3u, 7u}) {
    Soup mixed = flipped(soup);
    for (std::size_t t = 0; t < mixed.triangles.size(); t += step)
      std::swap(mixed.triangles[t][1], mixed.triangles[t][2]);
    EXPECT_EQ(triangle_set(load_body(mixed).mesh), good) << step;
  }
}

/// Faces and, at their corners, the normals of a function.
std::string obj_with_normals(const Soup& soup, const std::function<Vec3d(const Vec3d&)>& normal) {
  std::string text = obj({soup.positions, {}});
  for (const Vec3d& p : soup.positions) {
    const Vec3d n = normal(p);
    text += "vn " + std::to_string(n.x) + ' ' + std::to_string(n.y) + ' ' + std::to_string(n.z) + '\n';
  }
  for (const auto& triangle : soup.triangles) {
    text += 'f';
    for (const std::uint32_t v : triangle) {
      const std::string number = std::to_string(v + 1);
      text += ' ' + number + "//" + number;
    }
    text += '\n';
  }
  return text;
}

Soup flat_sheet() {
  return {{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}}, {{0, 1, 2}, {0, 2, 3}}};
}

// Claim: a sheet, which has no inside, faces where the file's normals point, faceted or not; without normals, or with normals
// that disagree, as its triangles are wound. Source: outward.h. Tolerance: none. Fails if: the winding decides against the
// normals, or rounding decides a sheet.
TEST(MeshRepair, SheetsGoByTheirNormals) {
  const Soup sheet = flat_sheet();
  const auto up = [](const Vec3d&) { return Vec3d{0, 0, 1}; };
  const auto either = [](const Vec3d& p) { return Vec3d{0, 0, p.x - .5}; };
  for (const NormalMode mode : {NormalMode::smooth, NormalMode::faceted}) {
    EXPECT_EQ(load_body("a.obj", obj_with_normals(sheet, up), mode).report.flipped, 0u);
    const CheckedMesh turned = load_body("a.obj", obj_with_normals(flipped(sheet), up), mode);
    EXPECT_EQ(turned.report.flipped, 2u);
    EXPECT_TRUE(warns(turned.report, "against the file's normals"));
    EXPECT_FALSE(warns(turned.report, "pointed into the surface"));
    EXPECT_EQ(load_body("a.obj", obj_with_normals(flipped(sheet), either), mode).report.flipped, 0u);
  }
  EXPECT_EQ(load_body(sheet).report.flipped + load_body(flipped(sheet)).report.flipped, 0u);
  EXPECT_TRUE(warns(load_body(flipped(sheet)).report, "open mesh: 4 boundary edges"));
  for (double angle = .1; angle < 3;
       angle += .1) {  // nothing but rounding tells the sides of a tilted sheet apart
    Soup tilted_sheet = sheet;
    for (Vec3d& p : tilted_sheet.positions) p = {p.x, p.y * std::cos(angle), p.y * std::sin(angle) + p.x / 3};
    EXPECT_EQ(load_body(tilted_sheet).report.flipped + load_body(flipped(tilted_sheet)).report.flipped, 0u);
  }
}

// Claim: normals turned inward with the winding do not hide that a nearly closed body is inside out; half a sphere, which may be
// meant to be seen from within, goes by its normals. Source: outward.h. Tolerance: none. Fails if: either of volume and normals
// is asked alone.
TEST(MeshRepair, NormalsDecideWhereVolumeIsNotSure) {
  const auto in = [](const Vec3d& p) { return -p; };
  const auto out = [](const Vec3d& p) { return p; };
  Soup pierced = sphere();
  pierced.triangles.pop_back();
  const Soup half = without(sphere(), [](const Vec3d& p) { return p.y > -1e-9; });
  EXPECT_EQ(load_body("a.obj", obj_with_normals(flipped(pierced), in)).report.flipped,
            pierced.triangles.size());
  EXPECT_EQ(load_body("a.obj", obj_with_normals(flipped(pierced), out)).report.flipped,
            pierced.triangles.size());
  EXPECT_EQ(load_body("a.obj", obj_with_normals(flipped(half), in)).report.flipped, 0u);
  EXPECT_EQ(load_body("a.obj", obj_with_normals(flipped(half), out)).report.flipped, half.triangles.size());
}

// Claim: without a medium, open parts keep their winding: opaque sheets have two equal sides. Source: make_mesh.h. Tolerance:
// none. Fails if: a room is turned round.
TEST(MeshRepair, OpenPartsWithoutMediumStay) {
  for (const auto& [what, soup] : open_bodies()) {
    if (what == "a closed cavity in an open body") continue;
    EXPECT_EQ(load(flipped(soup)).report.flipped, 0u) << what;
  }
}

// Claim: a GLB wound against its normals, an open sphere, is turned by them, and an edit that moves it finds the same. Source:
// the file's normals. Tolerance: none. Fails if: what an earlier check remembers is taken for a mesh that was turned.
TEST(MeshRepair, OpenGlbIsTurned) {
  Shape shape = file_shape(OPALINE_TEST_INPUTS "/bowl_winding.glb");
  std::get<MeshFile>(shape.source).part = "0/0";
  shape.medium = 0;
  MeshMemory memory;
  for (int i = 0; i < 3; ++i) {
    const CheckedMesh bowl = make_mesh(shape, memory);
    EXPECT_EQ(bowl.report.flipped, bowl.mesh.triangles.size());
    for (const auto& [a, b, c] : bowl.mesh.triangles) {
      const Vec3d &p = bowl.mesh.positions[a],
                  normal = cross(bowl.mesh.positions[b] - p, bowl.mesh.positions[c] - p);
      ASSERT_GT(dot(normal, Vec3d(bowl.mesh.normals[a])), 0);
      ASSERT_GT(dot(normal, p - shape.to_world.translation), 0);
    }
    shape.to_world.translation = {double(i), 2, 3};
  }
}

// Claim: doubles, also those wound the other way or with vertices of their own, and triangles without area
// are dropped and counted; the closed cube is left. Source: check_mesh.h. Tolerance: none. Fails if:
// duplicates are looked for before equal positions are welded, or the area test is a difference of indices
// alone.
TEST(MeshRepair, DoublesAndTrianglesWithoutAreaAreDropped) {
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
  EXPECT_TRUE(warns(mesh.report, "3 triangles given twice were dropped"));
  EXPECT_TRUE(warns(mesh.report, "3 triangles without area were dropped"));
  EXPECT_EQ(mesh.report.open_edges, 0u);
}

// Claim: a double is one also if it brings normals of its own. Source, tolerance as above. Fails if: doubles
// are looked for by vertices instead of positions.
TEST(MeshRepair, DoublesWithOtherNormalsAreDropped) {
  const std::string vertices = "v 0 0 0\nv 1 0 0\nv 0 1 0\nvn 0 0 1\nvn 0 0.6 0.8\n";
  const CheckedMesh mesh = load("a.obj", vertices + "f 1//1 2//1 3//1\nf 2//2 3//2 1//2\n");
  EXPECT_EQ(mesh.mesh.triangles.size(), 1u);
  EXPECT_EQ(mesh.report.duplicates_dropped, 1u);
}

// Claim: a triangle of three points in a line is dropped but does not count as a leak. Source:
// check_mesh.cpp. Tolerance: none. Fails if: such triangles are dropped before edges are counted.
TEST(MeshRepair, SliverLeavesNoHole) {
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

// Claim: open and non-manifold meshes are taken and said, a Moebius strip too. Source: check_mesh.h.
// Tolerance: none. Fails if: edges with one, or more than two, triangles are not counted.
TEST(MeshRepair, OpenAndNonManifoldAreSaid) {
  Soup open = cube();
  open.triangles.pop_back();
  EXPECT_EQ(load(open).report.open_edges, 3u);
  EXPECT_TRUE(warns(load(open).report, "open mesh: 3 boundary edges; light can leak"));

  Soup fin = cube();
  fin.positions.push_back({0, -2, -1});
  fin.triangles.push_back({0, 1, 8});
  EXPECT_EQ(load(fin).report.non_manifold_edges, 1u);
  EXPECT_EQ(load(fin).report.open_edges, 2u);
  EXPECT_TRUE(warns(load(fin).report, "non-manifold mesh: 1 edges"));

  Soup strip;
  for (int i = 0; i < 10; ++i) {
    const double turn = i / 2 * 2 * M_PI / 5, tilt = turn / 2, r = 1 + (i % 2 ? 0.3 : -0.3) * std::cos(tilt);
    strip.positions.push_back(
        {r * std::cos(turn), (i % 2 ? 0.3 : -0.3) * std::sin(tilt), r * std::sin(turn)});
  }
  for (std::uint32_t i = 0; i < 8; ++i) strip.triangles.push_back({i, i + 1, i + 2});
  strip.triangles.push_back({8, 9, 1});
  strip.triangles.push_back({9, 1, 0});
  EXPECT_EQ(load(strip).mesh.triangles.size(), 10u);
  EXPECT_TRUE(warns(load(strip).report, "one-sided surface"));
}

// Claim: a sphere with its cap cut off is closed by fill_holes with the cap's rim as the only vertices, wound
// like the rest, and the area gained is the rim's polygon. Source: the disc of radius sin(angle) of the rim.
// Tolerance: 3e-3 relative, the staircase of the rim. Fails if: the patch is not added, or turned round.
TEST(MeshRepair, CapOfASphereIsFilled) {
  Soup soup = sphere();
  std::erase_if(soup.triangles, [&](const auto& t) {
    return soup.positions[t[0]].y > 0.8 && soup.positions[t[1]].y > 0.8 && soup.positions[t[2]].y > 0.8;
  });
  const CheckedMesh open = load(soup), closed = load(soup, true);
  EXPECT_GT(open.report.open_edges, 100u);
  EXPECT_EQ(open.report.holes_filled, 0u);
  EXPECT_EQ(closed.report.open_edges, 0u);
  EXPECT_EQ(closed.report.holes_filled, 1u);
  EXPECT_EQ(closed.report.hole_triangles_added, open.report.open_edges - 2);
  EXPECT_EQ(closed.report.flipped, 0u);
  EXPECT_EQ(closed.mesh.positions.size(), open.mesh.positions.size());
  EXPECT_NEAR(surface_area(closed.mesh) - surface_area(open.mesh), M_PI * 0.36, 0.05);
  EXPECT_NEAR(signed_volume(closed.mesh), M_PI * (4 / 3.0 - 0.04 * 2.8 / 3), 3e-3 * 4);
  EXPECT_FALSE(warns(closed.report, "open mesh"));
}

// Claim: a sphere of sines and cosines, whose last meridian is the first but for sin(2 pi) = -2.4e-16, is closed. Source:
// what programs write as GLB and OBJ. Tolerance: none. Fails if: the seam is a row of boundary edges.
TEST(MeshRepair, SeamOfASphereOfSinesIsClosed) {
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
TEST(MeshRepair, SeamsAreClosedBeforeAMeshIsPlaced) {
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
TEST(MeshRepair, FineMeshesBesideFarVerticesAreNotJoined) {
  Soup soup = cube();
  soup.positions.push_back({1e16, 0, 0});
  soup.triangles.push_back({0, 1, 8});
  EXPECT_EQ(load(soup).mesh.triangles.size(), 12u);
}

// Claim: holes are filled in a mesh that CGAL's half-edges do not take as it is (two fans meeting in one
// vertex, a fin on an edge), and what is no hole is left. Source: repair_mesh.cpp. Tolerance: none. Fails if:
// vertices that CGAL doubles are not led back.
TEST(MeshRepair, HolesBesideNonManifoldPlacesAreFilled) {
  Soup soup = cube();
  append(soup, cube(1, {2, 2, 2}));                   // touches the first at one vertex
  soup.triangles.erase(soup.triangles.begin() + 12);  // a hole in the second, at that vertex
  soup.triangles.erase(soup.triangles.begin() + 2);   // and one in the first
  soup.positions.push_back({0, -2, -1});
  soup.triangles.push_back({0, 1, 16});  // a fin
  const CheckedMesh mesh = load(soup, true);
  EXPECT_EQ(mesh.report.holes_filled, 2u);
  EXPECT_EQ(mesh.report.open_edges, 2u);
  EXPECT_EQ(mesh.mesh.triangles.size(), 25u);
}

// Claim: a hole with several fillings as good as each other has the same one wherever memory lies. Source: the fuzzer's
// "the same mesh". Tolerance: none. Fails if: CGAL looks among the triangles of a Delaunay tetrahedrization, whose order is
// that of addresses.
TEST(MeshRepair, TiesAreBrokenTheSameWay) {
  Soup soup;
  soup.positions = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {0, 0, 1}, {1, 0, 1}, {1, 1, 1}, {0, 1, 1}};
  soup.triangles = {{0, 3, 2}, {0, 2, 1}, {4, 5, 6}, {4, 6, 7}, {0, 1, 5},
                    {0, 5, 4}, {1, 2, 6}, {1, 6, 5}, {2, 4, 7}};
  const auto first = load(soup, true).mesh.triangles;
  std::vector<std::vector<char>> held;
  for (std::size_t i = 0; i < 300; ++i) {
    // Blocks of all sizes, every second one given back: addresses no longer rise.
    for (std::size_t size = 16; size < 700; size += 8) held.emplace_back(size + i % 7);
    for (std::size_t k = i % 2; k < held.size(); k += 2) std::vector<char>().swap(held[k]);
    ASSERT_EQ(load(soup, true).mesh.triangles, first) << i;
  }
}

// Claim: vertices that no triangle uses do not survive, and do not count for fit_size. Source: make_mesh.cpp.
// Tolerance: none. Fails if: the box is taken over all positions.
TEST(MeshRepair, UnusedVerticesAreLeftOut) {
  Soup soup = cube();
  soup.positions.push_back({100, 100, 100});
  const CheckedMesh mesh = load(soup);
  EXPECT_EQ(mesh.mesh.positions.size(), 8u);
}

}  // namespace
}  // namespace opaline
