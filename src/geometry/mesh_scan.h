// SPDX-License-Identifier: GPL-3.0-or-later
// OBJ, which is read in one pass, and a first pass over the bytes of the other mesh files, before OpenMesh
// sees them. OpenMesh 9 drops vertices that are not numbers (which shifts every later index) and faces with
// bad indices without an error, trusts the counts of a header, and reads coordinates as float. So a scan
// checks every count against the file's length, every coordinate and every index; keeps coordinates in
// double; and blanks in the bytes what OpenMesh would stumble over. read_mesh then compares what OpenMesh
// returned with the scan.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "opaline/core/error.h"
#include "opaline/core/vec3.h"
#include "source_mesh.h"

namespace opaline {

/// What a file holds, as the scan found it.
struct MeshScan {
  std::vector<Vec3d> positions;  ///< in the file's order; empty for STL, whose vertices OpenMesh numbers
  std::vector<Vec3f> normals;    ///< OFF: the file's own; other formats leave normals to OpenMesh
  std::size_t triangles = 0;     ///< after cutting polygons into fans
  std::size_t collapsed = 0;     ///< faces with fewer than three different corners
  std::uint64_t corners = 0;     ///< CornerHash over the faces; STL: 0
  std::uint64_t faces = 0;       ///< the same with where each face ends; STL: 0
  bool vertex_normals = false;   ///< OpenMesh should deliver vertex normals
  bool binary = false;           ///< OpenMesh should read binary STL
  std::vector<std::string> warnings;
};

/// bytes: the whole file; its continued lines are joined.
/// error Error{bad_input} naming the file and the line
SourceMesh read_obj(const std::string& path, std::string& bytes);

/// The scans of the other formats; `bytes` is the whole file and is edited as said above.
/// error Error{bad_input} naming the file, and the line where the format has lines
MeshScan scan_ply(const std::string& path, std::string& bytes);
MeshScan scan_stl(const std::string& path, std::string& bytes);
MeshScan scan_off(const std::string& path, std::string& bytes);

/// An order-dependent checksum over the corners of all faces.
class CornerHash {
 public:
  void add(std::uint64_t vertex) { value_ = (value_ ^ (vertex + 1)) * 0x100000001b3u; }
  void end_face() { faces_ = (faces_ ^ value_) * 0x100000001b3u; }
  std::uint64_t value() const { return value_; }
  std::uint64_t faces() const { return faces_; }

 private:
  std::uint64_t value_ = 0xcbf29ce484222325u, faces_ = value_;
};

/// Coordinates must stay below this: Embree drops triangles beyond 1.8e18 without a word.
inline constexpr double coordinate_limit = 1e18;

/// Counts the vertices whose coordinates are not finite or too large, so that one error names them all.
class VertexCheck {
 public:
  /// line: 1-based, 0 in binary files
  void check(const Vec3d& position, std::size_t index, int line);
  void throw_if_any(const std::string& path) const;

 private:
  std::size_t bad_ = 0, first_index_ = 0;
  int first_line_ = 0;
  Vec3d first_;
};

/// Bad input at a line of a file.
Error bad_line(const std::string& path, int line, std::string message, std::string expected = {},
               std::string got = {});

/// error "the mesh has no faces" or "no vertices" where that is so
void require_faces(const std::string& path, std::size_t vertices, std::size_t faces);

}  // namespace opaline
