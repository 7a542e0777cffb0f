// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/formats/ply_header.h"

#include <array>
#include <string_view>

#include "geometry/formats/file_checks.h"
#include "geometry/formats/text_cursor.h"

namespace opaline {
namespace {

struct TypeName {
  std::string_view short_name, long_name;
  std::size_t size;
};

constexpr std::array<TypeName, 8> types{{{"char", "int8", 1},
                                         {"uchar", "uint8", 1},
                                         {"short", "int16", 2},
                                         {"ushort", "uint16", 2},
                                         {"int", "int32", 4},
                                         {"uint", "uint32", 4},
                                         {"float", "float32", 4},
                                         {"double", "float64", 8}}};

class HeaderReader {
 public:
  HeaderReader(const std::string& path, const std::string& bytes) : path_(path), at_(bytes) {}

  PlyHeader run() {
    const std::string_view magic = at_.word();
    if (magic != "ply" && magic != "PLY")
      throw bad_line(path_, 1, "this is not a PLY file", "ply", quoted_word(magic));
    do {
      at_.next_line();
      if (at_.at_end())
        throw bad_line(path_, at_.line(), "truncated PLY header", "end_header", "end of file");
    } while (statement());
    at_.next_line();
    if (!has_format_) throw bad_file(path_, "the PLY header has no format line");
    header_.size = at_.offset();
    header_.lines = at_.line() - 1;
    return header_;
  }

 private:
  bool statement() {
    const std::string_view keyword = at_.word();
    if (keyword == "end_header") return false;
    if (keyword == "format") {
      format();
    } else if (keyword == "element") {
      element();
    } else if (keyword == "property") {
      property();
    } else if (keyword == "comment") {
      if (at_.word() == "TextureFile" && header_.texture.empty()) header_.texture = at_.rest_of_line();
    } else if (!keyword.empty() && keyword != "obj_info") {
      throw bad_line(path_, at_.line(), "unknown statement in a PLY header",
                     "format, element, property, comment or end_header", quoted_word(keyword));
    }
    return true;
  }

  void format() {
    const std::string_view word = at_.word();
    if (word != "ascii" && word != "binary_little_endian" && word != "binary_big_endian")
      throw bad_line(path_, at_.line(), "unknown PLY format",
                     "ascii, binary_little_endian or binary_big_endian", quoted_word(word));
    header_.encoding = word == "ascii"                  ? PlyEncoding::ascii
                       : word == "binary_little_endian" ? PlyEncoding::little_endian
                                                        : PlyEncoding::big_endian;
    has_format_ = true;
  }

  void element() {
    PlyElement element;
    element.name = at_.word();
    const std::string_view word = at_.word();
    std::int64_t count = 0;
    if (element.name.empty() || !parse_integer(word, count) || count < 0)
      throw bad_line(path_, at_.line(), "bad element in a PLY header", "a name and a count >= 0",
                     quoted_word(word));
    element.count = std::uint64_t(count);
    header_.elements.push_back(element);
  }

  PlyScalar type(std::string_view word) const {
    for (std::size_t i = 0; i < types.size(); ++i)
      if (word == types[i].short_name || word == types[i].long_name) return PlyScalar(i);
    throw bad_line(path_, at_.line(), "unknown type in a PLY header",
                   "char, uchar, short, ushort, int, uint, float or double", quoted_word(word));
  }

  void property() {
    if (header_.elements.empty())
      throw bad_line(path_, at_.line(), "a property before the first element of a PLY header");
    PlyProperty property;
    std::string_view word = at_.word();
    if (word == "list") {
      property.is_list = true;
      property.count_type = type(at_.word());
      if (is_floating(property.count_type))
        throw bad_line(path_, at_.line(), "the length of a PLY list is not an integer");
      word = at_.word();
    }
    property.type = type(word);
    property.name = at_.word();
    if (property.name.empty()) throw bad_line(path_, at_.line(), "a PLY property without a name");
    header_.elements.back().properties.push_back(property);
  }

  const std::string& path_;
  TextCursor at_;
  PlyHeader header_;
  bool has_format_ = false;
};

}  // namespace

std::size_t byte_size(PlyScalar type) {
  return types[std::size_t(type)].size;
}

PlyHeader read_ply_header(const std::string& path, const std::string& bytes) {
  return HeaderReader(path, bytes).run();
}

}  // namespace opaline
