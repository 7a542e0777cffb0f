// SPDX-License-Identifier: GPL-3.0-or-later
// Faces of many corners, and concave ones.
#include <ctime>
#include <random>

#include "mesh_test.h"
#include "scene/scene_properties.h"

namespace opaline {
namespace {

using namespace mesh_test;

constexpr double kPi = 3.14159265358979323846;

std::string ring(std::size_t count) {
  std::string text;
  for (std::size_t i = 0; i < count; ++i) {
    const double angle = 2 * kPi * double(i) / double(count);
    text += "v " + std::to_string(std::cos(angle)) + ' ' + std::to_string(std::sin(angle)) + " 0\n";
  }
  return text;
}

double cpu_seconds() {
  return double(std::clock()) / CLOCKS_PER_SEC;
}

// Claim: an OBJ face of 200,000 corners is read, with normals and without, in less than two seconds of CPU;
// its area is the disc's within 1e-3. Measured for twice as many corners: .5 s. Fails if: each corner of a
// large face is compared with each.
TEST(MeshLargeFaces, AreReadInTimeThatGrowsWithThem) {
  constexpr std::size_t kCorners = 200000;
  for (const std::string normal : {"", "//1"}) {
    std::string text = ring(kCorners) + "vn 0 0 1\nf";
    for (std::size_t i = 1; i <= kCorners; ++i) text += ' ' + std::to_string(i) + normal;
    const double before = cpu_seconds();
    const CheckedMesh mesh = load("disc.obj", text + '\n');
    EXPECT_LT(cpu_seconds() - before, 2);
    EXPECT_NEAR(surface_area(mesh.mesh), kPi, 1e-3 * kPi);
  }
}

// Claim: a large face is cut into the fan of its first corner, with the normals of its corners, its repeated
// corners left out, and negative indices counted from where it stands. Fails if: fans are counted from another
// corner, or lose normals.
TEST(MeshLargeFaces, AreFansOfTheirFirstCorner) {
  constexpr std::size_t kCorners = 1500;
  std::string text = ring(kCorners) + "vn 0 0 1\nvn 0 .6 .8\nf";
  for (std::size_t i = 1; i <= kCorners; ++i)
    text += ' ' + std::to_string(std::int64_t(i) - std::int64_t(kCorners) - 1) + "//" + (i % 2 ? "1" : "2");
  const CheckedMesh mesh = load("disc.obj", text + " 7//1 7//2\nv 5 5 5\n");
  ASSERT_EQ(mesh.mesh.triangles.size(), kCorners - 2);
  for (std::uint32_t t = 0; t < kCorners - 2; ++t)
    ASSERT_EQ(mesh.mesh.triangles[t], (std::array<std::uint32_t, 3>{0, t + 1, t + 2}));
  EXPECT_EQ(mesh.mesh.normals[10], Vec3f(0, 0, 1));
  EXPECT_NEAR(mesh.mesh.normals[11].y, .6, 1e-6);
  std::string one_place = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\nf";
  for (std::size_t i = 0; i < kCorners; ++i) one_place += i % 2 ? " 1" : " 2";
  EXPECT_EQ(load("double.obj", one_place + '\n').report.zero_area_dropped, 1u);
}

using Polygon = std::vector<Vec3d>;

std::string vertex_lines(const Polygon& polygon, const char* keyword) {
  std::ostringstream text;
  text.precision(17);
  for (const Vec3d& p : polygon) text << keyword << p.x << ' ' << p.y << ' ' << p.z << '\n';
  return text.str();
}

std::string numbers(std::size_t count, std::size_t first) {
  std::string text;
  for (std::size_t i = 0; i < count; ++i) text += ' ' + std::to_string(first + i);
  return text + '\n';
}

/// The polygon as the only face of a file of each format that has polygons; name and bytes.
std::vector<std::array<std::string, 2>> files_of(const Polygon& polygon) {
  const std::string count = std::to_string(polygon.size());
  return {
      {"a.obj", vertex_lines(polygon, "v ") + "f" + numbers(polygon.size(), 1)},
      {"a.off", "OFF\n" + count + " 1 0\n" + vertex_lines(polygon, "") + count + numbers(polygon.size(), 0)},
      {"a.ply",
       "ply\nformat ascii 1.0\nelement vertex " + count +
           "\nproperty double x\nproperty double y\nproperty double z\nelement face 1\nproperty list "
           "int int vertex_indices\nend_header\n" +
           vertex_lines(polygon, "") + count + numbers(polygon.size(), 0)}};
}

/// Of a plane polygon, by the sum of its corners' cross products.
double polygon_area(const Polygon& polygon) {
  Vec3d sum;
  for (std::size_t i = 0; i < polygon.size(); ++i)
    sum += cross(polygon[i], polygon[(i + 1) % polygon.size()]);
  return length(sum) / 2;
}

/// Sum of the triangles' area vectors: an overlap or a fold leaves it, and makes the area larger.
Vec3d area_vector(const Mesh& mesh) {
  Vec3d sum;
  for (const auto& [a, b, c] : mesh.triangles)
    sum += cross(mesh.positions[b] - mesh.positions[a], mesh.positions[c] - mesh.positions[a]) * .5;
  return sum;
}

void expect_area(const Polygon& polygon, double area, const std::string& what) {
  for (const auto& [name, bytes] : files_of(polygon)) {
    const Mesh mesh = load(name, bytes).mesh;
    EXPECT_NEAR(surface_area(mesh), area, 1e-9 * area) << what << ' ' << name;
    EXPECT_NEAR(length(area_vector(mesh)), area, 1e-9 * area) << what << ' ' << name;
  }
}

Polygon rotated(Polygon polygon, std::size_t first) {
  std::rotate(polygon.begin(), polygon.begin() + std::ptrdiff_t(first), polygon.end());
  return polygon;
}

Polygon tilted(Polygon polygon) {
  for (Vec3d& p : polygon) p = {.36 * p.x - .8 * p.y + 5, .48 * p.x + .6 * p.y, .8 * p.x - 7};
  return polygon;
}

const Polygon kL{{20, 0, 0}, {20, 10, 0}, {10, 10, 0}, {10, 20, 0}, {0, 20, 0}, {0, 0, 0}};
const Polygon kDart{{0, 0, 0}, {4, 0, 0}, {1, 1, 0}, {0, 4, 0}};

// Claim: a concave face is cut into triangles that cover it once, whichever corner is its first, wherever its plane lies: an
// L, a quad with a reflex corner, an L with corners on its edges, a face that touches itself, and one with a hole that an edge
// leads to and back. Source: their areas by hand. Tolerance: rounding. Fails if: a face is the fan of its first corner, or
// corners met twice are left out.
TEST(MeshPolygons, ConcaveFacesHaveTheirArea) {
  const Polygon with_collinear{{0, 0, 0},   {10, 0, 0},  {20, 0, 0},  {20, 5, 0}, {20, 10, 0}, {15, 10, 0},
                               {10, 10, 0}, {10, 15, 0}, {10, 20, 0}, {5, 20, 0}, {0, 20, 0},  {0, 10, 0}};
  const Polygon touching{{0, 0, 0}, {4, 0, 0}, {4, 4, 0}, {2, 0, 0}, {0, 4, 0}};
  for (const auto& [polygon, area] :
       std::vector<std::pair<Polygon, double>>{{kL, 300}, {kDart, 4}, {with_collinear, 300}, {touching, 8}})
    for (std::size_t first = 0; first < polygon.size(); ++first) {
      expect_area(rotated(polygon, first), area, std::to_string(area) + " first " + std::to_string(first));
      expect_area(tilted(rotated(polygon, first)), area, std::to_string(area) + " tilted");
    }
  const std::string square = "v 0 0 0\nv 4 0 0\nv 4 4 0\nv 0 4 0\nv 1 1 0\nv 1 3 0\nv 3 3 0\nv 3 1 0\n";
  const CheckedMesh holed = load("hole.obj", square + "f 1 2 3 4 1 5 6 7 8 5\n");
  EXPECT_DOUBLE_EQ(surface_area(holed.mesh), 12);
  EXPECT_DOUBLE_EQ(area_vector(holed.mesh).z, 12);
}

// Claim: random star-shaped polygons, of up to 33 corners, are covered once. Source: the sum of cross products. Tolerance:
// what is let pass as rounding, 1e-6. Fails if: corners inside of an ear are missed.
TEST(MeshPolygons, RandomFacesHaveTheirArea) {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> uniform;
  std::string text;
  double area = 0;
  constexpr std::size_t kFaces = 2000;
  std::vector<Polygon> polygons;
  for (std::size_t k = 0; k < kFaces; ++k) {
    const std::size_t count = 4 + k % 30;
    Polygon polygon;
    for (std::size_t i = 0; i < count; ++i) {
      const double angle = 2 * kPi * (double(i) + .9 * uniform(random)) / double(count),
                   r = .05 + uniform(random);
      polygon.push_back({r * std::cos(angle), r * std::sin(angle), double(k)});
    }
    polygon = rotated(polygon, k % count);
    Polygon flat = polygon;
    for (Vec3d& p : flat) p.z = 0;
    area += polygon_area(flat);
    text += vertex_lines(polygon, "v ") + "f";
    for (std::size_t i = 0; i < count; ++i)
      text += ' ' + std::to_string(std::int64_t(i) - std::int64_t(count));
    text += '\n';
  }
  const Mesh mesh = load("stars.obj", text).mesh;
  EXPECT_NEAR(surface_area(mesh), area, 2e-6 * area);
  EXPECT_NEAR(area_vector(mesh).z, area, 2e-6 * area);
}

/// How many of the triangles that lie in z = 10 cover a point.
int covered(const Mesh& mesh, double x, double y) {
  const auto side = [&](std::uint32_t a, std::uint32_t b) {
    const Vec3d &p = mesh.positions[a], &q = mesh.positions[b];
    return (q.x - p.x) * (y - p.y) - (q.y - p.y) * (x - p.x);
  };
  int count = 0;
  for (const auto& [a, b, c] : mesh.triangles) {
    if (mesh.positions[a].z != 10 || mesh.positions[b].z != 10 || mesh.positions[c].z != 10) continue;
    count += side(a, b) > 0 && side(b, c) > 0 && side(c, a) > 0;
  }
  return count;
}

// Claim: an L-shaped prism of polygons is closed, has 1400 mm2, and covers what the same prism of triangles covers. Source: the
// triangles. Tolerance: rounding. Fails if: its ends are fans.
TEST(MeshPolygons, PrismOfPolygonsIsThatOfTriangles) {
  const std::string folder = OPALINE_TEST_INPUTS "/";
  const Mesh triangles = make_mesh(file_shape(folder + "Ltri.obj")).mesh;
  for (const char* name : {"L1.obj", "L1.ply"}) {
    const CheckedMesh polygons = make_mesh(file_shape(folder + name));
    EXPECT_NEAR(surface_area(polygons.mesh), 1400, 1e-9) << name;
    EXPECT_EQ(polygons.report.open_edges, 0u) << name;
    EXPECT_EQ(polygons.report.non_manifold_edges, 0u) << name;
    EXPECT_NEAR(signed_volume(polygons.mesh), 3000, 1e-9) << name;
    for (double x = .37; x < 20; x += 1.03)
      for (double y = .41; y < 20; y += 1.01)
        EXPECT_EQ(covered(polygons.mesh, x, y), covered(triangles, x, y)) << name << ' ' << x << ' ' << y;
  }
}

// Claim: a face that its fan covers once keeps its fan: convex, a quad that is not plane, an L from the corner that sees all of
// it. Fails if: every face is cut anew.
TEST(MeshPolygons, FansThatCoverTheirFacesStay) {
  const Polygon saddle{{0, 0, 0}, {1, 0, .5}, {1, 1, 0}, {0, 1, .5}};
  Polygon hexagon;
  for (int i = 0; i < 6; ++i) hexagon.push_back({std::cos(i * kPi / 3), std::sin(i * kPi / 3), 0});
  for (const Polygon& polygon : {saddle, hexagon, rotated(kL, 2), rotated(kDart, 2)})
    for (const auto& [name, bytes] : files_of(polygon)) {
      const Mesh mesh = load(name, bytes).mesh;
      ASSERT_EQ(mesh.triangles.size(), polygon.size() - 2);
      for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t)
        EXPECT_EQ(mesh.triangles[t], (std::array<std::uint32_t, 3>{0, t + 1, t + 2})) << name;
    }
}

// Claim: corners keep their UVs and normals where a face is cut otherwise than into its fan. Source: UVs that are the corners'
// positions. Fails if: vertices are rearranged alone.
TEST(MeshPolygons, CornersKeepUvsAndNormals) {
  std::string text = vertex_lines(kL, "v ") + "vn 0 0 1\nvn 0 .6 .8\n", face = "f";
  for (std::size_t i = 0; i < kL.size(); ++i) {
    text += "vt " + std::to_string(kL[i].x) + ' ' + std::to_string(kL[i].y) + '\n';
    const std::string number = std::to_string(i + 1);
    face += ' ' + number + '/' + number + '/' + (i == 3 ? "2" : "1");
  }
  const ScratchFolder folder;
  put_bytes(folder.file("l.obj"), text + "f 1 2 5\n" + face + '\n');
  const Mesh mesh = make_mesh(file_shape(folder.file("l.obj")), MeshUvs::required).mesh;
  EXPECT_EQ(mesh.triangles.size(), 5u);
  for (std::size_t t = 1; t < mesh.triangles.size(); ++t)
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t v = mesh.triangles[t][k];
      const Vec3d& p = mesh.positions[v];
      EXPECT_EQ(mesh.uvs[t][k], (std::array<float, 2>{float(p.x), float(p.y)}));
      EXPECT_NEAR(mesh.normals[v].y, p == kL[3] ? .6 : 0, 1e-6);
    }
}

