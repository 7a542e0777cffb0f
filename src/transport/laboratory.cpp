// SPDX-License-Identifier: GPL-3.0-or-later
#include "transport/laboratory.h"

#include <cmath>
#include <optional>
#include <utility>

#include "core/parallel.h"
#include "transport/fresnel.h"
#include "transport/laboratory_checks.h"
#include "transport/layer_stack.h"
#include "transport/random_walk.h"
#include "transport/slab_tally.h"

namespace opaline {
namespace {

const Vec3d kUp{0, 0, 1};

/// Slab between z = 0, the face of entry, and z = -thickness.
struct SlabBody {
  double thickness;

  BoundaryAhead ahead(const Vec3d& position, const Vec3d& direction) const {
    const double cosine = direction.z;
    if (cosine > 0) return {std::max(0.0, -position.z / cosine), kUp};
    if (cosine < 0 && std::isfinite(thickness))
      return {std::max(0.0, (thickness + position.z) / -cosine), -kUp};
    return {std::numeric_limits<double>::infinity(), -kUp};
  }
};

struct EnteredLight {
  double cosine = 1;  ///< outside
  double weight = 1;  ///< weight of mean 1
};

/// in    u uniform in [0, 1)
EnteredLight enter(const SlabEntry& entry, double eta, double average_transmittance, double u) {
  if (!entry.is_diffuse) return {entry.cosine, 1};
  const double cosine = std::sqrt(1 - u);  // density 2 cos
  return {cosine, eta == 1 ? 1 : fresnel_transmittance(cosine, eta) / average_transmittance};
}

Vec3d direction_inside(double cosine, double eta) {
  const Vec3d outside{std::sqrt(std::max(0.0, 1 - cosine * cosine)), 0, -cosine};
  return refracted_inward(outside, kUp, eta);
}

struct Experiment {
  double eta;
  SlabEntry entry;
  double entered;  ///< fraction of the incident flux
  std::uint64_t seed, most_collisions;
  std::size_t walks_each;
  TallyBins bins;
  std::optional<SlabControls> controls;  ///< homogeneous slab only
};

/// Records one walk.
struct SlabWatcher {
  const Experiment& experiment;
  SlabTally& tally;
  double returned = 0;

