// SPDX-License-Identifier: GPL-3.0-or-later
#include "volume/first_collisions.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>

#include "core/parallel.h"
#include "transport/smooth_boundary.h"
#include "volume/entry_directions.h"

namespace opaline {
namespace {

constexpr int kMostReflections = 4;
constexpr double kLeastReflected = .05;  // share of the flux at the first exit
constexpr double kFarthest = 4;          // free paths; longer flights end there

// Additive recurrence with the golden ratio in [0, 1).
double golden_point(std::size_t i) {
  const double turns = .5 + .6180339887498949 * double(i);
  return turns - std::floor(turns);
}

class Depositor {
 public:
  explicit Depositor(const DiffusionSpace& space) : space_(space), paths_(space) {
    result_.source.resize(space.grid.cells().size());
    result_.crossing.resize(space.boundary.elements.size());
    result_.uncollided.resize(space.boundary.elements.size());
    result_.at_once.resize(space.boundary.elements.size());
    for (const std::array<CalibratedMedium, 3>& media : space.media)
      for (const CalibratedMedium& medium : media)
        if (medium.albedo > 0) longest_ = std::max(longest_, 1 / medium.extinction);
    if (!space.varies()) step_ = stretch_of(BodyPaths::kStep * space.lattice.cell, 0);
  }

  /// entering: W
  void enter(const Vec3d& outward, const Rgb& entering, std::size_t i, bool is_focused);
  /// Light meeting a part of the body thinner than the cells, e.g. the tip of a needle: it crosses.
  void cross(const Rgb& entering, std::size_t i) {
    result_.uncollided[i] += RgbF(entering / double(space_.boundary.elements[i].area));
  }
  FirstCollisions take() { return std::move(result_); }

 private:
  using Exit = BodyPaths::Exit;
  /// Segment of a path within a cell, per channel: fraction of the arriving flux colliding in it, and mean
  /// distance of collisions.
  struct Stretch {
    double length = 0;
    std::array<double, 3> share{}, middle{}, scattered{};  // scattered: fraction of the collisions
  };
  // Scattered fraction of a collision. In a homogeneous medium, absorption is applied at the entry instead.
  double scattered_of(const CalibratedMedium& medium) const { return space_.varies() ? medium.albedo : 1; }
  Stretch stretch_of(double length, std::uint32_t cell) const;
  std::optional<Exit> collide(const Way& way, double start, std::uint32_t first, Rgb& flux);
  /// Collisions of the three channels at separate, close positions.
  struct Collided {
    std::array<Vec3d, 3> places;
    Rgb flux{};
  };
  void deposit(const Collided& collided, const Vec3d& about, std::uint32_t fallback);
  void deposit(const Vec3d& place, std::uint32_t fallback, std::size_t channel, double flux);
  void deposit(const Way& way, double start, const Stretch& stretch, std::uint32_t fallback, Rgb& flux);
  void spread(const Vec3d& at, const Exit& exit);
  void leave(Way way, Exit exit, std::size_t i, bool is_focused, Rgb flux);

