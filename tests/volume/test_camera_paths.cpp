// SPDX-License-Identifier: GPL-3.0-or-later
// The truth against another one: random walks from the light, and paths from the viewer.
#include "core/parallel.h"
#include "support/statistics.h"
#include "volume/camera_paths.h"
#include "volume/lit_body.h"

namespace opaline {
namespace {

using namespace test;

constexpr std::size_t kPatches = 4;

// Lamps that leave one side of the body dark, and take up much of what paths see.
const QuadLight kAbove{{-40, 6, 40}, {80, 0, 0}, {0, 0, -80}, Rgb(1)},
    kBeside{{6, -40, -40}, {0, 0, 80}, {0, 46, 0}, Rgb(1)};

/// Quarters around a point, by the position of a sample: bodies and lamps are symmetric in z.
std::size_t patch_of(const LitBody& body, const Vec3f& position, const Vec3d& middle) {
  const Vec3d p = out_of_world(body.world, Vec3d(position)) - middle;
  return std::size_t(p.x > 0) + 2 * std::size_t(p.y > 0);
}

/// What a ray sees of flat lamps that do not hide each other.
double lamp_radiance(std::span<const Light> lights, const Vec3d& from, const Vec3d& towards) {
  double radiance = 0;
  for (const Light& light : lights) {
    const QuadLight& quad = std::get<QuadLight>(light.source);
    const Vec3d normal = cross(quad.u, quad.v);
    const double facing = dot(normal, towards), t = dot(quad.corner - from, normal) / facing;
    const Vec3d p = from + towards * t - quad.corner;
    const double u = dot(p, quad.u) / dot(quad.u, quad.u), v = dot(p, quad.v) / dot(quad.v, quad.v);
    if (facing < 0 && t > 0 && u >= 0 && u <= 1 && v >= 0 && v <= 1) radiance += quad.radiance.x;
  }
  return radiance;
}

/// Mean exitance of the patches, by walks of several seeds: walks leave by several cells, so that the cells'
/// errors are not those of a patch.
std::array<Mean, kPatches> walked_patches(const LitBody& body, const Vec3d& middle, std::size_t seeds,
                                          const MediaInside& inside = {}) {
  std::array<Mean, kPatches> patches;
  for (std::size_t seed = 0; seed < seeds; ++seed) {
    VolumeInput input = body.input(1000 + seed);
    input.media_inside = inside;
    const VolumeExitance walked = volume_exitance(input);
    for (std::size_t p = 0; p < kPatches; ++p)
      patches[p].add(
          body.mean_where(walked,
                          [&](const SurfaceSample& s) { return patch_of(body, s.position, middle) == p; })
              .value);
  }
  return patches;
}

/// The same from the viewer's side.
std::array<Mean, kPatches> seen_patches(const LitBody& body, const Vec3d& middle, std::size_t paths,
                                        const std::function<bool(const Vec3d&)>& is_inside = {},
                                        const HomogeneousMedium& densest = {},
                                        const std::function<HomogeneousMedium(const Vec3d&)>& medium = {}) {
  constexpr std::size_t kParts = 64;
  const VolumeInput input = body.input();
  const SampleGrid grid(body.world, body.surface, body.surface.spacing());
  std::vector<std::array<Mean, kPatches>> parts(kParts);
  parallel_chunks(kParts, 1, [&](std::size_t part, std::size_t, std::size_t) {
    CameraPaths camera(
        {body.rays, body.world, body.meshes.size(), medium ? densest : input.media[0], body.reenter,
         [&](const Vec3d& p, const Vec3d& d) { return lamp_radiance(body.lights, p, d); }, is_inside, medium},
        99 + part);
    for (std::size_t i = 0; i < paths / kParts; ++i) {
      const CameraPaths::Place place = camera.any_place();
      const std::uint32_t cell = grid.nearest(place.position, Vec3f(place.normal)).first;
      parts[part][patch_of(body, body.surface.samples[cell].position, middle)].add(camera.exitance(place));
    }
  });
  std::array<Mean, kPatches> patches;
  for (const auto& part : parts)
    for (std::size_t p = 0; p < kPatches; ++p) patches[p].add(part[p].mean());
  return patches;
}

/// Each patch within 4 standard errors of both, and these no larger than 1 %.
void expect_agreement(const std::array<Mean, kPatches>& walked, const std::array<Mean, kPatches>& seen) {
  for (std::size_t p = 0; p < kPatches; ++p) {
    const double error = std::hypot(walked[p].error(), seen[p].error());
    EXPECT_NEAR(walked[p].mean(), seen[p].mean(), 4 * error)
        << "patch " << p << ", standard error " << 100 * error / seen[p].mean() << " %";
    EXPECT_LT(error, .01 * seen[p].mean()) << "patch " << p;
  }
}

// Claim: what random walks from the lamps count on the cells of a sphere is what a viewer's paths bring back from
// there, patch by patch (quarters), with scattering forward. Source: reciprocity; both are without bias. Tolerance: 4
// standard errors of both, at most 1 % each. Fails if: light enters unrefracted or without Ft, cells are not those of
// the samples' areas, lamps are sampled by another weight, or g is left out.
TEST(CameraPaths, Sphere) {
  LitBody body(SphereShape{{}, 3, 4}, 300, NormalMode::faceted);
  body.medium = {.01, 1, .5, 1.4};
  body.light({kAbove, kBeside});
  expect_agreement(walked_patches(body, {}, 16), seen_patches(body, {}, 250000));
}

// Claim: the same of a sphere whose left half is another medium than its right one. Source: as above; the camera's paths know
// the medium by the sign of x. Tolerance: as above. Fails if: walks fly by another medium than that of the densest place, all
// their collisions count, or the albedo is not that of the place.
TEST(CameraPaths, TwoHalves) {
  LitBody body(SphereShape{{}, 3, 4}, 300, NormalMode::faceted);
  ASSERT_EQ(body.world.unit, 1);
  ASSERT_EQ(body.world.origin, Vec3d());
  const HomogeneousMedium left{.03, 2.5, .5, 1.4}, right{.01, 1, .5, 1.4};
  body.medium = right;
  body.medium.sigma_a = 0;  // cubes of .5: their faces are where the halves meet
  body.light({kAbove, kBeside});
  const auto at = [&](const Vec3d& p) { return p.x < 0 ? left : right; };
  const auto media = [&](const Vec3d& p, double) {
    return std::array<HomogeneousMedium, 3>{at(p), at(p), at(p)};
  };
  expect_agreement(walked_patches(body, {}, 22, media), seen_patches(body, {}, 500000, {}, left, at));
}

// Claim: the same of two boxes that overlap in a body with a reentrant edge, with light that leaves and enters again and
// without. Source: as above; the camera's paths know the union of the boxes by their corners. Tolerance: as above. Fails
// if: sheets within the body stop or reflect light, light that leaves does not enter again or the lamps' reflections do
// not, or shadow rays go through the body.
TEST(CameraPaths, TwoOverlappingBoxes) {
  const BoxShape tall{{-3, -3, -2}, {0, 3, 2}}, low{{-1, -2.5, -1.5}, {3, -1, 1.5}};
  for (const bool reenter : {true, false}) {
    LitBody body(world_of({tall, low}, NormalMode::faceted), 600);
    body.medium = {.01, 1, 0, 1.4};
    body.reenter = reenter;
    body.light({kAbove, kBeside});
    const auto is_inside = [&](const Vec3d& p) {
      const Vec3d mm = out_of_world(body.world, p);
      return std::ranges::any_of(std::array{tall, low}, [&](const BoxShape& b) {
        return mm.x > b.low.x && mm.y > b.low.y && mm.z > b.low.z && mm.x < b.high.x && mm.y < b.high.y &&
               mm.z < b.high.z;
      });
    };
    const Vec3d middle{-1, -1, 0};
    expect_agreement(walked_patches(body, middle, 10), seen_patches(body, middle, 400000, is_inside));
  }
}

}  // namespace
}  // namespace opaline
