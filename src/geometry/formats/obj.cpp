// SPDX-License-Identifier: GPL-3.0-or-later
// Wavefront OBJ: reads v (with colours), vn, vt, s and f, and usemtl if the faces of one material are a part
// of the file; counts and reports other statements.
#include <algorithm>
#include <array>
#include <limits>
#include <unordered_set>
#include <utility>

#include "core/byte_order_mark.h"
#include "geometry/formats/file_checks.h"
#include "geometry/formats/mesh_format.h"
#include "geometry/formats/obj_material.h"
#include "geometry/formats/text_cursor.h"
#include "geometry/formats/vertex_colors.h"

namespace opaline {
namespace {

constexpr std::array<std::string_view, 11> silent{"vt",  "vp",     "g",        "o",        "usemtl", "mg",
                                                  "lod", "mtllib", "c_interp", "d_interp", "vc"};

constexpr std::int64_t kNone = -1;  // index of a corner's missing normal or UV
constexpr std::int64_t kMissing = std::numeric_limits<std::int64_t>::max();  // index of a missing normal

/// OBJ gives normals to corners of faces: a vertex with several normals gets a copy for each, after all
/// vertices.
class VertexVariants {
 public:
  explicit VertexVariants(SourceMesh& mesh) : mesh_(mesh), next_(mesh.positions.size(), kUnmet) {
    mesh.normals.resize(mesh.positions.size());
  }

  /// The vertex's copy with this normal.
  std::uint32_t of(std::uint32_t vertex, const Vec3f& normal) {
    if (next_[vertex] == kUnmet) {
      next_[vertex] = kLast;
      mesh_.normals[vertex] = normal;
      return vertex;
    }
    std::uint32_t at = vertex;
    while (mesh_.normals[at] != normal && next_[at] != kLast) at = next_[at];
    if (mesh_.normals[at] == normal) return at;
    next_[at] = std::uint32_t(mesh_.positions.size());
    next_.push_back(kLast);
    mesh_.normals.push_back(normal);
    mesh_.positions.push_back(mesh_.positions[vertex]);
    return next_[at];
  }

 private:
  static constexpr std::uint32_t kUnmet = 0xffffffff, kLast = 0xfffffffe;

  SourceMesh& mesh_;
  std::vector<std::uint32_t> next_;  // next copy of a vertex
};

class ObjReader {
 public:
  /// part: reads the faces of this material; null: all faces
  ObjReader(const std::string& path, const std::string* part, std::string& bytes, MeshUvs uvs)
      : path_(path), part_(part), bytes_(bytes), with_uvs_(uvs != MeshUvs::unread) {}

  SourceMesh run() {
    drop_byte_order_mark(path_, bytes_);
    end_lines_with_line_feeds(bytes_);
    if (bytes_.find('\0') != bytes_.npos)
      throw bad_file(path_, "this is not an OBJ file", "text", "binary data");
    join_continued_lines();
    for (TextCursor at(bytes_); !at.at_end(); at.next_line()) statement(at);
    finish();
    return std::move(mesh_);
  }

 private:
  struct Corner {
    std::int64_t vertex, normal, uv;  // from 0; kNone
  };

  /// A backslash at the end of a line continues it.
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

  void statement(TextCursor& at) {
    const std::string_view keyword = at.word();
    if (keyword == "#MRGB") has_polypaint_ = true;
    if (keyword.empty() || keyword[0] == '#') return;
    if (keyword == "v") return vertex(at);
    if (keyword == "vn") return normal(at);
    if (keyword == "f") return face(at);
    if (keyword == "vt" && with_uvs_) return uv(at);
    if (keyword == "s") return smoothing_group(at);
    if (std::find(silent.begin(), silent.end(), keyword) == silent.end()) leave_out(keyword, at);
    if (keyword == "usemtl") material_ = obj_material_name(at.rest_of_line());
    if (first_material_line_ == 0 && (keyword == "mtllib" || keyword == "usemtl"))
      first_material_line_ = line(at);
  }

  void leave_out(std::string_view keyword, const TextCursor& at) {
    if (unread_++ > 0) return;
    first_unread_ = quoted_word(keyword);
    first_unread_line_ = line(at);
  }

