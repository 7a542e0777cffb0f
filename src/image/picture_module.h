// SPDX-License-Identifier: GPL-3.0-or-later
// The reader module with OpenImageIO (picture_reader.h), loaded on first use.
#pragma once

namespace opaline {

/// A function of the module.
/// error Error{run_failed}: the module is missing
void* picture_module_function(const char* name);

/// True if it was loaded.
bool picture_module_is_loaded();

}  // namespace opaline
