// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <numbers>

#include "irradiance/sample_key.h"
#include "render/shade.h"

namespace opaline {

// Fibres reflect in broad lobes: the lights are sampled, and light from other surfaces counts as uniform.
void Shader::add_fuzz(const SurfaceHits& hits, const OuterBoundary& boundary, std::span<const RgbF> arriving,
                      const RayBatch& batch) const {
  const auto samples_per_pixel = std::uint64_t(input_.scene.film.samples_per_pixel);
  std::vector<std::uint64_t> keys;
  std::vector<Vec3f> towards_eye;
  std::vector<float> cosines;
  std::vector<RgbF> colors;
  std::vector<OuterBoundary> boundaries;  // with textures only
  const auto boundary_at = [&](std::size_t i) -> const OuterBoundary& {
    return boundaries.empty() ? boundary : boundaries[i];
  };
  for (std::size_t i = 0; i < hits.rays.size(); ++i) {
    keys.push_back(batch.mirrors > 0 ? hits.keys[i] : key_in_pixel(hits.keys[i], samples_per_pixel));
    const Vec3f& direction = batch.rays[hits.rays[i]].ray.direction;
    towards_eye.push_back(-normalized(direction));
    cosines.push_back(cos_view(hits.points[i], direction));
    const RgbF& color = appearances_[hits.hits[i].mesh].fuzz_color;
    colors.push_back(hits.textures.empty() ? color : hits.textures[i].fuzz_color.value_or(color));
    if (boundary.is_textured()) boundaries.push_back(*hits.textures[i].boundary);
  }
  const auto specular = [&](std::size_t i) -> RgbF& { return batch.out[hits.rays[i]].specular; };
  for_each_ray({input_.rays,
                hits.points,
                keys,
                lights_,
                {},
                batch.light_samples,
                point_irradiance_seed(input_.scene.settings)},
               [&](std::size_t l, std::size_t i, const Vec3f& towards, float irradiance) {
                 const float value =
                     boundary_at(i).fuzz_value(cosines[i], std::min(1.f, dot(hits.points[i].normal, towards)),
                                               dot(towards_eye[i], towards));
                 specular(i) += emitted_[l] * colors[i] * (irradiance * value);
               });
  for (std::size_t i = 0; i < arriving.size(); ++i) {
    const OuterBoundary& here = boundary_at(i);
    const float entering = (1 - appearances_[hits.hits[i].mesh].average_reflectance) * here.past_fuzz();
    const RgbF share = colors[i] * (1 - here.past_fuzz(cosines[i]));
    specular(i) += arriving[i] * share * (std::numbers::inv_pi_v<float> / entering);
  }
}

}  // namespace opaline
