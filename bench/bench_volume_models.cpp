// SPDX-License-Identifier: GPL-3.0-or-later
// How far each model's radiant exitance is from random walks, patch by patch.
//
//   bench_volume_models SCENE TRUTH [KEY=VALUE ...]
//   bench_volume_models FOLDER
//   bench_volume_models FOLDER --default [MESH OR PART OF SHAPE AND MEDIUM ...]
//   bench_volume_models FOLDER --model NAME [KEY=VALUE ...] [PART OF SHAPE AND MEDIUM ...]
//
// The second prints one table of models by shape by medium (model_table.h), with scenes and truths in FOLDER; the third
// a table of the default image; the fourth one model of the first table channel by channel. In the first
// TRUTH keeps the walks' result (until the error of a cell is kUntilError; minutes) for later runs; it is made where it is
// missing. KEY=VALUE as for `opaline render --set`, beside those that choose samples or light. Patches of about
// .9 mm^2 of a 50 mm bunny: one for each of kPatches samples. rms and bias are shares of the mean exitance, in
// percent; the walks' own noise, known from their batches, is taken out of the rms. p99 is of the absolute difference,
// with the walks' noise in it; the last line is what p99 would be of that noise alone.
#include <fmt/format.h>

#include <array>
#include <cmath>
#include <cstdlib>
#include <numbers>
#include <string>
#include <string_view>
#include <vector>

#include "core/random.h"
#include "input/load_scene.h"
#include "methods/volume/volume_state.h"
#include "model_table.h"
#include "session/session_records.h"
#include "user_seconds.h"
#include "volume/nearest_sample.h"
#include "volume_truth.h"

using namespace opaline;

namespace {

constexpr std::size_t kPatches = 6500;
constexpr double kUntilError = .045;  // of a sample's cell; a patch has about four

struct Patches {
  std::vector<std::uint32_t> of_sample;
  std::vector<double> area;
};

// Of a standard normal distribution (Box & Muller 1958).
float normal_number(std::uint64_t i) {
  const double u = 1 - unit_double(hash_bits(1, i)), v = unit_double(hash_bits(2, i));
  return float(std::sqrt(-2 * std::log(u)) * std::cos(2 * std::numbers::pi * v));
}

Patches make_patches(const Session& session, const std::vector<SurfaceSample>& samples) {
  const SurfaceSamples seeds = sample_surface(
      {.world = session.world(), .meshes = session.bodies()[0].plan.meshes, .count = kPatches, .seed = 99});
  const NearestSample nearest(seeds.samples, &session.world());
  Patches patches;
  patches.area.resize(seeds.samples.size());
  for (const SurfaceSample& s : samples) {
    patches.of_sample.push_back(nearest.at(s.position, s.normal));
    patches.area[patches.of_sample.back()] += double(s.area);
  }
  return patches;
}

void print_errors(const std::string& name, const std::vector<SurfaceSample>& samples, const Patches& patches,
                  const Truth& truth, const std::vector<RgbF>& exitance, double seconds) {
  std::vector<Rgb> difference(patches.area.size()), variance(patches.area.size());
  Rgb mean{}, bias{}, squares{};
  double area = 0;
  for (std::size_t i = 0; i < exitance.size(); ++i) {
    const double a = double(samples[i].area);
    const std::uint32_t p = patches.of_sample[i];
    difference[p] += (Rgb(exitance[i]) - Rgb(truth.exitance[i])) * a;
    const Rgb error = Rgb(truth.error[i]) * a;
    variance[p] += error * error;
    mean += Rgb(truth.exitance[i]) * a;
    bias += (Rgb(exitance[i]) - Rgb(truth.exitance[i])) * a;
    area += a;
  }
  std::array<std::vector<double>, 3> sizes;
  for (std::size_t p = 0; p < patches.area.size(); ++p) {
    if (!(patches.area[p] > 0)) continue;
    const Rgb d = difference[p] / patches.area[p];
    squares += (d * d - variance[p] / (patches.area[p] * patches.area[p])) * patches.area[p];
    for (std::size_t c = 0; c < 3; ++c) sizes[c].push_back(std::abs(d[c]) * area / mean[c]);
  }
  fmt::print("{:<28}", name);
  for (std::size_t c = 0; c < 3; ++c) {
    const auto p99 = sizes[c].begin() + std::ptrdiff_t(.99 * double(sizes[c].size()));
    std::ranges::nth_element(sizes[c], p99);
    fmt::print("{:>8.2f}{:>+7.2f}{:>6.1f}",
               100 * std::sqrt(std::max(0.0, squares[c] / area)) * area / mean[c], 100 * bias[c] / mean[c],
               100 * *p99);
  }
  fmt::print("{:>9.2f}\n", seconds);
}

}  // namespace

