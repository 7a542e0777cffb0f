// SPDX-License-Identifier: GPL-3.0-or-later
#include "methods/volume/fit_cells.h"

namespace opaline {

std::shared_ptr<const CellFit> fit_cells(BodyStages& stages, ReusedWeights& weights,
                                         std::span<const RgbF> means, std::span<const RgbF> errors) {
  const std::vector<SurfaceSample>& samples = stages.body.surface.samples;
  if (!stages.expects_edits) return std::make_shared<const CellFit>(samples, means, errors);
  stages.store.get(weights, stages.keys.samples_key,
                   [&] { return std::make_shared<const CellWeights>(samples); });
  return std::make_shared<const CellFit>(*weights.value, means, errors);
}

std::vector<RgbF> fit_at(const CellFit& fit, std::span<const Query> points) {
  std::vector<RgbF> values;
  for (const Query& point : points) values.push_back(fit.at(point.position, point.normal).value);
  return values;
}

}  // namespace opaline