  /// Sets the smoothing group of the faces following; faces before the first `s` belong to none.
  void smoothing_group(TextCursor& at) {
    has_groups_ = true;
    groups_.resize(mesh_.triangles.size(), group_);
    const std::string_view word = at.word();
    std::int64_t number = 0;
    const bool is_number = parse_integer(word, number);
    group_ = word.empty() || word == "off" ? 0 : is_number ? std::uint32_t(number) : 1;
  }

  Vec3d three_numbers(TextCursor& at, const char* what) {
    Vec3d value;
    for (std::size_t i = 0; i < 3; ++i) {
      const std::string_view word = at.word();
      if (!parse_number(word, value[i]))
        throw bad_line(path_, line(at), std::string("bad ") + what, "three numbers", quoted_word(word));
    }
    return value;
  }

  void vertex(TextCursor& at) {
    const Vec3d position = three_numbers(at, "vertex");
    check_.check(position, mesh_.positions.size(), line(at));
    color(at);
    mesh_.positions.push_back(position);
  }

  /// Three numbers after a position, or four with opacity last or a weight of 1 first; fewer are a weight.
  void color(TextCursor& at) {
    std::array<double, 4> value{};
    std::size_t count = 0;
    while (count < 4 && parse_number(at.word(), value[count])) ++count;
    if (count < 3) return;
    const std::size_t vertex = mesh_.positions.size();
    colors_.set(vertex, RgbF(Vec3d(value[0], value[1], value[2])));
    if (count == 4) colors_after_weights_.set(vertex, RgbF(Vec3d(value[1], value[2], value[3])));
    have_weights_ = have_weights_ && count == 4 && value[0] == 1;
    have_opacity_1_ = have_opacity_1_ && (count < 4 || value[3] == 1);
  }

  void normal(TextCursor& at) { normals_.push_back(usable_normal(three_numbers(at, "normal"))); }

  void uv(TextCursor& at) {
    std::array<float, 2>& uv = uvs_.emplace_back();
    for (std::size_t i = 0; i < 2; ++i) {
      const std::string_view word = at.word();
      double value = 0;
      if (word.empty() && i == 1) return;  // a texture of one dimension
      if (!parse_number(word, value))
        throw bad_line(path_, line(at), "bad texture coordinate", "one to three numbers", quoted_word(word));
      uv[i] = float(value);
    }
  }

  /// One index of a corner, made zero-based; negative ones count back from the latest.
  std::int64_t index(std::string_view text, std::size_t count, const char* what, const TextCursor& at) const {
    std::int64_t value = 0;
    if (!parse_integer(text, value) || value == 0 || value < -std::int64_t(count))
      throw bad_line(path_, line(at), std::string("bad ") + what + " index in a face",
                     "1 to their number, or -1 to -" + std::to_string(count), quoted_word(text));
    return value > 0 ? value - 1 : std::int64_t(count) + value;
  }

  /// "v", "v/vt", "v//vn" or "v/vt/vn".
  Corner corner(std::string_view text, const TextCursor& at) {
    const std::size_t slash = text.find('/');
    Corner corner{index(text.substr(0, slash), mesh_.positions.size(), "vertex", at), kNone, kNone};
    remember_highest(highest_vertex_, corner.vertex, at);
    if (slash == text.npos) return corner;
    const std::size_t second = text.find('/', slash + 1);
    const std::string_view uv = text.substr(slash + 1, second == text.npos ? second : second - slash - 1);
    if (with_uvs_ && !uv.empty()) {
      corner.uv = index(uv, uvs_.size(), "texture coordinate", at);
      remember_highest(highest_uv_, corner.uv, at);
    }
    if (second == text.npos || second + 1 == text.size()) return corner;
    corner.normal = normal_index(text.substr(second + 1), at);
    return corner;
  }

  std::int64_t normal_index(std::string_view text, const TextCursor& at) const {
    std::int64_t value = 0;
    const bool is_number = parse_integer(text, value);
    if (is_number && (value == 0 || value < -std::int64_t(normals_.size()))) return kMissing;
    return index(text, normals_.size(), "normal", at);
  }

  struct Highest {
    std::int64_t index = -1;
    int line = 0;
  };

