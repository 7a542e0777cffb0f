// SPDX-License-Identifier: GPL-3.0-or-later
// Wavefront OBJ: v, vn and f are read; what else a file says is hidden from OpenMesh by turning the line into
// a comment (it would open material files, and fail on one-dimensional texture coordinates).
#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <unordered_set>
#include <utility>

#include "mesh_scan.h"
#include "text_cursor.h"

namespace opaline {
namespace {

constexpr std::array<std::string_view, 12> silent{"vt", "vp",  "g",      "o",        "s",        "usemtl",
                                                  "mg", "lod", "mtllib", "c_interp", "d_interp", "vc"};

class ObjScanner {
 public:
  ObjScanner(const std::string& path, std::string& bytes) : path_(path), bytes_(bytes) {}

  MeshScan run() {
    if (bytes_.find('\0') != bytes_.npos)
      throw bad_file(path_, "this is not an OBJ file", "text", "binary data");
    join_continued_lines();
    for (TextCursor at(bytes_); !at.at_end(); at.next_line()) statement(at);
    finish();
    return std::move(scan_);
  }

 private:
  /// A backslash at the end of a line continues it; OpenMesh would lose the face.
  void join_continued_lines() {
    for (std::size_t at = bytes_.find('\\'); at != bytes_.npos; at = bytes_.find('\\', at + 1)) {
      const std::size_t newline = bytes_.compare(at + 1, 1, "\r") == 0 ? at + 2 : at + 1;
      if (newline >= bytes_.size() || bytes_[newline] != '\n') continue;
      std::fill(bytes_.begin() + std::ptrdiff_t(at), bytes_.begin() + std::ptrdiff_t(newline) + 1, ' ');
      joined_.push_back(newline);
    }
  }

  int line(const TextCursor& at) const {
    return at.line() + int(std::lower_bound(joined_.begin(), joined_.end(), at.offset()) - joined_.begin());
  }

  void hide(std::size_t first) { bytes_[first] = '#'; }

  void statement(TextCursor& at) {
    const std::string_view keyword = at.word();
    if (keyword.empty() || keyword[0] == '#') return;
    const std::size_t first = at.offset() - keyword.size();
    if (keyword == "v") return vertex(at);
    if (keyword == "vn") return normal(at);
    if (keyword == "f") return face(at, first);
    if (std::find(silent.begin(), silent.end(), keyword) == silent.end() && unread_++ == 0) {
      first_unread_ = quoted(keyword);
      first_unread_line_ = line(at);
    }
    if (first_material_line_ == 0 && (keyword == "mtllib" || keyword == "usemtl"))
      first_material_line_ = line(at);
    hide(first);
  }

  Vec3d three_numbers(TextCursor& at, const char* what) {
    Vec3d value;
    for (std::size_t i = 0; i < 3; ++i) {
      const std::string_view word = at.word();
      if (!parse_number(word, value[i]))
        throw bad_line(path_, line(at), std::string("bad ") + what, "three numbers", quoted(word));
    }
    return value;
  }

  void vertex(TextCursor& at) {
    const Vec3d position = three_numbers(at, "vertex");
    check_.check(position, scan_.positions.size(), line(at));
    scan_.positions.push_back(position);
  }

  /// A normal that is not finite would shift OpenMesh's numbering: it becomes 0 0 0, "none" to what follows.
  void normal(TextCursor& at) {
    const std::size_t first = at.offset();
    const Vec3d value = three_numbers(at, "normal");
    ++normals_;
    if (is_finite(value) && max_component(component_max(value, -value)) < coordinate_limit) return;
    bytes_.replace(first, at.offset() - first, " 0 0 0" + std::string(at.offset() - first - 6, ' '));
  }

  /// One index of a corner, made zero-based; negative ones count back from the latest.
  std::int64_t index(std::string_view text, std::size_t count, const char* what, const TextCursor& at) const {
    std::int64_t value = 0;
    if (!parse_integer(text, value) || value == 0 || value < -std::int64_t(count))
      throw bad_line(path_, line(at), std::string("bad ") + what + " index in a face",
                     "1 to the number of them, or -1 to -" + std::to_string(count), quoted(text));
    return value > 0 ? value - 1 : std::int64_t(count) + value;
  }

  /// The vertex of a corner "v", "v/vt", "v//vn" or "v/vt/vn"; normal_ becomes its normal, or -1.
  std::int64_t corner(std::string_view text, const TextCursor& at) {
    normal_ = -1;
    const std::size_t slash = text.find('/');
    const std::int64_t vertex = index(text.substr(0, slash), scan_.positions.size(), "vertex", at);
    if (slash == text.npos) return vertex;
    const std::size_t second = text.find('/', slash + 1);
    if (second == text.npos || second + 1 == text.size()) return vertex;
    const std::int64_t normal = index(text.substr(second + 1), normals_, "normal", at);
    remember_highest(highest_normal_, normal, at);
    normal_ = normal;
    return vertex;
  }

  struct Highest {
    std::int64_t index = -1;
    int line = 0;
  };

  void remember_highest(Highest& highest, std::int64_t index, const TextCursor& at) const {
    if (index > highest.index) highest = {index, line(at)};
  }

