// SPDX-License-Identifier: GPL-3.0-or-later
// Error of an image against its cost, at several settings.
#pragma once

#include <cstddef>
#include <functional>
#include <optional>

#include "session/session_records.h"

namespace opaline {

/// A setting of the trade-off.
struct TradePoint {
  Method method = Method::hierarchical;  ///< or lambert, for which the next three are meaningless
  std::optional<double> sample_spacing;  ///< mm
  std::optional<std::size_t> samples;    ///< samples of a body, if the scene sets them instead of the spacing
  double tolerance = 0;
  std::size_t all_samples = 0;  ///< all samples of all groups
  bool is_given = false;        ///< measured with the scene's own settings, approximately the values above
  double seconds = 0;           ///< CPU of an image: samples, light, tree and shading, without loading
  double error = 0;             ///< as TargetError::predicted
};

/// Applies the point's settings.
void set_point(Settings& settings, const TradePoint& point);

/// Tries settings from a sixteenth of the scene's samples to four times as many, each with a matching
/// tolerance, and Method::lambert. Measures the cost of preparing; predicts the cost of shading from some
/// tiles. Estimates errors from a small image: by its own error layer, for lambert by the difference from the
/// image with most samples. All errors are against the converged diffusion of the scene, the limit of
/// Method::direct, and exclude the model error.
/// in    scene: any method; the trade-off is of `hierarchical`. session: is edited; without a cache
/// out   tried: called with each point, in order of samples, lambert last; never if no translucent shape is
///       visible
/// error as Session::edit and Session::prepare
void try_trade(Session& session, Scene scene, const std::function<void(const TradePoint&)>& tried,
               Monitor* monitor = nullptr);

}  // namespace opaline
