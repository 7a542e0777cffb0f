// SPDX-License-Identifier: GPL-3.0-or-later
// Samples of bodies as a point cloud.
#pragma once

#include <span>
#include <string>

#include "bodies/body.h"

namespace opaline {

/// Writes all samples as a binary PLY: x y z, nx ny nz, area, irradiance r g b, shape; world space, mm.
/// error Error{run_failed} naming the file
void write_samples_ply(const std::string& path, std::span<const Body> groups, const World& world);

}  // namespace opaline
