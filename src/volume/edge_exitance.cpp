// SPDX-License-Identifier: GPL-3.0-or-later
#include "volume/edge_exitance.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/parallel.h"
#include "transport/smooth_boundary.h"

namespace opaline {
namespace {

constexpr double kFarthest = 3;     // mean free paths
constexpr double kSameSheet = .9;   // least agreement of normals of one sheet
constexpr double kWeight = 6;       // per fraction of light from another part of the surface
constexpr double kLeastLeft = .02;  // share of a path to follow
constexpr double kLeastReflected = .05;
constexpr double kLeastWeight = .1;
constexpr double kOfThin = 4;   // subtracted, per share of light from an opposite sheet
constexpr int kLegs = 2;        // pieces of a path, reflected at the surface once
constexpr double kOfNode = .5;  // light of a path at one place, sum of the channels

std::array<Vec3d, 3> frame_of(const Vec3f& normal) {
  std::array<Vec3d, 3> frame{Vec3d{}, Vec3d{}, Vec3d(normal)};
  tangent_frame(frame[2], frame[0], frame[1]);
  return frame;
}

/// True if two elements are in one plane.
bool is_level(const BoundaryElement& a, const BoundaryElement& b) {
  return dot(a.normal, b.normal) > .9999f &&
         std::abs(dot(a.normal, b.position - a.position)) < 1e-3f * std::sqrt(a.area);
}

}  // namespace

EdgeExitance::EdgeExitance(const DiffusionSpace& space) : space_(space), paths_(space_) {
  for (const std::array<CalibratedMedium, 3>& media : space.media)
    for (const CalibratedMedium& medium : media)
      if (medium.albedo > 0) longest_ = std::max(longest_, 1 / medium.extinction);
  // Outside, two rings with the probability of their cosine.
  for (std::size_t k = 0; k < kPaths; ++k) {
    const double square = (double(k / kOfRing) + .5) * kOfRing / kPaths, cosine = std::sqrt(1 - square);
    const double angle = 2 * std::numbers::pi * (double(k % kOfRing) + .5) / kOfRing,
                 sine = std::sqrt(square);
    const Vec3d outward(sine * std::cos(angle), sine * std::sin(angle), cosine);
    directions_[k] = {refracted_inward(-outward, {0, 0, 1}, space_.eta()),
                      (1 - fresnel_reflectance(cosine, space_.eta())) / double(kPaths)};
    seen_ += directions_[k].share;
  }
  if (!space.varies()) {
    step_ = BodyPaths::kStep * space.lattice.cell;
    absorbed_ = absorbed_in(step_, 0);
  }
  std::vector<char> is_near(space.boundary.elements.size());
  parallel_chunks(is_near.size(), 256, [&](std::size_t begin, std::size_t end, std::size_t) {
    for (std::size_t i = begin; i < end; ++i) is_near[i] = is_near_other_sheet(i) ? 1 : 0;
  });
  for (std::size_t s = 0; s < space.samples.size(); ++s)
    if (is_near[element_of(s)] != 0) samples_.push_back(std::uint32_t(s));
}

Way EdgeExitance::path_from(const BoundaryElement& from, const std::array<Vec3d, 3>& frame,
                            std::size_t path) const {
  const Vec3d& inward = directions_[path].inward;
  return {space_.in_lattice(from.position), frame[0] * inward.x + frame[1] * inward.y + frame[2] * inward.z};
}

bool EdgeExitance::has_own_sheet_only(const BoundaryElement& from, const Vec3d& position) const {
  const std::uint32_t cell = space_.grid.at(Vec3f(position));
  return cell != DiffusionGrid::kNone &&
         std::ranges::all_of(space_.elements_of.of(cell),
                             [&](std::uint32_t e) { return agreement(from, e) > kSameSheet; });
}

// Along the flattest paths, if they may leave: by some points on them.
bool EdgeExitance::is_near_other_sheet(std::size_t element) const {
  const std::uint32_t cell = space_.attached[element].cell;
  if (cell == DiffusionGrid::kNone) return false;
  const BoundaryElement& from = space_.boundary.elements[element];
  const double farthest = kFarthest * longest_;
  const std::array<Vec3d, 3> frame = frame_of(from.normal);
  for (std::size_t k = kPaths - kOfRing; k < kPaths; ++k) {
    const Way way = path_from(from, frame, k);
    if (std::ranges::all_of(std::array{1. / 3, 2. / 3, 1.}, [&](double part) {
          return has_own_sheet_only(from, paths_.at(way, part * farthest));
        }))
      continue;
    const BodyPaths::End end = paths_.follow(way, 0, farthest, cell, [](double, double, std::uint32_t) {});
    if (end.exit && space_.is_wide(end.exit->element) &&
        std::abs(agreement(from, end.exit->element)) < kSameSheet)
      return true;
  }
  return false;
}

Rgb EdgeExitance::absorbed_in(double step, std::uint32_t cell) const {
  Rgb share{};
  for (std::size_t c = 0; c < 3; ++c) share[c] = -std::expm1(-space_.media_of(cell)[c].extinction * step);
  return share;
}

void EdgeExitance::add_sheet(std::uint32_t element, Paths& paths) const {
  constexpr std::size_t kMost = 4;
  if (paths.sheets.size() == kMost) return;
  for (const std::uint32_t other : paths.sheets)
    if (dot(space_.boundary.elements[other].normal, space_.boundary.elements[element].normal) > kSameSheet)
      return;
  paths.sheets.push_back(element);
}

// Paths inwards, reflected at the surface.
void EdgeExitance::follow(std::size_t sample, Paths& paths) const {
  const BoundaryElement& from = space_.samples[sample];
  paths.nodes.clear();
  paths.sheets.assign(1, element_of(sample));
  paths.beside = paths.opposite = {};
  const std::array<Vec3d, 3> frame = frame_of(from.normal);
  for (std::size_t k = 0; k < kPaths; ++k) {
    const double weight = directions_[k].share;
    Rgb left(weight);
    Way way = path_from(from, frame, k);
    std::uint32_t cell = cell_of(sample);
    for (int leg = 0; leg < kLegs && max_component(left) > kLeastLeft * weight; ++leg) {
      Rgb emitted{};
      double middle = 0;
      const auto add = [&](const Rgb& share, double length) {
        emitted += share;
        middle += length * (share.x + share.y + share.z);
      };
      const auto end_node = [&](std::uint32_t at) {
        const double sum = emitted.x + emitted.y + emitted.z;
        if (sum > 0) paths.nodes.push_back({paths_.at(way, middle / sum), at, emitted});
        emitted = {}, middle = 0;
      };
      const auto emit = [&](double start, double step, std::uint32_t at) {
        const Rgb share = left * (step == step_ ? absorbed_ : absorbed_in(step, at));
        left -= share;
        add(share, start + .5 * step);
        if (emitted.x + emitted.y + emitted.z > kOfNode * weight) end_node(at);
      };
      const BodyPaths::End end = paths_.follow(way, 0, kFarthest * longest_, cell, emit);
      if (!end.exit) add(left, kFarthest * longest_);
      end_node(end.cell);
      if (!end.exit) break;
      const float agreement_there = agreement(from, end.exit->element);
      if (leg == 0 && space_.is_wide(end.exit->element) && agreement_there < kSameSheet)
        (agreement_there > -kSameSheet ? paths.beside : paths.opposite) += left;
      add_sheet(end.exit->element, paths);
      const auto [further, reflectance] = paths_.reflected(way, *end.exit);
      left *= reflectance;
      way = further;
      cell = end.exit->cell;
    }
  }
  paths.beside = paths.beside / seen_;
  paths.opposite = paths.opposite / seen_;
}

// Entry, through a sheet, of light reaching a position: by the plane of its element, then by that of the element found
// there.
EdgeExitance::Entry EdgeExitance::back_to_sheet(const Vec3d& position, const Vec3d& along,
                                                std::uint32_t sheet) const {
  const Vec3d sheet_normal(space_.boundary.elements[sheet].normal);
  std::uint32_t element = sheet;
  double length = 0;
  for (int i = 0; i < 2; ++i) {
    const BoundaryElement& plane = space_.boundary.elements[element];
    const Vec3d normal(plane.normal);
    length = std::max(0., dot(space_.in_lattice(plane.position) - position, normal) /
                              std::max(BodyPaths::kLeastCosine, -dot(along, normal)));
    if (length * space_.lattice.cell > kFarthest * longest_) return {};
    const Vec3d entry = position - along * length;
    const std::uint32_t before = element;
    double nearest = INFINITY;
    for (const double below : {0., .05, .35, .7}) {  // cells
      const std::uint32_t cell = space_.grid.at(Vec3f(entry - normal * below));
      if (cell == DiffusionGrid::kNone) continue;
      for (const std::uint32_t e : space_.elements_of.of(cell)) {
        const BoundaryElement& other = space_.boundary.elements[e];
        const Vec3d apart = space_.in_lattice(other.position) - entry, other_normal(other.normal);
        if (dot(other_normal, sheet_normal) < kSameSheet) {
          if (dot(apart, normal) < 0 && dot(apart, other_normal) < 0) return {};  // beyond an edge
          continue;
        }
        if (dot(apart, apart) >= nearest) continue;
        nearest = dot(apart, apart);
        element = e;
      }
      if (std::isfinite(nearest)) break;
    }
    if (!std::isfinite(nearest)) return {};
    if (element == before || is_level(plane, space_.boundary.elements[element])) break;
  }
  return {length * space_.lattice.cell, element};
}

EdgeExitance::Entry EdgeExitance::entry_of(const Beam& beam, const Vec3d& position) const {
  if (beam.mirror == DiffusionGrid::kNone) return back_to_sheet(position, beam.along, beam.element);
  const Vec3d normal(space_.boundary.elements[beam.mirror].normal), along = mirrored(beam.along, normal);
  const Entry turn = back_to_sheet(position, along, beam.mirror);
  if (turn.element == DiffusionGrid::kNone) return {};
  const Vec3d at = position - along * (turn.length / space_.lattice.cell);
  const Entry entry = back_to_sheet(at, beam.along, beam.element);
  return {turn.length + entry.length, entry.element};
}

// True if light enters there or in a cell beside.
bool EdgeExitance::is_lit(std::uint32_t sheet, const TransmittedLight& source) const {
  const auto enters = [&](std::uint32_t e) { return max_component(source.flux[e]) > 0; };
  if (enters(sheet)) return true;
  const std::uint32_t cell = space_.attached[sheet].cell;
  return cell != DiffusionGrid::kNone &&
         std::ranges::any_of(space_.grid.links(cell), [&](const DiffusionGrid::Link& link) {
           return std::ranges::any_of(space_.elements_of.of(link.to), [&](std::uint32_t e) {
             return enters(e) && agreement(space_.boundary.elements[sheet], e) > kSameSheet;
           });
         });
}

// Beams through each sheet, and those reflected at each other one.
std::vector<std::vector<EdgeExitance::Beam>> EdgeExitance::beams_of(const Paths& paths,
                                                                    const TransmittedLight& source) const {
  std::vector<std::vector<Beam>> beams;
  for (const std::uint32_t sheet : paths.sheets) {
    if (!is_lit(sheet, source)) continue;
    const Vec3d normal(space_.boundary.elements[sheet].normal);
    const EntryDirections directions = source.directions(sheet);
    const auto count = double(directions.all().size());  // each node has one of them
    std::vector<Beam>& direct = beams.emplace_back();
    for (const EntryDirection& from : directions.all())
      direct.push_back(
          {refracted_inward(-Vec3d(from.outward), normal, space_.eta()), sheet, from.share * count});
    for (const std::uint32_t other : paths.sheets) {
      if (other == sheet) continue;
      std::vector<Beam> reflected = beams.back();
      double most = 0;
      for (Beam& beam : reflected) {
        const double cosine = dot(beam.along, Vec3d(space_.boundary.elements[other].normal));
        beam.share *= cosine > 0 ? inside_reflectance(cosine, space_.eta()) : 0;
        beam.mirror = other;
        most = std::max(most, beam.share);
      }
      if (most > kLeastReflected) beams.insert(beams.end() - 1, std::move(reflected));
    }
  }
  return beams;
}

// Sum over the paths of the first collisions there.
Rgb EdgeExitance::scattered_once(const Paths& paths, const TransmittedLight& source) const {
  Rgb sum{};
  for (const std::vector<Beam>& beams : beams_of(paths, source)) {
    std::size_t next = 0;
    for (const Node& node : paths.nodes) {
      const Beam& beam = beams[next++ % beams.size()];
      if (!(beam.share > 0)) continue;
      const auto [length, element] = entry_of(beam, node.position);
      if (element == DiffusionGrid::kNone) continue;
      const BoundaryElement& entry = space_.boundary.elements[element];
      const double cosine = std::max(BodyPaths::kLeastCosine, -dot(beam.along, Vec3d(entry.normal)));
      const Rgb arriving = source.flux[element] * (beam.share / (double(entry.area) * cosine));
      for (std::size_t c = 0; c < 3; ++c) {
        const CalibratedMedium& medium = space_.media_of(node.cell)[c];
        sum[c] += node.share[c] * medium.albedo * arriving[c] * std::exp(-medium.extinction * length);
      }
    }
  }
  return sum;
}

// Sum over the paths of the fluence there.
Rgb EdgeExitance::scattered_more(const Paths& paths, std::span<const FluenceInCell> fluence) const {
  Rgb sum{};
  for (const Node& node : paths.nodes) {
    const FluenceInCell& here = fluence[node.cell];
    const Vec3f apart = Vec3f(node.position) - space_.grid.cells()[node.cell].centre;
    for (std::size_t c = 0; c < 3; ++c)
      sum[c] += node.share[c] * space_.media_of(node.cell)[c].albedo *
                double(std::max(0.f, here.value.c[c] + dot(here.gradient[c], apart)));
  }
  return sum;
}

Rgb EdgeExitance::weight_of(const Paths& paths) {
  Rgb weight{};
  for (std::size_t c = 0; c < 3; ++c)
    weight[c] = std::clamp(kWeight * paths.beside[c] - kLeastWeight, 0., 1.) *
                std::max(0., 1 - kOfThin * paths.opposite[c]);
  return weight;
}

// Where light enters, the fluence near the surface is above that of diffusion.
std::vector<EdgeExitance::AtSample> EdgeExitance::exitance(const EnteringLight& light,
                                                           std::span<const FluenceInCell> fluence,
                                                           Monitor* monitor) const {
  constexpr std::size_t kAtOnce = 4;  // lights, by memory
  std::vector<AtSample> result(samples_.size());
  std::vector<TransmittedLight> sources;
  const auto add_scattered_once = [&] {
    for_each_path(monitor, [&](std::size_t i, const Paths& paths) {
      for (const TransmittedLight& source : sources) result[i].exitance += scattered_once(paths, source);
    });
    sources.clear();
  };
  for_each_source(space_, light, [&](TransmittedLight one) {
    sources.push_back(std::move(one));
    if (sources.size() == kAtOnce) add_scattered_once();
  });
  const double factor = 1 / (4 * space_.eta() * space_.eta());
  for_each_path(monitor, [&](std::size_t i, const Paths& paths) {
    Rgb once = result[i].exitance;
    for (const TransmittedLight& source : sources) once += scattered_once(paths, source);
    const Rgb more = scattered_more(paths, fluence);
    result[i].weight = weight_of(paths);
    for (std::size_t c = 0; c < 3; ++c) {
      const CalibratedMedium::Emission& emission = space_.media_of(cell_of(samples_[i]))[c].emission;
      const double once_share = once[c] > 0 ? once[c] / (once[c] + more[c]) : 0;
      const double lit = std::min(1., once_share / emission.once_share);
      result[i].exitance[c] =
          factor * (once[c] + more[c] * (emission.unlit + (emission.lit - emission.unlit) * lit));
    }
  });
  return result;
}

// Calls visit(index among samples_, paths) for those with a weight.
template <class Visit>
void EdgeExitance::for_each_path(Monitor* monitor, const Visit& visit) const {
  parallel_chunks(samples_.size(), 64, [&](std::size_t begin, std::size_t end, std::size_t) {
    advance(monitor, 0);
    Paths paths;
    for (std::size_t i = begin; i < end; ++i) {
      follow(samples_[i], paths);
      if (max_component(weight_of(paths)) > 0) visit(i, paths);
    }
  });
}

}  // namespace opaline