  void face(TextCursor& at, std::size_t first) {
    corners_.clear();
    corner_normals_.clear();
    for (std::string_view word = at.word(); !word.empty(); word = at.word()) {
      if (word[0] == '#') {  // OpenMesh would read numbers in the comment as corners
        std::fill(bytes_.begin() + std::ptrdiff_t(at.offset() - word.size()),
                  bytes_.begin() + std::ptrdiff_t(at.line_end()), ' ');
        break;
      }
      corners_.push_back(corner(word, at));
      corner_normals_.push_back(normal_);
      remember_highest(highest_vertex_, corners_.back(), at);
    }
    if (corners_.size() < 3)
      throw bad_line(path_, line(at), "bad face", "at least three corners", std::to_string(corners_.size()));
    if (corners_.size() > kMostCorners) return cut_later(first);
    keep_first_of_equal_corners();
    if (corners_.size() < 3) {
      ++scan_.collapsed;
      return hide(first);
    }
    scan_.triangles += corners_.size() - 2;
    for (const std::int64_t vertex : corners_) hash_.add(std::uint64_t(vertex));
    hash_.end_face();
  }

  /// As OpenMesh does.
  void keep_first_of_equal_corners() {
    std::size_t kept = 0;
    const bool few = corners_.size() <= 64;
    if (!few) seen_.assign(corners_.begin(), corners_.end()), std::sort(seen_.begin(), seen_.end());
    if (!few && std::adjacent_find(seen_.begin(), seen_.end()) == seen_.end()) return;
    for (const std::int64_t vertex : corners_) {
      const auto end = corners_.begin() + std::ptrdiff_t(kept);
      if (std::find(corners_.begin(), end, vertex) == end) corners_[kept++] = vertex;
    }
    corners_.resize(kept);
  }

  /// OpenMesh compares each corner of a face with each: a face with very many is read as the triangles of its
  /// fan, behind all others.
  void cut_later(std::size_t first) {
    hide(first);
    std::unordered_set<std::int64_t> met;
    std::vector<std::pair<std::int64_t, std::int64_t>> fan;
    for (std::size_t i = 0; i < corners_.size(); ++i)
      if (met.insert(corners_[i]).second) fan.emplace_back(corners_[i], corner_normals_[i]);
    if (fan.size() < 3) {
      ++scan_.collapsed;
      return;
    }
    scan_.triangles += fan.size() - 2;
    fans_.push_back(std::move(fan));
  }

  void append_fans() {
    for (const auto& fan : fans_)
      for (std::size_t i = 2; i < fan.size(); ++i) {
        bytes_ += "\nf";
        for (const auto& [vertex, normal] : {fan[0], fan[i - 1], fan[i]}) {
          bytes_ += ' ' + std::to_string(vertex + 1);
          if (normal >= 0) bytes_ += "//" + std::to_string(normal + 1);
          hash_.add(std::uint64_t(vertex));
        }
        hash_.end_face();
      }
    if (!fans_.empty()) bytes_ += '\n';
  }

  void finish() {
    append_fans();
    require_faces(path_, scan_.positions.size(), scan_.triangles + scan_.collapsed);
    check_.throw_if_any(path_);
    check_range(highest_vertex_, scan_.positions.size(), "vertex");
    check_range(highest_normal_, normals_, "normal");
    if (unread_ > 0)
      scan_.warnings.push_back(
          path_ + ":" + std::to_string(first_unread_line_) + ": " + std::to_string(unread_) +
          " statements that are no part of a polygon mesh are" + " left out, the first is " + first_unread_);
    if (first_material_line_ > 0)
      scan_.warnings.push_back(path_ + ":" + std::to_string(first_material_line_) +
                               ": materials and textures (mtllib, usemtl) are not read: the scene file says "
                               "what a shape is made of");
    scan_.vertex_normals = scan_.corner_normals = highest_normal_.index >= 0;
    scan_.corners = hash_.value();
    scan_.faces = hash_.faces();
  }

  void check_range(const Highest& highest, std::size_t count, const char* what) const {
    if (highest.index < std::int64_t(count)) return;
    throw bad_line(path_, highest.line, std::string(what) + " index out of range in a face",
                   "at most " + std::to_string(count), std::to_string(highest.index + 1));
  }

  const std::string& path_;
  std::string& bytes_;
  MeshScan scan_;
  VertexCheck check_;
  CornerHash hash_;
  std::vector<std::size_t> joined_;  // offsets of the newlines taken out
  static constexpr std::size_t kMostCorners = 1024;

  std::vector<std::int64_t> corners_, corner_normals_, seen_;
  std::vector<std::vector<std::pair<std::int64_t, std::int64_t>>> fans_;  // vertices and normals
  std::int64_t normal_ = -1;
  std::size_t normals_ = 0, unread_ = 0;
  Highest highest_vertex_, highest_normal_;
  std::string first_unread_;
  int first_unread_line_ = 0, first_material_line_ = 0;
};

}  // namespace

MeshScan scan_obj(const std::string& path, std::string& bytes) {
  return ObjScanner(path, bytes).run();
}

}  // namespace opaline