  void remember_highest(Highest& highest, std::int64_t index, const TextCursor& at) const {
    if (index > highest.index) highest = {index, line(at)};
  }

  void face(TextCursor& at) {
    corners_.clear();
    for (std::string_view word = at.word(); !word.empty() && word[0] != '#'; word = at.word())
      corners_.push_back(corner(word, at));
    if (corners_.size() < 3) return leave_out("f of " + std::to_string(corners_.size()) + " corners", at);
    if (part_ != nullptr && material_ != *part_) return;
    keep_first_of_equal_corners();
    if (corners_.size() < 3) {
      ++mesh_.collapsed;
      return;
    }
    if (corners_.size() > 3)
      fans_.push_back({std::uint32_t(mesh_.triangles.size()), std::uint32_t(corners_.size() - 2)});
    for (std::size_t i = 2; i < corners_.size(); ++i)
      add_triangle({corners_[0], corners_[i - 1], corners_[i]});
  }

  /// The normals of its corners wait until all vertices are known.
  void add_triangle(const std::array<Corner, 3>& corners) {
    const auto& [a, b, c] = corners;
    const std::size_t before = mesh_.triangles.size();
    mesh_.triangles.push_back({std::uint32_t(a.vertex), std::uint32_t(b.vertex), std::uint32_t(c.vertex)});
    if (with_uvs_) corner_uvs_.push_back({a.uv, b.uv, c.uv});
    if (corner_normals_.empty() && std::max({a.normal, b.normal, c.normal}) == kNone) return;
    corner_normals_.resize(before, {kNone, kNone, kNone});
    corner_normals_.push_back({a.normal, b.normal, c.normal});
  }

  /// Skips corners at a repeated vertex, except in a face with a hole.
  void keep_first_of_equal_corners() {
    constexpr std::size_t kFew = 16;  // to compare each with each
    kept_.clear();
    seen_.clear();
    for (const Corner& corner : corners_) {
      const bool is_new = corners_.size() <= kFew
                              ? std::ranges::find(kept_, corner.vertex, &Corner::vertex) == kept_.end()
                              : seen_.insert(corner.vertex).second;
      if (is_new) kept_.push_back(corner);
    }
    const bool has_hole = kept_.size() >= 3 && kept_.size() < corners_.size() && has_bridge();
    if (!has_hole) corners_.swap(kept_);
  }

  /// True if the face contains an edge in both directions, a bridge to a hole.
  bool has_bridge() const {
    std::vector<std::array<std::int64_t, 2>> edges;
    for (std::size_t i = 0; i < corners_.size(); ++i)
      edges.push_back({corners_[i].vertex, corners_[(i + 1) % corners_.size()].vertex});
    std::ranges::sort(edges);
    return std::ranges::any_of(edges, [&](const auto& edge) {
      return edge[0] != edge[1] && std::ranges::binary_search(edges, std::array{edge[1], edge[0]});
    });
  }

  void finish() {
    const std::size_t faces = mesh_.triangles.size() + mesh_.collapsed;
    if (part_ != nullptr && faces == 0)
      throw bad_file(path_, "has no such part", "a material that usemtl gives to faces", quoted_word(*part_));
    require_faces(path_, mesh_.positions.size(), faces);
    check_.throw_if_any(path_);
    check_range(highest_vertex_, mesh_.positions.size(), "vertex");
    check_range(highest_uv_, uvs_.size(), "texture coordinate");
    cut_faces();
    if (unread_ > 0)
      mesh_.warnings.push_back(path_ + ":" + std::to_string(first_unread_line_) + ": " +
                               std::to_string(unread_) + " statements not part of a polygon mesh are" +
                               " ignored, the first is " + first_unread_);
    if (first_material_line_ > 0 && part_ == nullptr)
      mesh_.warnings.push_back(path_ + ":" + std::to_string(first_material_line_) +
                               ": materials and textures (mtllib, usemtl) are ignored; the scene file "
                               "defines the material of a shape");
    if (has_polypaint_)
      mesh_.warnings.push_back(path_ + ": polypaint (#MRGB) is ignored; export vertex colours instead");
    const FileColors& colors = have_weights_ && !have_opacity_1_ ? colors_after_weights_ : colors_;
    if (!colors.empty()) give_vertex_colors(mesh_, colors.linear(mesh_.positions.size()));
    if (has_groups_) give_smoothing();
    if (!corner_normals_.empty()) give_normals();
    if (!uvs_.empty()) give_uvs();
  }

