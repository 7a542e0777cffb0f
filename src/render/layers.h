// SPDX-License-Identifier: GPL-3.0-or-later
// Layers of an image, and the contribution of one ray.
#pragma once

#include <cmath>
#include <string>
#include <vector>

#include "opaline/scene.h"
#include "opaline/vec3.h"
#include "subsurface/method_layers.h"

namespace opaline {

/// Result of one camera ray; zero if it hit nothing.
struct PixelSample {
  RgbF diffuse{}, specular{};
  RgbF emitted{};      ///< radiance of directly visible lights and environments
  float coverage = 0;  ///< 1 on a surface
  float shadow = 0;    ///< opacity of the shadows on a shadow catcher
  RgbF albedo{}, irradiance{};
  RgbF error{};           ///< error of diffuse, about equal for all rays of a pixel
  Rgb noise{};            ///< variance of diffuse, independent between rays
  RgbF bias{};            ///< signed error of diffuse, shared by rays of a pixel
  float translucent = 0;  ///< 1 on a translucent surface
  Vec3f normal{}, position{};
  float depth = 0;

  /// True if no camera ray of the pixel hit anything.
  bool empty() const { return coverage == 0 && shadow == 0 && emitted == RgbF{}; }
};

/// Channel names in the order of store_pixel. The irradiance of `volume` covers opaque surfaces only.
inline std::vector<std::string> layer_names(const MethodLayers& layers) {
  std::vector<std::string> names{"R", "G", "B", "A", "Z"};
  const auto add = [&](const std::string& layer, const std::string& parts) {
    for (const char part : parts) names.push_back(layer + "." + part);
  };
  for (const char* layer : {"diffuse", "specular", "albedo"}) add(layer, "RGB");
  add("N", "XYZ");
  add("P", "XYZ");
  add(layers.variance ? "variance" : "irradiance", "RGB");
  if (layers.error) add("error", "RGB");
  return names;
}

/// Standard error of the mean of a pixel's rays; all: one over their number.
inline RgbF pixel_error(const PixelSample& sum, float all) {
  RgbF error = sum.error * all;
  for (std::size_t c = 0; c < 3; ++c)
    if (sum.noise[c] > 0) {
      const double shared = double(sum.error[c]), bias = double(sum.bias[c]);
      error[c] = float(std::sqrt(shared * shared + bias * bias + sum.noise[c])) * all;
    }
  return error;
}

/// Writes the mean of `count` samples to one pixel: radiance and coverage over all of them; albedo, normal,
/// position, depth and irradiance over those with a hit, counted by sum.coverage. Returns 1 if the pixel's
/// radiance is not finite, else 0.
inline std::size_t store_pixel(const PixelSample& sum, int count, const MethodLayers& layers, float* out) {
  const float all = 1.0f / float(count), seen = sum.coverage > 0 ? 1.0f / sum.coverage : 0.0f;
  const auto put = [&out](const Vec3f& value, float scale) {
    out[0] = value.x * scale;
    out[1] = value.y * scale;
    out[2] = value.z * scale;
    out += 3;
  };
  const RgbF radiance = sum.diffuse + sum.specular + sum.emitted;
  put(radiance, all);
  *out++ = (sum.coverage + sum.shadow) * all;
  *out++ = sum.depth * seen;
  put(sum.diffuse, all);
  put(sum.specular, all);
  put(sum.albedo, seen);
  put(normalized(sum.normal), 1);
  put(sum.position, seen);
  put(sum.irradiance, seen);
  if (layers.error) put(pixel_error(sum, all), 1);
  return is_finite(radiance) ? 0 : 1;
}

/// Adds a camera ray's layers to its pixel's.
inline void add_sample(PixelSample& sum, const PixelSample& s) {
  sum.diffuse += s.diffuse;
  sum.specular += s.specular;
  sum.emitted += s.emitted;
  sum.coverage += s.coverage;
  sum.shadow += s.shadow;
  sum.albedo += s.albedo;
  sum.irradiance += s.irradiance;
  sum.error += s.error;
  sum.noise += s.noise;
  sum.bias += s.bias;
  sum.translucent += s.translucent;
  sum.normal += s.normal;
  sum.position += s.position;
  sum.depth += s.depth;
}

}  // namespace opaline
