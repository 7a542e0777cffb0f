// SPDX-License-Identifier: GPL-3.0-or-later
// How far the shading of a slow shot flickers: what changes from frame to frame beyond the change of a
// picture with 16 times the samples, with samples that go along, with samples drawn anew in each frame, and by
// `image_space`.
// The first shape ripples, or the first light (a point) goes around, slowly and twice as fast. Writes a strip
// of each slow shot, NAME-ripple.png and NAME-sweep.png: frames side by side, below them what changed beyond
// the reference to the next frame, 20-fold, on grey: carried, then resampled. usage: bench_flicker SCENE NAME
// [PIXELS [FRAMES]]
#include <fmt/format.h>

#include <cstdlib>
#include <exception>
#include <filesystem>

#include "input/load_scene.h"
#include "plan/make_plan.h"
#include "support/flicker.h"

namespace {

using namespace opaline;
using namespace opaline::test;

constexpr double kWaveLength = 25;  // mm
constexpr float kAmplified = 20;

void copy_into(Image& strip, const Image& picture, int column, int row, float scale, float offset) {
  for (int y = 0; y < picture.height; ++y)
    for (int x = 0; x < picture.width; ++x)
      for (int c = 0; c < 3; ++c)
        strip.pixels[std::size_t(((row * picture.height + y) * strip.width + column * picture.width + x) * 3 +
                                 c)] =
            offset + scale * picture.pixels[std::size_t((y * picture.width + x) * 4 + c)];
}

double mean_signal(const Image& picture) {
  double sum = 0, pixels = 0;
  for (std::size_t i = 0; i < picture.pixels.size(); i += 4) {
    sum += double(picture.pixels[i] + picture.pixels[i + 1] + picture.pixels[i + 2]) / 3;
    pixels += double(picture.pixels[i + 3]);
  }
  return sum / pixels;
}

void write_strip(const std::string& path, const std::vector<Image>& reference,
                 const std::vector<Image>& carried, const std::vector<Image>& resampled, double exposure) {
  const int changes = int(carried.size()) - 1;
  Image strip;
  strip.width = strip.full_width = changes * carried[0].width;
  strip.height = strip.full_height = 3 * carried[0].height;
  strip.channels = {"R", "G", "B"};
  strip.pixels.resize(3 * std::size_t(strip.width) * std::size_t(strip.height));
  constexpr float kGrey = .2f;
  const auto mean = float(mean_signal(reference[0]));
  for (int f = 0; f < changes; ++f) {
    const auto i = std::size_t(f);
    copy_into(strip, carried[i], f, 0, float(std::exp2(exposure)), 0);
    int row = 1;
    for (const std::vector<Image>* pictures : {&carried, &resampled})
      copy_into(strip, own_change((*pictures)[i], (*pictures)[i + 1], reference[i], reference[i + 1]), f,
                row++, kAmplified * kGrey / mean, kGrey);
  }
  write_png(path, strip, 0);
}

/// strip: a file, or empty.
void print_shot(const std::string& name, const std::vector<Scene>& shot, const std::string& strip) {
  std::vector<Scene> in_image_space = shot;
  for (Scene& scene : in_image_space) scene.settings.method = Method::image_space;
  const std::vector<Image> reference = reference_pictures(shot), carried = carried_pictures(shot),
                           resampled = resampled_pictures(shot);
  const double along = flicker(carried, reference), anew = flicker(resampled, reference),
               from_lights = flicker(carried_pictures(in_image_space), reference);
  fmt::print("{:<28}{:>14.3f} %{:>9.4f} %{:>11.4f} %{:>9.1f} x{:>14.4f} %\n", name,
             100 * whole_change(reference), 100 * along, 100 * anew, anew / along, 100 * from_lights);
  if (!strip.empty()) write_strip(strip, reference, carried, resampled, shot[0].film.exposure);
}

}  // namespace

int main(int argc, char** argv) try {
  if (argc < 3) {
    fmt::print(stderr, "usage: bench_flicker SCENE NAME [PIXELS [FRAMES]]\n");
    return 2;
  }
  Scene scene = load_scene(argv[1], std::vector<std::string>{"settings.method=hierarchical"});
  const std::string name = argv[2];
  const int pixels = argc > 3 ? std::atoi(argv[3]) : 256, frames = argc > 4 ? std::atoi(argv[4]) : 7;
  scene.film.resolution = {pixels, pixels};
  scene.settings.samples = make_plan(scene, make_world(scene)).groups.at(0).samples;
  const std::filesystem::path folder = std::filesystem::temp_directory_path() / "opaline-bench-flicker";
  std::filesystem::create_directories(folder);
  fmt::print("{} samples, {} frames of {} x {} pixels; changes over the mean\n", *scene.settings.samples,
             frames, pixels, pixels);
  fmt::print("{:<28}{:>16}{:>11}{:>13}{:>27}\n", "shot", "scene changes", "carried", "resampled",
             "image_space");
  print_shot("ripple, 96 frames a wave", rippling(scene, kWaveLength, 96, frames, folder.string()),
             name + "-ripple.png");
  print_shot("ripple, 48 frames a wave", rippling(scene, kWaveLength, 48, frames, folder.string()), "");
  print_shot("light, 1 degree a frame", sweeping(scene, 1, frames), name + "-sweep.png");
  print_shot("light, 2 degrees a frame", sweeping(scene, 2, frames), "");
  std::filesystem::remove_all(folder);
  return 0;
} catch (const std::exception& error) {
  fmt::print(stderr, "bench_flicker: {}\n", error.what());
  return 3;
}
