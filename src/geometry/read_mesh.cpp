// SPDX-License-Identifier: GPL-3.0-or-later
#include "read_mesh.h"

#include <OpenMesh/Core/IO/MeshIO.hh>
#include <OpenMesh/Core/System/omstream.hh>
#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <limits>
#include <locale>
#include <mutex>
#include <streambuf>

#include "geometry/mesh_size.h"
#include "mesh_scan.h"
#include "opaline/scene/nearest_name.h"
#include "soup_importer.h"

namespace opaline {
namespace {

namespace fs = std::filesystem;

/// read: all by itself, or scan: and OpenMesh reads.
struct Format {
  const char* extension;
  SourceMesh (*read)(const std::string&, std::string&);
  MeshScan (*scan)(const std::string&, std::string&);
};

constexpr std::array<Format, 4> formats{{{"obj", read_obj, nullptr},
                                         {"ply", nullptr, scan_ply},
                                         {"stl", nullptr, scan_stl},
                                         {"off", nullptr, scan_off}}};

const Format& format_of(const std::string& path) {
  std::string extension = fs::path(path).extension().string();
  for (char& c : extension) c = char(std::tolower(static_cast<unsigned char>(c)));
  for (const Format& format : formats)
    if (extension == std::string(".") + format.extension) return format;
  throw bad_file(path, "unknown mesh format", "a name that ends in .obj, .ply, .stl or .off",
                 extension.empty() ? "no extension" : "'" + extension + "'");
}

/// The mesh file beside the missing one that is called almost the same.
std::string nearest_mesh(const fs::path& missing) {
  constexpr std::size_t most = 10000;  // of a folder's files are looked at
  std::vector<std::string> names;
  std::error_code error;
  for (fs::directory_iterator it(missing.parent_path().empty() ? "." : missing.parent_path(), error), end;
       !error && it != end && names.size() < most; it.increment(error))
    names.push_back(it->path().filename().string());
  std::ranges::sort(names);
  return did_you_mean(missing.filename().string(), std::vector<std::string_view>(names.begin(), names.end()));
}

/// A stream buffer over bytes in memory that can seek, as OpenMesh's readers need.
class MemoryBuffer : public std::streambuf {
 public:
  explicit MemoryBuffer(std::string& bytes) { setg(bytes.data(), bytes.data(), bytes.data() + bytes.size()); }

