// SPDX-License-Identifier: GPL-3.0-or-later
#include "opaline/volume/volume_diffusion.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "opaline/core/parallel.h"
#include "opaline/core/random.h"
#include "opaline/lights/light.h"
#include "opaline/volume/smooth_boundary.h"
#include "volume/boundary_points.h"
#include "volume/calibrated_medium.h"
#include "volume/diffusion_grid.h"
#include "volume/diffusion_solver.h"

namespace opaline {
namespace {

constexpr double kTolerance = 1e-3;  // of the solver
constexpr std::size_t kDepths = 4;   // first collisions of a point and light

Lattice lattice_around(const VolumeDiffusionInput& input, double cell) {
  Vec3d low{1e300, 1e300, 1e300}, high{-1e300, -1e300, -1e300};
  for (const std::uint32_t m : input.meshes)
    for (const Vec3d& p : input.world.meshes[m].positions) {
      low = component_min(low, p);
      high = component_max(high, p);
    }
  // No plane of the lattice in a face of a box.
  const Vec3d margin = Vec3d(1.3713, 1.4289, 1.3317) * cell;
  const auto cells = [&](double extent) {
    return DiffusionGrid::kLargest * int(std::ceil((extent / cell + 2.8) / DiffusionGrid::kLargest));
  };
  return {low - margin, cell, cells(high.x - low.x), cells(high.y - low.y), cells(high.z - low.z)};
}

// Evenly over [0, 1).
double golden_point(std::size_t i) {
  const double turns = .5 + .6180339887498949 * double(i);
  return turns - std::floor(turns);
}

constexpr double kLeastCosine = 1e-3;  // of light inside: against division by 0 where eta < 1

/// A boundary point in its cell.
struct Attached {
  std::uint32_t cell = DiffusionGrid::kNone;
  double depth = 0;  // of the cell's centre under it, world units
};

class Solver {
 public:
  Solver(const VolumeDiffusionInput& input, double cell)
      : input_(input),
        lattice_(lattice_around(input, cell)),
        points_(boundary_points(input.world, input.meshes, input.samples, lattice_)),
        grid_(make_grid()) {
    for (std::size_t c = 0; c < 3; ++c) media_[c] = CalibratedMedium(input.media[c]);
    attach();
  }

  /// Fills fluence, from that of larger cells if there is any, and gives the exitance, one a sample.
  std::vector<RgbF> exitance(const Solver* larger) {
    DiffusionProblem problem{grid_, {}, {}, {}};
    for (std::size_t c = 0; c < 3; ++c) problem.diffusivity[c] = float(media_[c].diffusion * lattice_.cell);
    problem.loss = losses();
    std::vector<RgbF> direct(points_.size());
    problem.source = sources(direct);
    std::vector<Channels> start;
    if (larger != nullptr) start = larger->fluence_in(*this);
    fluence_ = solve_diffusion(problem, kTolerance, std::move(start), input_.monitor).fluence;
    std::vector<Rgb> flux(input_.samples.size());
    for (std::size_t i = 0; i < points_.size(); ++i) {
      Rgb leaving(direct[i]);
      if (attached_[i].cell != DiffusionGrid::kNone)
        for (std::size_t c = 0; c < 3; ++c)
          leaving[c] += double(fluence_[attached_[i].cell].c[c]) * media_[c].conductance(attached_[i].depth);
      flux[points_[i].sample] += leaving * double(points_[i].area);
    }
    std::vector<RgbF> result;
    for (std::size_t s = 0; s < flux.size(); ++s)
      result.push_back(RgbF(flux[s] / double(input_.samples[s].area)));
    return result;
  }

 private:
  /// The fluence here at the centres of another's cells.
  std::vector<Channels> fluence_in(const Solver& other) const {
    std::vector<Channels> result;
    for (const DiffusionGrid::Cell& cell : other.grid_.cells()) {
      const Vec3d position = Vec3d(cell.centre) * other.lattice_.cell + other.lattice_.low;
      const std::uint32_t here = grid_.at(Vec3f(lattice_.into(position)));
      result.push_back(here == DiffusionGrid::kNone ? Channels{} : fluence_[here]);
    }
    return result;
  }

  DiffusionGrid make_grid() const {
    const InsideLines lines(input_.world, input_.meshes, lattice_);
    std::vector<Vec3f> surface;
    for (const BoundaryPoint& point : points_) surface.push_back(point.position);
    return {lines, lattice_, surface};
  }

