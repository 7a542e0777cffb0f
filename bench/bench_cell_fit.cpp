// SPDX-License-Identifier: GPL-3.0-or-later
// How far interpolation between cells is off, and whether it says so.
//
//   bench_cell_fit SCENE CELLS [KEY=VALUE ...]
//
// The field is one without noise: the exitance of `hierarchical` at 300,000 points of the first body. Its means over some
// CELLS cells, and half and twice as many, are interpolated and compared with it, as they are and with 10 % of noise in
// each mean. Errors are relative to sqrt(M^2 + (1 % of the largest)^2), green.
#include <fmt/format.h>

#include <cmath>
#include <cstdlib>
#include <random>
#include <string>
#include <vector>

#include "input/load_scene.h"
#include "session/session_records.h"
#include "subsurface/method.h"
#include "volume/cell_fit.h"

using namespace opaline;

namespace {

constexpr std::size_t kPoints = 300000;
constexpr float kNoise = .1f;

std::vector<RgbF> exact_exitance(const Session& session) {
  const Body& body = session.bodies()[0];
  std::vector<Vec3d> points;
  std::vector<Vec3f> normals;
  for (const SurfaceSample& s : body.surface.samples) {
    points.push_back(out_of_world(session.world(), Vec3d(s.position)));
    normals.push_back(s.normal);
  }
  return radiant_exitance(body, session.world(), points, normals, session.scene().settings);
}

void measure(const Session& session, std::span<const RgbF> exact, std::size_t cells, float noise) {
  const World& world = session.world();
  const Body& body = session.bodies()[0];
  const SurfaceSamples coarse =
      sample_surface({.world = world, .meshes = body.plan.meshes, .count = cells, .seed = 5});
  const NearestSample nearest(coarse.samples, &world);
  std::vector<Rgb> sums(coarse.samples.size());
  std::vector<double> areas(sums.size());
  double largest = 0;
  for (std::size_t i = 0; i < exact.size(); ++i) {
    const SurfaceSample& s = body.surface.samples[i];
    const Vec3f normal = surface_point(world.meshes[s.mesh], s.triangle, s.u, s.v).geometric;
    const std::uint32_t cell = nearest.at(s.position, normal);
    sums[cell] += Rgb(exact[i]) * double(s.area);
    areas[cell] += double(s.area);
    largest = std::max(largest, double(exact[i].y));
  }
  std::mt19937 engine(1);
  std::normal_distribution<float> gauss;
  std::vector<RgbF> means, errors;
  for (std::size_t c = 0; c < sums.size(); ++c) {
    const RgbF mean = areas[c] > 0 ? RgbF(sums[c] / areas[c]) : RgbF{};
    errors.push_back(mean * noise);
    means.push_back(mean * (1 + noise * gauss(engine)));
  }
  const CellFit fit(coarse.samples, means, errors);
  double off = 0, foretold = 0, bias = 0, count = 0;
  for (std::size_t i = 0; i < exact.size(); i += 5, ++count) {
    const SurfaceSample& s = body.surface.samples[i];
    const CellFit::Value found = fit.at(s.position, s.normal);
    const double value = double(exact[i].y), scale = std::sqrt(value * value + 1e-4 * largest * largest);
    off += std::abs(double(found.value.y) - value) / scale;
    bias += (double(found.value.y) - value) / scale;
    foretold += std::sqrt(2 / 3.14159265) * std::hypot(double(found.noise.y), double(found.shape.y)) / scale;
  }
  fmt::print(
      "{:7} cells {:.3f} mm apart, noise {:2.0f} %: mean error {:.2f} %, foretold {:.2f} %, bias {:+.3f} %\n",
      sums.size(), coarse.spacing() * world.unit, 100 * double(noise), 100 * off / count,
      100 * foretold / count, 100 * bias / count);
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 3) return 2;
  const std::vector<std::string> overrides(argv + 3, argv + argc);
  Scene scene = load_scene(argv[1], overrides);
  scene.settings.method = Method::hierarchical;
  scene.settings.samples = kPoints;
  scene.settings.evaluator = EvaluatorKind::dual_tree;
  scene.settings.tolerance = 1e-3;
  Session session;
  session.edit(scene);
  session.prepare();
  const std::vector<RgbF> exact = exact_exitance(session);
  for (const double factor : {.5, 1., 2.})
    for (const float noise : {0.f, kNoise})
      measure(session, exact, std::size_t(factor * std::atof(argv[2])), noise);
}
