// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <cctype>
#include <filesystem>
#include <fstream>

#include "../core/scratch_folder.h"
#include "scene_test.h"

namespace opaline {
namespace {

namespace fs = std::filesystem;

struct BrokenFile {
  std::string text;
  int line, column;
  std::vector<std::string> fragments;
};

// Claim: text that is no JSON is placed, described without its bytes, and never crashes the reader.
// Source: RFC 8259. Fails if TreeBuilder::parse_error passes nlohmann's own message on (it dumps the token),
// or takes `position` for the offset.
TEST(SceneBrokenFiles, PlaceTheBreak) {
  std::string binary =
      "\x7f"
      "ELF";
  for (int i = 0; i < 4096; ++i) binary += static_cast<char>(i * 37 % 256);
  const std::vector<BrokenFile> cases{
      {"", 0, 0, {"empty"}},
      {" \n\t", 0, 0, {"empty"}},
      {"// nothing\n", 2, 1, {"unexpected end of input"}},
      {"{\"film\": {\n", 2, 1, {"broken JSON", "the end of the text"}},
      {"{\"film\": {\"filter\": \"bo", 1, 24, {"missing closing quote", "the end of the text"}},
      {"{\"film\": 1,\n}", 2, 1, {"expected no trailing comma", "got '}'"}},
      {"{'film': 1}", 1, 2, {"expected double quotes"}},
      {"{\"film\": True}", 1, 10, {"expected true, false or null", "got 'T'"}},
      {"{\"film\": 1 \"camera\": 2}", 1, 12, {"unexpected string literal", "got '\"'"}},
      {"{\"film\": NaN}", 1, 10, {"invalid literal", "got 'N'"}},
      {"{\"film\": 1} x", 1, 13, {"broken JSON", "got 'x'"}},
      {"{\"film\": 1} {}", 1, 13, {"unexpected '{'", "expected end of input"}},
      {"{\"mm_per_unit\": 1e999}", 1, 17, {"'mm_per_unit' is out of range", "a finite number", "got 1e999"}},
      {"{\"camera\": {\"position\": [0,\n -1e999, 0]}}", 2, 2, {"'camera.position.1'", "got -1e999"}},
      {"{\"media\": /* open", 1, 18, {"comment"}},
      {binary, 1, 1, {"broken JSON", "byte 0x7F"}},
      {std::string("\0\0\0", 3), 1, 1, {"broken JSON", "byte 0x00"}},
      {"\xff\xfe{", 1, 1, {"broken JSON", "byte 0xFF"}},
      {std::string(1000000, '['), 1, 65, {"nested too deeply", "64 levels"}},
  };
  for (const BrokenFile& c : cases) {
    SCOPED_TRACE(c.text.substr(0, 60));
    const Error error = error_of(c.text);
    EXPECT_EQ(error.line, c.line) << error.what();
    EXPECT_EQ(error.column, c.column) << error.what();
    expect_fragments(error, c.fragments);
    const std::string message = error.what();
    EXPECT_LT(message.size(), 300u);
    EXPECT_TRUE(std::all_of(message.begin(), message.end(), [](unsigned char ch) {
      return ch >= ' ' && ch < 127;
    })) << message;
  }
}

// Claim: every cut of a real scene file is an Error, and no cut or flipped byte crashes. Source: the scene
// itself. Fails if close() pops a stack that open() did not push, or if a value is used before its kind is
// checked.
TEST(SceneBrokenFiles, EveryCutIsAnError) {
  std::ifstream in(std::string(OPALINE_SCENES_DIR) + "/sphere.json");
  const std::string text((std::istreambuf_iterator<char>(in)), {});
  ASSERT_GT(text.size(), 500u);
  const std::size_t end = text.rfind('}');
  for (std::size_t n = 0; n <= end; ++n) error_of(text.substr(0, n));
  for (std::size_t i = 0; i < text.size(); ++i) {
    std::string flipped = text;
    flipped[i] = static_cast<char>(flipped[i] ^ 0x15);
    try {
      parse(flipped);
    } catch (const Error& error) {
      EXPECT_EQ(error.kind, ErrorKind::bad_input);
    }
  }
}

// Claim: a message is one short line for any names in the file. Source: opaline/error.h.
// Fails if `printable` is dropped from ObjectReader's or Value::fail's message.
TEST(SceneBrokenFiles, MessagesStayShort) {
  const std::string name(1 << 20, 'x');
  for (const std::string& text :
       {"{\"" + name + "\": 1}", "{\"media\": {\"" + name + "\": {}}}",
        "{\"film\": {\"filter\": \"" + name + "\"}}", std::string("{\"a\\n\\u0007\": 1}")}) {
    const std::string message = error_of(text).what();
    EXPECT_LT(message.size(), 400u);
    EXPECT_EQ(message.find('\n'), std::string::npos);
  }
}

class SceneFiles : public testing::Test {
 protected:
  std::string write(const std::string& name, const std::string& bytes) const {
    std::ofstream(folder_ / name, std::ios::binary) << bytes;
    return (folder_ / name).string();
  }

  const ScratchFolder scratch_;
  const fs::path& folder_ = scratch_.path;
};

void expect_load_error(const std::string& path, const std::string& fragment) {
  try {
    load_scene(path);
    ADD_FAILURE() << "no error for " << path;
  } catch (const Error& error) {
    EXPECT_EQ(error.kind, ErrorKind::bad_input);
    EXPECT_EQ(error.file, path);
    expect_fragments(error, {fragment});
  }
}

// Claim: a file that cannot be a scene is refused by name. Source: load_scene.h.
// Fails if read_text takes more than 64 MiB, or opens a folder like a file.
TEST_F(SceneFiles, AreRefusedByName) {
  expect_load_error((folder_ / "missing.json").string(), "no such scene file");
  expect_load_error(folder_.string(), "is a folder");
  expect_load_error(write("empty.json", ""), "empty");
  expect_load_error(write("cut.json", "{\"film\":"), "cut.json:1:9: broken JSON");
  expect_load_error(write("mesh.txt", "v 0 0 0\n"),
                    "with a name that ends in .glb, .gltf, .obj, .ply, .stl or .off");
  const std::string large = write("large.json", "{}");
  fs::resize_file(large, (std::uintmax_t{64} << 20) + 1);
  expect_load_error(large, "64 MiB");
}

// Claim: relative mesh paths start at the scene's folder, absolute ones are kept. Source: scenes/README.md.
// Fails if read_mesh_file does not put the folder in front.
TEST_F(SceneFiles, MeshPathsStartAtTheScene) {
  const Scene scene =
      load_scene(write("a.json", R"({"shapes": [{"file": "x/b.obj"}, {"file": "/y/c.ply"}]})"));
  EXPECT_EQ(std::get<MeshFile>(scene.shapes[0].source).path, (folder_ / "x/b.obj").string());
  EXPECT_EQ(std::get<MeshFile>(scene.shapes[1].source).path, "/y/c.ply");
  EXPECT_EQ(std::get<MeshFile>(parse(R"({"shapes": [{"file": "b.obj"}]})").shapes[0].source).path, "b.obj");
}

// Claim: more values than the limit are refused, so memory is bounded. Source: json_tree.h, max_values.
// Fails if TreeBuilder::add does not count.
TEST(SceneBrokenFiles, TooManyValues) {
  std::string text = "{\"film\": [0";
  for (int i = 0; i < 1000000; ++i) text += ",0";
  expect_fragments(error_of(text + "]}"), {"too many values", "1000000"});
}

}  // namespace
}  // namespace opaline
