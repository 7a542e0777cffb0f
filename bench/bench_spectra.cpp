// SPDX-License-Identifier: GPL-3.0-or-later
// Colour differences (CIEDE2000, mean and largest) between spectral images and images in red, green and blue: a ball of
// each measured preset, and of skin by its pigments, in the light of D65, A and FL2. The lamp's white is the white of
// both. Media in red, green and blue have the coefficients at 626.66, 541.92 and 443.15 nm.
// usage: bench_spectra [PIXELS]
#include <fmt/format.h>

#include <array>
#include <cmath>
#include <cstdlib>
#include <exception>
#include <string>
#include <vector>

#include "ciede2000.h"
#include "input/load_scene.h"
#include "input/presets.h"
#include "opaline/session.h"
#include "spectra/wavelengths.h"

namespace {

using namespace opaline;

/// XYZ of linear Rec.709 (IEC 61966-2-1).
Vec3d to_xyz(const Rgb& c) {
  return {.4124564 * c.x + .3575761 * c.y + .1804375 * c.z, .2126729 * c.x + .7151522 * c.y + .0721750 * c.z,
          .0193339 * c.x + .1191920 * c.y + .9503041 * c.z};
}

Vec3d to_lab(const Rgb& rgb, const Rgb& white_rgb) {
  const Vec3d color = to_xyz(rgb), white = to_xyz(white_rgb);
  const auto f = [](double t) {
    constexpr double kLinear = 6. / 29;
    return t > kLinear * kLinear * kLinear ? std::cbrt(t) : t / (3 * kLinear * kLinear) + 4. / 29;
  };
  const double x = f(color.x / white.x), y = f(color.y / white.y), z = f(color.z / white.z);
  return {116 * y - 16, 500 * (x - y), 200 * (y - z)};
}

/// media: JSON with the medium "m"; light: an irradiance as JSON.
Scene ball_of(const std::string& media, const std::string& light, int pixels,
              const std::vector<std::string>& overrides = {}) {
  return parse_scene(fmt::format(R"({{"media": {}, "shapes": [{{"sphere": {{"radius": 10}}, "medium": "m"}}],
        "lights": [{{"type": "directional", "direction": [-1, -1, -2], "irradiance": {}}}],
        "camera": {{"position": [0, 0, 60], "look_at": [0, 0, 0], "field_of_view": 22}},
        "film": {{"resolution": [{}, {}], "pixel_type": "float"}},
        "settings": {{"method": "hierarchical", "samples": 20000}}}})",
                                 media, light, pixels, pixels),
                     "ball.json", overrides);
}

/// Coefficients at three wavelengths as those of red, green and blue, in a light of this colour.
Scene in_red_green_and_blue(Scene at_three_wavelengths, const Rgb& light) {
  at_three_wavelengths.wavelengths.reset();
  std::get<DirectionalLight>(at_three_wavelengths.lights.at(0).source).irradiance = light;
  return at_three_wavelengths;
}

Image rendered(const Scene& scene) {
  Session session;
  session.edit(scene);
  return session.render().image;
}

struct Difference {
  double mean = 0, largest = 0;
};

Difference difference_of(const Image& a, const Image& b, const Rgb& white) {
  Difference difference;
  double covered = 0;
  const std::size_t channels = a.channels.size();
  for (std::size_t i = 0; i + channels <= a.pixels.size(); i += channels) {
    if (!(a.pixels[i + 3] > .99f)) continue;  // the rim is half background
    const auto lab = [&](const Image& image) {
      return to_lab({double(image.pixels[i]), double(image.pixels[i + 1]), double(image.pixels[i + 2])},
                    white);
    };
    const double one = ciede2000(lab(a), lab(b));
    difference.mean += one;
    difference.largest = std::max(difference.largest, one);
    ++covered;
  }
  difference.mean /= covered;
  return difference;
}

struct Subject {
  std::string name, media;
};

/// Epidermis with this fraction of melanin over dermis and fat, as scenes/skin-tones.json.
Subject skin(double melanin) {
  return {fmt::format("skin, {:g} % melanin", 100 * melanin), fmt::format(R"({{
      "epidermis": {{"sigma_a": {{"tissue": {{"melanin": {}}}}}, "specular_ior": 1.4,
                    "sigma_s_prime": {{"powers": [[14.74, -0.22], [2.2e11, -4]]}}}},
      "dermis": {{"sigma_a": {{"tissue": {{"blood": 0.02}}}},
                 "sigma_s_prime": {{"powers": [[7.37, -0.22], [1.1e11, -4]]}}}},
      "fat": {{"sigma_a": 0.01, "sigma_s_prime": 1.2}},
      "m": {{"layers": [{{"medium": "epidermis", "thickness": 0.1}}, {{"medium": "dermis", "thickness": 1.5}},
                       {{"medium": "fat"}}]}}}})",
                                                                          melanin)};
}

/// Three pairs of Sharma, Wu & Dalal 2005.
bool has_right_differences() {
  return std::abs(ciede2000({50, 2.6772, -79.7751}, {50, 0, -82.7485}) - 2.0425) < 5e-5 &&
         std::abs(ciede2000({50, 2.5, 0}, {73, 25, -18}) - 27.1492) < 5e-5 &&
         std::abs(ciede2000({2.0776, .0795, -1.135}, {.9033, -.0636, -.5514}) - .9082) < 5e-5;
}

}  // namespace

int main(int argc, char** argv) try {
  const int pixels = argc > 1 ? std::atoi(argv[1]) : 64;
  if (pixels < 8 || !has_right_differences()) {
    fmt::print(stderr, "usage: bench_spectra [PIXELS], at least 8\n");
    return 2;
  }
  std::vector<Subject> subjects;
  for (const Preset& preset : measured_presets())
    subjects.push_back(
        {std::string(preset.name), fmt::format(R"({{"m": {{"preset": "{}"}}}})", preset.name)});
  for (const double melanin : {.01, .05, .15, .4}) subjects.push_back(skin(melanin));
  constexpr std::array<std::string_view, 3> kLamps{"D65", "A", "FL2"};
  fmt::print("{:<20}", "dE00, mean (largest)");
  for (const std::string_view lamp : kLamps) fmt::print("{:>16}", lamp);
  fmt::print("{:>14}\n", "wavelengths");
  for (const Subject& subject : subjects) {
    fmt::print("{:<20}", subject.name);
    std::string counts;
    for (const std::string_view lamp : kLamps) {
      const Rgb white = exact_color(with_unit_luminance(illuminant(lamp)), {{560}, {1}});
      const std::string light = fmt::format(R"({{"illuminant": "{}", "scale": 3.14159265}})", lamp);
      const Scene spectral = ball_of(subject.media, light, pixels);
      const Scene rgb = in_red_green_and_blue(ball_of(subject.media, light, pixels, {"film.wavelengths=3"}),
                                              white * 3.14159265);
      const Difference difference = difference_of(rendered(spectral), rendered(rgb), white);
      fmt::print("{:>8.2f} ({:>5.2f})", difference.mean, difference.largest);
      counts += fmt::format("{}{}", counts.empty() ? "" : ", ", 3 * (1 + spectral.other_wavelengths.size()));
    }
    fmt::print("{:>14}\n", counts);
    std::fflush(stdout);
  }
  return 0;
} catch (const std::exception& failure) {
  fmt::print(stderr, "bench_spectra: {}\n", failure.what());
  return 1;
}
