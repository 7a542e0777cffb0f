// SPDX-License-Identifier: GPL-3.0-or-later
#include "session/first_light.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "bodies/surface_boundaries.h"
#include "bodies/surface_textures.h"
#include "core/parallel.h"
#include "methods/hierarchical/hierarchical_state.h"
#include "render/tile_renderer.h"
#include "sampling/draft_samples.h"

namespace opaline {
namespace {

constexpr std::size_t kFewer = 16, kFewest = 256;  // samples
constexpr int kMostLightSamples = 16;              // to each light with an area

int divided_up(int a, int b) {
  return (a + b - 1) / b;
}

/// Maps pixels of an image to pixels of a coarse one with the same centre.
struct CoarseGrid {
  int stride;
  std::array<int, 2> resolution, coarse;

  CoarseGrid(const Film& film, int stride_)
      : stride(stride_),
        resolution(film.resolution),
        coarse{divided_up(film.resolution[0], stride_), divided_up(film.resolution[1], stride_)} {}

  /// Coordinates from the middle of the first pixel, in pixels.
  double place(double pixel, std::size_t axis) const {
    return (pixel + .5 - resolution[axis] / 2.0) / stride + coarse[axis] / 2.0 - .5;
  }
  /// Coarse pixels around all those of a part.
  std::array<int, 4> around(const Rectangle& part) const {
    const auto low = [&](int pixel, std::size_t axis) {
      return std::clamp(int(std::floor(place(pixel, axis))), 0, coarse[axis] - 1);
    };
    return {low(part.x0, 0), low(part.y0, 1), std::min(low(part.x1 - 1, 0) + 2, coarse[0]),
            std::min(low(part.y1 - 1, 1) + 2, coarse[1])};
  }
};

Scene coarse_scene(Scene scene, const CoarseGrid& grid) {
  constexpr double kHalf = std::numbers::pi / 360;  // degrees of a full angle to radians of its half
  Camera& camera = scene.camera;
  std::array<double, 2> wider;
  for (std::size_t axis = 0; axis < 2; ++axis)
    wider[axis] = double(grid.stride) * grid.coarse[axis] / grid.resolution[axis];
  double& angle = camera.field_of_view;
  angle = std::atan(std::tan(angle * kHalf) * wider[1]) / kHalf;
  if (camera.orthographic_height) *camera.orthographic_height *= wider[1];
  for (std::size_t axis = 0; axis < 2; ++axis) camera.shift[axis] /= wider[axis];
  camera.aperture = 0;
  scene.shutter.clear();
  if (scene.film.crop) scene.film.crop = grid.around(rendered_part(scene.film));
  scene.film.resolution = grid.coarse;
  scene.film.samples_per_pixel = 1;
  scene.settings.bounces = 0;
  return scene;
}

/// Pixels between two camera rays in each direction: at least 8, and as many as limit the coarse image to 48
/// x 48.
int stride_of(const Film& film) {
  constexpr int kStride = 8, kWidest = 48;
  const Rectangle part = rendered_part(film);
  return std::max(kStride, divided_up(std::max(part.x1 - part.x0, part.y1 - part.y0), kWidest));
}

/// Two neighbours of a row or column of pixels, and the second one's weight.
struct Between {
  std::size_t first, second;
  float share;
};

/// One for each of `count` pixels from `begin` on, among the coarse pixels [from, to).
std::vector<Between> neighbours(const CoarseGrid& grid, std::size_t axis, int begin, int count, int from,
                                int to) {
  std::vector<Between> all;
  for (int i = 0; i < count; ++i) {
    const double place = std::clamp(grid.place(begin + i, axis) - from, 0.0, to - from - 1.0);
    const int first = int(place);
    all.push_back(
        {std::size_t(first), std::size_t(std::min(first + 1, to - from - 1)), float(place - first)});
  }
  return all;
}

/// Bilinear; the first four channels of `coarse`.
void enlarge(const Image& coarse, const CoarseGrid& grid, Image& picture) {
  const std::vector<Between> columns = neighbours(grid, 0, picture.crop_x, picture.width, coarse.crop_x,
                                                  coarse.crop_x + coarse.width),
                             rows = neighbours(grid, 1, picture.crop_y, picture.height, coarse.crop_y,
                                               coarse.crop_y + coarse.height);
  const std::size_t channels = coarse.channels.size(), shown = picture.channels.size();
  parallel_chunks(rows.size(), 16, [&](std::size_t begin, std::size_t end, std::size_t) {
    for (std::size_t r = begin; r < end; ++r) {
      const float* above = coarse.pixels.data() + rows[r].first * std::size_t(coarse.width) * channels;
      const float* below = coarse.pixels.data() + rows[r].second * std::size_t(coarse.width) * channels;
      float* out = picture.pixels.data() + r * columns.size() * shown;
      const float t = rows[r].share;
      for (const Between& column : columns)
        for (std::size_t c = 0; c < shown; ++c) {
          const std::size_t left = column.first * channels + c, right = column.second * channels + c;
          *out++ = (1 - t) * ((1 - column.share) * above[left] + column.share * above[right]) +
                   t * ((1 - column.share) * below[left] + column.share * below[right]);
        }
    }
  });
}

std::vector<Body> draft_groups(const PrecomputeInput& input) {
  const std::vector<Light> lights = recentred_lights(input.scene, input.world);
  const SurfaceTextures textures(input.scene, input.world);
  const std::vector<OuterBoundary> boundaries = boundaries_of(input.scene, input.world);
  std::vector<Body> groups;
  for (std::size_t g = 0; g < input.plan.groups.size(); ++g) {
    BodyPlan plan = input.plan.groups[g];
    plan.method = Method::hierarchical;
    const DiffuseProfile profile = make_diffuse_profile(input.scene.media[plan.medium], input.world.unit);
    SurfaceSamples surface =
        draft_samples(input.world, plan.meshes, std::max(kFewest, plan.samples / kFewer));
    SplitKernel kernel = body_kernel(profile, surface.spacing(), input.world, input.scene);
    const OuterBoundary& boundary = boundaries[plan.meshes.front()];
    std::vector<LightTransfer> transfers = trace_transfers(input, g, boundary, surface.samples, lights);
    groups.push_back({plan, profile, boundary, std::move(surface), std::move(transfers)});
    Body& body = groups.back();
    body.entering = entering_tints(textures, body.surface.samples);
    set_hierarchical_state(body, entered_irradiance(body, lights), std::move(kernel));
  }
  return groups;
}

}  // namespace

Image coarse_picture(const RenderInput& input, int stride) {
  const CoarseGrid grid(input.scene.film, stride);
  const Scene scene = coarse_scene(input.scene, grid);
  const Image coarse = render({scene, input.world, input.rays, input.groups, input.monitor}).image;
  const Rectangle part = rendered_part(input.scene.film);
  Image picture = empty_image(part, input.scene.film, {"R", "G", "B", "A"});
  enlarge(coarse, grid, picture);
  return picture;
}

Image first_light(const PrecomputeInput& input) {
  Scene scene = input.scene;
  if (scene.settings.method != Method::lambert) scene.settings.method = Method::hierarchical;
  scene.settings.evaluator = EvaluatorKind::dual_tree;
  scene.settings.light_samples = std::min(scene.settings.light_samples, kMostLightSamples);
  std::vector<Body> groups;
  if (scene.settings.method == Method::hierarchical)
    groups = draft_groups({scene, input.world, input.rays, input.plan, input.monitor});
  return coarse_picture({scene, input.world, input.rays, groups, input.monitor}, stride_of(scene.film));
}

}  // namespace opaline
