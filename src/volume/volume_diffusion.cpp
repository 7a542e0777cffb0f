// SPDX-License-Identifier: GPL-3.0-or-later
#include "volume/volume_diffusion.h"

#include <algorithm>
#include <cmath>

#include "volume/cut_outer_surface.h"
#include "volume/diffusion_body.h"

namespace opaline {
namespace {

// Fraction of the difference to cells of twice the size that remains, for an error of order 1.2 in the cells.
constexpr float kLeft = .8f;

BodyMedia calibrated(const VolumeDiffusionInput& input) {
  const auto& media = input.media;
  BodyMedia body;
  for (std::size_t c = 0; c < 3; ++c) body.throughout[0][c] = CalibratedMedium(media[c]);
  if (!input.media_inside) return body;
  body.inside = input.media_inside;
  if (!input.is_calibrated) body.calibrations = calibrations_of(media[0].eta);
  return body;
}

Lattice doubled(const Lattice& lattice) {
  return {lattice.low, 2 * lattice.cell, lattice.nx / 2, lattice.ny / 2, lattice.nz / 2};
}

std::vector<BoundaryElement> elements_of(const VolumeDiffusionInput& input) {
  std::vector<BoundaryElement> elements;
  for (const SurfaceSample& s : input.samples)
    elements.push_back({s.centroid, input.normals[elements.size()], s.area});
  return elements;
}

}  // namespace

struct VolumeDiffusion::State {
  explicit State(const VolumeDiffusionInput& input)
      : media(calibrated(input)),
        samples(elements_of(input)),
        lattice(lattice_around(input.world, input.meshes, input.cell)),
        fine(input.world, input.meshes, samples, media, lattice, true),
        coarse(input.world, input.meshes, samples, media, doubled(lattice), false) {}

  VolumeExitance exitance(const EnteringLight& light, Monitor* monitor) const;

  BodyMedia media;
  std::vector<BoundaryElement> samples;
  Lattice lattice;
  DiffusionBody fine, coarse;
};

namespace {

CutSurface cut_by_parts(const World& world, std::span<const std::uint32_t> meshes, double cell, int parts,
                        const RayScene* rays) {
  Lattice lattice = lattice_around(world, meshes, cell);
  lattice.cell /= parts;
  for (int* count : {&lattice.nx, &lattice.ny, &lattice.nz}) *count *= parts;
  return cut_by_lattice(world, meshes, lattice, rays);
}

}  // namespace

CutSurface cut_surface(const World& world, std::span<const std::uint32_t> meshes, double cell, int parts) {
  return cut_by_parts(world, meshes, cell, parts, nullptr);
}

CutSurface cut_outer_surface(const RayScene& rays, const World& world, std::span<const std::uint32_t> meshes,
                             double cell, int parts) {
  return cut_by_parts(world, meshes, cell, parts, &rays);
}

double length_to_resolve(double mean_free_path, double absorbed) {
  return mean_free_path * std::min(1., kPerFading / std::sqrt(3 * absorbed));
}

// Cells per face of the surface's cells, as cells grow inwards; src/volume/README.md. Thin bodies contain
// cells of the smallest size only, filling them or cut by their surface.
double expected_cells(double area, double thickness, double cell) {
  constexpr double kOfThick = 4.5, kCut = .5;
  const double for_face = thickness > 0 ? std::min(kOfThick, thickness / (2 * cell) + kCut) : kOfThick;
  return for_face * area / (cell * cell);
}

VolumeDiffusion::VolumeDiffusion(const VolumeDiffusionInput& input)
    : state_(std::make_unique<const State>(input)) {}
VolumeDiffusion::VolumeDiffusion(VolumeDiffusion&&) noexcept = default;
VolumeDiffusion::~VolumeDiffusion() = default;

std::size_t VolumeDiffusion::cells() const {
  return state_->fine.grid().cells().size();
}

VolumeExitance VolumeDiffusion::exitance(std::span<const Light> lights,
                                         std::span<const LightTransfer> transfers,
                                         std::span<const RgbF> tints, Monitor* monitor) const {
  return state_->exitance({lights, transfers, tints}, monitor);
}

VolumeExitance VolumeDiffusion::exitance_of_even(std::span<const RgbF> entering, std::span<const RgbF> beside,
                                                 Monitor* monitor) const {
  if (monitor != nullptr) monitor->begin("diffusion", 2 * state_->coarse.elements());
  VolumeExitance result;
  result.exitance = state_->coarse.solve({{}, {}, {}, entering, beside}, {}, monitor).exitance;
  advance(monitor, state_->coarse.elements());
  result.error.resize(result.exitance.size());
  return result;
}

VolumeExitance VolumeDiffusion::State::exitance(const EnteringLight& light, Monitor* monitor) const {
  // Solving takes about as long as the first collisions.
  const std::size_t elements = coarse.elements() + fine.elements();
  if (monitor != nullptr) monitor->begin("diffusion", 2 * elements * sources_of(light));
  const DiffusionBody::Solution rough = coarse.solve(light, {}, monitor);
  advance(monitor, coarse.elements() * sources_of(light));
  DiffusionBody::Solution solution = fine.solve(light, coarse.carried(rough, fine), monitor);
  VolumeExitance result;
  for (const RgbF& before : rough.exitance) {
    const RgbF change = solution.exitance[result.error.size()] - before;
    result.error.push_back(RgbF(std::abs(change.x), std::abs(change.y), std::abs(change.z)) * kLeft);
  }
  fine.correct_edges(light, solution, monitor);
  result.exitance = std::move(solution.exitance);
  return result;
}

}  // namespace opaline
