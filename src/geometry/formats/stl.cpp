// SPDX-License-Identifier: GPL-3.0-or-later
// STL, text and binary: triangles without shared vertices. Reads coordinates as float; corners at the same
// position become one vertex, with smooth normals except across creases, as the format's parts often have
// sharp edges.
#include <algorithm>
#include <array>
#include <bit>
#include <utility>

#include "core/byte_order_mark.h"
#include "core/lower_case.h"
#include "geometry/formats/file_checks.h"
#include "geometry/formats/mesh_format.h"
#include "geometry/formats/text_cursor.h"
#include "geometry/topology.h"

namespace opaline {
namespace {

constexpr std::size_t binary_header = 84, binary_triangle = 50;
constexpr double kCreaseAngle = 30;  // degrees

std::uint32_t little_endian(const char* bytes) {
  std::uint32_t bits = 0;
  for (int i = 3; i >= 0; --i) bits = bits << 8 | std::uint8_t(bytes[i]);
  return bits;
}

std::size_t claimed_triangles(std::string_view header) {
  return little_endian(header.data() + 80);
}

std::size_t binary_size(std::string_view header) {
  return binary_header + claimed_triangles(header) * binary_triangle;
}

Vec3f binary_position(const char* bytes) {
  Vec3f position;
  for (std::size_t i = 0; i < 3; ++i) position[i] = std::bit_cast<float>(little_endian(bytes + 4 * i));
  return position;
}

/// Makes a mesh of corners, three a triangle; triangles with two equal corners are left out.
SourceMesh join_corners(const std::vector<Vec3f>& corners) {
  SourceMesh mesh;
  std::vector<std::uint32_t> vertex = weld(corners);  // per corner; first the earliest equal corner
  for (std::size_t corner = 0; corner < corners.size(); ++corner) {
    if (vertex[corner] == corner) {
      vertex[corner] = std::uint32_t(mesh.positions.size());
      mesh.positions.push_back(Vec3d(corners[corner]));
    } else {
      vertex[corner] = vertex[vertex[corner]];
    }
  }
  mesh.triangles.reserve(corners.size() / 3);
  for (std::size_t corner = 0; corner < corners.size(); corner += 3) {
    const Triangle triangle{vertex[corner], vertex[corner + 1], vertex[corner + 2]};
    const auto& [a, b, c] = triangle;
    if (a == b || b == c || c == a)
      ++mesh.collapsed;
    else
      mesh.triangles.push_back(triangle);
  }
  return mesh;
}

std::vector<Vec3f> read_binary(const std::string& path, const std::string& bytes) {
  if (bytes.size() < binary_header)
    throw bad_file(path, "truncated STL file, or not an STL file", "a header of 84 bytes",
                   std::to_string(bytes.size()) + " bytes");
  const std::size_t triangles = claimed_triangles(bytes);
  const std::size_t needed = binary_size(bytes);
  if (bytes.size() < needed)
    throw bad_file(path, "truncated STL file, or not an STL file",
                   std::to_string(triangles) + " triangles: " + std::to_string(needed) + " bytes",
                   std::to_string(bytes.size()));
  require_faces(path, triangles * 3, triangles);
  VertexCheck check;
  std::vector<Vec3f> corners(triangles * 3);
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const std::size_t at = binary_header + i / 3 * binary_triangle + 12 * (i % 3 + 1);
    corners[i] = binary_position(bytes.data() + at);
    check.check(Vec3d(corners[i]), i, 0);
  }
  check.throw_if_any(path);
  return corners;
}

/// Keywords besides the loops around the corners; the rest of their line is ignored.
constexpr std::array<std::string_view, 5> line_keywords{"solid", "endsolid", "facet", "endloop", "endfacet"};

class TextStlReader {
 public:
  TextStlReader(const std::string& path, const std::string& bytes) : path_(path), at_(bytes) {}

  std::vector<Vec3f> run() {
    for (; !at_.at_end(); at_.next_line()) statement();
    if (!ended_) throw bad_line(path_, at_.line() - 1, "truncated STL file", "endsolid", "end of file");
    require_faces(path_, corners_.size(), corners_.size() / 3);
    check_.throw_if_any(path_);
    return std::move(corners_);
  }

 private:
  void statement() {
    const std::string_view word = at_.word();
    if (word.empty()) return;
    const std::string keyword = in_lower_case(word);
    if (keyword == "outer") return loop();
    if (keyword == "solid") ended_ = false;
    if (keyword == "endsolid") ended_ = true;
    if (std::ranges::find(line_keywords, keyword) == line_keywords.end())
      throw bad_line(path_, at_.line(), "unknown statement in an STL file",
                     "facet, outer loop, vertex, endloop, endfacet or endsolid", quoted_word(word));
  }

  void loop() {
    for (int corner = 0; corner < 3; ++corner) {
      at_.next_line();
      Vec3d position;
      const std::string_view keyword = at_.word();
      bool good = in_lower_case(keyword) == "vertex";
      for (std::size_t i = 0; i < 3 && good; ++i) good = parse_number(at_.word(), position[i]);
      if (!good)
        throw bad_line(path_, at_.line(), "bad corner of a triangle", "vertex and three numbers",
                       at_.at_end() && keyword.empty() ? "end of file" : quoted_word(keyword));
      check_.check(position, corners_.size(), at_.line());
      corners_.push_back(Vec3f(position));
    }
  }

  const std::string& path_;
  TextCursor at_;
  std::vector<Vec3f> corners_;
  VertexCheck check_;
  bool ended_ = false;
};

SourceMesh read_stl(const std::string& path, std::string& bytes, MeshUvs) {
  const bool exact = bytes.size() >= binary_header && bytes.size() == binary_size(bytes);
  if (!exact) drop_byte_order_mark(path, bytes);
  const bool text =
      in_lower_case(TextCursor(bytes).word_across_lines()) == "solid" && bytes.find('\0') == bytes.npos;
  const bool binary = exact || !text;
  const std::vector<Vec3f> corners = binary ? read_binary(path, bytes) : TextStlReader(path, bytes).run();
  const std::size_t surplus = binary ? bytes.size() - binary_size(bytes) : 0;
  std::string().swap(bytes);  // frees memory for join_corners
  SourceMesh mesh = join_corners(corners);
  mesh.smoothing.crease_angle = kCreaseAngle;
  if (surplus > 0)
    mesh.warnings.push_back(path + ": " + std::to_string(surplus) +
                            " bytes after the last triangle are ignored");
  return mesh;
}

/// Announced length of a binary file.
std::uintmax_t announced_length(std::string_view start) {
  if (start.size() < binary_header) return 0;
  const std::string_view text = start.substr(0, binary_header);
  if (text.starts_with("solid") && text.find('\0') == text.npos) return 0;
  return binary_size(text);
}

}  // namespace

constinit const MeshFormat stl_format{.read = read_stl, .announced_length = announced_length};

}  // namespace opaline
