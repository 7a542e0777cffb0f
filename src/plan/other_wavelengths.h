// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>

#include "opaline/scene.h"

namespace opaline {

/// A scene's other wavelengths with its camera, film and settings.
/// in    index: of Scene::other_wavelengths
Scene at_other_wavelengths(const Scene& scene, std::size_t index);

}  // namespace opaline
