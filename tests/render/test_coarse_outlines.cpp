// SPDX-License-Identifier: GPL-3.0-or-later
// Outlines of coarse meshes that are shaded smooth.
#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>

#include "../core/scratch_folder.h"
#include "support/scenes.h"

namespace opaline {
namespace {

using namespace test;

// A sphere of few triangles, with the sphere's normals at its corners.
void write_coarse_sphere(const std::filesystem::path& path, double radius, int rings, int sides) {
  std::ofstream file(path);
  for (int ring = 0; ring <= rings; ++ring)
    for (int side = 0; side < sides; ++side) {
      const double down = kPi * ring / rings, around = 2 * kPi * side / sides;
      const Vec3d n{std::sin(down) * std::cos(around), std::cos(down), std::sin(down) * std::sin(around)};
      file << "v " << radius * n.x << ' ' << radius * n.y << ' ' << radius * n.z << "\nvn " << n.x << ' '
           << n.y << ' ' << n.z << '\n';
    }
  const auto corner = [&](int ring, int side) {
    const int i = ring * sides + side % sides + 1;
    return ' ' + std::to_string(i) + "//" + std::to_string(i);
  };
  for (int ring = 0; ring < rings; ++ring)
    for (int side = 0; side < sides; ++side) {
      if (ring > 0)
        file << 'f' << corner(ring, side) << corner(ring, side + 1) << corner(ring + 1, side + 1) << '\n';
      if (ring + 1 < rings)
        file << 'f' << corner(ring, side) << corner(ring + 1, side + 1) << corner(ring + 1, side) << '\n';
    }
}

// Claim: no pixel of a smooth-shaded sphere of 84 triangles, in light from all around, is darker than .45 of
// the same pixel where triangles are shaded flat. Source: what leaves is as even as the light; the boundary's
// transmittance grows with the cosine, at most in proportion, and the cosine is at least half the triangle's.
// Tolerance: a tenth below one half, for what leaves differs a little between the two. Fails if: the cosine
// is the shading normal's alone, which passes through 0 on the outline's triangles.
TEST(CoarseOutlines, HaveNoDarkPixels) {
  const ScratchFolder folder;
  write_coarse_sphere(folder.path / "sphere.obj", 10, 7, 7);
  MeshFile file;
  file.path = folder.file("sphere.obj");
  Scene scene = single_shape(file, marble(), 2000);
  scene.lights = {{"surroundings", Surroundings{Rgb(1)}}};
  scene.camera.field_of_view = 13;
  scene.film.resolution = {96, 96};
  const Image smooth = Prepared(scene).picture();
  scene.shapes[0].normals = NormalMode::faceted;
  const Image flat = Prepared(scene).picture();
  int seen = 0;
  double darkest = 1;
  for (int y = 0; y < 96; ++y)
    for (int x = 0; x < 96; ++x) {
      if (!(channel(flat, x, y, "A") > 0)) continue;
      ++seen;
      darkest = std::min(
          darkest, double(channel(smooth, x, y, "diffuse.G")) / double(channel(flat, x, y, "diffuse.G")));
    }
  EXPECT_GT(seen, 3000);
  EXPECT_GT(darkest, .45);
}

}  // namespace
}  // namespace opaline
