// SPDX-License-Identifier: GPL-3.0-or-later
// How a text file is encoded, by its first bytes.
#pragma once

#include <string>

namespace opaline {

/// Takes the byte order mark of UTF-8 off a file's text.
/// error Error{bad_input} naming the file: UTF-16
void drop_byte_order_mark(const std::string& path, std::string& text);

/// Ends the lines of a text that has carriage returns alone, as on the first Macintoshes, with line feeds.
void end_lines_with_line_feeds(std::string& text);

}  // namespace opaline