  const DiffusionSpace& space_;
  BodyPaths paths_;
  struct Share {
    std::uint32_t element;
    double per_area;
  };
  std::vector<Share> spread_;          // elements of the current exit
  std::vector<std::uint32_t> around_;  // cells around it
  double longest_ = 0;                 // free path
  Stretch step_;                       // smallest cells, in a homogeneous medium
  FirstCollisions result_;
};

Depositor::Stretch Depositor::stretch_of(double length, std::uint32_t cell) const {
  Stretch stretch{length, {}, {}, {}};
  for (std::size_t c = 0; c < 3; ++c) {
    const CalibratedMedium& medium = space_.media_of(cell)[c];
    stretch.scattered[c] = scattered_of(medium);
    if (!(medium.albedo > 0) && !space_.varies()) continue;
    const double paths = medium.extinction * length, share = -std::expm1(-paths);
    stretch.share[c] = share;
    stretch.middle[c] = paths > 1e-4 ? (1 - paths * (1 - share) / share) / medium.extinction : .5 * length;
  }
  return stretch;
}

// Deposits the collisions along a path from `start`. Returns the exit, with the remaining flux in `flux`.
std::optional<Depositor::Exit> Depositor::collide(const Way& way, double start, std::uint32_t first,
                                                  Rgb& flux) {
  const double farthest = start + kFarthest * longest_;
  const BodyPaths::End end =
      paths_.follow(way, start, farthest, first, [&](double length, double step, std::uint32_t cell) {
        deposit(way, length, step == step_.length ? step_ : stretch_of(step, cell), cell, flux);
      });
  if (end.exit) return end.exit;
  for (std::size_t c = 0; c < 3; ++c)
    if (const CalibratedMedium& medium = space_.media_of(end.cell)[c]; flux[c] > 0)
      deposit(paths_.at(way, farthest + 1 / medium.extinction), end.cell, c, flux[c] * scattered_of(medium));
  flux = {};
  return {};
}

// Deposits the collisions on a segment, each channel at its mean position.
void Depositor::deposit(const Way& way, double start, const Stretch& stretch, std::uint32_t fallback,
                        Rgb& flux) {
  Collided collided;
  for (std::size_t c = 0; c < 3; ++c) {
    collided.places[c] = paths_.at(way, start + stretch.middle[c]);
    collided.flux[c] = flux[c] * stretch.share[c];
    flux[c] -= collided.flux[c];
    collided.flux[c] *= stretch.scattered[c];
  }
  deposit(collided, paths_.at(way, start + .5 * stretch.length), fallback);
}

// Deposits by linear interpolation between the cell at a position and its neighbours on the nearer sides.
void Depositor::deposit(const Collided& collided, const Vec3d& about, std::uint32_t fallback) {
  const Vec3f place(about);
  const std::uint32_t found = space_.grid.at(place);
  const std::uint32_t home = found == DiffusionGrid::kNone ? fallback : found;
  Rgb left = collided.flux;
  if (found != DiffusionGrid::kNone) {
    const DiffusionGrid::Cell& cell = space_.grid.cells()[home];
    const std::array<int, 3> at{int(place.x), int(place.y), int(place.z)};
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const float centre = cell.centre[axis];
      const int corner = cell.size > 1 ? int(centre) - cell.size / 2 : at[axis];
      std::array<int, 3> beside = at;
      beside[axis] = place[axis] < centre ? corner - 1 : corner + cell.size;
      const std::uint32_t other = space_.grid.at(beside[0], beside[1], beside[2]);
      if (other == DiffusionGrid::kNone || other == home) continue;
      const double inverse = 1 / double(space_.grid.cells()[other].centre[axis] - centre);
      for (std::size_t c = 0; c < 3; ++c) {
        const double offset = collided.places[c][axis] - double(centre);
        const double share = collided.flux[c] * std::min(1., std::max(0., offset * inverse));
        result_.source[other].c[c] += float(share);
        left[c] -= share;
      }
    }
  }
  for (std::size_t c = 0; c < 3; ++c) result_.source[home].c[c] += float(left[c]);
}

// Deposits one channel.
void Depositor::deposit(const Vec3d& place, std::uint32_t fallback, std::size_t channel, double flux) {
  Collided collided{{place, place, place}, {}};
  collided.flux[channel] = flux;
  deposit(collided, place, fallback);
}

// Distributes a path's exit over the elements around it, by weights per area: one ray represents a whole cell
// face.
void Depositor::spread(const Vec3d& at, const Exit& exit) {
  spread_.clear();
  const Vec3f normal = space_.boundary.elements[exit.element].normal;
  double sum = 0;
  for_each_beside(space_, at, normal, around_, [&](std::uint32_t e, double weight) {
    spread_.push_back({e, weight});
    sum += weight * double(space_.boundary.elements[e].area);
  });
  if (spread_.empty()) {
    spread_.push_back({exit.element, 1});
    sum = double(space_.boundary.elements[exit.element].area);
  }
  for (Share& share : spread_) share.per_area /= sum;
}

// Splits the flux at an exit: the transmitted part leaves; the reflected part collides on its further path, or reaches
// the surface again.
void Depositor::leave(Way way, Exit exit, std::size_t i, bool is_focused, Rgb flux) {
  const double least = kLeastReflected * max_component(flux);
  for (int reflections = 1;; ++reflections) {
    std::vector<RgbF>& leaving = is_focused && reflections == 1 ? result_.crossing : result_.uncollided;
    const auto [further, reflectance] = paths_.reflected(way, exit);
    spread(further.from, exit);
    for (const auto& [element, per_area] : spread_)
      leaving[element] += RgbF(flux * ((1 - reflectance) * per_area));
    flux *= reflectance;
    way = further;
    const std::array<CalibratedMedium, 3>& media = space_.media_of(exit.cell);
    Rgb colliding{};
    for (std::size_t c = 0; c < 3; ++c) colliding[c] = flux[c] * (space_.varies() ? 1 : media[c].albedo);
    if (max_component(flux) < least || reflections == kMostReflections) {
      for (std::size_t c = 0; c < 3; ++c)
        deposit(paths_.at(way, -std::log1p(-golden_point(i)) / media[c].extinction), exit.cell, c,
                flux[c] * media[c].albedo);
      return;
    }
    const std::optional<Exit> next = collide(way, 0, exit.cell, colliding);
    if (!next) return;
    for (std::size_t c = 0; c < 3; ++c)
      flux[c] = space_.varies() ? colliding[c] : flux[c] * std::exp(-next->length * media[c].extinction);
    exit = *next;
  }
}

// Light transmitted at an element from one direction. Collisions above the centre of the element's cell
// partly leave at once, as a current divided by two resistances; the rest continues.
void Depositor::enter(const Vec3d& outward, const Rgb& entering, std::size_t i, bool is_focused) {
  const BoundaryElement& element = space_.boundary.elements[i];
  const AttachedElement& attached = space_.attached[i];
  const std::array<CalibratedMedium, 3>& media = space_.media_of(attached.cell);
  const Vec3d normal(element.normal);
  const Vec3d inward = refracted_inward(-outward, normal, space_.eta());
  const double cosine = std::max(BodyPaths::kLeastCosine, -dot(inward, normal)), depth = attached.depth;
  const double path = depth / cosine;
  const Way way{space_.in_lattice(element.position), inward};
  Rgb colliding{}, factors(1);
  for (std::size_t c = 0; c < 3; ++c) {
    const CalibratedMedium& medium = media[c];
    if (!(medium.albedo > 0)) continue;
    factors[c] = medium.entry_factor(cosine);
    const double enters = entering[c] * medium.albedo * factors[c];
    const double free_path = 1 / medium.extinction;
    const double passed = std::exp(-path / free_path);
    const double at_once =
        (depth - cosine * free_path * (1 - passed)) / (2 * medium.mismatch * medium.diffusion + depth);
    result_.at_once[i][c] += float(enters * at_once / double(element.area));
    result_.source[attached.cell].c[c] += float(enters * (1 - passed - at_once));
    colliding[c] = (space_.varies() ? entering[c] * factors[c] : enters) * passed;
  }
  const std::optional<Exit> exit = collide(way, path, attached.cell, colliding);
  if (!exit) return;
  Rgb arriving{};
  for (std::size_t c = 0; c < 3; ++c)
    if (media[c].albedo > 0)
      arriving[c] = space_.varies() ? colliding[c] / factors[c]
                                    : entering[c] * std::exp(-exit->length * media[c].extinction);
  leave(way, *exit, i, is_focused, arriving);
}

// Light transmitted at each element, W: the sum over the samples.
template <class OfSample>
std::vector<Rgb> entering_flux(const DiffusionSpace& space, const OfSample& entering) {
  std::vector<Rgb> flux(space.boundary.elements.size());
  for (std::size_t s = 0; s < space.samples.size(); ++s) flux[space.boundary.of_sample[s]] += entering(s);
  return flux;
}

/// Light entering at all elements. Each of a fixed number of parts of the elements has its own sums, added in order,
/// which makes the bits independent of the number of threads.
class EntryInParts {
 public:
  EntryInParts(const DiffusionSpace& space, Monitor* monitor)
      : space_(space), monitor_(monitor), parts_(kParts, Depositor(space)) {}

