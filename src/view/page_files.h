// SPDX-License-Identifier: GPL-3.0-or-later
// Files of the page, embedded from the folder page/ at configuration.
#pragma once

#include <span>

namespace opaline {

struct PageFile {
  const char *path, *type, *text;  ///< path: behind the token
};

std::span<const PageFile> page_files();

}  // namespace opaline