  void visit(const WalkState& walk, const BoundaryAhead&, const Crossing& crossing) {
    if (experiment.controls) experiment.controls->visit(walk, crossing, tally.controls);
  }
  void leave(const WalkExit& light) {
    const bool is_back = light.normal.z > 0;
    const TallyBins& bins = experiment.bins;
    FaceTally& face = is_back ? tally.back : tally.through;
    if (is_back) returned += light.weight;
    face.total += light.weight;
    if (light.collisions == 0) face.uncollided += light.weight;
    const double x = light.position.x, y = light.position.y;
    face.rings[bins.ring_of(x * x + y * y)] += light.weight;
    const double cosine = refracted_cosine(std::abs(light.direction.z), experiment.eta);
    face.cosines[bins.cosine_of(cosine)] += light.weight;
  }
};

/// Within a batch, the cosines of incidence are stratified.
/// follow: WalkEnd(WalkNumbers&, WalkState&, SlabWatcher&)
template <class Follow>
void walk_once(const Experiment& experiment, const Follow& follow, std::size_t batch, std::size_t i,
               SlabTally& tally) {
  const double eta = experiment.eta;
  WalkNumbers numbers(experiment.seed, batch * experiment.walks_each + i);
  const double u = (double(i) + numbers.next()) / double(experiment.walks_each);
  const EnteredLight light = enter(experiment.entry, eta, experiment.entered, u);
  WalkState walk{{}, direction_inside(light.cosine, eta), light.weight};
  if (experiment.controls)
    experiment.controls->start(walk, tally.controls);
  else
    tally.controls.back() += walk.weight - 1;  // its mean is known to be 0
  if (!(walk.weight > 0)) return;
  SlabWatcher watcher{experiment, tally};
  const WalkEnd end = follow(numbers, walk, watcher);
  if (end.unfinished > 0 && experiment.controls) experiment.controls->give_up(walk, tally.controls);
  tally.absorbed += end.absorbed;
  tally.unfinished += end.unfinished;
  tally.collisions += double(walk.collisions);
  if (!experiment.bins.by_entry) return;
  tally.entered[experiment.bins.cosine_of(light.cosine)] += light.weight;
  tally.returned[experiment.bins.cosine_of(light.cosine)] += watcher.returned;
}

void check_slab(const HomogeneousMedium& medium, const Slab& slab, const SlabEntry& entry) {
  check_medium(medium);
  check_value(slab.thickness > 0, "thickness", "a number above 0", slab.thickness);
  check_value(entry.is_diffuse || (entry.cosine > 0 && entry.cosine <= 1), "cosine",
              "a number above 0 and at most 1", entry.cosine);
  check_value(entry.is_diffuse || fresnel_reflectance(entry.cosine, medium.eta) < 1, "cosine",
              "one at which light enters, above the critical angle's", entry.cosine);
}

double entered_share(const HomogeneousMedium& medium, const SlabEntry& entry) {
  if (medium.eta == 1) return 1;
  return entry.is_diffuse ? 1 - average_reflectance_outside(medium.eta)
                          : fresnel_transmittance(entry.cosine, medium.eta);
}

}  // namespace

void check_settings(const LaboratorySettings& settings) {
  check_value(settings.walks > 0, "walks", "a number above 0", double(settings.walks));
  check_value(settings.most_collisions > 0, "most_collisions", "a number above 0",
              double(settings.most_collisions));
  check_value(settings.cosine_bins >= 1 && settings.cosine_bins <= 10000, "cosine_bins",
              "a number from 1 to 10000", settings.cosine_bins);
  double before = 0;
  for (const double r : settings.radii) {
    check_value(r > before && std::isfinite(r), "radii", "finite numbers above 0, ascending", r);
    before = r;
  }
}

std::vector<double> default_radii(const HomogeneousMedium& medium) {
  const double length = medium.reduced_mean_free_path();
  std::vector<double> radii;
  if (!std::isfinite(length)) return {1};
  for (int i = -30; i <= 30; ++i) radii.push_back(length * std::pow(10, i / 10.0));
  return radii;
}

namespace {

template <class Follow>
SlabWalks run(const Experiment& experiment, const Follow& follow, Monitor* monitor) {
  std::vector<SlabTally> batches(kWalkBatches);
  const std::size_t walks_each = experiment.walks_each;
  parallel_chunks(kWalkBatches, 1, [&](std::size_t begin, std::size_t, std::size_t batch) {
    SlabTally tally = empty_tally(experiment.bins);
    for (std::size_t i = 0; i < walks_each; ++i) {
      walk_once(experiment, follow, batch, i, tally);
      if (i % 64 == 0) advance(monitor, std::min<std::size_t>(64, walks_each - i));
    }
    batches[begin] = std::move(tally);
  });
  SlabWalks result = summarize(experiment.bins, batches, walks_each);
  result.entered = experiment.entered;
  return result;
}

Experiment experiment_of(const HomogeneousMedium& surface, const SlabEntry& entry,
                         const LaboratorySettings& settings) {
  check_settings(settings);
  const std::vector<double>& radii = settings.radii;
  return {surface.eta,
          entry,
          entered_share(surface, entry),
          settings.seed,
          settings.most_collisions,
          walks_of_a_batch(settings),
          make_bins(radii.empty() ? default_radii(surface) : radii, std::size_t(settings.cosine_bins),
                    entry.is_diffuse),
          {}};
}

}  // namespace

SlabWalks walk_slab(const HomogeneousMedium& medium, const Slab& slab, const SlabEntry& entry,
                    const LaboratorySettings& settings) {
  check_slab(medium, slab, entry);
  Experiment experiment = experiment_of(medium, entry, settings);
  experiment.controls.emplace(medium, slab.thickness);
  const SlabBody body{slab.thickness};
  const auto follow = [&](WalkNumbers& numbers, WalkState& walk, SlabWatcher& watcher) {
    return random_walk(medium, body, experiment.most_collisions, numbers, walk, watcher);
  };
  return run(experiment, follow, settings.monitor);
}

SlabWalks walk_layers(std::span<const SlabLayer> layers, const SlabEntry& entry,
                      const LaboratorySettings& settings) {
  check_value(!layers.empty(), "layers", "at least one", 0);
  const HomogeneousMedium& surface = layers.front().medium;
  std::vector<SlabLayer> kept;
  for (const SlabLayer& layer : layers) {
    const bool is_last = &layer == &layers.back();
    check_value(layer.thickness >= 0 && (is_last || std::isfinite(layer.thickness)), "thickness",
                "a number of at least 0, infinite in the last layer only", layer.thickness);
    check_medium(layer.medium);
    if (layer.thickness > 0 || is_last) kept.push_back(layer);
  }
  check_slab(surface, {std::max(kept.back().thickness, kept.front().thickness)}, entry);
  const Experiment experiment = experiment_of(surface, entry, settings);
  const LayerStack stack(kept);
  const auto follow = [&](WalkNumbers& numbers, WalkState& walk, SlabWatcher& watcher) {
    return layered_walk(stack, surface.eta, experiment.most_collisions, numbers, walk, watcher);
  };
  return run(experiment, follow, settings.monitor);
}

}  // namespace opaline