  void enter(const TransmittedLight& light) {
    const std::vector<Rgb>& flux = light.flux;
    const std::size_t of_part = (flux.size() + kParts - 1) / kParts;
    parallel_chunks(flux.size(), of_part, [&](std::size_t begin, std::size_t end, std::size_t part) {
      for (std::size_t i = begin; i < end; ++i) {
        advance(monitor_, 1);
        if (!(max_component(flux[i]) > 0)) continue;
        if (space_.attached[i].cell == DiffusionGrid::kNone) {
          parts_[part].cross(flux[i], i);
          continue;
        }
        const EntryDirections entry = light.directions(i);
        for (const EntryDirection& from : entry.all())
          parts_[part].enter(Vec3d(from.outward), flux[i] * from.share, i, light.is_focused);
      }
    });
  }

  FirstCollisions take() {
    FirstCollisions sum = parts_.front().take();
    for (Depositor& part : std::span(parts_).subspan(1)) {
      const FirstCollisions more = part.take();
      for (std::size_t i = 0; i < sum.source.size(); ++i) sum.source[i].c += more.source[i].c;
      for (std::size_t i = 0; i < sum.at_once.size(); ++i) {
        sum.crossing[i] += more.crossing[i];
        sum.uncollided[i] += more.uncollided[i];
        sum.at_once[i] += more.at_once[i];
      }
    }
    return sum;
  }

