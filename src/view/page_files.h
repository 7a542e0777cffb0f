// SPDX-License-Identifier: GPL-3.0-or-later
// Files of the page, embedded from the folder page/ at configuration.
#pragma once

#include <span>
#include <string_view>

namespace opaline {

struct PageFile {
  const char *path, *type;  ///< path: behind the token
  std::string_view bytes;
};

std::span<const PageFile> page_files();

}  // namespace opaline
