// SPDX-License-Identifier: GPL-3.0-or-later
// PLY, text and binary. Of the vertices x, y, z, nx, ny, nz and UVs are read, of the faces their vertices; all
// other properties, and other elements before the faces, are passed over.
#include <algorithm>
#include <array>
#include <cstring>
#include <optional>
#include <utility>

#include "geometry/formats/file_checks.h"
#include "geometry/formats/mesh_format.h"
#include "geometry/formats/ply_header.h"
#include "geometry/formats/text_cursor.h"

namespace opaline {
namespace {

/// The values behind the header, one after the other.
class PlyValues {
 public:
  PlyValues(const std::string& path, const std::string& bytes, const PlyHeader& header)
      : path_(path),
        bytes_(bytes),
        encoding_(header.encoding),
        offset_(header.size),
        text_(bytes, header.size, header.lines + 1) {}

  /// Where the next value is expected; 0 in a binary file.
  int line() const { return ascii() ? text_.line() : 0; }

  std::size_t bytes_left() const { return bytes_.size() - (ascii() ? text_.offset() : offset_); }

  double next(PlyScalar type) { return ascii() ? next_word(type) : next_binary(type); }

  std::uint64_t next_list_size(const PlyProperty& p) {
    const double count = next(p.count_type);
    const std::size_t most = (bytes_left() + 1) / (ascii() ? 2 : byte_size(p.type));
    if (count < 0 || count > double(most))
      throw bad_line(path_, line(), "a PLY list is longer than the file", "",
                     std::to_string(std::int64_t(count)) + " entries");
    return std::uint64_t(count);
  }

  void skip(const PlyProperty& p) {
    const std::uint64_t count = p.is_list ? next_list_size(p) : 1;
    for (std::uint64_t i = 0; i < count; ++i) next(p.type);
  }

  void require_room(const PlyElement& element) const {
    std::size_t row = 0;
    for (const PlyProperty& p : element.properties)
      row += ascii() ? 2 : byte_size(p.is_list ? p.count_type : p.type);
    if (row > 0 && element.count > (bytes_left() + 1) / row)  // the last word needs no blank behind it
      throw bad_file(path_, "the header claims more than the file holds, or the file is truncated",
                     std::to_string(element.count) + " of element '" + element.name + "', at least " +
                         std::to_string(row) + " bytes each",
                     std::to_string(bytes_left()) + " bytes");
  }

 private:
  bool ascii() const { return encoding_ == PlyEncoding::ascii; }

  double next_word(PlyScalar type) {
    const std::string_view word = text_.word_across_lines();
    double number = 0;
    std::int64_t integer = 0;
    const bool good = is_floating(type) ? parse_number(word, number) : parse_integer(word, integer);
    if (!good)
      throw bad_line(path_, text_.line(), "bad value in a PLY file",
                     is_floating(type) ? "a number" : "an integer",
                     word.empty() ? "end of file" : quoted(word));
    return is_floating(type) ? number : double(integer);
  }

  template <class T>
  static double as(const char* bytes) {
    T value;
    std::memcpy(&value, bytes, sizeof value);
    return double(value);
  }

  double next_binary(PlyScalar type) {
    const std::size_t size = byte_size(type);
    if (bytes_.size() - offset_ < size)
      throw bad_file(path_, "truncated PLY file", "more data",
                     "end of file after " + std::to_string(offset_) + " bytes");
    char raw[8];
    std::copy_n(bytes_.begin() + std::ptrdiff_t(offset_), size, raw);
    if (encoding_ == PlyEncoding::big_endian) std::reverse(raw, raw + size);
    offset_ += size;
    switch (type) {
      case PlyScalar::int8:
        return as<std::int8_t>(raw);
      case PlyScalar::uint8:
        return as<std::uint8_t>(raw);
      case PlyScalar::int16:
        return as<std::int16_t>(raw);
      case PlyScalar::uint16:
        return as<std::uint16_t>(raw);
      case PlyScalar::int32:
        return as<std::int32_t>(raw);
      case PlyScalar::uint32:
        return as<std::uint32_t>(raw);
      case PlyScalar::float32:
        return as<float>(raw);
      case PlyScalar::float64:
        return as<double>(raw);
    }
    return 0;
  }

  const std::string& path_;
  const std::string& bytes_;
  PlyEncoding encoding_;
  std::size_t offset_;  // in a binary file
  TextCursor text_;     // in a text file
};

// Programs call UVs by three pairs of names; behind the first one u is at even places.
constexpr std::array<std::string_view, 12> kept_names{"x", "y", "z", "nx", "ny",        "nz",
                                                      "u", "v", "s", "t",  "texture_u", "texture_v"};
constexpr std::size_t kFirstUv = 6;

class PlyReader {
 public:
  PlyReader(const std::string& path, const std::string& bytes, MeshUvs uvs)
      : path_(path),
        header_(read_ply_header(path, bytes)),
        values_(path, bytes, header_),
        has_uvs_(uvs != MeshUvs::unread) {}

  SourceMesh run() {
    for (const PlyElement* element : wanted_elements()) rows(*element);
    check_.throw_if_any(path_);
    cut_polygons(path_, mesh_, fans_);
    give_uvs(mesh_, uvs_);
    return std::move(mesh_);
  }

