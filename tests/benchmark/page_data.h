// SPDX-License-Identifier: GPL-3.0-or-later
// Data of a report's page.
#pragma once

#include <string>

#include "core/log.h"

namespace opaline {

/// The JSON in the page; throws where there is none.
inline Json page_data(const std::string& page) {
  const std::string mark = "<script id=\"data\" type=\"application/json\">";
  const std::size_t begin = page.find(mark) + mark.size();
  return Json::parse(page.substr(begin, page.find("</script>", begin) - begin));
}

/// The page without the scripts and their library, which name addresses in comments.
inline std::string page_without_scripts(const std::string& page) {
  return page.substr(0, page.find("<script>\n"));
}

}  // namespace opaline
