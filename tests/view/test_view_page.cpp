// SPDX-License-Identifier: GPL-3.0-or-later
// The real page in a real browser: what a person does there is what the scene becomes, and what the file holds.
#include <random>

#include "core/machine_memory.h"
#include "opaline/error.h"
#include "view_page.h"

namespace opaline {
namespace {

using namespace test;

// Claim: what is typed, dragged, turned and undone in the page is in the scene, and the picture on the canvas is the one
// of `opaline render` of it, in every view of film.view, to the byte that sRGB rounds to.
TEST_F(LongViewPage, EditsAreShown) {
  final_edits();
  expect_shown(rendered(folder.scene));
  const auto choose = [&](std::string_view name) {
    browser.run(tab, "(() => { const field = document.getElementById('transform'); field.value = '" +
                         std::string(name) + "'; field.dispatchEvent(new Event('change')); })()");
  };
  for (std::size_t v = 0; v < kViewNames.size(); ++v) {
    choose(kViewNames[v]);
    expect_shown(rendered(folder.scene), ViewTransform(v));
  }
  choose("soft");
  type("media.stone.specular_ior", "specular_ior", "1.35");
  EXPECT_EQ(final_edits(2), std::vector<std::string>{"media.stone.specular_ior=1.35"});
  expect_shown(rendered(folder.scene, {"media.stone.specular_ior=1.35"}));
  type("settings.laboratory.near_field", "near_field", "false");
  type("media.stone.profile", "profile", "better_dipole");
  type("lights.panel.radiance", "radiance green", "7");
  std::vector<std::string> edits = final_edits(5);
  EXPECT_EQ(edits.back(), "lights.panel.radiance=[5, 7, 5]");
  expect_shown(rendered(folder.scene, edits));

  const auto [x, y] = middle("#picture");
  browser.drag(tab, x, y, 50, 0, 1);  // Alt: the room, and its sun
  edits = final_edits(revision + 1);
  const auto sun_of = [&] {
    return normalized(std::get<DirectionalLight>(load_scene(folder.scene, edits).lights[2].source).direction);
  };
  EXPECT_GT(sun_of().x, .01);
  EXPECT_NEAR(sun_of().y, normalized(Vec3d{0, -2, -1}).y, 1e-5);
  expect_shown(rendered(folder.scene, edits));
  for (int i = 0; i < 2; ++i) {
    browser.key(tab, "z", 2);
    edits = final_edits(revision + 1);
  }
  EXPECT_EQ(edits.back(), "media.stone.profile=\"better_dipole\"");
  click("reset");
  EXPECT_TRUE(final_edits(revision + 1).empty());
  expect_shown(rendered(folder.scene));
}

// Claim: with parallel rays the wheel changes the height of the view, an edit of the scene, for a nearer camera would show the same; the lens's
// knobs set its values. Source: main.js, knobs.js. Fails if: the wheel does nothing that is seen, or a pair of numbers is no list.
TEST_F(LongViewPage, LensesAndParallelRays) {
  final_edits();
  const auto set = [&](const std::string& label, int field, const std::string& value) {
    browser.run(tab,
                "(() => { for (const d of document.querySelectorAll('details')) d.open = true; const input = "
                "document.querySelector('[aria-label^=\"" +
                    label + "\"]').querySelectorAll('input[type=number]')[" + std::to_string(field) +
                    "]; input.value = " + value + "; input.onchange(); })()");
    return final_edits(revision + 1);
  };
  EXPECT_EQ(set("camera.shift", 0, "0.25").back(), "camera.shift=[0.25, 0]");
  const std::vector<std::string> lens = set("camera.aperture", 0, "4");
  EXPECT_EQ(lens.back(), "camera.aperture=4");
  expect_shown(rendered(folder.scene, lens));
  ViewClient other(*view);
  other.set({{"camera.orthographic_height", 60}});
  final_edits(revision + 1);
  const auto [x, y] = middle("#picture");
  browser.mouse(tab, "mouseWheel", x, y, {{"deltaX", 0}, {"deltaY", -100}});
  const std::vector<std::string> nearer = final_edits(revision + 1);
  EXPECT_LT(*load_scene(folder.scene, nearer).camera.orthographic_height, 58);
  EXPECT_TRUE(look.empty());
  expect_shown(rendered(folder.scene, nearer));
}

// Claim: orbit, pan and dolly move a camera of the view's own: the picture is the one from there, and the edits, what
// is saved and Undo have the scene's, until a button makes it the scene's, by one step of Undo; another one goes back.
TEST_F(LongViewPage, TheCameraIsFree) {
  final_edits();
  const auto drag = [&](double dx, double dy, int modifiers = 0) {
    const auto [x, y] = middle("#picture");
    browser.drag(tab, x, y, dx, dy, modifiers);
    browser.run(tab, "new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(done)))");
  };
  drag(60, -25);
  EXPECT_TRUE(final_edits(2).empty());
  Camera camera = load_scene(folder.scene, look).camera;
  EXPECT_NEAR(length(camera.position - camera.look_at), length(Vec3d{0, 22, 120}), .01);
  EXPECT_GT(length(camera.position - Vec3d{0, 30, 120}), 5);
  EXPECT_EQ(camera.look_at, (Vec3d{0, 8, 0}));
  expect_shown(rendered(folder.scene, look));
  EXPECT_EQ(browser.run(tab, "document.getElementById('undo').disabled"), true);
  drag(40, 0, 8);  // Shift: pan
  final_edits(revision + 1);
  EXPECT_NE(load_scene(folder.scene, look).camera.look_at, (Vec3d{0, 8, 0}));
  const auto [x, y] = middle("#picture");
  browser.mouse(tab, "mouseWheel", x, y, {{"deltaX", 0}, {"deltaY", -100}});
  EXPECT_TRUE(final_edits(revision + 1).empty());
  camera = load_scene(folder.scene, look).camera;
  EXPECT_LT(length(camera.position - camera.look_at), length(Vec3d{0, 22, 120}) - 5);
  click("save");
  ASSERT_TRUE(browser.comes_true(
      tab, "document.getElementById('told').textContent.endsWith(\"with the scene camera\")"));
  EXPECT_EQ(bytes_of(folder.file("balls-edited.json")), bytes_of(folder.scene));
  click("look-back");
  EXPECT_TRUE(final_edits(revision + 1).empty());
  EXPECT_TRUE(look.empty());
  expect_shown(rendered(folder.scene));
  drag(60, -25);
  final_edits(revision + 1);
  camera = load_scene(folder.scene, look).camera;
  click("keep-look");
  const std::vector<std::string> kept = final_edits(revision + 1);
  ASSERT_EQ(kept.size(), 1u);  // look_at is as it was
  EXPECT_EQ(load_scene(folder.scene, kept).camera, camera);
  EXPECT_TRUE(look.empty());
  expect_shown(rendered(folder.scene, kept));
  EXPECT_EQ(browser.run(tab, "document.getElementById('keep-look').disabled"), true);
  click("undo");
  EXPECT_TRUE(final_edits(revision + 1).empty());
  expect_shown(rendered(folder.scene));
}

// Claim: a shape becomes translucent by a preset that the scene did not have, from the list or by its image, and opaque again; each is one step of
// undo. Source: knobs.js. Fails if: the surface of before stays in the way, or the medium is not added.
TEST_F(LongViewPage, ShapesChangeTheirMaterial) {
  final_edits();
  const auto choose = [&](const std::string& material) {
    browser.run(tab,
                "(() => { for (const d of document.querySelectorAll('details')) d.open = true; const s = "
                "document.querySelector('[aria-label=\"shapes.left.medium\"]'); s.value = '" +
                    material + "'; s.onchange(); })()");
    return final_edits(revision + 1);
  };
  std::vector<std::string> edits = choose("skin1");
  EXPECT_EQ(edits.back(), "shapes.left.medium=\"skin1\"");
  expect_shown(rendered(folder.scene, {R"(media.skin1={"preset": "skin1", "specular_roughness": 0.3})",
                                       "shapes.left.medium=skin1"}));
  browser.run(tab, "document.querySelector('[aria-label=\"shapes.left.medium jade\"]').click()");
  EXPECT_EQ(final_edits(revision + 1).back(), "shapes.left.medium=\"jade\"");
  expect_shown(rendered(folder.scene, {"media.jade.preset=jade", "shapes.left.medium=jade"}));
  EXPECT_EQ(choose("").back(), "shapes.left.reflectance=0.5");
  expect_shown(rendered(folder.scene, {"shapes.left.reflectance=0.5"}));
  EXPECT_EQ(choose("stone").back(), "shapes.left.medium=\"stone\"");
  for (int i = 0; i < 2; ++i) {
    browser.key(tab, "z", 2);
    edits = final_edits(revision + 1);
  }
  EXPECT_EQ(edits.back(), "shapes.left.medium=\"jade\"");
}

// Claim: an asset and its material file dropped onto the page are shown as rendered, and become translucent there. Fails if
// the names of the files are lost, or if the panel keeps the knobs of the scene before.
TEST_F(LongViewPage, DroppedAssetsAreShown) {
  final_edits();
  browser.run(tab, R"((() => { const dropped = new DataTransfer();
    const add = (name, text) => dropped.items.add(new File([text], name));
    add("box.obj", "mtllib box.mtl\nv 0 0 0\nv 20 0 0\nv 0 20 0\nv 0 0 20\nusemtl red\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n");
    add("box.mtl", "newmtl red\nKd 0.8 0.1 0.1\n");
    document.body.dispatchEvent(new DragEvent("drop", {dataTransfer: dropped, bubbles: true, cancelable: true})); })())");
  EXPECT_TRUE(browser.comes_true(tab, "document.getElementById('file').textContent === 'box.obj'"));
  final_edits(revision + 1);
  const std::string box = folder.file("dropped/box/box.obj");
  expect_shown(rendered(box));
  browser.run(tab, R"((() => { for (const d of document.querySelectorAll('details')) d.open = true;
    const s = document.querySelector('[aria-label$=".medium"]'); s.value = 'marble'; s.onchange(); })())");
  const std::vector<std::string> edits = final_edits(revision + 1);
  ASSERT_EQ(edits.size(), 2u);
  expect_shown(rendered(box, edits));
  EXPECT_EQ(browser.run(tab, "document.getElementById('name').value"), "box-edited");
}

