// SPDX-License-Identifier: GPL-3.0-or-later
// Open surfaces of bodies are wound outward: by the file's normals or by the volume with holes closed.
#include <algorithm>
#include <cmath>
#include <functional>

#include "mesh_test.h"

namespace opaline {
namespace {

using namespace mesh_test;

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
  const Soup cap = without(ball, [](const Vec3d& p) { return p.y < std::cos(.3 * M_PI) + 1e-9; });
  return {{"one triangle missing", pierced},
          {"a cap of 54 degrees", cap},
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
TEST(OpenBodies, OpenBodiesAreWoundOutward) {
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
TEST(OpenBodies, OpenBodiesOfMixedWindingAreWoundOutward) {
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

std::string ply_with_normals(const Soup& soup, const std::function<Vec3d(const Vec3d&)>& normal) {
  std::ostringstream text;
  text << "ply\nformat ascii 1.0\nelement vertex " << soup.positions.size();
  for (const char* name : {"x", "y", "z", "nx", "ny", "nz"}) text << "\nproperty float " << name;
  text << "\nelement face " << soup.triangles.size()
       << "\nproperty list uchar int vertex_indices\nend_header\n";
  for (const Vec3d& p : soup.positions) {
    const Vec3d n = normal(p);
    text << p.x << ' ' << p.y << ' ' << p.z << ' ' << n.x << ' ' << n.y << ' ' << n.z << '\n';
  }
  for (const auto& [a, b, c] : soup.triangles) text << "3 " << a << ' ' << b << ' ' << c << '\n';
  return text.str();
}

Soup flat_sheet() {
  return {{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}}, {{0, 1, 2}, {0, 2, 3}}};
}

// Claim: a sheet, which has no inside, faces where the file's normals point, faceted or not; without normals, or with normals
// that disagree, as its triangles are wound. Source: outward.h. Tolerance: none. Fails if: the winding decides against the
// normals, or rounding decides a sheet.
TEST(OpenBodies, SheetsGoByTheirNormals) {
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

/// A square sheet in xy of height z(x, y), facing +z.
Soup relief(const std::function<double(double, double)>& z) {
  constexpr std::uint32_t kSide = 32;
  Soup soup;
  for (std::uint32_t j = 0; j <= kSide; ++j)
    for (std::uint32_t i = 0; i <= kSide; ++i) {
      const double x = 2. * i / kSide - 1, y = 2. * j / kSide - 1;
      soup.positions.push_back({x, y, z(x, y)});
      if (i == kSide || j == kSide) continue;
      const std::uint32_t a = j * (kSide + 1) + i, b = a + 1, c = b + kSide + 1, d = c - 1;
      soup.triangles.push_back({a, b, c});
      soup.triangles.push_back({a, c, d});
    }
  return soup;
}

// Claim: without normals, shallow and wavy sheets keep their winding, as dishes, terrain and liquids in a glass are as usual as
// domes. Source: outward.cpp. Tolerance: none. Fails if: the sign of a small volume decides.
TEST(OpenBodies, ShallowSheetsKeepTheirWinding) {
  for (const double depth : {.1, .2, .3})
    for (const Soup& sheet : {relief([&](double x, double y) { return depth * (x * x + y * y); }),
                              relief([&](double x, double y) { return -depth * (x * x + y * y); }),
                              relief([&](double x, double y) { return depth * std::sin(5 * x + y); })}) {
      EXPECT_EQ(load_body(sheet).report.flipped, 0u) << depth;
      EXPECT_EQ(load_body(flipped(sheet)).report.flipped, 0u) << depth;
    }
}

// Claim: normals turn a shallow dish of any file format, also a concave one. Source: outward.h. Tolerance: none. Fails if: the
// volume decides against normals.
TEST(OpenBodies, NormalsTurnShallowSheets) {
  for (const double depth : {-.8, -.2, .2, .8}) {
    const Soup sheet = relief([&](double x, double y) { return depth * (x * x + y * y); });
    const auto up = [&](const Vec3d& p) { return Vec3d{-2 * depth * p.x, -2 * depth * p.y, 1}; };
    for (const bool is_turned : {false, true}) {
      const Soup soup = is_turned ? flipped(sheet) : sheet;
      const std::size_t expected = is_turned ? soup.triangles.size() : 0;
      EXPECT_EQ(load_body("a.obj", obj_with_normals(soup, up)).report.flipped, expected) << depth;
      EXPECT_EQ(load_body("a.ply", ply_with_normals(soup, up)).report.flipped, expected) << depth;
    }
  }
}

// Claim: normals turned inward with the winding do not hide that a nearly closed body is inside out; half a sphere, which may be
// meant to be seen from within, goes by its normals. Source: outward.h. Tolerance: none. Fails if: either of volume and normals
// is asked alone.
TEST(OpenBodies, NormalsDecideWhereVolumeIsNotSure) {
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
TEST(OpenBodies, OpenPartsWithoutMediumStay) {
  for (const auto& [what, soup] : open_bodies()) {
    if (what == "a closed cavity in an open body") continue;
    EXPECT_EQ(load(flipped(soup)).report.flipped, 0u) << what;
  }
}

// Claim: a GLB wound against its normals, an open sphere, is turned by them, and an edit that moves it finds the same. Source:
// the file's normals. Tolerance: none. Fails if: what an earlier check remembers is taken for a mesh that was turned.
TEST(OpenBodies, OpenGlbIsTurned) {
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

}  // namespace
}  // namespace opaline
