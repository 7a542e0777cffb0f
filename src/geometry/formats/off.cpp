// SPDX-License-Identifier: GPL-3.0-or-later
// Object File Format, text: [ST][C][N]OFF. Ignores texture coordinates, and anything after a vertex or a
// face's colour on the same line.
#include <algorithm>
#include <optional>

#include "core/byte_order_mark.h"
#include "geometry/formats/file_checks.h"
#include "geometry/formats/mesh_format.h"
#include "geometry/formats/text_cursor.h"
#include "geometry/formats/vertex_colors.h"

namespace opaline {
namespace {

class OffReader {
 public:
  OffReader(const std::string& path, std::string& bytes) : path_(path), bytes_(bytes), at_(bytes) {}

  SourceMesh run() {
    drop_byte_order_mark(path_, bytes_);
    at_ = TextCursor(bytes_);
    blank_comments();
    header();
    counts();
    for (std::int64_t i = 0; i < vertices_; ++i) vertex();
    for (std::int64_t i = 0; i < faces_; ++i) face();
    require_faces(path_, std::size_t(vertices_), std::size_t(faces_));
    check_.throw_if_any(path_);
    cut_polygons(path_, mesh_, fans_);
    if (!vertex_colors_.empty())
      give_vertex_colors(mesh_, vertex_colors_.linear(mesh_.positions.size()));
    else if (!face_colors_.empty())
      for (const RgbF& color : face_colors_.linear(mesh_.triangles.size()))
        mesh_.colors.push_back({color, color, color});
    return std::move(mesh_);
  }

 private:
  void blank_comments() {
    for (std::size_t at = bytes_.find('#'); at != bytes_.npos; at = bytes_.find('#', at)) {
      const std::size_t end = std::min(bytes_.find('\n', at), bytes_.size());
      std::fill(bytes_.begin() + std::ptrdiff_t(at), bytes_.begin() + std::ptrdiff_t(end), ' ');
    }
  }

  void header() {
    const std::string_view word = at_.word_across_lines();
    std::string_view rest = word;
    if (rest.starts_with("ST")) rest.remove_prefix(2);
    if (rest.starts_with("C")) has_colors_ = true, rest.remove_prefix(1);
    if (rest.starts_with("N")) has_normals_ = true, rest.remove_prefix(1);
    if (rest != "OFF")
      throw bad_line(path_, at_.line(), "this is not an OFF file of three dimensions",
                     "OFF, COFF, NOFF or STOFF", quoted_word(word));
  }

  std::int64_t integer(const char* what) {
    const std::string_view word = at_.word_across_lines();
    std::int64_t value = 0;
    if (!parse_integer(word, value) || value < 0)
      throw bad_line(path_, at_.line(), std::string("bad ") + what, "an integer >= 0",
                     word.empty() ? "end of file" : quoted_word(word));
    return value;
  }

  void counts() {
    TextCursor peek = at_;
    if (peek.word_across_lines() == "BINARY")
      throw bad_file(path_, "binary OFF is not supported", "text OFF, or another format", "OFF BINARY");
    vertices_ = integer("number of vertices");
    faces_ = integer("number of faces");
    integer("number of edges");
    end_line();
    const std::int64_t left = std::int64_t(bytes_.size() - at_.offset());
    if (vertices_ > left / 5 || faces_ > left / 2 || vertices_ * 5 + faces_ * 2 > left)
      throw bad_file(path_, "the header claims more than the file holds",
                     std::to_string(vertices_) + " vertices and " + std::to_string(faces_) + " faces",
                     std::to_string(left) + " bytes after the header");
    mesh_.positions.reserve(std::size_t(vertices_));
    constexpr std::int64_t smallest_triangle = 7;  // bytes: "3 0 1 2"
    mesh_.triangles.reserve(std::size_t(std::min(faces_, left / smallest_triangle)));
  }

  void end_line() {
    if (!at_.at_end()) at_.next_line();
  }

  Vec3d three_numbers(const char* what, bool across_lines) {
    Vec3d value;
    for (std::size_t i = 0; i < 3; ++i) {
      const std::string_view word = across_lines && i == 0 ? at_.word_across_lines() : at_.word();
      if (!parse_number(word, value[i]))
        throw bad_line(path_, at_.line(), std::string("bad ") + what, "three numbers",
                       at_.at_end() && word.empty() ? "end of file" : quoted_word(word));
    }
    return value;
  }

  void vertex() {
    const Vec3d position = three_numbers("vertex", true);
    check_.check(position, mesh_.positions.size(), at_.line());
    if (has_normals_) mesh_.normals.push_back(usable_normal(three_numbers("normal", false)));
    if (has_colors_)
      if (const auto value = color()) vertex_colors_.set(mesh_.positions.size(), *value);
    mesh_.positions.push_back(position);
    end_line();
  }

  /// The next three numbers of the line; none: it has fewer.
  std::optional<RgbF> color() {
    Vec3d value;
    for (std::size_t i = 0; i < 3; ++i)
      if (!parse_number(at_.word(), value[i])) return std::nullopt;
    return RgbF(value);
  }

  void face() {
    const std::int64_t corners = integer("number of corners of a face");
    if (corners > std::int64_t(bytes_.size() - at_.offset()) / 2 + 1)
      throw bad_line(path_, at_.line(), "a face claims more corners than the file holds", "",
                     std::to_string(corners));
    const std::size_t triangles = mesh_.triangles.size();
    PolygonFan fan(mesh_, fans_);
    for (std::int64_t i = 0; i < corners; ++i) {
      const std::int64_t vertex = integer("vertex index in a face");
      if (vertex >= vertices_)
        throw bad_line(path_, at_.line(), "vertex index out of range in a face",
                       "0 to " + std::to_string(vertices_ - 1), std::to_string(vertex));
      fan.add_corner(std::uint32_t(vertex));
    }
    fan.finish();
    const auto value = color();
    for (std::size_t t = triangles; value && t < mesh_.triangles.size(); ++t) face_colors_.set(t, *value);
    end_line();
  }

  const std::string& path_;
  std::string& bytes_;
  TextCursor at_;
  SourceMesh mesh_;
  std::vector<Fan> fans_;
  VertexCheck check_;
  std::int64_t vertices_ = 0, faces_ = 0;
  bool has_normals_ = false, has_colors_ = false;
  FileColors vertex_colors_{ColorCoding::linear}, face_colors_{ColorCoding::linear};
};

SourceMesh read_off(const std::string& path, std::string& bytes, MeshUvs) {
  return OffReader(path, bytes).run();
}

}  // namespace

constinit const MeshFormat off_format{.read = read_off};

}  // namespace opaline
