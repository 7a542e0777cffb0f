// SPDX-License-Identifier: GPL-3.0-or-later
// Object File Format, text: [ST][C][N]OFF. OpenMesh understands neither comments nor counts on the header's
// line nor colours of faces without a C in the header, and forgets the header when it reads from memory; so
// all but counts, coordinates and indices is blanked, and normals are kept here.
#include <algorithm>

#include "mesh_scan.h"
#include "text_cursor.h"

namespace opaline {
namespace {

class OffScanner {
 public:
  OffScanner(const std::string& path, std::string& bytes) : path_(path), bytes_(bytes), at_(bytes) {}

  MeshScan run() {
    blank_comments();
    header();
    counts();
    for (std::int64_t i = 0; i < vertices_; ++i) vertex();
    for (std::int64_t i = 0; i < faces_; ++i) face();
    require_faces(path_, std::size_t(vertices_), std::size_t(faces_));
    check_.throw_if_any(path_);
    scan_.corners = hash_.value();
    scan_.faces = hash_.faces();
    return std::move(scan_);
  }

 private:
  void blank(std::size_t first, std::size_t end) {
    std::fill(bytes_.begin() + std::ptrdiff_t(first), bytes_.begin() + std::ptrdiff_t(end), ' ');
  }

  void blank_comments() {
    for (std::size_t at = bytes_.find('#'); at != bytes_.npos; at = bytes_.find('#', at)) {
      const std::size_t end = std::min(bytes_.find('\n', at), bytes_.size());
      blank(at, end);
    }
  }

  void header() {
    const std::string_view word = at_.word_across_lines();
    std::string_view rest = word;
    if (rest.starts_with("ST")) rest.remove_prefix(2);
    if (rest.starts_with("C")) rest.remove_prefix(1);
    if (rest.starts_with("N")) has_normals_ = true, rest.remove_prefix(1);
    if (rest != "OFF")
      throw bad_line(path_, at_.line(), "this is not an OFF file of three dimensions",
                     "OFF, COFF, NOFF or STOFF", quoted(word));
    blank(0, at_.offset());
    bytes_[0] = '\n';  // OpenMesh takes the first line for the header, unread
  }

  std::int64_t integer(const char* what) {
    const std::string_view word = at_.word_across_lines();
    std::int64_t value = 0;
    if (!parse_integer(word, value) || value < 0)
      throw bad_line(path_, at_.line(), std::string("bad ") + what, "an integer >= 0",
                     word.empty() ? "end of file" : quoted(word));
    return value;
  }

  void counts() {
    TextCursor peek = at_;
    if (peek.word_across_lines() == "BINARY")
      throw bad_file(path_, "binary OFF is not read", "text OFF, or another format", "OFF BINARY");
    vertices_ = integer("number of vertices");
    faces_ = integer("number of faces");
    integer("number of edges");
    end_line();
    const std::int64_t left = std::int64_t(bytes_.size() - at_.offset());
    if (vertices_ > left / 5 || faces_ > left / 2 || vertices_ * 5 + faces_ * 2 > left)
      throw bad_file(path_, "the header claims more than the file holds",
                     std::to_string(vertices_) + " vertices and " + std::to_string(faces_) + " faces",
                     std::to_string(left) + " bytes after the header");
    scan_.positions.reserve(std::size_t(vertices_));
  }

  /// Drops what is left of this line (colours, texture coordinates).
  void end_line() {
    const std::size_t first = at_.offset();
    const std::size_t end = at_.line_end();
    blank(first, end);
    if (!at_.at_end()) at_.next_line();
  }

  Vec3d three_numbers(const char* what, bool across_lines) {
    Vec3d value;
    for (std::size_t i = 0; i < 3; ++i) {
      const std::string_view word = across_lines && i == 0 ? at_.word_across_lines() : at_.word();
      if (!parse_number(word, value[i]))
        throw bad_line(path_, at_.line(), std::string("bad ") + what, "three numbers",
                       at_.at_end() && word.empty() ? "end of file" : quoted(word));
    }
    return value;
  }

  void vertex() {
    const Vec3d position = three_numbers("vertex", true);
    check_.check(position, scan_.positions.size(), at_.line());
    scan_.positions.push_back(position);
    const std::size_t extra = at_.offset();
    if (has_normals_) scan_.normals.push_back(Vec3f(three_numbers("normal", false)));
    blank(extra, at_.offset());
    end_line();
  }

  void face() {
    const std::int64_t corners = integer("number of corners of a face");
    if (corners > std::int64_t(bytes_.size() - at_.offset()) / 2 + 1)
      throw bad_line(path_, at_.line(), "a face claims more corners than the file holds", "",
                     std::to_string(corners));
    for (std::int64_t i = 0; i < corners; ++i) {
      const std::int64_t vertex = integer("vertex index in a face");
      if (vertex >= vertices_)
        throw bad_line(path_, at_.line(), "vertex index out of range in a face",
                       "0 to " + std::to_string(vertices_ - 1), std::to_string(vertex));
      hash_.add(std::uint64_t(vertex));
    }
    hash_.end_face();
    if (corners >= 3) scan_.triangles += std::size_t(corners) - 2;
    if (corners < 3) ++scan_.collapsed;
    end_line();
  }

  const std::string& path_;
  std::string& bytes_;
  TextCursor at_;
  MeshScan scan_;
  VertexCheck check_;
  CornerHash hash_;
  std::int64_t vertices_ = 0, faces_ = 0;
  bool has_normals_ = false;
};

}  // namespace

MeshScan scan_off(const std::string& path, std::string& bytes) {
  return OffScanner(path, bytes).run();
}

}  // namespace opaline
