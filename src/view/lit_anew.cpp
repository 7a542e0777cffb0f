// SPDX-License-Identifier: GPL-3.0-or-later
#include "view/lit_anew.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <string_view>
#include <utility>
#include <vector>

#include "core/parallel.h"
#include "lights/light.h"

namespace opaline {
namespace {

constexpr double kSame = 1e-6;  // relative difference of factors, from values with few digits

bool differ_in_emission_alone(Scene before, const Scene& now) {
  if (before.lights.size() != now.lights.size()) return false;
  const auto unit = [](const Light& light) { return with_emission(light, {1, 1, 1}); };
  if (!std::ranges::equal(before.lights, now.lights, {}, unit, unit)) return false;
  before.lights = now.lights;
  before.film.exposure = now.film.exposure;
  return before == now;
}

bool is_same(double factor, double other) {
  return std::abs(factor - other) <= kSame * other;
}

/// Factor per channel; none without a light in the channel.
using ChannelFactors = std::array<std::optional<double>, 3>;

/// Common factor of all lights per channel; none: they differ by other changes.
std::optional<ChannelFactors> common_factors(const Scene& before, const Scene& now) {
  ChannelFactors factors;
  for (std::size_t c = 0; c < 3; ++c) {
    std::optional<double> known;
    for (std::size_t l = 0; l < now.lights.size(); ++l) {
      const double was = emission(before.lights[l])[c], is = emission(now.lights[l])[c];
      if (was == is && was == 0) continue;
      if (!(was > 0)) return {};
      const double own = is / was;
      if (known && !is_same(own, *known)) return {};
      known = own;
    }
    factors[c] = known;
  }
  return factors;
}

bool are_one(const ChannelFactors& factors) {
  const auto first = std::ranges::find_if(factors, [](const auto& factor) { return factor.has_value(); });
  return std::all_of(first, factors.end(), [&](const auto& f) { return !f || is_same(*f, **first); });
}

/// Light channel scaling each image channel; none: independent of the lights.
std::vector<std::optional<std::size_t>> lit_channels(const std::vector<std::string>& names) {
  constexpr std::array<std::string_view, 5> kLit{"", "diffuse.", "specular.", "irradiance.", "error."};
  std::vector<std::optional<std::size_t>> channels;
  for (const std::string_view name : names) {
    const std::size_t place = std::string_view("RGB").find(name.back());
    const std::string_view layer = name.substr(0, name.size() - 1);
    const bool is_lit = place != std::string_view::npos && std::ranges::find(kLit, layer) != kLit.end();
    channels.push_back(is_lit ? std::optional(place) : std::nullopt);
  }
  return channels;
}

}  // namespace

std::optional<LitAnew> lit_anew(const Image& picture, const Scene& before, const Scene& now) {
  if (!differ_in_emission_alone(before, now)) return {};
  if (std::ranges::any_of(now.shapes, &Shape::catches_shadows)) return {};
  const std::optional<ChannelFactors> of_channels = common_factors(before, now);
  if (!of_channels) return {};
  const bool has_backdrop = now.backdrop && *now.backdrop != Rgb{};
  if (has_backdrop && std::ranges::any_of(*of_channels, [](const auto& f) { return f && *f != 1; }))
    return {};
  Image lit = picture;
  const std::vector<std::optional<std::size_t>> channels = lit_channels(lit.channels);
  const std::size_t count = channels.size();
  std::vector<float> factors(count, 1.0f);
  for (std::size_t c = 0; c < count; ++c)
    if (channels[c]) factors[c] = float((*of_channels)[*channels[c]].value_or(1));
  parallel_chunks(lit.pixels.size() / count, 1 << 14, [&](std::size_t begin, std::size_t end, std::size_t) {
    for (std::size_t p = begin; p < end; ++p)
      for (std::size_t c = 0; c < count; ++c) lit.pixels[p * count + c] *= factors[c];
  });
  return LitAnew{std::move(lit), are_one(*of_channels)};
}

}  // namespace opaline
