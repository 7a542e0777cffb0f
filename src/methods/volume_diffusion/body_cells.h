// SPDX-License-Identifier: GPL-3.0-or-later
// Cells of the diffusion equation inside a body.
#pragma once

#include <span>

#include "bodies/body.h"
#include "volume/volume_diffusion.h"

namespace opaline {

/// Cells with the media of the body.
/// in    body: with the samples of its cut surface; normals: of that
VolumeDiffusion body_cells(const PrecomputeInput& input, const Body& body, std::span<const Vec3f> normals);

}  // namespace opaline