// Claim: buttons add and remove a light, whose knobs appear and vanish. Fails if the panel keeps those of before.
TEST_F(LongViewPage, LightsComeAndGo) {
  final_edits();
  const auto press = [&](const std::string& text) {
    browser.run(tab, "[...document.querySelectorAll('#panel button')].filter((b) => b.textContent === '" +
                         text + "').pop().click()");
    final_edits(revision + 1);
  };
  const std::string groups = "document.querySelectorAll('[data-group^=\"lights.\"]').length";
  press("Add light");
  EXPECT_TRUE(browser.comes_true(tab, groups + " === 4"));
  press("Copy");
  EXPECT_TRUE(browser.comes_true(tab, groups + " === 5"));
  press("Remove");
  press("Remove");
  EXPECT_TRUE(browser.comes_true(tab, groups + " === 3"));
  expect_shown(rendered(folder.scene));
}

// Claim: one finger orbits, two fingers apart approach, together they pan; the keys are listed by "?". Fails if the second
// finger orbits, or if the first one jumps when the second is lifted.
TEST_F(LongViewPage, FingersMoveTheCamera) {
  final_edits();
  const auto [x, y] = middle("#picture");
  const auto touch = [&](const char* type, const std::vector<std::array<double, 2>>& points) {
    Json all = Json::array();
    for (std::size_t i = 0; i < points.size(); ++i)
      all.push_back({{"x", points[i][0]}, {"y", points[i][1]}, {"id", i}});
    browser.call(tab, "Input.dispatchTouchEvent", {{"type", type}, {"touchPoints", all}});
  };
  const auto camera_now = [&] {
    browser.run(tab, "new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(done)))");
    final_edits(revision + 1);
    return load_scene(folder.scene, look).camera;
  };
  const Camera before = load_scene(folder.scene).camera;
  touch("touchStart", {{x, y}});
  touch("touchMove", {{x + 40, y}});
  touch("touchEnd", {});
  const Camera orbited = camera_now();
  EXPECT_EQ(orbited.look_at, before.look_at);
  EXPECT_GT(length(orbited.position - before.position), 5);
  touch("touchStart", {{x - 30, y}, {x + 30, y}});
  touch("touchMove", {{x - 60, y}, {x + 60, y}});
  touch("touchEnd", {});
  const Camera nearer = camera_now();
  EXPECT_NEAR(length(nearer.position - nearer.look_at) / length(orbited.position - orbited.look_at), .5, .05);
  EXPECT_LT(length(nearer.look_at - orbited.look_at), 3);
  touch("touchStart", {{x - 30, y}, {x + 30, y}});
  touch("touchMove", {{x - 30, y + 40}, {x + 30, y + 40}});
  touch("touchEnd", {});
  const Camera panned = camera_now();
  EXPECT_GT(panned.look_at.y, nearer.look_at.y + 2);
  EXPECT_NEAR(length(panned.position - panned.look_at), length(nearer.position - nearer.look_at), .5);
  click("show-keys");
  EXPECT_EQ(browser.run(tab, "document.getElementById('keys').open"), true);
}