  void give_smoothing() {
    groups_.resize(mesh_.triangles.size(), group_);
    const std::uint32_t first = groups_.empty() ? 1 : groups_.front();
    if (!std::ranges::all_of(groups_, [&](std::uint32_t group) { return group == first; }))
      mesh_.smoothing.groups = std::move(groups_);
    else if (first == 0)
      mesh_.smoothing.crease_angle = 0;
  }

  void cut_faces() {
    const std::vector<Recut> cuts = cut_polygons(path_, mesh_, fans_);
    if (with_uvs_) recut(cuts, corner_uvs_);
    if (corner_normals_.empty()) return;
    corner_normals_.resize(mesh_.triangles.size(), {kNone, kNone, kNone});
    recut(cuts, corner_normals_);
  }

  void give_uvs() {
    mesh_.uvs.resize(corner_uvs_.size());
    for (std::size_t t = 0; t < corner_uvs_.size(); ++t)
      for (std::size_t i = 0; i < 3; ++i)
        if (corner_uvs_[t][i] != kNone) mesh_.uvs[t][i] = uvs_[std::size_t(corner_uvs_[t][i])];
  }

  void give_normals() {
    VertexVariants variants(mesh_);
    for (std::size_t t = 0; t < mesh_.triangles.size(); ++t)
      for (std::size_t i = 0; i < 3; ++i)
        if (const std::int64_t normal = corner_normals_[t][i]; normal != kNone)
          mesh_.triangles[t][i] = variants.of(mesh_.triangles[t][i], normal_of(normal));
  }

  /// Zero where the file lacks it.
  Vec3f normal_of(std::int64_t index) const {
    return index < std::int64_t(normals_.size()) ? normals_[std::size_t(index)] : Vec3f();
  }

  void check_range(const Highest& highest, std::size_t count, const char* what) const {
    if (highest.index < std::int64_t(count)) return;
    throw bad_line(path_, highest.line, std::string(what) + " index out of range in a face",
                   "at most " + std::to_string(count), std::to_string(highest.index + 1));
  }

  const std::string& path_;
  const std::string* part_;
  std::string& bytes_;
  std::string material_{kNoMaterial};  // material of the following faces
  SourceMesh mesh_;
  VertexCheck check_;
  std::vector<std::size_t> joined_;  // offsets of the newlines taken out
  std::vector<Vec3f> normals_;
  std::vector<std::array<std::int64_t, 3>> corner_normals_;  // per triangle, up to the last with normals
  bool with_uvs_;
  std::vector<std::array<float, 2>> uvs_;
  std::vector<std::array<std::int64_t, 3>> corner_uvs_;  // corner uvs of triangles
  std::vector<Corner> corners_, kept_;                   // corners of the current face
  std::vector<Fan> fans_;                                // fans of faces with more than three corners
  std::unordered_set<std::int64_t> seen_;
  FileColors colors_{ColorCoding::srgb}, colors_after_weights_{ColorCoding::srgb};
  // True while every colour has four numbers and the first is 1; true while no fourth number differs from 1.
  bool have_weights_ = true, have_opacity_1_ = true;
  std::uint32_t group_ = 0;  // smoothing group of the following faces
  bool has_groups_ = false, has_polypaint_ = false;
  std::vector<std::uint32_t> groups_;  // smoothing groups of the triangles before the last s
  std::size_t unread_ = 0;
  Highest highest_vertex_, highest_uv_;
  std::string first_unread_;
  int first_unread_line_ = 0, first_material_line_ = 0;
};

SourceMesh read_obj(const std::string& path, std::string& bytes, MeshUvs uvs) {
  return ObjReader(path, nullptr, bytes, uvs).run();
}

SourceMesh read_material(const std::string& path, const std::string& part, std::string& bytes, MeshUvs uvs) {
  return ObjReader(path, &part, bytes, uvs).run();
}

}  // namespace

constinit const MeshFormat obj_format{.read = read_obj, .read_part = read_material};

}  // namespace opaline
