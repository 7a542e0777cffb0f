// SPDX-License-Identifier: GPL-3.0-or-later
// PLY, text and binary. Reads x, y, z, nx, ny, nz, UVs and colours of vertices, and vertices, corner UVs and
// colours of faces; ignores all other properties, and other elements before the faces.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <optional>
#include <utility>

#include "core/byte_order_mark.h"
#include "geometry/formats/file_checks.h"
#include "geometry/formats/mesh_format.h"
#include "geometry/formats/ply_header.h"
#include "geometry/formats/text_cursor.h"
#include "geometry/formats/vertex_colors.h"

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
                     word.empty() ? "end of file" : quoted_word(word));
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

// UVs have three pairs of names in use; in the list below, u is at even indices.
constexpr std::array<std::string_view, 12> kept_names{"x", "y", "z", "nx", "ny",        "nz",
                                                      "u", "v", "s", "t",  "texture_u", "texture_v"};
constexpr std::size_t kFirstUv = 6;

/// Largest value of a whole type.
double largest_of(PlyScalar type) {
  const bool is_signed = std::size_t(type) % 2 == 0;
  return std::ldexp(1.0, 8 * int(byte_size(type)) - is_signed) - 1;
}

/// Bytes are the usual scale, for any type.
constexpr double kOfBytes = 255;

/// The red, green and blue of an element.
class PlyColors {
 public:
  explicit PlyColors(const PlyElement& element) {
    for (const auto& names : kNames) {
      std::array<const PlyProperty*, 3> found{};
      for (const PlyProperty& p : element.properties)
        for (std::size_t c = 0; c < 3; ++c)
          if (!p.is_list && p.name == names[c]) found[c] = &p;
      if (std::ranges::find(found, nullptr) == found.end()) channels_ = found;
    }
    if (channels_[0] != nullptr && !is_floating(channels_[0]->type)) colors_ = FileColors(ColorCoding::srgb);
  }

  /// Takes a value of one of the three channels; false for others.
  bool take(const PlyProperty& p, PlyValues& values) {
    const auto channel = std::ranges::find(channels_, &p);
    if (channel == channels_.end()) return false;
    const double value = values.next(p.type);
    if (value > largest_) largest_ = value, largest_property_ = &p;
    color_[std::size_t(channel - channels_.begin())] = float(value);
    return true;
  }

  bool are_there() const { return channels_[0] != nullptr; }
  void set(std::size_t index) { colors_.set(index, color_); }
  /// Whole numbers count to 255 or, where one is larger, to the largest number of their type.
  /// error Error{bad_input} naming the property: whole numbers of 4 bytes above 255
  std::vector<RgbF> linear(std::size_t elements, const std::string& path) {
    const PlyScalar type = channels_[0]->type;
    if (is_floating(type)) return colors_.linear(elements);
    if (largest_ > kOfBytes && byte_size(type) > 2)
      throw bad_file(path, "the PLY property '" + largest_property_->name + "' is not a colour",
                     "whole numbers from 0 to 255, or floats from 0 to 1",
                     std::to_string(std::int64_t(largest_)) + " of a type of 4 bytes");
    colors_.divide_by(byte_size(type) == 1 || largest_ > kOfBytes ? float(largest_of(type))
                                                                  : float(kOfBytes));
    return colors_.linear(elements);
  }

 private:
  static constexpr std::array<std::array<std::string_view, 3>, 3> kNames{
      {{"r", "g", "b"}, {"diffuse_red", "diffuse_green", "diffuse_blue"}, {"red", "green", "blue"}}};

