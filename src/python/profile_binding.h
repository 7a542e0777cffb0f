// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <nanobind/nanobind.h>

namespace opaline {

/// Adds `profile`, the laboratory of `opaline profile`.
void add_profile(nanobind::module_& module);

}  // namespace opaline