int main(int argc, char** argv) {
  if (argc == 2) return print_model_table(argv[1]), 0;
  if (argc > 2 && std::string_view(argv[2]) == "--default")
    return print_default_table(argv[1], std::vector<std::string>(argv + 3, argv + argc)), 0;
  if (argc > 3 && std::string_view(argv[2]) == "--model")
    return print_model_channels(argv[1], argv[3], {argv + 4, argv + argc}), 0;
  if (argc < 3)
    return fmt::print(
               "usage: bench_volume_models SCENE TRUTH [KEY=VALUE ...], or bench_volume_models FOLDER\n"
               "       [--default [MESH OR PART OF SHAPE AND MEDIUM ...]], or bench_volume_models FOLDER\n"
               "       [--model NAME [KEY=VALUE ...] [PART OF SHAPE AND MEDIUM ...]]\n"),
           2;
  const std::vector<std::string> overrides(argv + 3, argv + argc);
  Scene scene = load_scene(argv[1], overrides);
  Session session;
  Truth truth;
  scene.settings.method = Method::volume;
  scene.settings.until_error = kUntilError;
  scene.settings.reenter = false;  // as with all models
  if (!read_truth(argv[2], truth)) {
    session.edit(scene);
    session.prepare();
    const Body& body = session.bodies()[0];
    truth = {volume_state(body).exitance.value.exitance, volume_state(body).exitance.value.error};
    fmt::print("{} walks, error {:.1f} %\n", volume_state(body).exitance.value.walks,
               100 * volume_state(body).exitance.value.relative_error);
    write_truth(argv[2], truth);
  }
  scene.settings.method = Method::hierarchical;
  session.edit(scene);
  session.prepare();
  const std::vector<SurfaceSample> samples = session.bodies()[0].surface.samples;  // the walks'
  const Patches patches = make_patches(session, samples);
  fmt::print("{:<28}", "rms, bias, p99 in %");
  for (const char* channel : {"red", "green", "blue"}) fmt::print("{:>14}{:>7}", channel, "");
  fmt::print("{:>9}\n", "seconds");
  const auto measure = [&](const std::string& name) {
    std::vector<RgbF> exitance;
    const double seconds = user_seconds([&] {
      session.edit(scene);
      session.prepare();
      exitance = exitance_at(session, samples);
    });
    print_errors(name, samples, patches, truth, exitance, seconds);
  };
  const auto print_noise = [&] {
    std::vector<RgbF> noisy = truth.exitance;
    for (std::size_t i = 0; i < noisy.size(); ++i) noisy[i] += truth.error[i] * normal_number(i);
    print_errors("noise of the walks", samples, patches, truth, noisy, 0);
  };
  for (std::size_t kind = 0; kind < kProfileNames.size(); ++kind) {
    if (ProfileKind(kind) == ProfileKind::directional_dipole) continue;  // by `direct` alone
    for (Medium& medium : scene.media) medium.profile = ProfileKind(kind);
    measure(std::string(kProfileNames[kind]));
  }
  scene.settings.method = Method::volume_diffusion;
  measure("volume_diffusion");
  print_noise();
}
