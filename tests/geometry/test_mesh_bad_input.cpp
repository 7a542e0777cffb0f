// SPDX-License-Identifier: GPL-3.0-or-later
// Bad mesh files: one clear error each, and no more memory than the file is long.
#include <sys/resource.h>

#include <chrono>
#include <limits>

#include "mesh_test.h"

namespace opaline {
namespace {

using namespace mesh_test;

struct BadFile {
  const char* file;
  std::string bytes;
  const char* says;  // part of the message
};

const std::string three_vertices = "v 0 0 0\nv 1 0 0\nv 0 1 0\n";
const std::string ply_of_three =
    "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n"
    "element face 1\nproperty list uchar int vertex_indices\nend_header\n";
const std::string loop = "facet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\n";

std::string garbage(std::size_t size) {
  std::string bytes;
  for (std::uint32_t i = 0, x = 1; i < size; ++i) bytes += char((x = x * 1664525 + 1013904223) >> 24);
  return bytes;
}

std::string stl_with(float x) {
  std::string bytes = binary_stl(cube());
  return bytes.replace(96, 4, raw(x));
}

void expect_errors(const std::vector<BadFile>& files) {
  for (const BadFile& bad : files) {
    const std::string error = load_error(bad.file, bad.bytes);
    EXPECT_NE(error.find(bad.says), std::string::npos) << bad.says << " is not in: " << error;
    EXPECT_NE(error.find(bad.file), std::string::npos) << "the file is not named in: " << error;
  }
}

// Claim: each of these is an Error{bad_input} naming the file, the line where there are lines, and what is
// wrong. Source: OBJ, PLY, STL and OFF descriptions. Tolerance: none. Fails if: a check of a reader is left
// out.
TEST(BadMesh, Obj) {
  expect_errors({
      {"empty.obj", "", "is empty"},
      {"zeros.obj", std::string(1000, '\0'), "not an OBJ file"},
      {"garbage.obj", garbage(5000), "not an OBJ file"},
      {"words.obj", "once upon a time\n", "no vertices"},
      {"faceless.obj", three_vertices, "no faces"},
      {"cut.obj", three_vertices + "f 1 2", "no faces"},
      {"cut2.obj", "v 0 0 0\nv 1", ":2: bad vertex (expected three numbers, got end of line)"},
      {"nan.obj", three_vertices + "v 0 nan 0\nf 1 2 3\n",
       ":4: 1 vertex has a coordinate that is not finite"},
      {"inf.obj", three_vertices + "v 0 0 -inf\nv inf 0 0\nf 1 2 3\n", ":4: 2 vertices have"},
      {"huge.obj", three_vertices + "v 0 1e300 0\nf 1 2 3\n",
       "expected finite coordinates below 1e18, got (0, 1e+300, 0)"},
      {"limit.obj", three_vertices + "v 1e18 0 0\nf 1 2 3\n", ":4: 1 vertex has"},
      {"over.obj", three_vertices + "v 1e999 0 0\nf 1 2 3\n", ":4: 1 vertex has"},
      {"text.obj", three_vertices + "v one two three\nf 1 2 3\n",
       ":4: bad vertex (expected three numbers, got 'one')"},
      {"comma.obj", "v 0,5 0 0\n", ":1: bad vertex (expected three numbers, got '0,5')"},
      {"zero.obj", three_vertices + "f 0 1 2\n", ":4: bad vertex index in a face"},
      {"far.obj", three_vertices + "f 1 2 3\nf 1 2 4\nv 0 0 1 1\nf 1 2 9\n",
       ":7: vertex index out of range in a face"},
      {"back.obj", three_vertices + "f -1 -2 -4\n", ":4: bad vertex index in a face"},
      {"normal.obj", three_vertices + "vn 0 0 1\nf 1//1 2//1 3//x\n", ":5: bad normal index in a face"},
      {"utf16.obj", std::string("\xff\xfev\0 \0", 6), "is UTF-16 (expected text in UTF-8)"},
      {"slash.obj", three_vertices + "f /1 2 3\n", ":4: bad vertex index in a face"},
      {"continued.obj", three_vertices + "f 1 2 \\\n 3\nf 1 2 \\\n 7\n", ":7: vertex index out of range"},
      {"noarea.obj", "v 0 0 0\nv 1 1 1\nv 2 2 2\nf 1 2 3\n", "no area"},
      {"point.obj", "v 0 0 0\nf 1 1 1\n", "no area"},
      {"mesh.xyz", three_vertices,
       "expected a name that ends in .obj, .ply, .stl, .off, .glb or .gltf, got '.xyz'"},
      {"mesh", three_vertices, "got no extension"},
  });
}

TEST(BadMesh, Ply) {
  expect_errors({
      {"empty.ply", "", "is empty"},
      {"garbage.ply", garbage(5000), "not a PLY file"},
      {"header.ply", ply_of_three.substr(0, ply_of_three.find("element face")), "truncated PLY header"},
      {"cut.ply", ply_of_three + "0 0 0\n1 0 0\n0 1", ""},
      {"list.ply", ply_of_three + "0 0 0\n1 0 0\n0 1 0\n3 0 1\n",
       ":14: bad value in a PLY file (expected an integer, got end of"},
      {"nan.ply", ply_of_three + "0 0 0\n1 nan 0\n0 1 0\n3 0 1 2\n", ":11: 1 vertex has a coordinate"},
      {"text.ply", ply_of_three + "0 0 0\n1 x 0\n0 1 0\n3 0 1 2\n",
       ":11: bad value in a PLY file (expected a number, got 'x')"},
      {"index.ply", ply_of_three + "0 0 0\n1 0 0\n0 1 0\n3 0 1 3\n",
       ":13: vertex index out of range in face 1"},
      {"minus.ply", ply_of_three + "0 0 0\n1 0 0\n0 1 0\n3 0 1 -1\n", "expected 0 to 2, got -1"},
      {"long.ply", ply_of_three + "0 0 0\n1 0 0\n0 1 0\n200 0 1 2\n", "longer than the file"},
      {"strip.ply",
       "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n"
       "element tristrips 1\nproperty list int int vertex_indices\nend_header\n0 0 0 1 0 0 0 1 0 3 0 1 2\n",
       "PLY triangle strips are not supported"},
      {"int.ply",
       "ply\nformat ascii 1.0\nelement vertex 3\nproperty int x\nproperty int y\nproperty int z\nelement "
       "face 1\n"
       "property list uchar int vertex_indices\nend_header\n0 0 0 1 0 0 0 1 0 3 0 1 2\n",
       "without positions"},
      {"type.ply", "ply\nformat ascii 1.0\nelement vertex 3\nproperty half x\nend_header\n",
       ":4: unknown type"},
  });
}

TEST(BadMesh, Stl) {
  const std::string good = binary_stl(cube());
  expect_errors({
      {"empty.stl", "", "is empty"},
      {"garbage.stl", garbage(5000), "truncated STL file, or not an STL file"},
      {"short.stl", good.substr(0, 70),
       "truncated STL file, or not an STL file (expected a header of 84 bytes, got 70 bytes)"},
      {"cut.stl", good.substr(0, good.size() - 1), "12 triangles: 684 bytes, got 683"},
      {"none.stl", good.substr(0, 80) + std::string(4, '\0'), "no vertices"},
      {"nan.stl", stl_with(std::numeric_limits<float>::quiet_NaN()), "1 vertex has a coordinate"},
      {"huge.stl", stl_with(1e19f), "below 1e18"},
      {"cut2.stl", "solid a\n" + loop,
       ":6: bad corner of a triangle (expected vertex and three numbers, got end of file)"},
      {"open.stl", "solid a\n" + loop + "vertex 0 1 0\nendloop\nendfacet\n",
       "truncated STL file (expected endsolid"},
      {"text.stl", "solid a\n" + loop + "vertex 0 x 0\nendloop\nendfacet\nendsolid\n", ":6: bad corner"},
      {"word.stl", "solid a\nfacets\n", ":2: unknown statement in an STL file"},
      {"hollow.stl", "solid a\nendsolid a\n", "no vertices"},
  });
}

TEST(BadMesh, Off) {
  const std::string head = "OFF\n3 1 0\n0.00 0 0\n1.00 0 0\n";
  expect_errors({
      {"empty.off", "", "is empty"},
      {"garbage.off", garbage(5000), "not an OFF file"},
      {"four.off", "4OFF\n3 1 0\n", "not an OFF file of three dimensions"},
      {"binary.off", "OFF BINARY\n" + std::string(40, '\0'), "binary OFF is not supported"},
      {"claim.off", "OFF\n4000000000 4000000000 0\n0 0 0\n", "claims more than the file holds"},
      {"count.off", "OFF\n3 many 0\n", ":2: bad number of faces (expected an integer >= 0, got 'many')"},
      {"cut.off", head + "0 1", ":5: bad vertex (expected three numbers, got end of file)"},
      {"nan.off", head + "0 nan 0\n3 0 1 2\n", ":5: 1 vertex has a coordinate"},
      {"index.off", head + "0 1 0\n3 0 1 3\n",
       ":6: vertex index out of range in a face (expected 0 to 2, got 3)"},
      {"long.off", head + "0 1 0\n99 0 1 2\n", "more corners than the file holds"},
      {"faceless.off", "OFF\n3 0 0\n0 0 0\n1 0 0\n0 1 0\n", "no faces"},
  });
}

// Claim: a missing file and a folder are errors of their own. Source: read_mesh.h. Tolerance: none. Fails if:
// the file is opened without asking what it is (a folder opens).
TEST(BadMesh, MissingFileAndFolder) {
  const auto error = [](const std::string& path) {
    try {
      make_mesh(file_shape(path));
    } catch (const Error& e) {
      return std::string(e.what());
    }
    return std::string();
  };
  const ScratchFolder scratch;
  const std::string path = scratch.file("mesh.obj");
  EXPECT_NE(error(path).find("no such mesh file"), std::string::npos);
  std::filesystem::create_directory(path);
  EXPECT_NE(error(path).find("is a folder"), std::string::npos);
}

// Claim: a PLY that claims four billion vertices or faces is refused at once, in memory that its few bytes
// explain. Source: read_mesh.h. Tolerance: 1 s and 16 MB, thousands of
// times what is needed and a thousandth of what is claimed. Fails if: counts are not checked against the
// file's length first.
TEST(BadMesh, ClaimOfFourBillionIsCheap) {
  const auto peak = [] {
    rusage usage{};
    getrusage(RUSAGE_SELF, &usage);
    return usage.ru_maxrss;
  };
  for (const std::string format : {"ascii", "binary_little_endian"}) {
    for (const bool faces : {false, true}) {
      std::string bytes = "ply\nformat " + format + " 1.0\nelement vertex " + (faces ? "1" : "4294967295") +
                          "\nproperty float x\nproperty float y\nproperty float z\nelement face " +
                          (faces ? "4294967295" : "1") +
                          "\nproperty list uchar int vertex_indices\nend_header\n" +
                          (format == "ascii" ? "0 0 0\n" : std::string(12, '\0'));
      const long before = peak();
      const auto start = std::chrono::steady_clock::now();
      EXPECT_NE(load_error("claim.ply", bytes).find("claims more than the file holds"), std::string::npos);
      EXPECT_LT(std::chrono::steady_clock::now() - start, std::chrono::seconds(1));
      EXPECT_LT(peak() - before, 16384);
    }
  }
}

// Claim: no cut and no flipped byte of a good file crashes, and what is accepted is finite and in range.
// Source: read_mesh.h. Tolerance: none. Fails if: a reader trusts a
// count or an index.
TEST(BadMesh, CutAndDamagedFilesAreErrorsOrMeshes) {
  const std::vector<std::pair<std::string, std::string>> files{
      {"a.obj", obj(cube()) + "vn 0 0 1\nf 1//1 2//1 3//1\n"},
      {"a.ply", ply_of_three + "0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n"},
      {"a.stl", binary_stl(cube())},
      {"b.stl", "solid a\n" + loop + "vertex 0 1 0\nendloop\nendfacet\nendsolid a\n"},
      {"a.off", "NOFF\n3 1 0\n0 0 0 0 0 1\n1 0 0 0 0 1\n0 1 0 0 0 1\n3 0 1 2\n"}};
  const ScratchFolder folder;
  const auto try_file = [&](const std::string& name, const std::string& bytes) {
    put_bytes(folder.file(name), bytes);
    try {
      const CheckedMesh mesh = make_mesh(file_shape(folder.file(name)));
      for (const Vec3d& p : mesh.mesh.positions) EXPECT_TRUE(is_finite(p));
      for (const auto& t : mesh.mesh.triangles)
        for (const std::uint32_t v : t) EXPECT_LT(v, mesh.mesh.positions.size());
    } catch (const Error& error) {
      EXPECT_EQ(error.kind, ErrorKind::bad_input);
    }
  };
  for (const auto& [name, bytes] : files) {
    for (std::size_t i = 0; i<bytes.size(); i += bytes.size()> 500 ? 7 : 1) {
      try_file(name, bytes.substr(0, i));
      for (const char damage : {'\0', '\xff', '9', '-', '\n', '/'}) {
        std::string damaged = bytes;
        damaged[i] = damage;
        try_file(name, damaged);
      }
    }
  }
}

}  // namespace
}  // namespace opaline
