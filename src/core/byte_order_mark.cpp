// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/byte_order_mark.h"

#include <algorithm>

#include "opaline/error.h"

namespace opaline {

void drop_byte_order_mark(const std::string& path, std::string& text) {
  constexpr std::string_view mark = "\xef\xbb\xbf";
  if (text.starts_with(mark)) text.erase(0, mark.size());
  if (text.starts_with("\xff\xfe") || text.starts_with("\xfe\xff"))
    throw bad_file(path, "is UTF-16", "text in UTF-8");
}

void end_lines_with_line_feeds(std::string& text) {
  if (text.find('\n') == text.npos) std::ranges::replace(text, '\r', '\n');
}

}  // namespace opaline
