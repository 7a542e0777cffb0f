// SPDX-License-Identifier: GPL-3.0-or-later
// PLY, text and binary. OpenMesh trusts the header's counts, takes lists other than vertex_indices for single
// values, and misplaces binary data after a comment at the header's end; so the file is rewritten in place
// with nothing but x, y, z, nx, ny, nz and vertex_indices, under a plain header.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <optional>

#include "mesh_scan.h"
#include "ply_header.h"
#include "text_cursor.h"

namespace opaline {
namespace {

constexpr std::array<std::string_view, 6> kept_names{"x", "y", "z", "nx", "ny", "nz"};

class PlyScanner {
 public:
  PlyScanner(const std::string& path, std::string& bytes)
      : path_(path), bytes_(bytes), header_(read_ply_header(path, bytes)) {}

  MeshScan run() {
    std::vector<const PlyElement*> elements = wanted_elements();
    const std::string plain = plain_header();
    if (plain.size() > header_.size) bytes_.insert(0, plain.size() - header_.size, ' ');
    read_ = std::max(header_.size, plain.size());
    at_ = TextCursor(bytes_, read_, header_.lines + 1);
    bytes_.replace(0, plain.size(), plain);
    write_ = plain.size();
    for (const PlyElement* element : elements) rows(*element);
    check_.throw_if_any(path_);
    bytes_.resize(write_);
    scan_.corners = hash_.value();
    scan_.faces = hash_.faces();
    return std::move(scan_);
  }

 private:
  bool ascii() const { return header_.encoding == PlyEncoding::ascii; }

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
    check_vertex_properties();
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

  void check_vertex_properties() {
    std::array<int, 6> found{};
    for (const PlyProperty& p : vertices_->properties) {
      const auto at = std::find(kept_names.begin(), kept_names.end(), p.name);
      if (at != kept_names.end() && !p.is_list && is_floating(p.type))
        ++found[std::size_t(at - kept_names.begin())];
    }
    if (found[0] != 1 || found[1] != 1 || found[2] != 1)
      throw bad_file(path_, "PLY vertices without positions",
                     "properties x, y and z of type float or double");
    scan_.vertex_normals = found[3] == 1 && found[4] == 1 && found[5] == 1;
    for (const PlyProperty& p : vertices_->properties) slots_.push_back(kept_slot(p));
  }

  /// Which of kept_names a vertex property is; none: it is dropped.
  std::optional<std::size_t> kept_slot(const PlyProperty& p) const {
    const auto at = std::find(kept_names.begin(), kept_names.end(), p.name);
    const std::size_t slot = std::size_t(at - kept_names.begin());
    if (p.is_list || !is_floating(p.type) || slot >= (scan_.vertex_normals ? 6u : 3u)) return {};
    return slot;
  }

  std::string plain_header() const {
    constexpr std::array<const char*, 3> formats{"ascii", "binary_little_endian", "binary_big_endian"};
    std::string text = "ply\nformat " + std::string(formats[std::size_t(header_.encoding)]) + " 1.0\n";
    text += "element vertex " + std::to_string(vertices_->count) + "\n";
    for (std::size_t i = 0; i < slots_.size(); ++i) {
      const PlyProperty& p = vertices_->properties[i];
      if (slots_[i]) text += "property " + ply_type_name(p.type) + " " + p.name + "\n";
    }
    text += "element face " + std::to_string(faces_->count) + "\n";
    const std::size_t size = byte_size(indices_->count_type);
    const char* count_type = size == 1 ? "uchar" : size == 2 ? "uint16" : "int";
    return text + "property list " + count_type + " " + ply_type_name(indices_->type) +
           " vertex_indices\nend_header\n";
  }

  std::size_t offset() const { return ascii() ? at_.offset() : read_; }

  void require_room(const PlyElement& element) const {
    std::size_t row = 0;
    for (const PlyProperty& p : element.properties)
      row += ascii() ? 2 : byte_size(p.is_list ? p.count_type : p.type);
    const std::size_t left = bytes_.size() - offset() + 1;  // the last word needs no blank behind it
    if (row > 0 && element.count > left / row)
      throw bad_file(path_, "the header claims more than the file holds, or the file is truncated",
                     std::to_string(element.count) + " of element '" + element.name + "', at least " +
                         std::to_string(row) + " bytes each",
                     std::to_string(left - 1) + " bytes");
  }

  void rows(const PlyElement& element) {
    if (element.properties.empty()) return;
    require_room(element);
    if (&element == vertices_) scan_.positions.reserve(element.count);
    for (std::uint64_t i = 0; i < element.count; ++i) {
      if (&element == vertices_) {
        vertex();
      } else if (&element == faces_) {
        face();
      } else {
        for (const PlyProperty& p : element.properties) skip(p);
      }
    }
  }

