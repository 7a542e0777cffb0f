// SPDX-License-Identifier: GPL-3.0-or-later
// Random walks from a point source in an infinite medium: the reference of its closed forms.
#pragma once

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/parallel.h"
#include "transport/control_regression.h"
#include "transport/laboratory_checks.h"
#include "transport/point_source.h"
#include "transport/random_walk.h"
#include "transport/slab_tally.h"

namespace opaline::test {

struct NoBoundary {
  BoundaryAhead ahead(const Vec3d&, const Vec3d&) const { return {}; }
};

/// Every flight but the first starts at a collision: weight there is collided weight.
struct ShellWatcher {
  const TallyBins& bins;
  std::vector<double>& collided;
  double albedo;

  void visit(const WalkState& walk, const BoundaryAhead&, const Crossing&) {
    if (walk.collisions == 0) return;
    collided[bins.ring_of(dot(walk.position, walk.position))] += walk.weight / albedo;
  }
  void leave(const WalkExit&) {}
};

/// Mean fluence in a spherical shell.
struct WalkedShell {
  double low = 0, high = 0;  ///< mm
  WalkedValue fluence;       ///< 1/mm^2
};

/// Shells between the radii, the first from 0 on; any g. The same bits for any number of threads.
/// in    sigma_a and sigma_s > 0; settings.radii: ascending, mm, at least one; cosine_bins is not used
/// error Error{bad_input} naming what is out of range; Error{interrupted}
inline std::vector<WalkedShell> walk_point_source(const HomogeneousMedium& medium,
                                                  const LaboratorySettings& settings) {
  check_medium(medium);
  check_value(medium.sigma_s > 0, "sigma_s", "a number above 0", medium.sigma_s);
  check_value(medium.sigma_a > 0, "sigma_a", "a number above 0: else walks do not end", medium.sigma_a);
  check_settings(settings);
  check_value(!settings.radii.empty(), "radii", "at least one", 0);
  const TallyBins bins = make_bins(settings.radii, 1, false);
  const std::size_t walks_each = walks_of_a_batch(settings);
  std::vector<std::vector<double>> batches(kWalkBatches, std::vector<double>(bins.radii.size() + 1));
  parallel_chunks(kWalkBatches, 1, [&](std::size_t begin, std::size_t, std::size_t batch) {
    ShellWatcher watcher{bins, batches[begin], medium.albedo()};
    for (std::size_t i = 0; i < walks_each; ++i) {
      WalkNumbers numbers(settings.seed, batch * walks_each + i);
      const double cosine = 2 * numbers.next() - 1;
      WalkState walk{{}, deflected({0, 0, 1}, cosine, numbers.next_angle())};
      random_walk(medium, NoBoundary{}, settings.most_collisions, numbers, walk, watcher);
    }
    advance(settings.monitor, walks_each);
  });
  std::vector<WalkedShell> shells;
  for (std::size_t s = 0; s < bins.radii.size(); ++s) {
    const double low = s == 0 ? 0 : bins.radii[s - 1], high = bins.radii[s];
    const double volume = 4 * std::numbers::pi / 3 * (std::pow(high, 3) - std::pow(low, 3));
    std::vector<double> values;
    for (const auto& batch : batches)
      values.push_back(batch[s] / double(walks_each) / (volume * medium.sigma_t()));
    shells.push_back(WalkedShell{low, high, batch_mean(values)});
  }
  return shells;
}

}  // namespace opaline::test