  std::array<const PlyProperty*, 3> channels_{};  // null: there are none
  RgbF color_;
  double largest_ = 0;
  const PlyProperty* largest_property_ = nullptr;
  FileColors colors_{ColorCoding::linear};
};

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
    const std::vector<Recut> cuts = cut_polygons(path_, mesh_, fans_);
    if (has_wedges_) {
      recut(cuts, mesh_.uvs);
    } else {
      mesh_.uvs.clear();
      give_uvs(mesh_, uvs_);
    }
    give_colors();
    if (!has_uvs_ && !header_.texture.empty())
      mesh_.warnings.push_back(path_ + ": the texture " + quoted_word(header_.texture) +
                               " (TextureFile) is ignored; the scene file defines the material of a shape");
    if (textures_ > 1)
      mesh_.warnings.push_back(path_ + ": its faces have " + std::to_string(textures_) +
                               " textures (texnumber), treated as one");
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
      throw bad_file(path_, "PLY triangle strips are not supported", "faces; export the mesh as triangles",
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

  void give_colors() {
    if (vertex_colors_->are_there())
      give_vertex_colors(mesh_, vertex_colors_->linear(mesh_.positions.size(), path_));
    else if (face_colors_->are_there())
      for (const RgbF& color : face_colors_->linear(mesh_.triangles.size(), path_))
        mesh_.colors.push_back({color, color, color});
  }

  static bool is_wedges(const PlyProperty& p) {
    return p.is_list && is_floating(p.type) && p.name == "texcoord";
  }

  void find_kept_properties() {
    vertex_colors_.emplace(*vertices_);
    face_colors_.emplace(*faces_);
    const auto wedges = std::ranges::find_if(faces_->properties, is_wedges);
    if (has_uvs_ && wedges != faces_->properties.end()) wedges_ = &*wedges;
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
      if (vertex_colors_->take(p, values_)) continue;
      if (!slots_[i])
        values_.skip(p);
      else if (*slots_[i] < kFirstUv)
        read[*slots_[i] / 3][*slots_[i] % 3] = values_.next(p.type);
      else
        uv[*slots_[i] % 2] = float(values_.next(p.type));
    }
    check_.check(read[0], mesh_.positions.size(), values_.line());
    if (vertex_colors_->are_there()) vertex_colors_->set(mesh_.positions.size());
    mesh_.positions.push_back(read[0]);
    if (has_normals_) mesh_.normals.push_back(usable_normal(read[1]));
    if (has_uvs_) uvs_.push_back(uv);
  }

  void face(std::uint64_t number) {
    const std::size_t triangles = mesh_.triangles.size();
    polygon_.clear();
    wedge_.clear();
    for (const PlyProperty& p : faces_->properties) {
      if (face_colors_->take(p, values_)) continue;
      if (&p == indices_)
        polygon(p, number);
      else if (&p == wedges_)
        for (std::uint64_t left = values_.next_list_size(p); left > 0; --left)
          wedge_.push_back(float(values_.next(p.type)));
      else if (wedges_ != nullptr && !p.is_list && p.name == "texnumber")
        textures_ = std::max(textures_, std::int64_t(values_.next(p.type)) + 1);
      else
        values_.skip(p);
    }
    if (wedges_ != nullptr) give_wedges(triangles);
    if (face_colors_->are_there())
      for (std::size_t t = triangles; t < mesh_.triangles.size(); ++t) face_colors_->set(t);
  }

  void polygon(const PlyProperty& p, std::uint64_t number) {
    PolygonFan fan(mesh_, fans_);
    for (std::uint64_t left = values_.next_list_size(p); left > 0; --left) {
      const double vertex = values_.next(p.type);
      if (vertex < 0 || vertex >= double(vertices_->count))
        throw bad_line(path_, values_.line(),
                       "vertex index out of range in face " + std::to_string(number + 1),
                       "0 to " + std::to_string(vertices_->count - 1), std::to_string(std::int64_t(vertex)));
      fan.add_corner(std::uint32_t(vertex));
      if (wedges_ != nullptr) polygon_.push_back(std::uint32_t(vertex));
    }
    fan.finish();
  }

  /// Gives a face's triangles, from this one on, the UVs of its corners: u and v of each, or none at all.
  void give_wedges(std::size_t triangle) {
    mesh_.uvs.resize(mesh_.triangles.size());
    if (wedge_.empty() || wedge_.size() != 2 * polygon_.size()) return;
    has_wedges_ = true;
    corner_of_.resize(vertices_->count);
    for (std::size_t corner = 0; corner < polygon_.size(); ++corner)
      corner_of_[polygon_[corner]] = std::uint32_t(corner);
    for (; triangle < mesh_.triangles.size(); ++triangle)
      for (std::size_t k = 0; k < 3; ++k) {
        const std::size_t corner = corner_of_[mesh_.triangles[triangle][k]];
        mesh_.uvs[triangle][k] = {wedge_[2 * corner], wedge_[2 * corner + 1]};
      }
  }

  const std::string& path_;
  PlyHeader header_;
  PlyValues values_;
  const PlyElement* vertices_ = nullptr;
  const PlyElement* faces_ = nullptr;
  const PlyProperty* indices_ = nullptr;
  std::vector<std::optional<std::size_t>> slots_;  // index in kept_names of each vertex property
  bool has_normals_ = false, has_uvs_;
  std::vector<std::array<float, 2>> uvs_;
  std::optional<PlyColors> vertex_colors_, face_colors_;
  const PlyProperty* wedges_ =
      nullptr;  // UVs at the corners of faces; null: there are none, or they are not wanted
  std::vector<std::uint32_t> polygon_;    // polygon of the current face, where it has positions
  std::vector<float> wedge_;              // the same
  std::vector<std::uint32_t> corner_of_;  // corner of each vertex in the current face
  bool has_wedges_ = false;               // a face has given them
  std::int64_t textures_ = 0;
  SourceMesh mesh_;
  std::vector<Fan> fans_;
  VertexCheck check_;
};

SourceMesh read_ply(const std::string& path, std::string& bytes, MeshUvs uvs) {
  drop_byte_order_mark(path, bytes);
  return PlyReader(path, bytes, uvs).run();
}

}  // namespace

constinit const MeshFormat ply_format{.read = read_ply};

}  // namespace opaline
