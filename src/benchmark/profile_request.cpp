// SPDX-License-Identifier: GPL-3.0-or-later
#include "benchmark/profile_request.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "diffusion/layered_medium.h"
#include "input/load_scene.h"
#include "input/schema.h"
#include "opaline/enumerations.h"
#include "opaline/error.h"
#include "values/json_tree.h"
#include "values/nearest_name.h"

namespace opaline {
namespace {

constexpr const char* kGiven = "MEDIUM";  // name of the argument in messages, as in --help

bool is_object(const std::string& text) {
  const std::size_t first = text.find_first_not_of(" \t\r\n");
  return first != std::string::npos && text[first] == '{';
}

Medium preset_medium(const std::string& name) {
  const std::span<const std::string_view> names = key_info("medium", "preset").choices;
  if (std::ranges::find(names, name) != names.end())
    return parse_medium("{\"preset\": \"" + name + "\"}", kGiven);
  const std::string near = did_you_mean(name, names);
  throw Error(ErrorKind::bad_input, {}, 0, 0, "unknown medium '" + printable(name) + "'" + near,
              near.empty()
                  ? "one of " + join(names) + R"(, or an object such as {"sigma_a": 0.01, "sigma_s": 2})"
                  : "");
}

/// Mean cosine of a medium given as text; a scene's medium includes it in its coefficients.
double anisotropy_of(const std::string& text) {
  if (!is_object(text)) return 0;
  const Document document{kGiven, text, {}, {}, 1, line_starts_of(text)};
  const Node root = parse_tree(document, text);
  const Node* g = find_member(root, "g");
  return g == nullptr ? 0 : g->number;
}

/// A medium with its name, at wavelengths or in red, green and blue.
struct GivenMedium {
  std::string name;
  Medium medium;
  std::optional<ThreeWavelengths> wavelengths;
};

/// A scene's medium, at three wavelengths if the scene has spectra.
GivenMedium medium_of_scene(const GivenProfile& given) {
  const std::string &name = given.medium, &file = given.scene;
  const auto load = [&](const std::vector<std::string>& overrides) {
    return given.scene_text ? parse_scene(*given.scene_text, file, overrides) : load_scene(file, overrides);
  };
  Scene scene = load({});
  if (!scene.other_wavelengths.empty()) scene = load({"film.wavelengths=3"});
  const auto found = std::ranges::find(scene.media, name, &Medium::name);
  if (found != scene.media.end()) return {name, *found, scene.wavelengths};
  std::vector<std::string_view> names;
  for (const Medium& medium : scene.media) names.push_back(medium.name);
  throw Error(ErrorKind::bad_input, file, 0, 0, "has no medium '" + printable(name) + "'",
              names.empty() ? "a scene with media" : "one of " + join(names));
}

GivenMedium given_medium(const GivenProfile& given) {
  if (!given.scene.empty()) return medium_of_scene(given);
  if (is_object(given.medium)) return {"the medium", parse_medium(given.medium, kGiven), {}};
  return {given.medium, preset_medium(given.medium), {}};
}

/// error Error{bad_input} naming the option, unless is_good
void check_option(const GivenProfile& given, bool is_good, const char* name, const char* expected,
                  double value) {
  check_value(is_good, (given.prefix + std::string(name)).c_str(), expected, value);
}

/// Layers of a channel, of scattering with the mean cosine g at the same reduced scattering; the last one fills the rest of
/// the thickness.
std::vector<SlabLayer> layers_of(const Medium& medium, std::size_t channel, const ProfileRequest& request,
                                 const GivenProfile& given) {
  std::vector<FlatLayer> flat = flat_layers(medium, channel);
  if (flat.empty()) {
    const auto& coefficients = std::get<PhysicalMedium>(medium.coefficients);
    flat.push_back({coefficients.sigma_a[channel], coefficients.sigma_s_prime[channel]});
  }
  std::vector<SlabLayer> layers;
  double above = 0;
  for (const auto& [sigma_a, sigma_s_prime, thickness] : flat) {
    layers.push_back({{sigma_a, sigma_s_prime / (1 - request.g), request.g, request.eta}, thickness});
    above += layers.size() < flat.size() ? thickness : 0;
  }
  layers.back().thickness = request.thickness - above;
  check_option(given, layers.back().thickness > 0, "thickness", "a length above that of the upper layers",
               request.thickness);
  return layers;
}

bool are_alike(const std::vector<SlabLayer>& a, const std::vector<SlabLayer>& b) {
  return std::ranges::equal(a, b, [](const SlabLayer& x, const SlabLayer& y) {
    return x.medium.sigma_a == y.medium.sigma_a && x.medium.sigma_s == y.medium.sigma_s;
  });
}

ProfileKind profile_kind(const std::string& name) {
  const auto found = std::ranges::find(kProfileNames, name);
  if (found != kProfileNames.end()) return ProfileKind(found - kProfileNames.begin());
  throw Error(ErrorKind::bad_input, {}, 0, 0,
              "unknown radial profile '" + printable(name) + "'" + did_you_mean(name, kProfileNames),
              "one of " + join(kProfileNames));
}

}  // namespace

ProfileRequest profile_request(const GivenProfile& given) {
  const auto [name, medium, wavelengths] = given_medium(given);
  if (!std::holds_alternative<PhysicalMedium>(medium.coefficients))
    throw Error(ErrorKind::bad_input, {}, 0, 0,
                "subsurface_color defines a different medium for each diffusion model, so random walks have "
                "no medium",
                "sigma_a and sigma_s_prime, or sigma_a and sigma_s");
  ProfileRequest request;
  request.name = name;
  request.eta = given.eta.value_or(medium.eta);
  const Range& range = key_info("medium", "specular_ior").range;
  check_option(given, request.eta >= range.low && request.eta <= range.high, "eta", "a number from 0.1 to 10",
               request.eta);
  const double own = given.scene.empty() ? anisotropy_of(given.medium) : medium.scatter_anisotropy;
  request.g = given.g.value_or(own);
  check_option(given, std::abs(request.g) < 1, "g", "a number between -1 and 1", request.g);
  if (given.thickness) request.thickness = *given.thickness;
  check_option(given, request.thickness > 0, "thickness", "a length above 0", request.thickness);
  if (given.walks) request.walks = std::size_t(*given.walks);
  request.seed = given.seed;
  for (const std::string& profile : given.profiles) request.kinds.push_back(profile_kind(profile));
  constexpr std::array<const char*, 3> kNames{"R", "G", "B"};
  for (std::size_t c = 0; c < 3; ++c) {
    const std::string channel = wavelengths ? fmt::format("{:.0f} nm", wavelengths->bands[c][0]) : kNames[c];
    request.channels.push_back({channel, layers_of(medium, c, request, given)});
  }
  const std::vector<SlabLayer>& first = request.channels[0].layers;
  if (are_alike(first, request.channels[1].layers) && are_alike(first, request.channels[2].layers)) {
    request.channels.resize(1);
    request.channels[0].name = "all";
  }
  return request;
}

}  // namespace opaline