 protected:
  pos_type seekoff(off_type offset, std::ios_base::seekdir from, std::ios_base::openmode) override {
    char* base = from == std::ios_base::beg ? eback() : from == std::ios_base::end ? egptr() : gptr();
    if (offset < eback() - base || offset > egptr() - base) return pos_type(off_type(-1));
    setg(eback(), base + offset, egptr());
    return pos_type(gptr() - eback());
  }
  pos_type seekpos(pos_type position, std::ios_base::openmode mode) override {
    return seekoff(off_type(position), std::ios_base::beg, mode);
  }
};

/// Lets OpenMesh read; its readers are global objects with a state, so one at a time, and silent.
bool read_with_openmesh(std::string& bytes, const Format& format, const MeshScan& scan,
                        SoupImporter& importer) {
  static std::mutex one_at_a_time;
  const std::lock_guard lock(one_at_a_time);
  MemoryBuffer buffer(bytes);
  std::istream stream(&buffer);
  stream.imbue(std::locale::classic());
  OpenMesh::IO::Options options;
  if (scan.vertex_normals) options += OpenMesh::IO::Options::VertexNormal;
  if (scan.binary) options += OpenMesh::IO::Options::Binary;
  omerr().disable();
  const bool done = OpenMesh::IO::IOManager().read(stream, format.extension, importer, options);
  omerr().enable();
  return done;
}

bool same_in_float(const Vec3d& exact, const Vec3d& read) {
  for (std::size_t i = 0; i < 3; ++i) {
    const double rounding = std::abs(exact[i]) * std::numeric_limits<float>::epsilon() +
                            double(std::numeric_limits<float>::denorm_min());
    if (!(std::abs(exact[i] - read[i]) <= rounding)) return false;
  }
  return true;
}

Error differs(const std::string& path, const char* what, std::size_t scanned, std::size_t read) {
  return bad_file(path, std::string("OpenMesh read other ") + what + " than the file holds",
                  std::to_string(scanned), std::to_string(read));
}

/// Every difference between the scan and what OpenMesh returned is an error.
void compare(const std::string& path, const MeshScan& scan, const SoupImporter& read) {
  const bool numbered =
      !scan.positions.empty();  // else STL, where OpenMesh leaves triangles of equal corners out
  if (numbered && read.vertices() != scan.positions.size())
    throw differs(path, "vertices", scan.positions.size(), read.vertices());
  if (read.triangles().size() > scan.triangles || (numbered && read.triangles().size() != scan.triangles))
    throw differs(path, "triangles", scan.triangles, read.triangles().size());
  if (!numbered) return;
  if (read.corners() != scan.corners) throw bad_file(path, "OpenMesh read other faces than the file holds");
  for (std::size_t v = 0; v < scan.positions.size(); ++v)
    if (!same_in_float(scan.positions[v], read.positions()[v])) throw differs(path, "coordinates", v, v);
}

/// The scan holds all the rest of a mesh without normals.
bool has_faces_of(const MeshScan& scan, const SourceMesh& before) {
  return before.faces != 0 && scan.faces == before.faces && !scan.vertex_normals && scan.normals.empty() &&
         scan.positions.size() == before.positions.size() && scan.triangles == before.triangles.size();
}

SourceMesh with_faces_of(MeshScan scan, const SourceMesh& before) {
  return {.positions = std::move(scan.positions),
          .normals = {},
          .triangles = before.triangles,
          .faces = scan.faces,
          .collapsed = scan.collapsed,
          .warnings = std::move(scan.warnings)};
}

/// Indices of edges must fit 32 bits, OpenMesh's are signed.
void require_indexable(const std::string& path, std::size_t vertices, std::size_t triangles) {
  constexpr std::size_t limit = std::size_t(1) << 30;
  if (vertices > limit || triangles > limit)
    throw bad_file(path, "the mesh is too large", "at most 2^30 vertices and triangles");
}

}  // namespace

std::string read_mesh_bytes(const std::string& path) {
  std::error_code error;
  const fs::file_status status = fs::status(path, error);
  if (status.type() == fs::file_type::not_found)
    throw bad_file(path, "no such mesh file" + nearest_mesh(path));
  if (!fs::is_regular_file(status))
    throw bad_file(path, "cannot read the mesh", "a file",
                   fs::is_directory(status) ? "a directory" : "something else");
  std::ifstream file(path, std::ios::binary);
  const std::uintmax_t size = fs::file_size(path, error);
  if (!file || error) throw bad_file(path, "cannot open the mesh file");
  if (size == 0) throw bad_file(path, "the mesh file is empty");
  check_mesh_size(path, size);
  std::string bytes(size, '\0');
  file.read(bytes.data(), std::streamsize(size));
  if (std::uintmax_t(file.gcount()) != size) throw run_failed(path, "reading the mesh file failed");
  return bytes;
}

SourceMesh read_mesh(const std::string& path, const SourceMesh* before) {
  const Format& format = format_of(path);
  std::string bytes = read_mesh_bytes(path);
  if (format.read != nullptr) {
    SourceMesh mesh = format.read(path, bytes);
    require_indexable(path, mesh.positions.size(), mesh.triangles.size());
    return mesh;
  }
  MeshScan scan = format.scan(path, bytes);
  require_indexable(path, scan.positions.size(), scan.triangles);
  if (before != nullptr && has_faces_of(scan, *before)) return with_faces_of(std::move(scan), *before);
  SoupImporter importer(scan);
  if (!read_with_openmesh(bytes, format, scan, importer))
    throw bad_file(path, "OpenMesh cannot read the mesh");
  compare(path, scan, importer);
  const std::size_t dropped =
      scan.collapsed + (scan.positions.empty() ? scan.triangles - importer.triangles().size() : 0);
  SourceMesh mesh = importer.take(scan.positions);
  mesh.collapsed = dropped;
  mesh.warnings = scan.warnings;
  if (!scan.normals.empty()) mesh.normals = scan.normals;
  if (mesh.normals.empty()) mesh.faces = scan.faces;
  return mesh;
}

}  // namespace opaline
