// SPDX-License-Identifier: GPL-3.0-or-later
// Keys of what meshes are loaded from.
#include <gtest/gtest.h>

#include <chrono>
#include <filesystem>
#include <fstream>
#include <thread>

#include "../core/scratch_folder.h"
#include "session/shape_key.h"

namespace opaline::test {
namespace {

namespace fs = std::filesystem;

std::string triangle(char last) {
  return std::string("v 0 0 0\nv 1 0 0\nv 0 1 ") + last + "\nf 1 2 3\n";
}

void write(const fs::path& path, const std::string& text) {
  std::ofstream(path, std::ios::binary) << text;
}

// Claim: a mesh file that is written again, with as many bytes and its old time, has another key, and the old one with
// its old bytes; also where it is replaced, and where it was left alone for long enough to be known by its record.
// Source: SourceKeys. Fails if: a file is known by size and time of writing alone, or the record of a young file is
// believed.
TEST(SourceKeys, OfChangedFilesAreOthers) {
  const ScratchFolder folder;
  const fs::path path = folder.path / "mesh.obj", other = folder.path / "other.obj";
  Shape shape;
  shape.source = MeshFile{path.string(), false, {}};
  SourceKeys keys;
  write(path, triangle('0'));
  const fs::file_time_type then = fs::last_write_time(path);
  const StageKey flat = keys.key(shape);
  for (int round = 0; round < 20; ++round) {
    write(path, triangle('1'));
    fs::last_write_time(path, then);
    EXPECT_NE(keys.key(shape), flat);
    write(other, triangle('0'));
    fs::last_write_time(other, then);
    fs::rename(other, path);
    EXPECT_EQ(keys.key(shape), flat);
  }
  std::this_thread::sleep_for(std::chrono::milliseconds(4100));
  EXPECT_EQ(keys.key(shape), flat);  // known from here on
  write(path, triangle('1'));
  fs::last_write_time(path, then);
  EXPECT_NE(keys.key(shape), flat);
}

}  // namespace
}  // namespace opaline::test