  // ---- values -------------------------------------------------------------------------------------------

  /// The next value; its bytes stay findable for keep().
  double value(PlyScalar type) {
    if (!ascii()) return binary_value(type);
    const std::string_view word = at_.word_across_lines();
    word_size_ = word.size();
    double number = 0;
    std::int64_t integer = 0;
    const bool good = is_floating(type) ? parse_number(word, number) : parse_integer(word, integer);
    if (!good)
      throw bad_line(path_, at_.line(), "bad value in a PLY file",
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

  double binary_value(PlyScalar type) {
    const std::size_t size = byte_size(type);
    if (bytes_.size() - read_ < size)
      throw bad_file(path_, "truncated PLY file", "more data",
                     "end of file after " + std::to_string(read_) + " bytes");
    char raw[8];
    std::copy_n(bytes_.begin() + std::ptrdiff_t(read_), size, raw);
    if (header_.encoding == PlyEncoding::big_endian) std::reverse(raw, raw + size);
    read_ += word_size_ = size;
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

  /// Moves the value just read to the end of what OpenMesh will see.
  void keep() {
    const std::size_t first = offset() - word_size_;
    std::copy_n(bytes_.begin() + std::ptrdiff_t(first), word_size_, bytes_.begin() + std::ptrdiff_t(write_));
    write_ += word_size_;
    if (ascii()) separate();
  }

  /// Behind a word that is still in its place the blank is there already.
  void separate() {
    if (write_ == bytes_.size()) {
      bytes_ += ' ';
      at_ = TextCursor(bytes_, bytes_.size(), at_.line());
    } else if (write_ < at_.offset()) {
      bytes_[write_] = ' ';
    }
    ++write_;
  }

  std::uint64_t list_size(const PlyProperty& p) {
    const double count = value(p.count_type);
    const std::size_t left = bytes_.size() - offset() + 1;
    if (count < 0 || count > double(left / (ascii() ? 2 : byte_size(p.type))))
      throw bad_line(path_, ascii() ? at_.line() : 0, "a PLY list is longer than the file", "",
                     std::to_string(std::int64_t(count)) + " entries");
    return std::uint64_t(count);
  }

  void skip(const PlyProperty& p) {
    const std::uint64_t count = p.is_list ? list_size(p) : 1;
    for (std::uint64_t i = 0; i < count; ++i) value(p.type);
  }

  // ---- rows ---------------------------------------------------------------------------------------------

  void vertex() {
    Vec3d position;
    for (std::size_t i = 0; i < slots_.size(); ++i) {
      const PlyProperty& p = vertices_->properties[i];
      const std::optional<std::size_t> slot = slots_[i];
      if (!slot) {
        skip(p);
        continue;
      }
      const double v = value(p.type);
      if (*slot < 3) position[*slot] = v;
      const bool readable = std::abs(v) < coordinate_limit;  // else OpenMesh would read no further
      if (ascii() && !readable) {
        bytes_[offset() - word_size_] = '0';
        std::fill_n(bytes_.begin() + std::ptrdiff_t(offset() - word_size_ + 1), word_size_ - 1, ' ');
      }
      keep();
    }
    check_.check(position, scan_.positions.size(), ascii() ? at_.line() : 0);
    scan_.positions.push_back(position);
  }

  void face() {
    for (const PlyProperty& p : faces_->properties) {
      if (&p != indices_) {
        skip(p);
        continue;
      }
      const std::uint64_t count = list_size(p);
      keep();
      for (std::uint64_t i = 0; i < count; ++i) {
        const double vertex = value(p.type);
        if (vertex < 0 || vertex >= double(vertices_->count))
          throw bad_line(path_, ascii() ? at_.line() : 0,
                         "vertex index out of range in face " + std::to_string(scan_face_ + 1),
                         "0 to " + std::to_string(vertices_->count - 1),
                         std::to_string(std::int64_t(vertex)));
        hash_.add(std::uint64_t(vertex));
        keep();
      }
      hash_.end_face();
      if (count >= 3) scan_.triangles += count - 2;
      if (count < 3) ++scan_.collapsed;
    }
    ++scan_face_;
  }

  const std::string& path_;
  std::string& bytes_;
  PlyHeader header_;
  const PlyElement* vertices_ = nullptr;
  const PlyElement* faces_ = nullptr;
  const PlyProperty* indices_ = nullptr;
  std::vector<std::optional<std::size_t>> slots_;  // which of kept_names each vertex property is
  MeshScan scan_;
  VertexCheck check_;
  CornerHash hash_;
  TextCursor at_{std::string_view()};
  std::size_t read_ = 0, write_ = 0, word_size_ = 0, scan_face_ = 0;
};

}  // namespace

MeshScan scan_ply(const std::string& path, std::string& bytes) {
  return PlyScanner(path, bytes).run();
}

}  // namespace opaline
