// SPDX-License-Identifier: GPL-3.0-or-later
// Errors found after reading a scene, with the position of their record.
#pragma once

#include <string>

#include "opaline/error.h"
#include "opaline/scene.h"

namespace opaline {

/// "scene.json:3:12: text"; the text alone without a position.
std::string text_at(const SourcePlace& place, const std::string& text);

/// Error at the position of its record, with its own file, such as a mesh, in the message. Unchanged without
/// a position.
Error told_at(const SourcePlace& place, const Error& failure);

}  // namespace opaline
