// SPDX-License-Identifier: GPL-3.0-or-later
#include "volume/diffusion_body.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <span>
#include <vector>

#include "core/parallel.h"
#include "volume/crossing_light.h"
#include "volume/diffusion_solver.h"

namespace opaline {
namespace {

/// Gradient of the fluence at a cell: least squares over its neighbours.
/// fluence: one per cell
/// out   per channel and lattice cell
std::array<Vec3f, 3> gradient_at(const DiffusionGrid& grid, std::span<const Channels> fluence,
                                 std::uint32_t i) {
  constexpr float kLeastSquare = .05f;  // along an axis without neighbours there is no slope
  const DiffusionGrid::Cell& cell = grid.cells()[i];
  Vec3f diagonal(kLeastSquare), off;  // off: of yz, zx, xy
  std::array<Vec3f, 3> sums{};
  for (const DiffusionGrid::Link& link : grid.links(i)) {
    if (!(link.conductance > 0)) continue;
    const Vec3f apart = grid.cells()[link.to].centre - cell.centre;
    diagonal += apart * apart * link.conductance;
    off += Vec3f(apart.y * apart.z, apart.z * apart.x, apart.x * apart.y) * link.conductance;
    for (std::size_t c = 0; c < 3; ++c)
      sums[c] += apart * (link.conductance * (fluence[link.to].c[c] - fluence[i].c[c]));
  }
  const Vec3f row0(diagonal.x, off.z, off.y), row1(off.z, diagonal.y, off.x), row2(off.y, off.x, diagonal.z);
  const Vec3f minors0 = cross(row1, row2), minors1 = cross(row2, row0), minors2 = cross(row0, row1);
  const float inverse = 1 / dot(row0, minors0);  // symmetric and positive
  for (Vec3f& sum : sums) sum = (minors0 * sum.x + minors1 * sum.y + minors2 * sum.z) * inverse;
  return sums;
}

/// Corrects the sources for oblique links: the fluence difference of two offset centres includes the change
/// along their face, which causes no flux through it.
/// fluence: one per cell, of the uncorrected problem
void add_oblique_flow(DiffusionProblem& problem, std::span<const Channels> fluence) {
  const DiffusionGrid& grid = problem.grid;
  std::vector<std::uint32_t> place(fluence.size(), DiffusionGrid::kNone), cells;
  for (const DiffusionGrid::ObliqueLink& link : grid.oblique())
    for (const std::uint32_t cell : {link.a, link.b})
      if (place[cell] == DiffusionGrid::kNone) {
        place[cell] = std::uint32_t(cells.size());
        cells.push_back(cell);
      }
  std::vector<std::array<Vec3f, 3>> gradients(cells.size());
  parallel_chunks(cells.size(), 4096, [&](std::size_t begin, std::size_t end, std::size_t) {
    for (std::size_t i = begin; i < end; ++i) gradients[i] = gradient_at(grid, fluence, cells[i]);
  });
  for (const DiffusionGrid::ObliqueLink& link : grid.oblique()) {
    const Channels diffusivity = problem.between(link.a, link.b);
    for (std::size_t c = 0; c < 3; ++c) {
      const Vec3f gradient = (gradients[place[link.a]][c] + gradients[place[link.b]][c]) * .5f;
      const float flow = diffusivity.c[c] * link.conductance * dot(gradient, link.across);
      problem.source[link.a].c[c] -= flow;
      problem.source[link.b].c[c] += flow;
    }
  }
}

constexpr double kTolerance = 1e-3;  // tolerance of the solver
constexpr double kRough = 1e-2;      // tolerance of the fluence for the oblique flux

DiffusionGrid make_grid(const World& world, std::span<const std::uint32_t> meshes, const Lattice& lattice,
                        const Boundary& boundary) {
  const InsideLines lines(world, meshes, lattice);
  std::vector<DiffusionGrid::Facet> surface;
  for (const BoundaryElement& element : boundary.elements)
    surface.push_back({Vec3f(lattice.into(Vec3d(element.position))), element.normal, element.area});
  return {lines, lattice, surface};
}

}  // namespace

Lattice lattice_around(const World& world, std::span<const std::uint32_t> meshes, double cell) {
  constexpr int kMultiple = 2 * DiffusionGrid::kLargest;  // multiple allowing cells of twice the size
  const auto [low, high] = bounds(world, meshes);
  // Shifts the lattice so none of its planes coincides with a face of a box.
  const Vec3d margin = Vec3d(1.3713, 1.4289, 1.3317) * cell;
  const auto cells = [&](double extent) {
    return kMultiple * int(std::ceil((extent / cell + 2.8) / kMultiple));
  };
  return {low - margin, cell, cells(high.x - low.x), cells(high.y - low.y), cells(high.z - low.z)};
}

DiffusionBody::DiffusionBody(const World& world, std::span<const std::uint32_t> meshes,
                             std::span<const BoundaryElement> samples, const BodyMedia& media,
                             const Lattice& lattice, bool has_edges)
    : samples_(samples),
      throughout_(media.throughout),
      lattice_(lattice),
      boundary_(merged(samples, lattice)),
      grid_(make_grid(world, meshes, lattice_, boundary_)) {
  if (media.inside) find_media(media);
  attach();
  elements_of_ = ElementsOfCells(lattice_, grid_, boundary_, attached_);
  if (has_edges) edges_ = std::make_unique<const EdgeExitance>(space());
}

void DiffusionBody::find_media(const BodyMedia& media) {
  of_cells_.resize(grid_.cells().size());
  parallel_chunks(of_cells_.size(), 256, [&](std::size_t begin, std::size_t end, std::size_t) {
    for (std::size_t i = begin; i < end; ++i) {
      const DiffusionGrid::Cell& cell = grid_.cells()[i];
      const Vec3d centre = Vec3d(cell.centre) * lattice_.cell + lattice_.low;
      const std::array<HomogeneousMedium, 3> here = media.inside(centre, double(cell.size) * lattice_.cell);
      for (std::size_t c = 0; c < 3; ++c)
        of_cells_[i][c] = media.calibrations.empty() ? CalibratedMedium(here[c], throughout_[0][c])
                                                     : calibrated(here[c], media.calibrations);
    }
  });
}

// Cells straight below an element; at edges, where its column has none near the surface, the nearest one beside it.
void DiffusionBody::attach() {
  attached_.resize(boundary_.elements.size());
  parallel_chunks(attached_.size(), 4096, [&](std::size_t begin, std::size_t end, std::size_t) {
    for (std::size_t i = begin; i < end; ++i) {
      const BoundaryElement& element = boundary_.elements[i];
      const Vec3f position(space().in_lattice(element.position)), normal = element.normal;
      const auto take = [&](std::uint32_t cell) {
        const float depth = dot(position - grid_.cells()[cell].centre, normal);
        attached_[i] = {cell, std::max(0.0, double(depth)) * lattice_.cell};
      };
      const auto take_below = [&](std::initializer_list<float> depths) {
        for (const float below : depths) {
          const std::uint32_t cell = grid_.at(position - normal * below);
          if (cell == DiffusionGrid::kNone) continue;
          take(cell);
          return true;
        }
        return false;
      };
      if (take_below({.05f, .35f, .7f})) continue;
      if (const std::uint32_t beside = nearest_below(position, normal); beside != DiffusionGrid::kNone)
        take(beside);
      else
        take_below({1.05f, 1.5f});
    }
  });
}

// The cell with the nearest centre below an element, among those around it; position: lattice units.
std::uint32_t DiffusionBody::nearest_below(const Vec3f& position, const Vec3f& normal) const {
  std::uint32_t found = DiffusionGrid::kNone;
  float nearest = 0;
  const Vec3f about = position - normal * .35f;
  for (const float x : {-1.f, 0.f, 1.f})
    for (const float y : {-1.f, 0.f, 1.f})
      for (const float z : {-1.f, 0.f, 1.f}) {
        const std::uint32_t cell = grid_.at(about + Vec3f(x, y, z));
        if (cell == DiffusionGrid::kNone) continue;
        const Vec3f apart = position - grid_.cells()[cell].centre;
        if (!(dot(apart, normal) > 0)) continue;
        if (found != DiffusionGrid::kNone && dot(apart, apart) >= nearest) continue;
        found = cell, nearest = dot(apart, apart);
      }
  return found;
}

DiffusionBody::Solution DiffusionBody::solve(const EnteringLight& light, std::vector<Channels> start,
                                             Monitor* monitor) const {
  DiffusionProblem problem{grid_, {}, losses(), {}};
  for (std::size_t c = 0; c < 3; ++c)
    problem.diffusivity[c] = float(throughout_[0][c].diffusion * lattice_.cell);
  for (const std::array<CalibratedMedium, 3>& media : of_cells_) {
    Channels& diffusivity = problem.diffusivities.emplace_back();
    for (std::size_t c = 0; c < 3; ++c) diffusivity.c[c] = float(media[c].diffusion * lattice_.cell);
  }
  FirstCollisions collisions = first_collisions(space(), light, monitor);
  Solution solution;
  for (const Channels& source : collisions.source)
    for (std::size_t c = 0; c < 3; ++c) solution.entered[c] += double(source.c[c]);
  take_uncollided(light, collisions, solution, monitor);
  problem.source = std::move(collisions.source);
  std::vector<Channels> rough = solve_diffusion(problem, kRough, std::move(start), monitor).fluence;
  add_oblique_flow(problem, rough);
  solution.fluence = solve_diffusion(problem, kTolerance, std::move(rough), monitor).fluence;
  read(at_samples(collisions.at_once), solution);
  return solution;
}

// Adds the light not entering the diffusion problem. For light crossing a thin body, values at the samples are more exact than
// those at the elements; the difference is taken from the collisions.
void DiffusionBody::take_uncollided(const EnteringLight& light, FirstCollisions& collisions,
                                    Solution& solution, Monitor* monitor) const {
  constexpr double kThin = .01;  // share of light crossing a thin body
  Rgb direct{}, crossing{};
  for (std::size_t i = 0; i < boundary_.elements.size(); ++i) {
    const double area = double(boundary_.elements[i].area);
    direct += Rgb(collisions.uncollided[i] + collisions.at_once[i]) * area;
    crossing += Rgb(collisions.crossing[i]) * area;
  }
  const bool is_thin = edges_ != nullptr && max_component(crossing) > kThin * max_component(solution.entered);
  if (is_thin) {
    solution.uncollided = at_samples(collisions.uncollided);
    const std::vector<RgbF> by_samples = crossing_light(space(), light, monitor);
    Rgb sum{}, kept(1);
    for (std::size_t s = 0; s < by_samples.size(); ++s) {
      solution.uncollided[s] += by_samples[s];
      sum += Rgb(by_samples[s]) * double(samples_[s].area);
    }
    for (std::size_t c = 0; c < 3; ++c) {
      const double more = space().media_of(0)[c].albedo * (sum[c] - crossing[c]);
      if (solution.entered[c] > 0) kept[c] = std::max(0., 1 - more / solution.entered[c]);
    }
    for (Channels& source : collisions.source)
      for (std::size_t c = 0; c < 3; ++c) source.c[c] *= float(kept[c]);
    solution.entered = solution.entered * kept;
    crossing = sum;
  } else {
    for (std::size_t i = 0; i < collisions.crossing.size(); ++i)
      collisions.uncollided[i] += collisions.crossing[i];
    solution.uncollided = at_samples(collisions.uncollided);
  }
  solution.entered += direct + crossing, solution.left += direct + crossing;
}

// Values at the elements, interpolated at samples finer than these.
std::vector<RgbF> DiffusionBody::at_samples(std::span<const RgbF> values) const {
  std::vector<RgbF> result(samples_.size());
  // Cells of twice the size serve error estimates and smooth light.
  const bool is_finer = edges_ != nullptr && 2 * samples_.size() > 3 * values.size();
  const DiffusionSpace here = space();
  parallel_chunks(result.size(), 256, [&](std::size_t begin, std::size_t end, std::size_t) {
    std::vector<std::uint32_t> around;
    for (std::size_t s = begin; s < end; ++s) {
      result[s] = values[boundary_.of_sample[s]];
      if (!is_finer) continue;
      Rgb sum{};
      double weights = 0;
      for_each_beside(here, here.in_lattice(samples_[s].position), samples_[s].normal, around,
                      [&](std::uint32_t e, double near) {
                        const double weight = near * double(boundary_.elements[e].area);
                        sum += Rgb(values[e]) * weight;
                        weights += weight;
                      });
      if (weights > 0) result[s] = RgbF(sum / weights);
    }
  });
  return result;
}

// Exitance at the samples: fluence under a sample, at the depth of its cell's centre, times the conductance
// to the outside. Normalized so the samples emit exactly the loss of all cells.
void DiffusionBody::read(std::span<const RgbF> at_once, Solution& solution) const {
  const std::span<const Channels> fluence = solution.fluence;
  struct Plane {
    RgbF value;  // exitance at the element
    std::array<Vec3f, 3> slope{};
  };
  std::vector<Plane> planes(attached_.size());
  parallel_chunks(planes.size(), 4096, [&](std::size_t begin, std::size_t end, std::size_t) {
    for (std::size_t i = begin; i < end; ++i) {
      const auto& [cell, depth] = attached_[i];
      if (cell == DiffusionGrid::kNone) continue;
      const BoundaryElement& element = boundary_.elements[i];
      const Vec3f apart = Vec3f(space().in_lattice(element.position)) - grid_.cells()[cell].centre;
      const Vec3f beside = apart - element.normal * dot(apart, element.normal);
      const std::array<Vec3f, 3> slopes = gradient_at(grid_, fluence, cell);
      const std::array<CalibratedMedium, 3>& media = space().media_of(cell);
      for (std::size_t c = 0; c < 3; ++c) {
        const auto conductance = float(media[c].conductance(depth));
        planes[i].value[c] = (fluence[cell].c[c] + dot(slopes[c], beside)) * conductance;
        planes[i].slope[c] = slopes[c] * (conductance / float(lattice_.cell));
      }
    }
  });
  solution.exitance.reserve(samples_.size());
  Rgb found{};
  for (std::size_t s = 0; s < samples_.size(); ++s) {
    const std::uint32_t i = boundary_.of_sample[s];
    const Vec3f apart = samples_[s].position - boundary_.elements[i].position;
    RgbF leaves = solution.uncollided[s] + at_once[s];
    for (std::size_t c = 0; c < 3; ++c)
      leaves[c] += std::max(0.f, planes[i].value[c] + dot(planes[i].slope[c], apart));
    found += Rgb(leaves) * double(samples_[s].area);
    solution.exitance.push_back(leaves);
  }
  for (std::size_t i = 0; i < attached_.size(); ++i) {
    const auto& [cell, depth] = attached_[i];
    if (cell == DiffusionGrid::kNone) continue;
    const std::array<CalibratedMedium, 3>& media = space().media_of(cell);
    for (std::size_t c = 0; c < 3; ++c)
      solution.left[c] +=
          double(boundary_.elements[i].area) * double(fluence[cell].c[c]) * media[c].conductance(depth);
  }
  Rgb factor{};
  for (std::size_t c = 0; c < 3; ++c) factor[c] = found[c] > 0 ? solution.left[c] / found[c] : 0;
  for (std::vector<RgbF>* values : {&solution.exitance, &solution.uncollided})
    for (RgbF& leaves : *values) leaves = RgbF(Rgb(leaves) * factor);
}

// Without its exit at an edge, a part of the light would be absorbed, and the rest leave elsewhere: here, everywhere alike.
// By bench_volume_models --default, this is nearer to random walks than solving again without this light.
void DiffusionBody::correct_edges(const EnteringLight& light, Solution& solution, Monitor* monitor) const {
  if (edges_ == nullptr || edges_->samples().empty()) return;
  std::vector<FluenceInCell> fluence(solution.fluence.size());
  parallel_chunks(fluence.size(), 4096, [&](std::size_t begin, std::size_t end, std::size_t) {
    for (std::size_t i = begin; i < end; ++i)
      fluence[i] = {solution.fluence[i], gradient_at(grid_, solution.fluence, std::uint32_t(i))};
  });
  const std::vector<EdgeExitance::AtSample> near_edges = edges_->exitance(light, fluence, monitor);
  Rgb more{};
  for (std::size_t i = 0; i < near_edges.size(); ++i) {
    const std::uint32_t s = edges_->samples()[i];
    const RgbF by_diffusion = solution.exitance[s] - solution.uncollided[s];
    const Rgb change = near_edges[i].weight * (near_edges[i].exitance - Rgb(by_diffusion));
    solution.exitance[s] += RgbF(change);
    more += change * double(samples_[s].area);
  }
  Rgb factor(1);
  for (std::size_t c = 0; c < 3; ++c) {
    const double kept =
        solution.entered[c] > 0 ? std::max(0., 1 - solution.left[c] / solution.entered[c]) : 0;
    if (solution.left[c] > 0) factor[c] = (solution.left[c] + kept * more[c]) / (solution.left[c] + more[c]);
  }
  for (RgbF& leaves : solution.exitance) leaves = RgbF(Rgb(leaves) * factor);
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
      loss[i].c[c] = float(space().media_of(i)[c].absorption * double(grid_.cells()[i].volume) * cube);
  for (std::size_t i = 0; i < attached_.size(); ++i)
    if (const auto& [cell, depth] = attached_[i]; cell != DiffusionGrid::kNone)
      for (std::size_t c = 0; c < 3; ++c)
        loss[cell].c[c] += boundary_.elements[i].area * float(space().media_of(cell)[c].conductance(depth));
  return loss;
}
}  // namespace opaline
