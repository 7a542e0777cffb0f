// SPDX-License-Identifier: GPL-3.0-or-later
// A mesh file of one format, from its bytes to checked triangles.
#include <cmath>

#include "fuzz_target.h"
#include "geometry/make_mesh.h"

namespace opaline::fuzz {
namespace {

const std::string kFormat = FUZZ_MESH_FORMAT;

void check(const CheckedMesh& checked) {
  const Mesh& mesh = checked.mesh;
  expect(!mesh.triangles.empty(), "triangles");
  expect(mesh.normals.empty() || mesh.normals.size() == mesh.positions.size(), "a normal for each vertex");
  for (const auto& triangle : mesh.triangles)
    for (const std::uint32_t v : triangle) expect(v < mesh.positions.size(), "an index in range");
  for (const Vec3d& p : mesh.positions)
    expect(std::abs(p.x) < 1e18 && std::abs(p.y) < 1e18 && std::abs(p.z) < 1e18, "coordinates in range");
  for (const Vec3f& n : mesh.normals) expect(std::abs(dot(n, n) - 1) < 1e-3f, "unit normals");
  expect(mesh.colors.empty() || mesh.colors.size() == mesh.triangles.size(), "colours for each triangle");
  for (const CornerColors& corners : mesh.colors)
    for (const RgbF& c : corners) expect(min_component(c) >= 0 && max_component(c) <= 1, "colours of 0 to 1");
}

/// Read again beside what an earlier check found, as after an edit, it is the same.
void check_again(const Shape& shape) {
  MeshMemory memory;
  const CheckedMesh once = make_mesh(shape, memory);
  memory.source_changed();
  const CheckedMesh again = make_mesh(shape, memory);
  expect(once.mesh.triangles == again.mesh.triangles && once.mesh.positions == again.mesh.positions,
         "the same mesh");
}

}  // namespace

std::vector<std::string> seeds() {
  if (kFormat != "stl") return {};
  std::string cube(80, ' ');  // binary: a heading, the count, 50 bytes a triangle
  cube += std::string("\2\0\0\0", 4);
  const float corners[2][12] = {{0, 0, 1, 0, 0, 0, 1, 0, 0, 1, 1, 0}, {0, 0, 1, 0, 0, 0, 1, 1, 0, 0, 1, 0}};
  for (const auto& triangle : corners)
    cube += std::string(reinterpret_cast<const char*>(triangle), 48) + "\1\2";
  return {cube};
}

std::vector<std::string> words() {
  if (kFormat == "obj")
    return {"\nv ", "\nvn ",     "\nvt ",     "\nf ", "//",           "/",        "\\\n", "\ng ", "\no ",
            "\ns ", "\nusemtl ", "\nmtllib ", "#",    "\xef\xbb\xbf", "\ns off\n"};
  if (kFormat == "off")
    return {"OFF", "NOFF", "COFF", "STOFF", "4OFF", "nOFF", "BINARY", "\n#", "\n3 0 1 2", "\n4 "};
  if (kFormat == "stl")
    return {"solid ", "endsolid", "facet normal ", "outer loop", "vertex ", "endloop", "endfacet", "\n"};
  return {"ply\n",
          "format ascii 1.0\n",
          "format binary_little_endian 1.0\n",
          "format binary_big_endian 1.0\n",
          "element vertex ",
          "element face ",
          "element edge 2\n",
          "element tristrips 1\n",
          "property float x\n",
          "property double ",
          "property list uchar int vertex_indices\n",
          "property list int short ",
          "property uchar red\n",
          "property float green\n",
          "property uchar blue\n",
          "property list uchar float texcoord\n",
          "property int texnumber\n",
          "property float nx\n",
          "comment ",
          "obj_info ",
          "end_header\n"};
}

}  // namespace opaline::fuzz

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace opaline;
  static const fuzz::ScratchFile file(fuzz::kFormat);
  file.put({reinterpret_cast<const char*>(data), size});
  MeshFile source{file.path(), size % 4 == 1, {}};
  if (size % 8 == 3) source.fit_size = 10;
  if (size % 8 == 5) source.crease_angle = 40;
  Shape shape;
  shape.source = source;
  shape.normals = size % 2 == 0 ? NormalMode::smooth : NormalMode::faceted;
  if (size % 3 == 0) shape.medium = 0;
  fuzz::try_input([&] { fuzz::check_again(shape); });
  fuzz::try_input([&] { fuzz::check(make_mesh(shape)); });
  return 0;
}
