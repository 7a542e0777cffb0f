// SPDX-License-Identifier: GPL-3.0-or-later
#include "volume/body_paths.h"

#include <cmath>

namespace opaline {

ElementsOfCells::ElementsOfCells(std::span<const AttachedElement> attached, std::size_t cells)
    : first_(cells + 1) {
  for (const AttachedElement& at : attached)
    if (at.cell != DiffusionGrid::kNone) ++first_[at.cell + 1];
  for (std::size_t i = 1; i < first_.size(); ++i) first_[i] += first_[i - 1];
  elements_.resize(first_.back());
  std::vector<std::uint32_t> next(first_.begin(), first_.end() - 1);
  for (std::uint32_t i = 0; i < attached.size(); ++i)
    if (attached[i].cell != DiffusionGrid::kNone) elements_[next[attached[i].cell]++] = i;
}

// Exit through the plane of the nearest boundary element, if the path leaves the body between `least`, in the
// cell `last`, and `length`: if there is no cell at `length` (`next` is none), or if it is behind an
// element's plane in `next`.
std::optional<BodyPaths::Exit> BodyPaths::exit_at(const Way& way, double length, double least,
                                                  std::uint32_t last, std::uint32_t next) const {
  const double cell = space_.lattice.cell;
  const Vec3d end = at(way, length);
  const bool has_left = next == DiffusionGrid::kNone;
  Exit exit{length, ~0u, has_left ? last : next};
  const Vec3d about = has_left ? end - way.along * (.5 * kStep) : end;
  double nearest = INFINITY;
  for (const std::uint32_t e : space_.elements_of.of(exit.cell)) {
    const BoundaryElement& element = space_.boundary.elements[e];
    const Vec3d apart = about - space_.in_lattice(element.position), normal(element.normal);
    if (!(dot(way.along, normal) > 0) || dot(apart, apart) >= nearest) continue;
    if (!has_left && !(dot(apart, normal) > 0)) continue;
    nearest = dot(apart, apart);
    exit.element = e;
  }
  if (exit.element == ~0u) return {};
  const BoundaryElement& element = space_.boundary.elements[exit.element];
  const Vec3d normal(element.normal);
  exit.length = dot(space_.in_lattice(element.position) - way.from, normal) /
                std::max(kLeastCosine, dot(way.along, normal)) * cell;
  exit.length = std::clamp(exit.length, least, std::max(least, length + cell));
  return exit;
}

}  // namespace opaline
