// SPDX-License-Identifier: GPL-3.0-or-later
// Light that enters by interpolated normals, and by those of the triangles.
#include <gtest/gtest.h>

#include "support/lighting.h"
#include "support/surfaces.h"

namespace opaline {
namespace {

using namespace test;

/// That enters a mesh from a distant light, W: the sum over its samples.
double entered_flux(const LitWorld& lit, const std::vector<SurfaceSample>& samples, bool geometric_normals) {
  const std::vector<Light> lights{
      recentred(light_of(DirectionalLight{{0, -1, 0}, Rgb(1)}), lit.world.origin)};
  IrradianceInput input{lit.rays, samples, lights};
  input.geometric_normals = geometric_normals;
  const std::vector<LightTransfer> transfers = compute_irradiance(input);
  double sum = 0;
  for (std::size_t i = 0; i < samples.size(); ++i)
    sum += double(samples[i].area) * double(transfers[0].weights[i]);
  return sum;
}

// Claim: by the triangles' normals as much light enters a mesh as its shadow holds. Source: a cube of edge 2 in light
// from above; normals that turn from corner to corner also light the upper half of its sides. Tolerance: .5 %, for 4000 samples
// without area of their own. Fails if: cosines are of interpolated normals.
TEST(EntryNormals, OfTrianglesLetInWhatArrives) {
  Mesh mesh;
  for (const double z : {-1., 1.})
    for (const double y : {-1., 1.})
      for (const double x : {-1., 1.}) mesh.positions.push_back({x, y, z});
  mesh.triangles = {{0, 2, 3}, {0, 3, 1}, {4, 5, 7}, {4, 7, 6}, {0, 1, 5}, {0, 5, 4},
                    {2, 6, 7}, {2, 7, 3}, {0, 4, 6}, {0, 6, 2}, {1, 3, 7}, {1, 7, 5}};
  for (const Vec3d& p : mesh.positions) mesh.normals.push_back(Vec3f(normalized(p)));
  const LitWorld lit(world_of_mesh(mesh));
  const std::vector<SurfaceSample> samples = sample_surface({lit.world, {{0}}, 4000}).samples;
  EXPECT_NEAR(entered_flux(lit, samples, true), 4, .02);
  EXPECT_GT(entered_flux(lit, samples, false), 5);
}

}  // namespace
}  // namespace opaline