 private:
  static constexpr std::size_t kParts = 4;  // more require more memory

  const DiffusionSpace& space_;
  Monitor* monitor_;
  std::vector<Depositor> parts_;
};

}  // namespace

Rgb flux_of(const DiffusionSpace& space, const EnteringLight& light, std::size_t l, std::size_t sample) {
  const Rgb tint = light.tints.empty() ? Rgb(1) : Rgb(light.tints[sample]);
  return emission(light.lights[l]) * tint *
         (double(space.samples[sample].area) * double(light.transfers[l].weights[sample]));
}

bool is_focused(const Light& light) {
  return is_delta(light) || extent(light).center.has_value();
}

void for_each_source(const DiffusionSpace& space, const EnteringLight& light,
                     const std::function<void(TransmittedLight)>& visit) {
  const std::vector<BoundaryElement>& elements = space.boundary.elements;
  for (std::size_t l = 0; l < light.lights.size(); ++l) {
    std::vector<Rgb> flux = entering_flux(space, [&](std::size_t s) { return flux_of(space, light, l, s); });
    const auto directions = [&space, &elements, &one = light.lights[l]](std::size_t i) {
      return towards_light(one, elements[i], space.eta(), i);
    };
    visit({std::move(flux), directions, is_focused(light.lights[l])});
  }
  if (light.even.empty()) return;
  const std::vector<Rgb> flux =
      entering_flux(space, [&](std::size_t s) { return Rgb(light.even[s]) * double(space.samples[s].area); });
  Rgb beside{};
  for (std::size_t s = 0; s < light.beside.size(); ++s)
    beside += Rgb(light.beside[s]) * double(space.samples[s].area);
  const EvenDirections even(flux, beside);
  const auto directions = [&space, &elements, even, flux](std::size_t i) {
    return even.at(elements[i], space.eta(), flux[i], i);
  };
  visit({flux, directions, false});
}

FirstCollisions first_collisions(const DiffusionSpace& space, const EnteringLight& light, Monitor* monitor) {
  EntryInParts entry(space, monitor);
  for_each_source(space, light, [&](const TransmittedLight& one) { entry.enter(one); });
  return entry.take();
}

}  // namespace opaline
