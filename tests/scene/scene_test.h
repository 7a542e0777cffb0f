// SPDX-License-Identifier: GPL-3.0-or-later
// What the scene tests share: a scene that is right, and a look at the error of one that is not.
#pragma once

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "input/load_scene.h"
#include "opaline/error.h"

namespace opaline {

inline Scene parse(const std::string& text, const std::vector<std::string>& overrides = {}) {
  return parse_scene(text, "test.json", overrides);
}

/// The error that parsing ends in; a test failure if there is none.
inline Error error_of(const std::string& text, const std::vector<std::string>& overrides = {}) {
  try {
    parse(text, overrides);
  } catch (const Error& error) {
    EXPECT_EQ(error.kind, ErrorKind::bad_input) << error.what();
    return error;
  }
  ADD_FAILURE() << "no error for: " << text.substr(0, 200);
  return bad_file("", "");
}

inline void expect_fragments(const Error& error, const std::vector<std::string>& fragments) {
  for (const std::string& fragment : fragments)
    EXPECT_NE(std::string(error.what()).find(fragment), std::string::npos)
        << "no \"" << fragment << "\" in \"" << error.what() << '"';
}

/// A scene whose only medium m is this object.
inline std::string with_medium(const std::string& medium) {
  return R"({"media": {"m": )" + medium + "}}";
}
/// A scene with media m and n and these shapes.
inline std::string with_shapes(const std::string& shapes) {
  return R"({"media": {"m": {"preset": "marble"}, "n": {"preset": "skin1"}}, "shapes": [)" + shapes + "]}";
}
inline std::string with_light(const std::string& light) {
  return R"({"lights": [)" + light + "]}";
}

/// A text with a '@' where the error is to be reported, and what the message must contain.
struct MarkedCase {
  std::string text;
  std::vector<std::string> fragments;
};

inline void expect_errors(const std::vector<MarkedCase>& cases) {
  for (const MarkedCase& c : cases) {
    SCOPED_TRACE(c.text.substr(0, 200));
    const std::size_t mark = c.text.find('@');
    ASSERT_NE(mark, std::string::npos);
    int line = 1, column = 1;
    for (std::size_t i = 0; i < mark; ++i) {
      line += c.text[i] == '\n';
      column = c.text[i] == '\n' ? 1 : column + 1;
    }
    const Error error = error_of(c.text.substr(0, mark) + c.text.substr(mark + 1));
    EXPECT_EQ(error.file, "test.json");
    EXPECT_EQ(error.line, line) << error.what();
    EXPECT_EQ(error.column, column) << error.what();
    expect_fragments(error, c.fragments);
  }
}

}  // namespace opaline
