// SPDX-License-Identifier: GPL-3.0-or-later
// A small picture in place of a large one: what two of them differ by is how far off their exitance is.
#pragma once

#include <cstdint>
#include <vector>

#include "opaline/session/session.h"

namespace opaline {

/// The same view of the same part with at most that many pixels, one point each; opaque surfaces are black.
Scene probe_scene(const Scene& scene, double most_pixels);

/// The probe seen with the samples, trees and surface caches that the session has prepared.
/// in    noise: pictures of different ones share no random number of a shadow ray
Image probe_picture(const Session& session, Scene probe, std::uint64_t noise, Monitor* monitor);

/// 1 for each pixel of a probe's picture that shows lit translucent surface.
std::vector<std::uint8_t> translucent_pixels(const Image& picture);

/// Mean relative difference of the diffuse light over b's translucent pixels, worst channel; 0 without such.
double probe_difference(const Image& a, const Image& b);

/// Mean relative error of a, worst channel, from how it differs from two pictures that are worse: the mean of
/// (a - b)(a - c) is a's squared error where errors are independent. Where they all fall from one to the next
/// but keep their pattern it is 1.2 times as much, if fourfold samples make a third of them.
/// out   between half and 1.4 times the difference of a and b
double probe_error(const Image& a, const Image& b, const Image& c);

}  // namespace opaline
