// SPDX-License-Identifier: GPL-3.0-or-later
#include "lights/light.h"

#include "core/random.h"
#include "lights/all_lights.h"
#include "lights/shared_rays.h"

namespace opaline {
namespace {

/// Colour member of a light; a kind without one does not compile.
auto& colour_of(auto& kind) {
  if constexpr (requires { kind.intensity; })
    return kind.intensity;
  else if constexpr (requires { kind.radiance; })
    return kind.radiance;
  else if constexpr (requires { kind.strength; })
    return kind.strength;
  else
    return kind.irradiance;
}

/// use(light of its kind).
auto by_kind(const Light& light, const auto& use) {
  return std::visit(use, light.source);
}

}  // namespace

Rgb emission(const Light& light) {
  return by_kind(light, [](const auto& kind) -> Rgb {
    if constexpr (requires { kind.channel; })
      return in_channel(colour_of(kind), kind.channel);
    else
      return colour_of(kind);
  });
}

Light with_emission(const Light& light, const Rgb& emission) {
  Light coloured = light;
  std::visit([&](auto& kind) { colour_of(kind) = emission; }, coloured.source);
  return coloured;
}

bool is_delta(const Light& light) {
  return by_kind(light, [](const auto& kind) { return is_delta(kind); });
}

int shadow_rays(const Light& light, int light_samples) {
  constexpr int kFewer = 3;  // src/irradiance/README.md
  if (is_delta(light)) return 1;
  const auto* many = std::get_if<ManyLights>(&light.source);
  return many == nullptr || many->tree->has_area() ? light_samples : (light_samples + kFewer - 1) / kFewer;
}

int lobe_draws(const Light& light, const Lobe& lobe) {
  const auto* const environment = std::get_if<EnvironmentLight>(&light.source);
  if (environment == nullptr) return 1;
  const EnvironmentPicture::InLobe* const blocks = known_blocks(*environment, lobe);
  return blocks == nullptr || blocks->blocks.empty() ? kLobeDraws : 1;
}

float mirrored(const Lobe& lobe, float cosine) {
  const float half = .5f + .5f * std::min(1.0f, cosine), square = lobe.alpha * lobe.alpha,
              facets = square / (1 - half * (1 - square));
  return facets * facets;
}

bool is_visible(const Light& light) {
  const auto* many = std::get_if<ManyLights>(&light.source);
  return many != nullptr ? many->tree->has_area() : !is_delta(light);
}

bool is_of_shape(const Light& light) {
  const auto* many = std::get_if<ManyLights>(&light.source);
  return std::holds_alternative<ShapeLight>(many != nullptr ? many->tree->lights()[0].source : light.source);
}

bool share_rays(const Light& a, const Light& b) {
  const auto *shape = std::get_if<ShapeLight>(&a.source), *other_shape = std::get_if<ShapeLight>(&b.source);
  if (shape != nullptr && other_shape != nullptr) return shape->shape == other_shape->shape;
  const auto *tree = std::get_if<ManyLights>(&a.source), *other_tree = std::get_if<ManyLights>(&b.source);
  if (tree != nullptr && other_tree != nullptr) return tree->tree->hash() == other_tree->tree->hash();
  const auto *one = std::get_if<EnvironmentLight>(&a.source),
             *other = std::get_if<EnvironmentLight>(&b.source);
  return one != nullptr && other != nullptr && a.name == b.name && one->picture == other->picture &&
         one->rotation == other->rotation;
}

std::uint64_t light_seed(std::uint64_t seed, const Light& light) {
  std::uint64_t name = 0;
  for (const char c : light.name) name = hash_bits(name, std::uint8_t(c));
  return hash_bits(seed, name);
}

Light recentred(const Light& light, const Vec3d& origin, double unit) {
  Light moved = light;
  moved.source = by_kind(light, [&](const auto& kind) { return LightSource(recentred(kind, origin, unit)); });
  return moved;
}

LightSample sample_light(const Light& light, const Vec3f& point, const Vec3f& normal,
                         std::array<double, 2> unit_square, int samples) {
  return by_kind(light,
                 [&](const auto& kind) { return sample_light(kind, point, normal, unit_square, samples); });
}

LightSample sample_lights(std::span<const Light> lights, const Vec3f& point, const Vec3f& normal,
                          std::array<double, 2> unit_square, int samples, std::span<float> weights) {
  return std::visit(
      [&]<class Kind>(const Kind& kind) {
        if constexpr (requires { kind.channel; }) {
          RgbF channels;
          LightSample sample = sample_channels(kind, point, normal, unit_square, samples, channels);
          for (std::size_t l = 0; l < lights.size(); ++l)
            weights[l] = channels[std::get<Kind>(lights[l].source).channel.value_or(0)];
          sample.weight = weights[0];
          return sample;
        } else {
          const LightSample sample = sample_light(kind, point, normal, unit_square, samples);
          weights[0] = sample.weight;
          return sample;
        }
      },
      lights[0].source);
}

float sampling_density(const Light& light, const Vec3f& point, const Vec3f& normal, const Vec3f& direction,
                       const Lobe* lobe) {
  if (const auto* environment = std::get_if<EnvironmentLight>(&light.source);
      environment != nullptr && lobe != nullptr && known_blocks(*environment, *lobe) != nullptr)
    return environment->picture->density(in_picture(*environment, direction),
                                         in_picture(*environment, normal),
                                         *known_blocks(*environment, *lobe));
  return by_kind(light, [&](const auto& kind) { return sampling_density(kind, point, normal, direction); });
}

EmitterHit intersect_emitter(const Light& light, const Vec3f& origin, const Vec3f& direction, float far) {
  return by_kind(light, [&](const auto& kind) { return intersect_emitter(kind, origin, direction, far); });
}

RgbF background(const Light& light, const Vec3f& direction) {
  return by_kind(light, [&](const auto& kind) { return background(kind, direction); });
}

LightExtent extent(const Light& light) {
  return by_kind(light, [](const auto& kind) { return extent(kind); });
}

std::optional<Lamp> lamp_of(const Light& light) {
  return by_kind(light, [](const auto& kind) { return lamp_of(kind); });
}

std::vector<double> geometry(const Light& light) {
  return by_kind(light, [](const auto& kind) { return geometry(kind); });
}

}  // namespace opaline