// Claim: a click on a shape opens its settings, a drag and a click beside all shapes open nothing. Fails if the pixel is
// mirrored, or if a drag counts as a click.
TEST_F(LongViewPage, AClickOpensTheShape) {
  final_edits();
  const auto is_open = [&](int shape) {
    return "document.querySelector('[data-group=\"shapes." + std::to_string(shape) + "\"]').open";
  };
  const auto [left, top, width, height] = box("#picture");
  const auto click_at = [&, x = left, y = top, w = width, h = height](double across, double below,
                                                                      double moved) {
    browser.drag(tab, x + across * w, y + below * h, moved, 0);
  };
  click_at(.5, .05, 0);
  click_at(.63, .5, 40);
  final_edits(revision + 1);
  for (int shape = 0; shape < 3; ++shape) EXPECT_EQ(browser.run(tab, is_open(shape)), false);
  click("look-back");
  final_edits(revision + 1);
  click_at(.63, .5, 0);
  EXPECT_TRUE(browser.comes_true(tab, is_open(1)));
  click_at(.37, .5, 0);
  EXPECT_TRUE(browser.comes_true(tab, is_open(0)));
  EXPECT_EQ(browser.run(tab, is_open(2)), false);
}

// Claim: a number that is refused is replaced by the accepted one at once, in its field, and the picture stays as it is.
// Fails if: what the page has changed goes before what the server tells of after it was refused.
TEST_F(LongViewPage, ARefusalRestores) {
  final_edits();
  const std::array<double, 4> before = box("#picture");
  const auto shows = [&](const std::string& path, const std::string& label, const std::string& value) {
    return browser.comes_true(tab, "document.querySelector('[aria-label^=\"" + path + ",\"] [aria-label=\"" +
                                       label + "\"]').value === '" + value + "'");
  };
  const auto is_told = [&](const std::string& text) {
    return browser.comes_true(tab, "document.getElementById('told').textContent.includes('" + text + "')");
  };
  type("film.resolution", "resolution width", "100000");
  EXPECT_TRUE(is_told("film.resolution"));
  EXPECT_NEAR(box("#picture")[3], before[3], 10);  // less the line that tells
  EXPECT_TRUE(shows("film.resolution", "resolution width", "48"));
  type("lights.sun.irradiance", "irradiance red", "-1");
  EXPECT_TRUE(is_told("irradiance"));
  EXPECT_TRUE(shows("lights.sun.irradiance", "irradiance red", "0.1"));
  type("camera.field_of_view", "field_of_view", "1000");
  EXPECT_TRUE(is_told("field_of_view"));
  EXPECT_TRUE(shows("camera.field_of_view", "field_of_view", "32"));
  EXPECT_TRUE(final_edits().empty());
}

