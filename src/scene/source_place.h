// SPDX-License-Identifier: GPL-3.0-or-later
// Failures that show only after the scene was read, at the place of their record.
#pragma once

#include <string>

#include "opaline/error.h"
#include "opaline/scene.h"

namespace opaline {

/// "scene.json:3:12: text"; the text alone where the place is empty.
std::string text_at(const SourcePlace& place, const std::string& text);

/// The failure, said at the place of the record that it came from; a file it names, such as a mesh, goes into
/// the message. The same failure where the place is empty.
Error told_at(const SourcePlace& place, const Error& failure);

}  // namespace opaline