 private:
  /// The elements up to the faces; finds the vertices and faces among them.
  std::vector<const PlyElement*> wanted_elements() {
    std::vector<const PlyElement*> elements;
    for (const PlyElement& element : header_.elements) {
      elements.push_back(&element);
      if (element.name == "vertex") vertices_ = &element;
      if (element.name == "face") {
        faces_ = &element;
        break;
      }
    }
    if (faces_ == nullptr && std::ranges::any_of(header_.elements, is_strips))
      throw bad_file(path_, "PLY triangle strips are not read", "faces; export the mesh as triangles",
                     "element tristrips");
    require_faces(path_, faces_ == nullptr || vertices_ != nullptr ? 1 : 0, faces_ != nullptr ? 1 : 0);
    require_faces(path_, vertices_->count, faces_->count);
    find_kept_properties();
    const auto indices = std::find_if(faces_->properties.begin(), faces_->properties.end(), is_indices);
    if (indices == faces_->properties.end())
      throw bad_file(path_, "PLY faces without vertices", "property list uchar int vertex_indices", "none");
    indices_ = &*indices;
    return elements;
  }

  static bool is_strips(const PlyElement& element) { return element.name == "tristrips"; }

  static bool is_indices(const PlyProperty& p) {
    return p.is_list && !is_floating(p.type) && (p.name == "vertex_indices" || p.name == "vertex_index");
  }

  void find_kept_properties() {
    std::array<int, kept_names.size()> found{};
    for (const PlyProperty& p : vertices_->properties) {
      const auto name = std::ranges::find(kept_names, p.name);
      const bool is_kept = name != kept_names.end() && !p.is_list && is_floating(p.type);
      slots_.push_back(is_kept ? std::optional<std::size_t>(name - kept_names.begin()) : std::nullopt);
      if (is_kept) ++found[*slots_.back()];
    }
    if (found[0] != 1 || found[1] != 1 || found[2] != 1)
      throw bad_file(path_, "PLY vertices without positions",
                     "properties x, y and z of type float or double");
    has_normals_ = found[3] == 1 && found[4] == 1 && found[5] == 1;
    const auto pairs = [&](std::size_t k) { return found[k] == 1 && found[k + 1] == 1; };
    has_uvs_ = has_uvs_ && (pairs(kFirstUv) || pairs(kFirstUv + 2) || pairs(kFirstUv + 4));
  }

  void rows(const PlyElement& element) {
    if (element.properties.empty()) return;
    values_.require_room(element);
    if (&element == vertices_) {
      mesh_.positions.reserve(element.count);
      if (has_normals_) mesh_.normals.reserve(element.count);
    }
    constexpr std::size_t smallest_triangle = 4;  // bytes
    if (&element == faces_)
      mesh_.triangles.reserve(std::min(element.count, values_.bytes_left() / smallest_triangle));
    for (std::uint64_t i = 0; i < element.count; ++i) {
      if (&element == vertices_) {
        vertex();
      } else if (&element == faces_) {
        face(i);
      } else {
        for (const PlyProperty& p : element.properties) values_.skip(p);
      }
    }
  }

  void vertex() {
    std::array<Vec3d, 2> read;  // position and normal
    std::array<float, 2> uv{};
    for (std::size_t i = 0; i < slots_.size(); ++i) {
      const PlyProperty& p = vertices_->properties[i];
      if (!slots_[i])
        values_.skip(p);
      else if (*slots_[i] < kFirstUv)
        read[*slots_[i] / 3][*slots_[i] % 3] = values_.next(p.type);
      else
        uv[*slots_[i] % 2] = float(values_.next(p.type));
    }
    check_.check(read[0], mesh_.positions.size(), values_.line());
    mesh_.positions.push_back(read[0]);
    if (has_normals_) mesh_.normals.push_back(usable_normal(read[1]));
    if (has_uvs_) uvs_.push_back(uv);
  }

  void face(std::uint64_t number) {
    for (const PlyProperty& p : faces_->properties) {
      if (&p != indices_) {
        values_.skip(p);
        continue;
      }
      PolygonFan fan(mesh_, fans_);
      for (std::uint64_t left = values_.next_list_size(p); left > 0; --left) {
        const double vertex = values_.next(p.type);
        if (vertex < 0 || vertex >= double(vertices_->count))
          throw bad_line(
              path_, values_.line(), "vertex index out of range in face " + std::to_string(number + 1),
              "0 to " + std::to_string(vertices_->count - 1), std::to_string(std::int64_t(vertex)));
        fan.add_corner(std::uint32_t(vertex));
      }
      fan.finish();
    }
  }

  const std::string& path_;
  PlyHeader header_;
  PlyValues values_;
  const PlyElement* vertices_ = nullptr;
  const PlyElement* faces_ = nullptr;
  const PlyProperty* indices_ = nullptr;
  std::vector<std::optional<std::size_t>> slots_;  // of each vertex property, its number in kept_names
  bool has_normals_ = false, has_uvs_;
  std::vector<std::array<float, 2>> uvs_;
  SourceMesh mesh_;
  std::vector<Fan> fans_;
  VertexCheck check_;
};

SourceMesh read_ply(const std::string& path, std::string& bytes, MeshUvs uvs) {
  return PlyReader(path, bytes, uvs).run();
}

}  // namespace

template <>
const MeshFormat& FormatOf<mesh_format_index("PLY")>::format() {
  static constexpr MeshFormat format{.read = read_ply};
  return format;
}

}  // namespace opaline
