// SPDX-License-Identifier: GPL-3.0-or-later
#include "random_scene.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <array>
#include <cmath>
#include <random>
#include <vector>

namespace opaline {
namespace {

class SceneMaker {
 public:
  explicit SceneMaker(std::uint64_t number) : random_(number) {}

  std::string make(const std::string& method) {
    std::vector<std::string> media, shapes, lights;
    const int bodies = 1 + int(4 * even());
    for (int i = 0; i < 2; ++i) media.push_back(medium(i));
    for (int i = 0; i < bodies; ++i) shapes.push_back(shape(i));
    for (int i = 1 + int(4 * even()); i > 0; --i) lights.push_back(light());
    const int side = int(between(32, 600));
    return fmt::format(
        R"({{"media": {{{}}}, "shapes": [{}], "lights": [{}],
 "camera": {{"position": [0, 10, 90], "look_at": [0, 0, 0]}},
 "film": {{"resolution": [{}, {}], "samples_per_pixel": {}}},
 "settings": {{{}}}}})",
        fmt::join(media, ", "), fmt::join(shapes, ", "), fmt::join(lights, ", "), side, side,
        even() < .2 ? 4 : 1, settings(method));
  }

 private:
  double even() { return std::uniform_real_distribution<double>(0, 1)(random_); }
  /// Evenly in the logarithm.
  double between(double low, double high) { return low * std::pow(high / low, even()); }

  std::string triple(double low, double high) {
    return fmt::format("[{:.4g}, {:.4g}, {:.4g}]", between(low, high), between(low, high),
                       between(low, high));
  }
  std::string point(double reach) {
    return fmt::format("[{:.3f}, {:.3f}, {:.3f}]", reach * (2 * even() - 1), reach * (2 * even() - 1),
                       reach * (2 * even() - 1));
  }

  std::string medium(int index) {
    return fmt::format(R"("m{}": {{"sigma_a": {}, "sigma_s_prime": {}, "specular_ior": {:.3g}}})", index,
                       triple(1e-4, 3), triple(.1, 10), between(1, 1.8));
  }

  std::string shape(int index) {
    const std::string where = point(20);
    const double size = between(2, 20);
    const std::array<std::string, 4> sources{
        fmt::format(R"("sphere": {{"center": {}, "radius": {:.4g}}})", where, size),
        fmt::format(R"("torus": {{"center": {}, "major_radius": {:.4g}, "minor_radius": {:.4g}}})", where,
                    size, size * between(.02, .5)),
        fmt::format(R"("slab": {{"center": {}, "width": {:.4g}, "depth": {:.4g}, "thickness": {:.4g}}})",
                    where, 2 * size, 2 * size, size * between(.02, 1)),
        fmt::format(R"("box": {{"low": [{:.4g}, {:.4g}, {:.4g}], "high": [{:.4g}, {:.4g}, {:.4g}]}})", -size,
                    -size - 10 * index, -size, size, -10. * index, between(.1, 1) * size)};
    return fmt::format(R"({{{}, "medium": "m{}"}})", sources[std::size_t(4 * even())], int(2 * even()));
  }

  std::string light() {
    const std::array<std::string, 3> kinds{
        fmt::format(R"("type": "point", "position": {}, "intensity": 5000)", point(60)),
        fmt::format(R"("type": "directional", "direction": {}, "irradiance": 2)", point(1)),
        fmt::format(R"("type": "sphere", "center": {}, "radius": 3, "radiance": 20)", point(60))};
    return "{" + kinds[std::size_t(3 * even())] + "}";
  }

  std::string settings(const std::string& method) {
    std::string text = fmt::format(R"("method": "{}")", method);
    if (method == "volume")
      return text + fmt::format(R"(, "samples": {}, "until_error": 0.9)", int(between(100, 1000)));
    if (method == "direct") return text + R"(, "entry_samples": 16)";
    if (even() < .5) text += fmt::format(R"(, "samples": {})", int(between(1000, 300000)));
    if (method == "hierarchical" && even() < .3) text += R"(, "evaluator": "surface_cache")";
    if (even() < .3) text += R"(, "bounces": 1)";
    return text;
  }

  std::mt19937_64 random_;
};

}  // namespace

std::string random_scene(std::uint64_t number, const std::string& method) {
  return SceneMaker(number).make(method);
}

}  // namespace opaline
