// SPDX-License-Identifier: GPL-3.0-or-later
// Probes: small images for estimating the error of a large one, from their differences.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "session/session_records.h"

namespace opaline {

/// The same view of the same part with at most this number of pixels, one point each.
Scene probe_scene(const Scene& scene, double most_pixels);

/// Renders a probe with the session's prepared samples, trees and surface caches.
/// in    noise: images with different values share no random number of a shadow ray
///       bounced: indirect light from any image of the same view (RenderInput::bounced)
/// out   opaque surfaces have no diffuse light
RenderResult probe_picture(const Session& session, Scene probe, std::uint64_t noise, Monitor* monitor,
                           std::shared_ptr<const BouncedPlaces> bounced = nullptr);

/// 1 for each pixel of a probe with a lit translucent surface.
std::vector<std::uint8_t> translucent_pixels(const Image& picture);

/// Mean relative difference of the diffuse light over b's translucent pixels, worst channel; 0 if there are
/// none.
double probe_difference(const Image& a, const Image& b);

/// Mean relative error of a, worst channel, from images with half and a quarter of its samples. The error is
/// a common pattern, decreasing by 2^p between images, plus independent noise, decreasing likewise. The means
/// of (a - b)^2 and (a - b)(b - c) separate the two, and |b - c| over |a - b| gives p.
double probe_error(const Image& a, const Image& b, const Image& c);

/// Order of the error in the number of samples, from the errors at half of them (`before`) and now; averaged
/// with the usual order, as two images are a weak estimate.
double error_slope(double before, double now);

}  // namespace opaline
