// SPDX-License-Identifier: GPL-3.0-or-later
// Files of the scene that change on the disk while they are shown.
#include "core/atomic_file.h"
#include "view_client.h"

namespace opaline {
namespace {

using namespace test;

void replace(std::string& text, const std::string& old, const std::string& now) {
  const std::size_t at = text.find(old);
  ASSERT_NE(at, std::string::npos) << old;
  text.replace(at, old.size(), now);
}

struct ViewReload : ::testing::Test {
  ViewFolder folder;
  std::string text = bytes_of(folder.scene), mesh = folder.file("ball.obj");

  ViewReload() {
    put_bytes(mesh, bytes_of(ball_file(10)));
    replace(text, ball_file(10), mesh);
    put_bytes(folder.scene, text);
  }
};

// Claim: a scene file written anew is shown with the page's edits, however it is written; a damaged one is reported and
// the scene stays; edits that no longer fit are reported. Fails if one of them is missed, or if edits are lost silently.
TEST_F(ViewReload, ChangedScenesAreShown) {
  const RunningView view(folder.scene);
  ViewClient page(view);
  ASSERT_TRUE(page.read_final());
  page.set({{"media.stone.specular_ior", 1.4}});
  ASSERT_TRUE(page.read_final(2));
  replace(text, "\"field_of_view\": 32", "\"field_of_view\": 40");
  put_bytes(folder.scene, text);
  ASSERT_TRUE(page.read_final(3));
  EXPECT_TRUE(page.frame.colours == rendered(folder.scene, {"media.stone.specular_ior=1.4"}));
  replace(text, "\"field_of_view\": 40", "\"field_of_view\": 50");
  write_file(folder.scene, text);  // by renaming another one
  ASSERT_TRUE(page.read_final(4));
  EXPECT_TRUE(page.frame.colours == rendered(folder.scene, {"media.stone.specular_ior=1.4"}));
  page.texts.erase("told");
  put_bytes(folder.scene, "{");
  ASSERT_TRUE(page.read_until([&] { return page.texts.contains("told"); }));
  EXPECT_FALSE(page.texts.at("told").at("good"));
  EXPECT_EQ(page.revision(), 4u);
  for (int i = 0; i < 3; ++i) replace(text, "stone", "rock");
  put_bytes(folder.scene, text);
  ASSERT_TRUE(page.read_final(5));
  EXPECT_FALSE(page.texts.at("told").at("good"));
  EXPECT_EQ(page.texts.at("scene").at("edits"), Json::array());
  EXPECT_TRUE(page.frame.colours == rendered(folder.scene));
  for (int i = 0; i < 3; ++i) replace(text, "rock", "stone");
  put_bytes(folder.scene, text);
  ASSERT_TRUE(page.read_final(6));
  page.send({{"do", "undo"}});
  ASSERT_TRUE(page.read_final(7));
  EXPECT_EQ(page.texts.at("scene").at("edits"), Json::array({"media.stone.specular_ior=1.4"}));
  page.send({{"do", "undo"}});
  ASSERT_TRUE(page.read_final(8));
  EXPECT_EQ(page.texts.at("scene").at("edits"), Json::array());
}

// Claim: a mesh written anew is shown, although the scene file is the same. Fails if the session's mesh is reused, or if the
// last image counts as one of an equal scene, as it may where rendering takes long.
TEST_F(ViewReload, ChangedMeshesAreShown) {
  replace(text, "\"resolution\": [48, 32]", "\"resolution\": [48, 32], \"samples_per_pixel\": 400");
  put_bytes(folder.scene, text);
  const RunningView view(folder.scene);
  ViewClient page(view);
  ASSERT_TRUE(page.read_final());
  const std::vector<std::uint16_t> before = page.frame.colours;
  put_bytes(mesh, bytes_of(ball_file(6)));
  ASSERT_TRUE(page.read_final(2));
  EXPECT_TRUE(page.frame.colours == rendered(folder.scene));
  EXPECT_FALSE(page.frame.colours == before);
}

// Claim: the shape at a pixel, by its index; none beside all. Fails if the crop is not added.
TEST_F(ViewReload, PixelsNameTheirShape) {
  replace(text, "\"resolution\": [48, 32]", "\"resolution\": [96, 64], \"crop\": [24, 16, 96, 64]");
  put_bytes(folder.scene, text);
  const RunningView view(folder.scene);
  ViewClient page(view);
  ASSERT_TRUE(page.read_final());
  const auto shape_at = [&](int x, int y) {
    page.texts.erase("picked");
    page.send({{"do", "pick"}, {"x", x - 24}, {"y", y - 16}});
    EXPECT_TRUE(page.read_until([&] { return page.texts.contains("picked"); }));
    return page.texts["picked"]["shape"];
  };
  EXPECT_EQ(shape_at(35, 32), 0);
  EXPECT_EQ(shape_at(61, 32), 1);
  EXPECT_EQ(shape_at(48, 50), 2);
  EXPECT_EQ(shape_at(48, 17), Json());
}

}  // namespace
}  // namespace opaline
