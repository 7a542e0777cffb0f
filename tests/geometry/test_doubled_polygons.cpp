// SPDX-License-Identifier: GPL-3.0-or-later
// Polygons that a file gives twice, from other corners on or the other way round, leave one surface.
#include <algorithm>
#include <cmath>

#include "mesh_test.h"
#include "scene/scene_properties.h"

namespace opaline {
namespace {

using namespace mesh_test;

using FaceCorners = std::vector<std::uint32_t>;

const std::vector<FaceCorners> kCubeFaces{{0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4},
                                          {2, 6, 7, 3}, {0, 4, 6, 2}, {1, 3, 7, 5}};

std::string polygons_as(const std::string& extension, const std::vector<Vec3d>& positions,
                        const std::vector<FaceCorners>& faces) {
  std::ostringstream text;
  const std::string vertices = std::to_string(positions.size()), count = std::to_string(faces.size());
  if (extension == "off") text << "OFF\n" << vertices << ' ' << count << " 0\n";
  if (extension == "ply")
    text << "ply\nformat ascii 1.0\nelement vertex " << vertices
         << "\nproperty double x\nproperty double y\nproperty double z\nelement face " << count
         << "\nproperty list uchar int vertex_indices\nend_header\n";
  for (const Vec3d& p : positions)
    text << (extension == "obj" ? "v " : "") << p.x << ' ' << p.y << ' ' << p.z << '\n';
  for (const FaceCorners& face : faces) {
    text << (extension == "obj" ? "f" : std::to_string(face.size()));
    for (const std::uint32_t v : face) text << ' ' << v + (extension == "obj" ? 1 : 0);
    text << '\n';
  }
  return text.str();
}

CheckedMesh load_polygons(const std::string& extension, const std::vector<Vec3d>& positions,
                          const std::vector<FaceCorners>& faces) {
  return load("faces." + extension, polygons_as(extension, positions, faces));
}

/// The polygon from another corner on, and the other way round.
FaceCorners started_at(FaceCorners polygon, std::size_t corner, bool is_reversed) {
  std::rotate(polygon.begin(), polygon.begin() + std::ptrdiff_t(corner), polygon.end());
  if (is_reversed) std::ranges::reverse(polygon);
  return polygon;
}

void expect_whole_cube(const CheckedMesh& mesh, std::size_t doubles) {
  EXPECT_EQ(mesh.mesh.triangles.size(), 12u);
  EXPECT_EQ(mesh.report.duplicates_dropped, doubles);
  EXPECT_EQ(mesh.report.open_edges, 0u);
  EXPECT_EQ(mesh.report.non_manifold_edges, 0u);
  EXPECT_DOUBLE_EQ(signed_volume(mesh.mesh), 8);
}

// Claim: a cube whose quads are all given twice, the second time from any corner on and in either direction, with vertices of
// its own or not, is the cube. Source: the same file with the quads once. Tolerance: none. Fails if: a quad's diagonal depends
// on the corner it starts at.
TEST(DoubledPolygons, QuadsGivenTwiceAreOneSurface) {
  for (const std::string extension : {"obj", "ply", "off"})
    for (std::size_t corner = 0; corner < 4; ++corner)
      for (const bool is_reversed : {false, true})
        for (const bool has_own_vertices : {false, true}) {
          SCOPED_TRACE(extension + ", corner " + std::to_string(corner) + (is_reversed ? ", reversed" : ""));
          std::vector<Vec3d> positions = cube().positions;
          std::vector<FaceCorners> faces = kCubeFaces;
          if (has_own_vertices) positions.insert(positions.end(), positions.begin(), positions.begin() + 8);
          for (FaceCorners face : kCubeFaces) {
            for (std::uint32_t& v : face) v += has_own_vertices ? 8 : 0;
            faces.push_back(started_at(face, corner, is_reversed));
          }
          expect_whole_cube(load_polygons(extension, positions, faces), 12);
        }
}

// Claim: quads that the file gives as pairs of triangles besides, along either diagonal, are one surface. Source, tolerance as
// above. Fails if: a quad is cut without a look at the triangles.
TEST(DoubledPolygons, QuadsGivenAsTrianglesTooAreOneSurface) {
  for (const std::size_t corner : {0u, 1u})
    for (const bool are_triangles_first : {false, true}) {
      std::vector<FaceCorners> faces = kCubeFaces, triangles;
      for (const FaceCorners& face : kCubeFaces) {
        const FaceCorners f = started_at(face, corner, false);
        triangles.push_back({f[0], f[1], f[2]});
        triangles.push_back({f[0], f[2], f[3]});
      }
      faces.insert(are_triangles_first ? faces.begin() : faces.end(), triangles.begin(), triangles.end());
      expect_whole_cube(load_polygons("obj", cube().positions, faces), 12);
    }
}

// Claim: polygons of any number of corners, convex or not, that are given twice leave the area of one. Source: areas of a
// regular octagon and of an L. Tolerance: rounding. Fails if: only quads, or only fans, are compared.
TEST(DoubledPolygons, LargerAndConcavePolygonsAreOneSurface) {
  std::vector<Vec3d> octagon, l{{0, 0, 0}, {40, 0, 0}, {40, 10, 0}, {10, 10, 0}, {10, 40, 0}, {0, 40, 0}};
  for (int i = 0; i < 8; ++i) octagon.emplace_back(std::cos(M_PI * i / 4), std::sin(M_PI * i / 4), 0);
  for (const auto& [corners, area] : {std::pair(octagon, 2 * std::sqrt(2.0)), std::pair(l, 700.0)}) {
    FaceCorners face;
    for (std::uint32_t i = 0; i < corners.size(); ++i) face.push_back(i);
    for (std::size_t corner = 0; corner < corners.size(); ++corner)
      for (const bool is_reversed : {false, true})
        for (const std::string extension : {"obj", "ply", "off"}) {
          const CheckedMesh mesh =
              load_polygons(extension, corners, {face, started_at(face, corner, is_reversed)});
          EXPECT_EQ(mesh.report.duplicates_dropped, corners.size() - 2) << extension << corner << is_reversed;
          EXPECT_NEAR(surface_area(mesh.mesh), area, 1e-4 * area) << extension << corner << is_reversed;
        }
  }
}

// Claim: polygons that share corners but not edges all stay. Source: two crossed quads over one square's corners. Tolerance:
// none. Fails if: sets of corners alone are compared.
TEST(DoubledPolygons, OtherPolygonsOfTheSameCornersStay) {
  const std::vector<Vec3d> tetrahedron{{1, 1, 1}, {1, -1, -1}, {-1, 1, -1}, {-1, -1, 1}};
  const CheckedMesh mesh = load_polygons("obj", tetrahedron, {{0, 1, 2, 3}, {0, 2, 1, 3}});
  EXPECT_LT(mesh.report.duplicates_dropped, 2u);
}

// Claim: UVs at the corners of the first polygon are those of its triangles. Source: the file. Tolerance: none. Fails if: a
// changed cut does not reach UVs.
TEST(DoubledPolygons, FirstPolygonKeepsItsUvs) {
  const std::string text =
      "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nvt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\n"
      "f 1/1 2/2 3/3 4/4\nf 4/1 3/1 2/1 1/1\n";
  const ScratchFolder folder;
  put_bytes(folder.file("a.obj"), text);
  const CheckedMesh mesh = make_mesh(file_shape(folder.file("a.obj")), MeshUvs::required);
  ASSERT_EQ(mesh.mesh.uvs.size(), 2u);
  for (std::size_t t = 0; t < 2; ++t)
    for (std::size_t k = 0; k < 3; ++k) {
      const Vec3d& p = mesh.mesh.positions[mesh.mesh.triangles[t][k]];
      EXPECT_EQ(mesh.mesh.uvs[t][k], (std::array{float(p.x), float(p.y)}));
    }
}

}  // namespace
}  // namespace opaline
