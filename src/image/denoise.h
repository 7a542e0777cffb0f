// SPDX-License-Identifier: GPL-3.0-or-later
// Removes noise from an image with Open Image Denoise, if its library is installed.
#pragma once

#include <cstdint>
#include <span>
#include <string>

#include "opaline/image.h"
#include "opaline/monitor.h"

namespace opaline {

/// Replaces the layers `diffuse` and `specular` by filtered ones, with `albedo` and `N` as guides, and changes
/// R, G and B by as much. Light emitted towards the camera stays. The diffuse light of a pixel with a known
/// error changes by at most twice that: the layer `error`, or the root of `variance`.
/// in    has_error: per pixel, as RenderResult::translucent
/// error Error{run_failed}: the library is missing, or fails; Error{interrupted}
void denoise(Image& image, std::span<const std::uint8_t> has_error, Monitor* monitor);

/// Its name and version.
/// error as denoise
std::string denoiser_name();

}  // namespace opaline