// Claim: a light is moved by its handle, by mouse and keys, and its brightness by the wheel.
TEST_F(LongViewPage, LightsAreMoved) {
  final_edits();
  const auto [x, y] = middle("[data-path=\"lights.key\"] circle");
  browser.drag(tab, x, y, 50, 30);
  std::vector<std::string> edits = final_edits(2);
  const Vec3d moved = std::get<PointLight>(load_scene(folder.scene, edits).lights[0].source).position;
  EXPECT_GT(moved.x, 2);
  EXPECT_LT(moved.y, 98);
  browser.mouse(tab, "mouseWheel", middle("[data-path=\"lights.key\"] circle")[0],
                middle("[data-path=\"lights.key\"] circle")[1], {{"deltaX", 0}, {"deltaY", -100}});
  edits = final_edits(revision + 1);
  EXPECT_EQ(edits.back(), "lights.key.intensity=[33000, 22000, 11000]");
  browser.run(tab, "document.querySelector('[data-path=\"lights.panel\"]').focus()");
  browser.key(tab, "ArrowLeft");
  edits = final_edits(revision + 1);
  EXPECT_TRUE(edits.back().starts_with("lights.panel.corner=[-6")) << edits.back();
  expect_shown(rendered(folder.scene, edits));
}

// Claim: the inspector shows the picture's values, of the layer too, to four digits. Source: the halves of an EXR.
TEST_F(LongViewPage, InspectorShowsTheValues) {
  final_edits();
  Session session;
  session.edit(load_scene(folder.scene));
  const Image image = session.render().image;
  browser.run(tab,
              "(() => { const c = document.getElementById('channel'); c.value = 'diffuse'; "
              "c.dispatchEvent(new Event('change')); })()");
  browser.run(tab,
              "(() => { document.getElementById('x').value = 15; document.getElementById('y').value = 14; "
              "document.getElementById('y').dispatchEvent(new Event('input')); })()");
  ASSERT_TRUE(browser.comes_true(tab, "document.getElementById('values').textContent.includes('diffuse')"));
  std::istringstream text(
      browser.run(tab, "document.getElementById('values').textContent").get<std::string>());
  const auto expect_channels = [&](const std::vector<std::string>& names, double precision) {
    for (const std::string& name : names) {
      double value = -1;
      text >> value;
      const auto c = std::size_t(std::ranges::find(image.channels, name) - image.channels.begin());
      const double there = double(image.pixels[(14 * 48 + 15) * image.channels.size() + c]);
      EXPECT_GT(there, 0) << name;
      EXPECT_NEAR(value, there, precision * there) << name;
    }
  };
  std::string word;
  for (int i = 0; i < 4; ++i) text >> word;
  expect_channels({"R", "G", "B"}, 1e-3);
  text >> word >> word;
  EXPECT_EQ(word, "diffuse");
  expect_channels({"diffuse.R", "diffuse.G", "diffuse.B"}, 5.1e-4);
}

