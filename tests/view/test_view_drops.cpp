// SPDX-License-Identifier: GPL-3.0-or-later
// Files uploaded by a page, without a browser: opened, or refused with nothing left.
#include "../support/pictures.h"
#include "view_client.h"

namespace opaline {
namespace {

using namespace test;

bool contains(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

constexpr const char* kTetrahedron =
    "mtllib a.mtl\nv 0 0 0\nv 20 0 0\nv 0 20 0\nv 0 0 20\nusemtl red\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n";

/// A view whose folder of dropped files is beside its scene.
struct ViewDrops : ::testing::Test {
  ViewFolder folder;
  const std::string dropped = folder.file("dropped");
  std::optional<RunningView> view{std::in_place, folder.scene};

  int put(const std::string& address, const std::string& bytes, const std::string& origin = "own") {
    return status_of("PUT", address, "Content-Length: " + std::to_string(bytes.size()) + "\r\n", bytes,
                     origin);
  }
  int status_of(const std::string& method, const std::string& address, const std::string& headers,
                const std::string& body, const std::string& origin = "own") {
    const std::string own = "http://" + view->host();
    return http_status(
        view->port(),
        {method, "/" + std::string(kToken) + address,
         "Host: " + view->host() + "\r\nOrigin: " + (origin == "own" ? own : origin) + "\r\n" + headers,
         body});
  }
  void drop(const std::string& number, const std::vector<std::string>& files) {
    for (std::size_t i = 0; i < files.size(); ++i)
      EXPECT_EQ(put("/dropped/" + number + "/" + std::to_string(i), files[i]), 200);
  }
  std::vector<std::string> left() const {
    std::vector<std::string> files;
    std::error_code vanished;  // by the server meanwhile
    for (std::filesystem::recursive_directory_iterator entry(dropped, vanished), end;
         !vanished && entry != end; entry.increment(vanished))
      if (entry->is_regular_file(vanished))
        files.push_back(std::filesystem::relative(entry->path(), dropped, vanished).string());
    std::ranges::sort(files);
    return files;
  }
};

// Claim: an asset with a material file in another folder replaces the scene, its edits begin anew, a saved scene stands
// beside it, and the same asset dropped again has a folder of its own. Fails if names are flattened, if edits of the
// old scene stay, or if files are overwritten.
TEST_F(ViewDrops, AnAssetReplacesTheScene) {
  ViewClient page(*view);
  ASSERT_TRUE(page.read_final());
  page.set({{"media.stone.specular_ior", 1.4}});
  ASSERT_TRUE(page.read_final(2));
  drop("17", {kTetrahedron, "newmtl red\nKd 0.8 0.1 0.1\n"});
  page.send({{"do", "open"}, {"drop", "17"}, {"names", {"box/a.obj", "box/a.mtl"}}});
  EXPECT_TRUE(contains(page.read_answer(), "opened " + dropped + "/a/box/a.obj"));
  ASSERT_TRUE(page.read_final(3));
  const Json& scene = page.texts.at("scene");
  EXPECT_EQ(scene.at("file"), "a.obj");
  EXPECT_EQ(scene.at("edits"), Json::array());
  EXPECT_FALSE(scene.at("undo"));
  const Json colour = scene.at("scene").at("shapes").at(0).at("reflectance");
  EXPECT_GT(colour.at(0).get<double>(), 4 * colour.at(1).get<double>()) << colour;
  page.send({{"do", "save"}, {"name", "b.json"}});
  EXPECT_TRUE(contains(page.read_answer(), "saved " + dropped + "/a/box/b.json"));
  EXPECT_NO_THROW(load_scene(dropped + "/a/box/b.json"));

  drop("18", {kTetrahedron});
  page.send({{"do", "open"}, {"drop", "18"}, {"names", {"a.obj"}}});
  EXPECT_TRUE(contains(page.read_answer(), "opened " + dropped + "/a-2/a.obj"));
  ASSERT_TRUE(page.read_final(4));
  EXPECT_EQ(left(), (std::vector<std::string>{"a-2/a.obj", "a/box/a.mtl", "a/box/a.obj", "a/box/b.json"}));
}

// Claim: lat-long images beside the scene, and in a folder beside it, are offered; one replaces the lights as an edit; no other file
// can be named. Fails if: renders are offered, or a page reads any file of the machine.
TEST_F(ViewDrops, EnvironmentsBesideTheSceneAreOffered) {
  const auto white = [](int, int) { return std::array<double, 3>{1, 1, 1}; };
  std::filesystem::create_directories(folder.file("maps/deeper"));
  put_exr(folder.file("maps/sky.exr"), 8, 4, white);
  put_exr(folder.file("maps/deeper/far.exr"), 8, 4, white);
  put_exr(folder.file("render.exr"), 8, 8, white);
  view.reset();
  view.emplace(folder.scene);
  ViewClient page(*view);
  ASSERT_TRUE(page.read_final());
  const nlohmann::json& scene = page.texts.at("scene");
  const auto& offered = scene.at("environments");
  EXPECT_NE(std::ranges::find(offered, "maps/sky.exr"), offered.end()) << offered;
  for (const char* name : {"render.exr", "maps/deeper/far.exr"}) {
    EXPECT_EQ(std::ranges::find(offered, name), offered.end()) << offered;
    page.send({{"do", "light_by"}, {"name", name}});
    EXPECT_TRUE(contains(page.read_answer(), "no environment map of this name is offered"));
  }
  page.send({{"do", "light_by"}, {"name", "maps/sky.exr"}});
  ASSERT_TRUE(page.read_final(2));
  const auto& lights = page.texts.at("scene").at("scene").at("lights");
  ASSERT_EQ(lights.size(), 1u);
  EXPECT_EQ(lights.at(0).at("type"), "environment");
}

// Claim: an environment map replaces the lights as an edit: undone, and saved in a scene that opens. Fails if it is no
// step of undo, or if the rule against edits of files refuses it.
TEST_F(ViewDrops, AnEnvironmentMapReplacesTheLights) {
  ViewClient page(*view);
  ASSERT_TRUE(page.read_final());
  const std::string map = folder.file("map.exr");
  put_exr(map, 8, 4, [](int, int) { return std::array<double, 3>{1, 1, 1}; });
  drop("3", {bytes_of(map)});
  page.send({{"do", "open"}, {"drop", "3"}, {"names", {"sky.exr"}}});
  EXPECT_TRUE(contains(page.read_answer(), "opened " + dropped + "/sky/sky.exr"));
  ASSERT_TRUE(page.read_final(2));
  const auto lights = [&] { return page.texts.at("scene").at("scene").at("lights"); };
  ASSERT_EQ(lights().size(), 1u);
  EXPECT_EQ(lights().at(0).at("type"), "environment");
  page.set({{"lights.environment.strength", 2}});
  ASSERT_TRUE(page.read_final(3));
  page.send({{"do", "save"}, {"name", "lit.json"}});
  EXPECT_TRUE(contains(page.read_answer(), "saved"));
  EXPECT_EQ(load_scene(folder.file("lit.json")).lights.size(), 1u);
  page.send({{"do", "undo"}});
  page.send({{"do", "undo"}});
  ASSERT_TRUE(page.read_final(5));
  EXPECT_EQ(lights().size(), 3u);
}

// Claim: uploads without the page's Origin or a length, out of bounds, and drops that cannot be opened are refused; the
// scene and other files stay, and no dropped file is left. Fails if a name leads out of its folder.
TEST_F(ViewDrops, BadOnesAreRefused) {
  ViewClient page(*view);
  ASSERT_TRUE(page.read_final());
  EXPECT_EQ(put("/dropped/1/0", "x", "http://evil.example"), 403);
  EXPECT_EQ(put("/dropped/1/0", "x", ""), 403);
  EXPECT_EQ(put("/main.js", "x"), 404);
  EXPECT_EQ(status_of("GET", "/", "Content-Length: 1\r\n", "x"), 400);
  EXPECT_EQ(status_of("PUT", "/dropped/1/0", "Content-Length: 2147483649\r\n", ""), 400);
  EXPECT_EQ(status_of("PUT", "/dropped/1/0", "Transfer-Encoding: chunked\r\n", "1\r\nx\r\n0\r\n\r\n"), 411);
  for (const char* address : {"/dropped/", "/dropped/1", "/dropped/1/256", "/dropped/1/x", "/dropped/../0",
                              "/dropped/1/-1", "/dropped/1/99999999999999999999"})
    EXPECT_EQ(put(address, "x"), 400) << address;
  EXPECT_EQ(left(), std::vector<std::string>{});

  const auto refuses = [&](const std::vector<std::string>& names, const std::string& why,
                           const std::string& bytes = kTetrahedron) {
    drop("5", std::vector<std::string>(names.size(), bytes));
    page.send({{"do", "open"}, {"drop", "5"}, {"names", names}});
    EXPECT_TRUE(contains(page.read_answer(), why)) << page.texts["told"];
    EXPECT_FALSE(page.texts["told"].at("good"));
  };
  for (const char* name : {"../a.obj", "/a.obj", ".a.obj", "b/../a.obj", "", "b//../../a.obj", "a\n.obj",
                           "1/2/3/4/5/6/7/8/a.obj"})
    refuses({name}, "invalid name");
  refuses({std::string(201, 'a') + ".obj"}, "invalid name");
  refuses({"a.obj", "b.obj"}, "several assets");
  refuses({"a.txt"}, "nothing to open");
  refuses({"a.obj"}, "a.obj", "v 0 0 nan\n");
  refuses({"a.exr"}, "a.exr", "no picture");
  page.send({{"do", "open"}, {"drop", "6"}, {"names", {"a.obj"}}});
  EXPECT_TRUE(contains(page.read_answer(), "incomplete"));
  drop("7", {kTetrahedron});
  page.send({{"do", "open"}, {"drop", "7"}, {"names", {"a.obj", "a.mtl"}}});
  EXPECT_TRUE(contains(page.read_answer(), "incomplete"));
  drop("8", {kTetrahedron});
  EXPECT_EQ(put("/dropped/8/0", kTetrahedron), 400);  // again
  Connection broken(view->port());
  const std::string head = "PUT /" + std::string(kToken) + "/dropped/9/0 HTTP/1.1\r\nHost: " + view->host() +
                           "\r\nOrigin: http://" + view->host() +
                           "\r\nContent-Length: 100000\r\n\r\nv 0 0 0\n";
  broken.write(head);
  while (left().empty()) std::this_thread::sleep_for(std::chrono::milliseconds(1));
  page.send({{"do", "open"}, {"drop", "9"}, {"names", {"half.obj"}}});
  EXPECT_TRUE(contains(page.read_answer(), "incomplete"));
  EXPECT_EQ(page.revision(), 1u);
  view.reset();
  EXPECT_EQ(left(), std::vector<std::string>{});
  EXPECT_FALSE(std::filesystem::exists(dropped));
  EXPECT_EQ(folder.entries(), 1u);
}

}  // namespace
}  // namespace opaline
