// SPDX-License-Identifier: GPL-3.0-or-later
// The module that has OpenImageIO (picture_reader.h), loaded where it is first asked for.
#pragma once

namespace opaline {

/// A function of the module.
/// error Error{run_failed}: the module is not there
void* picture_module_function(const char* name);

/// True if it was loaded.
bool picture_module_is_loaded();

}  // namespace opaline
