// SPDX-License-Identifier: GPL-3.0-or-later
// A small picture in place of a large one: what two of them differ by is how far off their exitance is.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "session/session_records.h"

namespace opaline {

/// The same view of the same part with at most that many pixels, one point each.
Scene probe_scene(const Scene& scene, double most_pixels);

/// The probe seen with the samples, trees and surface caches that the session has prepared.
/// in    noise: pictures of different ones share no random number of a shadow ray
///       bounced: light between things, of any picture of the same view (RenderInput::bounced)
/// out   opaque surfaces have no diffuse light
RenderResult probe_picture(const Session& session, Scene probe, std::uint64_t noise, Monitor* monitor,
                           std::shared_ptr<const BouncedPlaces> bounced = nullptr);

/// 1 for each pixel of a probe's picture that shows lit translucent surface.
std::vector<std::uint8_t> translucent_pixels(const Image& picture);

/// Mean relative difference of the diffuse light over b's translucent pixels, worst channel; 0 without such.
double probe_difference(const Image& a, const Image& b);

/// Mean relative error of a, worst channel, told from pictures with half and a quarter of its samples. A
/// picture is off by a pattern that all share and that shrinks by 2^p from one to the next, and by noise of
/// its own that does too: then the means of (a - b)^2 and (a - b)(b - c) tell the two apart, and |b - c| over
/// |a - b| tells p.
double probe_error(const Image& a, const Image& b, const Image& c);

/// The power of the number of samples with which an error falls that was `before` at half of them: what two
/// pictures say of it is half believed.
double error_slope(double before, double now);

}  // namespace opaline
