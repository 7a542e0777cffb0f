// SPDX-License-Identifier: GPL-3.0-or-later
// Error of an image against its cost, at several settings.
#pragma once

#include <cstddef>
#include <functional>
#include <optional>

#include "session/session_records.h"

namespace opaline {

/// A setting of the trade.
struct TradePoint {
  Method method = Method::hierarchical;  ///< or lambert, to which the next three mean nothing
  std::optional<double> sample_spacing;  ///< mm
  std::optional<std::size_t> samples;    ///< samples of a body, if the scene sets them instead of the spacing
  double tolerance = 0;
  std::size_t all_samples = 0;  ///< all samples of all groups
  bool is_given = false;  ///< measured with the scene's own settings, which the values above come close to
  double seconds = 0;     ///< CPU of a picture: samples, light, tree and shading, not loading
  double error = 0;       ///< as TargetError::predicted
};

/// Makes them those of the point.
void set_point(Settings& settings, const TradePoint& point);

/// Tries settings from a sixteenth of the scene's samples to four times as many, each with the tolerance that fits its
/// error, and Method::lambert. What a picture has to be prepared from is made and timed; its shading is foreseen from
/// some of its tiles, and its error from a small picture: of samples by the picture's own estimate, of lambert by the
/// difference from the picture with most samples. All errors are against the converged diffusion of the scene, which
/// Method::direct tends to; the error of the diffusion model is not in them.
/// in    scene: any method; the trade is of `hierarchical`. session: edits it, without a cache
/// out   tried: called with each point, in order of samples, lambert last; never where nothing translucent is seen
/// error as Session::edit and Session::prepare
void try_trade(Session& session, Scene scene, const std::function<void(const TradePoint&)>& tried,
               Monitor* monitor = nullptr);

}  // namespace opaline
