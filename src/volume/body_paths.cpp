// SPDX-License-Identifier: GPL-3.0-or-later
#include "volume/body_paths.h"

#include <cmath>

#include "transport/smooth_boundary.h"

namespace opaline {

ElementsOfCells::ElementsOfCells(const Lattice& lattice, const DiffusionGrid& grid, const Boundary& boundary,
                                 std::span<const AttachedElement> attached)
    : first_(grid.cells().size() + 1) {
  std::vector<std::uint32_t> cells(attached.size());
  for (std::size_t i = 0; i < cells.size(); ++i) {
    const std::uint32_t own = grid.at(Vec3f(lattice.into(Vec3d(boundary.elements[i].position))));
    cells[i] = own == DiffusionGrid::kNone ? attached[i].cell : own;
    if (cells[i] != DiffusionGrid::kNone) ++first_[cells[i] + 1];
  }
  for (std::size_t i = 1; i < first_.size(); ++i) first_[i] += first_[i - 1];
  elements_.resize(first_.back());
  std::vector<std::uint32_t> next(first_.begin(), first_.end() - 1);
  for (std::uint32_t i = 0; i < cells.size(); ++i)
    if (cells[i] != DiffusionGrid::kNone) elements_[next[cells[i]]++] = i;
}

// Nearest element to a point among a cell's, with the path going outwards; no slivers beside other elements.
std::uint32_t BodyPaths::nearest_left(const Way& way, const Vec3d& about, std::uint32_t cell,
                                      bool only_if_behind) const {
  std::uint32_t found = DiffusionGrid::kNone;
  double nearest = INFINITY;
  const std::span<const std::uint32_t> elements = space_.elements_of.of(cell);
  const bool has_wide = elements.size() > 1 &&
                        std::ranges::any_of(elements, [&](std::uint32_t e) { return space_.is_wide(e); });
  for (const std::uint32_t e : elements) {
    if (has_wide && !space_.is_wide(e)) continue;
    const BoundaryElement& element = space_.boundary.elements[e];
    const Vec3d apart = about - space_.in_lattice(element.position), normal(element.normal);
    if (!(dot(way.along, normal) > 0) || dot(apart, apart) >= nearest) continue;
    if (only_if_behind && !(dot(apart, normal) > 0)) continue;
    nearest = dot(apart, apart);
    found = e;
  }
  return found;
}

// Length at which a path leaves the cells.
double BodyPaths::end_of_cells(const Way& way, double inside, double outside) const {
  for (int i = 0; i < 5; ++i) {
    const double middle = .5 * (inside + outside);
    (space_.grid.at(Vec3f(at(way, middle))) == DiffusionGrid::kNone ? outside : inside) = middle;
  }
  return inside;
}

// Exit through the plane of the nearest boundary element, if the path leaves the body between `least`, in the
// cell `last`, and `length`: if there is no cell at `length` (`next` is none), or if it is behind an
// element's plane in `next`.
std::optional<BodyPaths::Exit> BodyPaths::exit_at(const Way& way, double length, double least,
                                                  std::uint32_t last, std::uint32_t next) const {
  const double cell = space_.lattice.cell;
  const Vec3d end = at(way, length);
  const bool has_left = next == DiffusionGrid::kNone;
  Exit exit{length, DiffusionGrid::kNone, has_left ? last : next};
  const Vec3d about = has_left ? end - way.along * (.5 * kStep) : end;
  exit.element = nearest_left(way, about, exit.cell, !has_left);
  if (exit.element == DiffusionGrid::kNone && has_left) {
    // The step may have crossed a narrow cell with the elements.
    const double left = end_of_cells(way, least, length);
    for (const double back : {0., .1, .4, .8}) {
      const std::uint32_t there = space_.grid.at(Vec3f(at(way, left - back * cell)));
      if (there == DiffusionGrid::kNone || there == last) continue;
      exit.cell = there;
      exit.element = nearest_left(way, about, there, false);
      if (exit.element != DiffusionGrid::kNone) break;
    }
  }
  if (exit.element == DiffusionGrid::kNone) return {};
  const BoundaryElement& element = space_.boundary.elements[exit.element];
  const Vec3d normal(element.normal);
  exit.length = dot(space_.in_lattice(element.position) - way.from, normal) /
                std::max(kLeastCosine, dot(way.along, normal)) * cell;
  exit.length = std::clamp(exit.length, least, std::max(least, length + cell));
  return exit;
}

BodyPaths::Reflection BodyPaths::reflected(const Way& way, const Exit& exit) const {
  const Vec3d normal(space_.boundary.elements[exit.element].normal);
  const double cosine = std::clamp(dot(way.along, normal), kLeastCosine, 1.);
  return {{at(way, exit.length), mirrored(way.along, normal)}, inside_reflectance(cosine, space_.eta())};
}

}  // namespace opaline
