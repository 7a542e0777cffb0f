// SPDX-License-Identifier: GPL-3.0-or-later
// Encoding of a text file, by its first bytes.
#pragma once

#include <string>

namespace opaline {

/// Removes the UTF-8 byte order mark of a file's text.
/// error Error{bad_input} naming the file: UTF-16
void drop_byte_order_mark(const std::string& path, std::string& text);

/// Replaces carriage returns by line feeds in a text without line feeds, as from classic Mac OS.
void end_lines_with_line_feeds(std::string& text);

}  // namespace opaline
