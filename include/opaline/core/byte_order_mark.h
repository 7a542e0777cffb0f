// SPDX-License-Identifier: GPL-3.0-or-later
// How a text file is encoded, by its first bytes.
#pragma once

#include <string>

namespace opaline {

/// Takes the byte order mark of UTF-8 off a file's text.
/// error Error{bad_input} naming the file: UTF-16
void drop_byte_order_mark(const std::string& path, std::string& text);

}  // namespace opaline
