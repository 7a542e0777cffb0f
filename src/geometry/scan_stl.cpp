// SPDX-License-Identifier: GPL-3.0-or-later
// STL, text and binary. OpenMesh numbers the vertices (it welds equal positions) and leaves out triangles
// with two equal corners; a truncated binary file it takes for an empty text file.
#include <algorithm>
#include <cctype>
#include <cstring>

#include "mesh_scan.h"
#include "text_cursor.h"

namespace opaline {
namespace {

constexpr std::size_t binary_header = 84, binary_triangle = 50;

float little_endian_float(const char* bytes) {
  std::uint32_t bits = 0;
  for (int i = 3; i >= 0; --i) bits = bits << 8 | std::uint8_t(bytes[i]);
  float value;
  std::memcpy(&value, &bits, sizeof value);
  return value;
}

std::size_t claimed_triangles(const std::string& bytes) {
  std::size_t count = 0;
  for (int i = 3; i >= 0; --i) count = count << 8 | std::uint8_t(bytes[80 + std::size_t(i)]);
  return count;
}

MeshScan scan_binary(const std::string& path, const std::string& bytes) {
  if (bytes.size() < binary_header)
    throw bad_file(path, "truncated STL file", "a header of 84 bytes",
                   std::to_string(bytes.size()) + " bytes");
  MeshScan scan;
  scan.binary = true;
  scan.triangles = claimed_triangles(bytes);
  const std::size_t needed = binary_header + scan.triangles * binary_triangle;
  if (bytes.size() < needed)
    throw bad_file(path, "truncated STL file, or not an STL file",
                   std::to_string(scan.triangles) + " triangles: " + std::to_string(needed) + " bytes",
                   std::to_string(bytes.size()));
  if (bytes.size() > needed)
    scan.warnings.push_back(path + ": " + std::to_string(bytes.size() - needed) +
                            " bytes after the last triangle are left out");
  require_faces(path, scan.triangles * 3, scan.triangles);
  VertexCheck check;
  for (std::size_t t = 0; t < scan.triangles; ++t) {
    for (std::size_t corner = 0; corner < 3; ++corner) {
      const char* at = bytes.data() + binary_header + t * binary_triangle + 12 * (corner + 1);
      check.check(
          Vec3d(Vec3f(little_endian_float(at), little_endian_float(at + 4), little_endian_float(at + 8))),
          3 * t + corner, 0);
    }
  }
  check.throw_if_any(path);
  return scan;
}

std::string lower(std::string_view word) {
  std::string text(word);
  for (char& c : text) c = char(std::tolower(static_cast<unsigned char>(c)));
  return text;
}

class TextStlScanner {
 public:
  TextStlScanner(const std::string& path, std::string& bytes) : path_(path), bytes_(bytes), at_(bytes) {}

  MeshScan run() {
    for (; !at_.at_end(); at_.next_line()) statement();
    if (!ended_) throw bad_line(path_, at_.line() - 1, "truncated STL file", "endsolid", "end of file");
    require_faces(path_, 3 * scan_.triangles, scan_.triangles);
    check_.throw_if_any(path_);
    return std::move(scan_);
  }

 private:
  void statement() {
    const std::string_view word = at_.word();
    if (word.empty()) return;
    const std::string keyword = lower(word);
    if (keyword == "outer") return loop(word);
    if (keyword == "solid") ended_ = false;
    if (keyword == "endsolid") ended_ = true;
    const bool hidden = keyword == "solid" || keyword == "endsolid" || keyword == "facet";
    if (!hidden && keyword != "endloop" && keyword != "endfacet")
      throw bad_line(path_, at_.line(), "unknown statement in an STL file",
                     "facet, outer loop, vertex, endloop, endfacet or endsolid", quoted(word));
    if (hidden) blank_line(word);  // names may hold words that OpenMesh takes for the start of a triangle
  }

  void blank_line(std::string_view from) {
    std::fill(bytes_.begin() + std::ptrdiff_t(at_.offset() - from.size()),
              bytes_.begin() + std::ptrdiff_t(at_.line_end()), ' ');
  }

  void loop(std::string_view word) {
    std::memcpy(bytes_.data() + at_.offset() - word.size(), "outer", 5);
    for (std::size_t corner = 0; corner < 3; ++corner) {
      at_.next_line();
      Vec3d position;
      const std::string_view keyword = at_.word();
      bool good = lower(keyword) == "vertex";
      for (std::size_t i = 0; i < 3 && good; ++i) good = parse_number(at_.word(), position[i]);
      if (!good)
        throw bad_line(path_, at_.line(), "bad corner of a triangle", "vertex and three numbers",
                       at_.at_end() && keyword.empty() ? "end of file" : quoted(keyword));
      check_.check(position, 3 * scan_.triangles + corner, at_.line());
    }
    ++scan_.triangles;
  }

  const std::string& path_;
  std::string& bytes_;
  TextCursor at_;
  MeshScan scan_;
  VertexCheck check_;
  bool ended_ = false;
};

}  // namespace

MeshScan scan_stl(const std::string& path, std::string& bytes) {
  const bool exact = bytes.size() >= binary_header &&
                     bytes.size() == binary_header + claimed_triangles(bytes) * binary_triangle;
  const bool text = lower(TextCursor(bytes).word_across_lines()) == "solid" && bytes.find('\0') == bytes.npos;
  return exact || !text ? scan_binary(path, bytes) : TextStlScanner(path, bytes).run();
}

}  // namespace opaline
