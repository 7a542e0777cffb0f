// SPDX-License-Identifier: GPL-3.0-or-later
// The page itself, from the folder page/ when the build is configured.
#pragma once

#include <span>

namespace opaline {

struct PageFile {
  const char *path, *type, *text;  ///< path: behind the token
};

std::span<const PageFile> page_files();

}  // namespace opaline