  void attach() {
    attached_.resize(points_.size());
    parallel_chunks(points_.size(), 4096, [&](std::size_t begin, std::size_t end, std::size_t) {
      for (std::size_t i = begin; i < end; ++i)
        for (const float below : {.05f, .35f, .7f, 1.05f, 1.5f}) {
          const std::uint32_t cell = grid_.at(points_[i].position - points_[i].normal * below);
          if (cell == DiffusionGrid::kNone) continue;
          const float depth = dot(points_[i].position - grid_.cells()[cell].centre, points_[i].normal);
          attached_[i] = {cell, std::max(0.0, double(depth)) * lattice_.cell};
          break;
        }
    });
  }

  std::vector<Channels> losses() const {
    std::vector<Channels> loss(grid_.cells().size());
    const double cube = lattice_.cell * lattice_.cell * lattice_.cell;
    for (std::size_t i = 0; i < loss.size(); ++i)
      for (std::size_t c = 0; c < 3; ++c)
        loss[i].c[c] = float(media_[c].absorption * double(grid_.cells()[i].volume) * cube);
    for (std::size_t i = 0; i < points_.size(); ++i)
      if (attached_[i].cell != DiffusionGrid::kNone)
        for (std::size_t c = 0; c < 3; ++c)
          loss[attached_[i].cell].c[c] += points_[i].area * float(media_[c].conductance(attached_[i].depth));
    return loss;
  }

  // What collides for the first time in each cell; `direct`: what leaves from above a cell's centre, W per square.
  std::vector<Channels> sources(std::vector<RgbF>& direct) const {
    std::vector<Channels> source(grid_.cells().size());
    for (std::size_t l = 0; l < input_.lights.size(); ++l)
      for (std::size_t i = 0; i < points_.size(); ++i) deposit(l, i, source, direct[i]);
    return source;
  }

  void deposit(std::size_t l, std::size_t i, std::vector<Channels>& source, RgbF& direct) const {
    const BoundaryPoint& point = points_[i];
    const double weight = double(input_.transfers[l].weights[point.sample]);
    if (!(weight > 0) || attached_[i].cell == DiffusionGrid::kNone) return;
    const Rgb entering = emission(input_.lights[l]) * weight;
    const Vec3f position(Vec3d(point.position) * lattice_.cell + lattice_.low);
    const std::array<double, 2> square = r2_point(i, {.5, .5});
    const Vec3f towards = sample_light(input_.lights[l], position, point.normal, square, 1).direction;
    const Vec3d normal(point.normal);
    if (!(dot(towards, point.normal) > 0)) return;
    const Vec3d inward = refracted_inward(-Vec3d(towards), normal, input_.media[0].eta);
    const double cosine = std::max(kLeastCosine, -dot(inward, normal)), depth = attached_[i].depth;
    std::array<double, kDepths> depths;  // mean free paths, one of each quarter of the light
    for (std::size_t k = 0; k < depths.size(); ++k)
      depths[k] = -std::log1p(-(double(k) + golden_point(i)) / double(kDepths));
    for (std::size_t c = 0; c < 3; ++c) {
      const CalibratedMedium& medium = media_[c];
      if (!(medium.albedo > 0)) continue;
      const double enters = entering[c] * medium.albedo * medium.entry_factor(cosine);
      const double free_path = 1 / medium.extinction, path = depth / cosine;
      const double passed = std::exp(-path / free_path);
      const double at_once =
          (depth - cosine * free_path * (1 - passed)) / (2 * medium.mismatch * medium.diffusion + depth);
      direct[c] += float(enters * at_once);
      const double flux = enters * double(point.area);
      source[attached_[i].cell].c[c] += float(flux * (1 - passed - at_once));
      for (const double collided : depths) {
        const double t = path + free_path * collided;
        const std::uint32_t cell = grid_.at(Vec3f(Vec3d(point.position) + inward * (t / lattice_.cell)));
        if (cell != DiffusionGrid::kNone) source[cell].c[c] += float(flux * passed / kDepths);
      }
    }
  }

  const VolumeDiffusionInput& input_;
  Lattice lattice_;
  std::vector<BoundaryPoint> points_;
  DiffusionGrid grid_;
  std::array<CalibratedMedium, 3> media_;
  std::vector<Attached> attached_;  // one a point
  std::vector<Channels> fluence_;   // one a cell, once it is solved
};

}  // namespace

VolumeExitance volume_diffusion(const VolumeDiffusionInput& input) {
  VolumeExitance result;
  if (input.samples.empty()) return result;
  Solver coarse(input, 2 * input.cell);
  const std::vector<RgbF> rough = coarse.exitance(nullptr);
  result.exitance = Solver(input, input.cell).exitance(&coarse);
  for (std::size_t i = 0; i < rough.size(); ++i) {
    const RgbF change = result.exitance[i] - rough[i];
    result.error.push_back({std::abs(change.x), std::abs(change.y), std::abs(change.z)});
  }
  return result;
}

}  // namespace opaline