// Claim: faces that cross themselves are read, with no more area than their fans have, and are reported. Source: the fans.
// Fails if: the search for ears does not end, or such faces pass in silence.
TEST(MeshPolygons, FacesThatCrossThemselvesAreReported) {
  Polygon tangle;
  for (int i = 0; i < 40; ++i) tangle.push_back({std::sin(3.7 * i * i), std::sin(5.3 * i), 0});
  const Polygon bow{{0, 0, 0}, {3, 3, 0}, {3, 1, 0}, {0, 1, 0}},
      even_bow{{0, 0, 0}, {1, 1, 0}, {1, 0, 0}, {0, 1, 0}};
  for (const Polygon& polygon : {tangle, bow, even_bow}) {
    double fan = 0;
    for (std::size_t i = 2; i < polygon.size(); ++i)
      fan += length(cross(polygon[i - 1] - polygon[0], polygon[i] - polygon[0])) / 2;
    for (const auto& [name, bytes] : files_of(polygon)) {
      const CheckedMesh mesh = load(name, bytes);
      EXPECT_LE(surface_area(mesh.mesh), fan * (1 + 1e-12)) << name;
      EXPECT_TRUE(warns(mesh.report, "1 face crosses itself")) << name;
    }
  }
}

// Claim: a star of 100,000 corners is cut in less than two seconds of CPU. Fails if: each corner is compared with each ear.
TEST(MeshPolygons, LargeConcaveFacesTakeLittleTime) {
  constexpr std::size_t kCorners = 100000;
  Polygon star;
  for (std::size_t i = 0; i < kCorners; ++i) {
    const double angle = 2 * kPi * double(i) / double(kCorners), r = i % 2 ? 1 : .6;
    star.push_back({r * std::cos(angle), r * std::sin(angle), 0});
  }
  const std::string bytes = files_of(star)[0][1];
  const double before = cpu_seconds();
  EXPECT_NEAR(surface_area(load("star.obj", bytes).mesh), polygon_area(star), 1e-6);
  EXPECT_LT(cpu_seconds() - before, 2);
}

}  // namespace
}  // namespace opaline