// Claim: the wipe shows the pinned picture on its left, and later ones on its right. Exposure changes both at once, and
// nothing on the server.
TEST_F(LongViewPage, WipeAndExposure) {
  final_edits();
  click("pin");
  type("lights.key.intensity", "intensity red", "300000");
  final_edits(2);
  const std::string red =
      "(id => document.getElementById(id).getContext('2d').getImageData(15, 14, 1, 1).data[0])";
  EXPECT_GT(browser.run(tab, red + "('picture')").get<int>(),
            browser.run(tab, red + "('pinned')").get<int>() + 10);
  EXPECT_EQ(browser.run(tab, "getComputedStyle(document.getElementById('pinned')).clipPath"),
            "inset(0px 50% 0px 0px)");
  const int before = browser.run(tab, red + "('pinned')");
  browser.run(tab,
              "(() => { const e = document.getElementById('exposure'); e.value = -2; e.dispatchEvent(new "
              "Event('input')); })()");
  EXPECT_LT(browser.run(tab, red + "('pinned')").get<int>(), before);
  EXPECT_EQ(final_edits(), std::vector<std::string>{"lights.key.intensity=[300000, 20000, 10000]"});
}

// Claim: what is saved is what is shown; a copied command renders it; a second page sees it.
TEST_F(LongViewPage, SaveAndSecondPage) {
  final_edits();
  type("media.stone.specular_ior", "specular_ior", "1.4");
  const std::vector<std::string> edits = final_edits(2);
  click("save");
  ASSERT_TRUE(browser.comes_true(tab, "document.getElementById('told').textContent.startsWith('saved')"));
  expect_shown(rendered(folder.file("balls-edited.json")));
  click("copy");
  ASSERT_TRUE(
      browser.comes_true(tab, "document.getElementById('told').textContent.includes('render with 1')"));
  const Tab second = browser.open(view->url());
  ASSERT_TRUE(browser.comes_true(second, kIsFinal + "2"));
  type("media.stone.specular_ior", "specular_ior", "1.2");
  final_edits(3);
  ASSERT_TRUE(browser.comes_true(second, kIsFinal + "3"));
  const std::string pixels = "document.getElementById('picture').toDataURL()";
  EXPECT_EQ(browser.run(tab, pixels), browser.run(second, pixels));
}

// Claim: a page that lost its server says so, and brings the next one at the same URL to the same scene.
TEST_F(LongViewPage, TheServerIsKilledAndBack) {
  loses_server = true;
  final_edits();
  type("media.stone.specular_ior", "specular_ior", "1.4");
  const std::vector<std::string> edits = final_edits(2);
  const std::uint16_t port = view->port();
  view.reset();
  ASSERT_TRUE(browser.comes_true(tab, "!document.getElementById('lost').hidden"));
  view.emplace(folder.scene, port);
  ASSERT_TRUE(browser.comes_true(tab, "document.getElementById('lost').hidden"));
  EXPECT_EQ(final_edits(2), edits);
  expect_shown(rendered(folder.scene, edits));
}

