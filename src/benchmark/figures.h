// SPDX-License-Identifier: GPL-3.0-or-later
// Numbers as the reports print them.
#pragma once

#include <string>

namespace opaline {

/// Three digits, and no more zeros than it takes: 0.0012, 0.0123, 1.23, 123, 12345.
std::string figure(double value);

}  // namespace opaline
