// SPDX-License-Identifier: GPL-3.0-or-later
#include "volume/diffusion_body.h"

#include <algorithm>
#include <cmath>

#include "opaline/core/parallel.h"
#include "opaline/core/random.h"
#include "opaline/lights/light.h"
#include "opaline/transport/smooth_boundary.h"

namespace opaline {
namespace {

constexpr double kTolerance = 1e-3;    // of the solver; moves the bunny's picture by .03 %
constexpr double kLeastCosine = 1e-3;  // of light inside: against division by 0 where eta < 1

Lattice lattice_around(const World& world, std::span<const std::uint32_t> meshes, double cell) {
  Vec3d low{1e300, 1e300, 1e300}, high{-1e300, -1e300, -1e300};
  for (const std::uint32_t m : meshes)
    for (const Vec3d& p : world.meshes[m].positions) {
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

DiffusionGrid make_grid(const World& world, std::span<const std::uint32_t> meshes, const Lattice& lattice,
                        std::span<const BoundaryPoint> points) {
  const InsideLines lines(world, meshes, lattice);
  std::vector<Vec3f> surface;
  for (const BoundaryPoint& point : points) surface.push_back(Vec3f(lattice.into(Vec3d(point.position))));
  return {lines, lattice, surface};
}

// Evenly over [0, 1).
double golden_point(std::size_t i) {
  const double turns = .5 + .6180339887498949 * double(i);
  return turns - std::floor(turns);
}

}  // namespace

DiffusionBody::DiffusionBody(const World& world, std::span<const std::uint32_t> meshes,
                             std::span<const BoundaryPoint> points,
                             const std::array<CalibratedMedium, 3>& media, double cell)
    : points_(points),
      media_(media),
      lattice_(lattice_around(world, meshes, cell)),
      grid_(make_grid(world, meshes, lattice_, points)) {
  attach();
}

void DiffusionBody::attach() {
  attached_.resize(points_.size());
  parallel_chunks(points_.size(), 4096, [&](std::size_t begin, std::size_t end, std::size_t) {
    for (std::size_t i = begin; i < end; ++i) {
      const Vec3f position(in_lattice(points_[i])), normal = points_[i].normal;
      for (const float below : {.05f, .35f, .7f, 1.05f, 1.5f}) {
        const std::uint32_t cell = grid_.at(position - normal * below);
        if (cell == DiffusionGrid::kNone) continue;
        const float depth = dot(position - grid_.cells()[cell].centre, normal);
        attached_[i] = {cell, std::max(0.0, double(depth)) * lattice_.cell};
        break;
      }
    }
  });
}

DiffusionBody::Solution DiffusionBody::solve(const EnteringLight& light, std::vector<Channels> start,
                                             Monitor* monitor) const {
  DiffusionProblem problem{grid_, {}, losses(), std::vector<Channels>(grid_.cells().size())};
  for (std::size_t c = 0; c < 3; ++c) problem.diffusivity[c] = float(media_[c].diffusion * lattice_.cell);
  Solution solution;
  solution.exitance.resize(points_.size());
  for (std::size_t l = 0; l < light.lights.size(); ++l)
    for (std::size_t i = 0; i < points_.size(); ++i)
      deposit(light, l, i, problem.source, solution.exitance[i]);
  solution.fluence = solve_diffusion(problem, kTolerance, std::move(start), monitor).fluence;
  for (std::size_t i = 0; i < points_.size(); ++i) {
    const Attached& at = attached_[i];
    if (at.cell == DiffusionGrid::kNone) continue;
    for (std::size_t c = 0; c < 3; ++c)
      solution.exitance[i][c] += solution.fluence[at.cell].c[c] * float(media_[c].conductance(at.depth));
  }
  return solution;
}

std::vector<Channels> DiffusionBody::carried(const Solution& solution, const DiffusionBody& to) const {
  std::vector<Channels> result;
  for (const DiffusionGrid::Cell& cell : to.grid_.cells()) {
    const Vec3d position = Vec3d(cell.centre) * to.lattice_.cell + to.lattice_.low;
    const std::uint32_t here = grid_.at(Vec3f(lattice_.into(position)));
    result.push_back(here == DiffusionGrid::kNone ? Channels{} : solution.fluence[here]);
  }
  return result;
}

std::vector<Channels> DiffusionBody::losses() const {
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

// The last cell of a way that ends outside.
std::uint32_t DiffusionBody::last_cell(const Vec3d& from, const Vec3d& way, std::uint32_t first) const {
  constexpr int kHalvings = 8;
  std::uint32_t last = first;
  double inside = 0, outside = 1;
  for (int step = 0; step < kHalvings; ++step) {
    const double middle = .5 * (inside + outside);
    const std::uint32_t cell = grid_.at(Vec3f(from + way * middle));
    (cell == DiffusionGrid::kNone ? outside : inside) = middle;
    if (cell != DiffusionGrid::kNone) last = cell;
  }
  return last;
}

// Of some directions towards a light, one, with the chance of its share of what would enter there.
Vec3f towards_light(const Light& light, const BoundaryPoint& point, double eta, std::size_t i) {
  constexpr int kTries = 8;
  const int tries = is_delta(light) ? 1 : kTries;
  Vec3f chosen = point.normal;
  double sum = 0, chance = unit_double(hash_bits(0, i));
  for (int t = 0; t < tries; ++t) {
    const LightSample sample =
        sample_light(light, point.position, point.normal,
                     r2_point(i * std::size_t(tries) + std::size_t(t), {.5, .5}), tries);
    const double cosine = double(dot(sample.direction, point.normal));
    if (!(sample.weight > 0 && cosine > 0)) continue;
    const double share = double(sample.weight) * cosine * fresnel_transmittance(std::min(cosine, 1.0), eta);
    sum += share;
    if (chance * sum < share) {  // reservoir: the number is used again within what it has chosen
      chosen = sample.direction;
      chance = chance * sum / share;
    } else {
      chance = (chance * sum - share) / (sum - share);
    }
  }
  return chosen;
}

// Light of one source that enters at a point: what collides between the point and the centre of its cell leaves in
// part at once, as between two resistances; of the rest of its way one place stands for all.
void DiffusionBody::deposit(const EnteringLight& light, std::size_t l, std::size_t i,
                            std::vector<Channels>& source, RgbF& leaves) const {
  const BoundaryPoint& point = points_[i];
  const double weight = double(light.transfers[l].weights[point.sample]);
  if (!(weight > 0) || attached_[i].cell == DiffusionGrid::kNone) return;
  Rgb entering = emission(light.lights[l]) * weight;
  if (!light.tints.empty()) entering = entering * Rgb(light.tints[point.sample]);
  const Vec3f towards = towards_light(light.lights[l], point, media_[0].eta, i);
  const Vec3d normal(point.normal);
  const Vec3d inward = refracted_inward(-Vec3d(towards), normal, media_[0].eta);
  const double cosine = std::max(kLeastCosine, -dot(inward, normal)), depth = attached_[i].depth;
  const double collided = -std::log1p(-golden_point(i));  // free paths behind the centre
  for (std::size_t c = 0; c < 3; ++c) {
    const CalibratedMedium& medium = media_[c];
    if (!(medium.albedo > 0)) continue;
    const double enters = entering[c] * medium.albedo * medium.entry_factor(cosine);
    const double free_path = 1 / medium.extinction, path = depth / cosine;
    const double passed = std::exp(-path / free_path);
    const double at_once =
        (depth - cosine * free_path * (1 - passed)) / (2 * medium.mismatch * medium.diffusion + depth);
    leaves[c] += float(enters * at_once);
    const double flux = enters * double(point.area);
    source[attached_[i].cell].c[c] += float(flux * (1 - passed - at_once));
    const Vec3d from = in_lattice(point), along = inward / lattice_.cell;
    const std::uint32_t cell = grid_.at(Vec3f(from + along * (path + free_path * collided)));
    if (cell != DiffusionGrid::kNone) {
      source[cell].c[c] += float(flux * passed);
    } else {  // it crosses the body
      const double crosses = entering[c] * double(point.area) * passed;
      source[last_cell(from + along * path, along * (free_path * collided), attached_[i].cell)].c[c] +=
          float(crosses);
    }
  }
}

}  // namespace opaline
