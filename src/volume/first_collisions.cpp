// SPDX-License-Identifier: GPL-3.0-or-later
#include "volume/first_collisions.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "opaline/core/random.h"
#include "opaline/lights/light.h"
#include "opaline/transport/smooth_boundary.h"

namespace opaline {
namespace {

constexpr double kLeastCosine = 1e-3;  // of light inside: against division by 0 where eta < 1
constexpr double kFarthest = 5;        // free paths; what goes farther ends there

// Evenly over [0, 1).
double golden_point(std::size_t i) {
  const double turns = .5 + .6180339887498949 * double(i);
  return turns - std::floor(turns);
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

float edge_of(const DiffusionGrid::Cell& cell) {
  return cell.volume > 64 ? 8 : cell.volume > 8 ? 4 : cell.volume > 1 ? 2 : 1;
}

/// The boundary points of each cell.
class PointsOfCells {
 public:
  PointsOfCells(std::span<const AttachedPoint> attached, std::size_t cells) : first_(cells + 1) {
    for (const AttachedPoint& at : attached)
      if (at.cell != DiffusionGrid::kNone) ++first_[at.cell + 1];
    for (std::size_t i = 1; i < first_.size(); ++i) first_[i] += first_[i - 1];
    points_.resize(first_.back());
    std::vector<std::uint32_t> next(first_.begin(), first_.end() - 1);
    for (std::uint32_t i = 0; i < attached.size(); ++i)
      if (attached[i].cell != DiffusionGrid::kNone) points_[next[attached[i].cell]++] = i;
  }
  std::span<const std::uint32_t> of(std::uint32_t cell) const {
    return std::span(points_).subspan(first_[cell], first_[cell + 1] - first_[cell]);
  }

 private:
  std::vector<std::uint32_t> first_, points_;
};

class Depositor {
 public:
  explicit Depositor(const DiffusionSpace& space)
      : space_(space), points_of_(space.attached, space.grid.cells().size()) {
    result_.source.resize(space.grid.cells().size());
    result_.leaving.resize(space.points.size());
    for (const CalibratedMedium& medium : space.media)
      if (medium.albedo > 0) longest_ = std::max(longest_, 1 / medium.extinction);
  }

  void enter(const EnteringLight& light, std::size_t l, std::size_t i);
  FirstCollisions take() { return std::move(result_); }

 private:
  /// A straight way inside, in lattice units; lengths in world units.
  struct Way {
    Vec3d from, along;
  };
  /// Where a way leaves the body.
  struct Exit {
    double length;
    std::uint32_t point;  // of the boundary, nearest
    std::uint32_t cell;   // the last
  };

  Vec3d at(const Way& way, double length) const {
    return way.from + way.along * (length / space_.lattice.cell);
  }
  std::optional<Exit> exit_of(const Way& way, double start, std::uint32_t first, double farthest) const;
  void deposit(const Vec3d& position, std::uint32_t fallback, std::size_t channel, double flux);
  void leave(const Way& way, const Exit& exit, std::size_t i, std::size_t channel, double flux);

  const DiffusionSpace& space_;
  PointsOfCells points_of_;
  double longest_ = 0;  // free path
  FirstCollisions result_;
};

// Steps of less than a cell, through larger cells, which lie as deep as they are large, of their edge; then the plane of the boundary point nearest to the way's end.
std::optional<Depositor::Exit> Depositor::exit_of(const Way& way, double start, std::uint32_t first,
                                                  double farthest) const {
  constexpr double kStep = .8;  // cells
  std::uint32_t last = first;
  double step = kStep;
  for (double length = start + kStep * space_.lattice.cell;; length += step * space_.lattice.cell) {
    if (length > farthest) return {};
    const std::uint32_t cell = space_.grid.at(Vec3f(at(way, length)));
    if (cell != DiffusionGrid::kNone) {
      last = cell;
      step = std::max(kStep, double(edge_of(space_.grid.cells()[cell])));
      continue;
    }
    Exit exit{length, ~0u, last};
    const Vec3d end = at(way, length - .5 * kStep * space_.lattice.cell);
    double nearest = INFINITY;
    for (const std::uint32_t p : points_of_.of(last)) {
      const Vec3d apart = space_.in_lattice(space_.points[p].position) - end;
      if (!(dot(way.along, Vec3d(space_.points[p].normal)) > 0) || dot(apart, apart) >= nearest) continue;
      nearest = dot(apart, apart);
      exit.point = p;
    }
    if (exit.point == ~0u) return {};
    const BoundaryPoint& point = space_.points[exit.point];
    const Vec3d normal(point.normal);
    exit.length = dot(space_.in_lattice(point.position) - way.from, normal) /
                  std::max(kLeastCosine, dot(way.along, normal)) * space_.lattice.cell;
    exit.length = std::clamp(exit.length, start, length + space_.lattice.cell);
    return exit;
  }
}

// In the cells around a place, by linear interpolation: the cell that it is in and its neighbours towards it.
void Depositor::deposit(const Vec3d& position, std::uint32_t fallback, std::size_t channel, double flux) {
  const Vec3f place(position);
  const std::uint32_t found = space_.grid.at(place);
  const std::uint32_t home = found == DiffusionGrid::kNone ? fallback : found;
  double left = 1;
  if (found != DiffusionGrid::kNone) {
    const DiffusionGrid::Cell& cell = space_.grid.cells()[home];
    const float edge = edge_of(cell);
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const float offset = place[axis] - cell.centre[axis];
      Vec3f beside = cell.centre;
      beside[axis] += std::copysign(edge, offset);
      const std::uint32_t other = space_.grid.at(beside);
      if (other == DiffusionGrid::kNone || other == home) continue;
      const float apart = space_.grid.cells()[other].centre[axis] - cell.centre[axis];
      const double share = std::clamp(double(offset / apart), 0., .5);
      result_.source[other].c[channel] += float(flux * share);
      left -= share;
    }
  }
  result_.source[home].c[channel] += float(flux * left);
}

// What the boundary reflects collides on its further way, which is taken to be inside.
void Depositor::leave(const Way& way, const Exit& exit, std::size_t i, std::size_t channel, double flux) {
  const BoundaryPoint& point = space_.points[exit.point];
  const CalibratedMedium& medium = space_.media[channel];
  const Vec3d normal(point.normal);
  const double reflected =
      flux * inside_reflectance(std::clamp(dot(way.along, normal), kLeastCosine, 1.), medium.eta);
  result_.leaving[exit.point][channel] += float((flux - reflected) / double(point.area));
  const Way back{at(way, exit.length), mirrored(way.along, normal)};
  const double collided = -std::log1p(-golden_point(i)) / medium.extinction;
  deposit(at(back, collided), exit.cell, channel, reflected * medium.albedo);
}

// Light of one source that enters at a point: what collides between the point and the centre of its cell leaves in
// part at once, as between two resistances; of the rest of its way one place stands for all.
void Depositor::enter(const EnteringLight& light, std::size_t l, std::size_t i) {
  const BoundaryPoint& point = space_.points[i];
  const AttachedPoint& attached = space_.attached[i];
  const double weight = double(light.transfers[l].weights[point.sample]);
  if (!(weight > 0) || attached.cell == DiffusionGrid::kNone) return;
  Rgb entering = emission(light.lights[l]) * weight;
  if (!light.tints.empty()) entering = entering * Rgb(light.tints[point.sample]);
  const double eta = space_.media[0].eta;
  const Vec3d normal(point.normal);
  const Vec3d inward = refracted_inward(-Vec3d(towards_light(light.lights[l], point, eta, i)), normal, eta);
  const double cosine = std::max(kLeastCosine, -dot(inward, normal)), depth = attached.depth;
  const double path = depth / cosine;
  const Way way{space_.in_lattice(point.position), inward};
  const std::optional<Exit> exit = exit_of(way, path, attached.cell, path + kFarthest * longest_);
  const double endless = -std::log1p(-golden_point(i));  // free paths
  for (std::size_t c = 0; c < 3; ++c) {
    const CalibratedMedium& medium = space_.media[c];
    if (!(medium.albedo > 0)) continue;
    const double enters = entering[c] * medium.albedo * medium.entry_factor(cosine);
    const double free_path = 1 / medium.extinction;
    const double passed = std::exp(-path / free_path);
    const double at_once =
        (depth - cosine * free_path * (1 - passed)) / (2 * medium.mismatch * medium.diffusion + depth);
    result_.leaving[i][c] += float(enters * at_once);
    const double flux = enters * double(point.area);
    result_.source[attached.cell].c[c] += float(flux * (1 - passed - at_once));
    const double crosses = exit ? std::exp(-exit->length / free_path) : 0;
    const double collided = exit ? -std::log1p(-golden_point(i) * (1 - crosses / passed)) : endless;
    deposit(at(way, path + free_path * collided), attached.cell, c, flux * (passed - crosses));
    if (exit) leave(way, *exit, i, c, entering[c] * double(point.area) * crosses);
  }
}

}  // namespace

FirstCollisions first_collisions(const DiffusionSpace& space, const EnteringLight& light) {
  Depositor depositor(space);
  for (std::size_t l = 0; l < light.lights.size(); ++l)
    for (std::size_t i = 0; i < space.points.size(); ++i) depositor.enter(light, l, i);
  return depositor.take();
}

}  // namespace opaline