// Claim: after any of 1000 strokes, however fast, the final image is that of the scene they lead to, from the view's own
// camera, and neither the server (with this test in its process) nor the page takes more memory than after the first 100.
// Tolerance: a quarter, what heaps keep. Fails if: an update is lost, or images or steps of undo pile up.
TEST_F(LongViewPage, RandomStrokes) {
  final_edits();
  std::mt19937 random(7);
  const auto between = [&](double low, double high) {
    return std::uniform_real_distribution<>(low, high)(random);
  };
  const auto [x, y] = middle("#picture");
  std::vector<double> server_bytes, page_bytes;
  for (int round = 0; round < 20; ++round) {
    for (int i = 0; i < 50; ++i) switch (random() % 5) {
        case 0:
          browser.drag(tab, x, y, between(-90, 90), between(-40, 40), random() % 2 ? 8 : 0);
          break;
        case 1:
          type("media.stone.specular_ior", "specular_ior", std::to_string(between(1.1, 1.9)));
          break;
        case 2:
          type("lights.panel.radiance", "radiance blue", std::to_string(between(0, 20)));
          break;
        case 3:
          click(random() % 3 ? "undo" : "redo");
          break;
        default:
          type("lights.key.position", "position x", std::to_string(between(-80, 80)));
      }
    browser.run(tab, "new Promise((done) => setTimeout(done, 300))");  // the last stroke is on its way
    std::vector<std::string> overrides = final_edits();
    overrides.insert(overrides.end(), look.begin(), look.end());
    expect_shown(rendered(folder.scene, overrides));
    browser.call(tab, "HeapProfiler.collectGarbage", {});
    page_bytes.push_back(browser.call(tab, "Runtime.getHeapUsage", {}).at("usedSize"));
    server_bytes.push_back(double(resident_memory()));
  }
  EXPECT_LT(page_bytes.back(), 1.25 * page_bytes[1]);
  EXPECT_LT(server_bytes.back(), 1.25 * server_bytes[1]);
}

// Claim: everything that can be focused has a name; the page fits windows from 1280 x 720 to 4k with the picture in
// sight; it is light or dark as its reader prefers.
TEST_F(LongViewPage, NamesSizesAndThemes) {
  final_edits();
  browser.run(tab, "for (const d of document.querySelectorAll('details')) d.open = true");
  browser.call(tab, "Accessibility.enable", {});
  std::size_t focusable = 0;
  const Json tree = browser.call(tab, "Accessibility.getFullAXTree", {});
  for (const Json& node : tree.at("nodes")) {
    const auto is_focusable = [](const Json& property) {
      return property.at("name") == "focusable" && property.at("value").at("value") == true;
    };
    const Json properties = node.value("properties", Json::array());
    if (node.value("ignored", false) || !std::ranges::any_of(properties, is_focusable)) continue;
    ++focusable;
    EXPECT_NE(node.value("name", Json::object()).value("value", ""), "") << node.dump();
  }
  EXPECT_GT(focusable, 100u);
  for (const auto& [width, height] : {std::pair{1280, 720}, {1920, 1080}, {3840, 2160}, {390, 844}}) {
    const bool is_narrow = width < 700;  // the panel is below the image
    browser.resize(tab, width, height);
    browser.run(tab, "new Promise((done) => requestAnimationFrame(() => setTimeout(done, 100)))");
    EXPECT_LE(browser.run(tab, "document.documentElement.scrollWidth - innerWidth"), 0) << width;
    if (!is_narrow) {
      EXPECT_LE(browser.run(tab, "document.documentElement.scrollHeight - innerHeight"), 0);
    }
    const auto [x, y, w, h] = box("#picture");
    EXPECT_GT(w * h, .2 * width * height) << width;
    EXPECT_NEAR(w / h, 1.5, .02);
    EXPECT_LE(y + h, height) << width;
  }
  const std::string paper = "getComputedStyle(document.body).backgroundColor";
  std::vector<std::string> papers;
  for (const char* scheme : {"light", "dark"}) {
    browser.call(tab, "Emulation.setEmulatedMedia",
                 {{"features", {{{"name", "prefers-color-scheme"}, {"value", scheme}}}}});
    papers.push_back(browser.run(tab, paper));
  }
  EXPECT_NE(papers[0], papers[1]);
}

}  // namespace
}  // namespace opaline
