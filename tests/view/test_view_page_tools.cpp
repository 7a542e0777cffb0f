// SPDX-License-Identifier: GPL-3.0-or-later
// Tools of the page in a real browser: handles, numbers and framing of a shape, snapshots, stored views, names, floor, keys.
#include "../support/scenes.h"
#include "view_page.h"

namespace opaline {
namespace {

using namespace test;

/// The page with a shape selected, and its handles.
struct LongViewTools : LongViewPage {
  LongViewTools() { final_edits(); }

  void click_shape(double across, double below) {
    const auto [x, y, width, height] = box("#picture");
    browser.drag(tab, x + across * width, y + below * height, 0, 0);
  }
  void select_right() {
    click_shape(.63, .5);
    EXPECT_TRUE(browser.comes_true(tab, "!document.querySelector('.gizmo').hasAttribute('hidden')"));
  }
  /// A point on the line of a handle, as a fraction of its length.
  std::array<double, 2> on_handle(const std::string& axis, double fraction) {
    return browser
        .run(tab, "(() => { const line = document.querySelector('.gizmo ." + axis +
                      " .grip'), overlay = document.getElementById('overlay').getBoundingClientRect(); "
                      "const at = line.getPointAtLength(" +
                      std::to_string(fraction) +
                      " * line.getTotalLength()); return [overlay.left + at.x, overlay.top + at.y]; })()")
        .get<std::array<double, 2>>();
  }
  std::vector<std::string> drag_handle(const std::string& axis, double fraction, double dx, double dy) {
    const auto [x, y] = on_handle(axis, fraction);
    browser.drag(tab, x, y, dx, dy);
    return final_edits(revision + 1);
  }
  Transform right_of(const std::vector<std::string>& edits) {
    return load_scene(folder.scene, edits).shapes[1].to_world;
  }
  Camera camera_now() { return load_scene(folder.scene, look).camera; }
};

// Claim: F shows the clicked shape where it is, from the direction of before, and without one everything but the flat floor; the
// scene keeps its camera. Fails if the bounds are those before the transform, or if the floor counts.
TEST_F(LongViewTools, FrameSelected) {
  const Camera before = load_scene(folder.scene).camera;
  select_right();
  browser.key(tab, "f");
  EXPECT_TRUE(final_edits(revision + 1).empty());
  const Camera one = camera_now();
  EXPECT_NEAR(length(one.look_at - Vec3d{15, 10, 0}), 0, .05);
  EXPECT_NEAR(dot(normalized(one.look_at - one.position), normalized(before.look_at - before.position)), 1,
              1e-6);
  const double fills = 10 / (length(one.look_at - one.position) * std::tan(16 * kPi / 180));
  EXPECT_GT(fills, .6);
  EXPECT_LT(fills, 1);
  expect_shown(rendered(folder.scene, look));
  browser.key(tab, "Escape");
  EXPECT_TRUE(browser.comes_true(tab, "document.querySelector('.gizmo').hasAttribute('hidden')"));
  browser.key(tab, "f");
  EXPECT_TRUE(final_edits(revision + 1).empty());
  EXPECT_NEAR(length(camera_now().look_at - Vec3d{0, 10, 0}), 0, .05);
  EXPECT_GT(length(camera_now().look_at - camera_now().position), length(one.look_at - one.position));
}

// Claim: a drag of an axis moves the shape along it, as far as the pointer, and nowhere else, as one step of undo; arrow
// keys move it, too. Fails if a drag is many steps, or if the handle leaves the pointer.
TEST_F(LongViewTools, HandlesMoveTheShape) {
  select_right();
  const std::array<double, 2> before = on_handle("x", 1);
  std::vector<std::string> edits = drag_handle("x", .8, 70, 10);
  ASSERT_EQ(edits.size(), 1u);
  EXPECT_TRUE(edits[0].starts_with("shapes.right.transform=[{\"translate\"")) << edits[0];
  const Vec3d moved = right_of(edits).translation;
  EXPECT_GT(moved.x, 18);
  EXPECT_NEAR(moved.y, 10, 1e-9);
  EXPECT_NEAR(moved.z, 0, 1e-9);
  expect_shown(rendered(folder.scene, edits));
  EXPECT_NEAR(on_handle("x", 1)[0], before[0] + 70, 6);
  edits = drag_handle("all", 0, 0, -40);
  EXPECT_GT(right_of(edits).translation.y, 12);
  const double z = right_of(edits).translation.z;
  browser.run(tab, "document.querySelector('.gizmo .z').focus()");
  browser.key(tab, "ArrowDown");
  edits = final_edits(revision + 1);
  EXPECT_LT(right_of(edits).translation.z, z - 1);
  for (int i = 0; i < 3; ++i) {
    browser.key(tab, "z", 2);
    edits = final_edits(revision + 1);
  }
  EXPECT_TRUE(edits.empty());
  EXPECT_EQ(browser.run(tab, "document.getElementById('undo').disabled"), true);
}

// Claim: rings turn the shape about its middle, by the angle of the drag, and the scale's handles scale it there, along one axis or all.
// Fails if the middle moves, or if the ring turns against the pointer.
TEST_F(LongViewTools, HandlesTurnAndScale) {
  select_right();
  browser.key(tab, "e");
  std::vector<std::string> edits = drag_handle("y", .05, 60, 0);
  Transform placed = right_of(edits);
  EXPECT_NEAR(length(placed.translation - Vec3d{15, 10, 0}), 0, .01);
  EXPECT_NEAR(placed.y.y, 1, 1e-5);
  EXPECT_LT(std::abs(placed.x.x), .99);
  EXPECT_LT(placed.x.z, 0);  // the front goes to the right
  browser.key(tab, "r");
  edits = drag_handle("all", 0, 30, 0);
  placed = right_of(edits);
  const double size = length(placed.x);
  EXPECT_GT(size, 1.1);
  EXPECT_NEAR(length(placed.y), size, 1e-5);
  EXPECT_NEAR(length(placed.translation - Vec3d{15, 10, 0}), 0, .01);
  edits = drag_handle("y", 1, 0, -25);
  placed = right_of(edits);
  EXPECT_GT(length(placed.y), size + .1);
  EXPECT_NEAR(length(placed.x), size, 1e-5);
  EXPECT_NEAR(length(placed.translation - Vec3d{15, 10, 0}), 0, .02);
  expect_shown(rendered(folder.scene, edits));
}

// Claim: numbers place a shape: its steps keep their order. Fails if a number makes a second translation.
TEST_F(LongViewTools, NumbersPlaceTheShape) {
  type("shapes.right.transform.translate", "translate x", "20");
  EXPECT_EQ(final_edits(revision + 1).back(), R"(shapes.right.transform=[{"translate": [20, 10, 0]}])");
  type("shapes.right.transform.rotate", "rotate y", "30");
  type("shapes.right.transform.scale", "scale z", "2");
  std::vector<std::string> edits = final_edits(revision + 2);
  ASSERT_EQ(edits.size(), 1u);
  const Transform placed = right_of(edits);
  EXPECT_NEAR(placed.x.x, std::cos(kPi / 6), 1e-9);
  EXPECT_NEAR(length(placed.z), 2, 1e-9);
  EXPECT_EQ(placed.translation, (Vec3d{20, 10, 0}));
  type("shapes.right.transform.rotate", "rotate y", "0");
  type("shapes.left.transform.translate", "translate y", "3");
  edits = final_edits(revision + 2);
  EXPECT_EQ(edits.back(), R"(shapes.left.transform=[{"translate": [0, 3, 0]}])");
  expect_shown(rendered(folder.scene, edits));
}

// Claim: a snapshot shows its image on either side of the wipe without a render, and a click brings its edits and camera
// back, as a step of undo; of more than twelve the oldest goes. Fails if the kept image is the newest one.
TEST_F(LongViewTools, Snapshots) {
  const auto press = [&](int number, const std::string& side) {
    browser.run(tab, "document.querySelector('[aria-label=\"Snapshot " + std::to_string(number) + " on the " +
                         side + " of the wipe\"]').click()");
  };
  const std::string pixels = "(id => document.getElementById(id).toDataURL())";
  const Json first = browser.run(tab, pixels + "('picture')");
  browser.key(tab, "s");
  type("lights.key.intensity", "intensity red", "300000");
  const std::vector<std::string> edits = final_edits(revision + 1);
  const Json second = browser.run(tab, pixels + "('picture')");
  click("snapshot");
  browser.drag(tab, middle("#picture")[0], middle("#picture")[1], 60, 0);
  final_edits(revision + 1);
  press(1, "left");
  press(2, "right");
  EXPECT_EQ(browser.run(tab, pixels + "('pinned')"), first);
  EXPECT_EQ(browser.run(tab, pixels + "('picture')"), second);
  press(2, "left");
  EXPECT_EQ(browser.run(tab, pixels + "('pinned')"), second);
  browser.run(tab, "document.querySelector('#snapshots .restore').click()");
  EXPECT_TRUE(final_edits(revision + 2).empty());
  EXPECT_TRUE(look.empty());
  expect_shown(rendered(folder.scene));
  click("undo");
  EXPECT_EQ(final_edits(revision + 1), edits);
  for (int i = 0; i < 13; ++i) click("snapshot");
  EXPECT_EQ(browser.run(tab, "document.querySelectorAll('#snapshots figure').length"), 12);
  EXPECT_EQ(browser.run(tab, "document.querySelector('#snapshots b').textContent"), "4");
}

// Claim: the size of a shape in mm scales the scene; a link holds the edits and the camera. By hand: a ball of 20 units at 40 mm
// has 2 mm a unit. Fails if the size of another shape counts, or if the link loses the camera.
TEST_F(LongViewTools, SizeAndLink) {
  type("shapes.1.size", "size", "40");
  std::vector<std::string> edits = final_edits(revision + 1);
  ASSERT_EQ(edits.size(), 1u);
  EXPECT_NEAR(load_scene(folder.scene, edits).mm_per_unit, 2, .01);
  browser.drag(tab, middle("#picture")[0], middle("#picture")[1], 60, -25);
  final_edits(revision + 1);
  const Camera linked = camera_now();
  click("link");
  const std::string told = "document.getElementById('told').textContent";
  ASSERT_TRUE(browser.comes_true(tab, told + ".includes('#')"));
  const std::string link = browser.run(tab, told + ".replace(/.*http/, 'http')").get<std::string>();
  click("reset");
  click("look-back");
  EXPECT_TRUE(final_edits(revision + 2).empty());
  browser.run(tab, "location.href = '" + link + "'; location.reload()");
  ASSERT_TRUE(browser.comes_true(tab, "document.getElementById('whose-camera')?.textContent === 'free'"));
  EXPECT_EQ(final_edits(revision + 1), edits);
  EXPECT_EQ(camera_now(), linked);
}

// Claim: the channel `error` is in false colours beside their legend: without an error the first of them, the background
// black. Fails if the error is shown as light.
TEST_F(LongViewTools, ErrorsInFalseColours) {
  browser.run(tab,
              "(() => { const field = document.getElementById('channel'); field.value = 'error'; "
              "field.onchange(); })()");
  EXPECT_EQ(browser.run(tab, "document.getElementById('legend').textContent.startsWith('0.1 %')"), true);
  const std::string pixels =
      "(() => { const picture = document.getElementById('picture'), counts = {}; "
      "const bytes = picture.getContext('2d').getImageData(0, 0, picture.width, picture.height).data; "
      "for (let i = 0; i < bytes.length; i += 4) { const key = bytes.slice(i, i + 3).join(); "
      "counts[key] = (counts[key] || 0) + 1; } return counts; })()";
  ASSERT_TRUE(browser.comes_true(tab, pixels + "['13,20,90'] > 0"));
  const Json counts = browser.run(tab, pixels);
  EXPECT_GT(counts.value("0,0,0", 0), 20);
  EXPECT_GT(counts.size(), 20u);
}

// Claim: Shift and a digit store the free camera, the digit shows it again, also after the page was loaded anew. Fails if the scene's
// camera is stored, or if views are lost with the page.
TEST_F(LongViewTools, StoredViews) {
  const auto [x, y] = middle("#picture");
  browser.drag(tab, x, y, 60, -25);
  final_edits(revision + 1);
  const Camera stored = camera_now();
  browser.key(tab, "!", 8, "Digit1");
  browser.drag(tab, x, y, 60, 0);
  final_edits(revision + 1);
  EXPECT_NE(camera_now(), stored);
  browser.call(tab, "Page.reload", {});
  ASSERT_TRUE(browser.comes_true(tab, "document.querySelector('[aria-label=\"View 1\"]')"));
  browser.key(tab, "1", 0, "Digit1");
  EXPECT_TRUE(final_edits(revision + 1).empty());
  EXPECT_EQ(camera_now(), stored);
  expect_shown(rendered(folder.scene, look));
}

// Claim: a medium gets another name in its panel, which stays open; a refused name is replaced by the old one. A check box adds a
// floor, and takes it away. Fails if the panel closes, or if the field keeps the refused name.
TEST_F(LongViewTools, NamesAndFloor) {
  const auto rename = [&](const std::string& name, const std::string& to) {
    browser.run(tab, "(() => { const field = document.querySelector('[aria-label=\"media." + name +
                         " name\"]'); field.closest('details').open = true; field.value = '" + to +
                         "'; field.dispatchEvent(new Event('change')); })()");
  };
  rename("stone", "gneiss");
  std::vector<std::string> edits = final_edits(revision + 1);
  EXPECT_EQ(load_scene(folder.scene, edits).media.at(0).name, "gneiss");
  expect_shown(rendered(folder.scene, edits));
  EXPECT_EQ(browser.run(tab, "document.querySelector('[data-group=\"media.gneiss\"]').open"), true);
  rename("gneiss", "a b");
  EXPECT_TRUE(
      browser.comes_true(tab, "document.getElementById('told').textContent.includes('not a valid name')"));
  EXPECT_TRUE(browser.comes_true(
      tab, "document.querySelector('[aria-label=\"media.gneiss name\"]').value === 'gneiss'"));
  const std::string floor = "document.querySelector('[aria-label=\"floor\"]')";
  browser.run(tab, floor + ".click()");
  edits = final_edits(revision + 1);
  EXPECT_EQ(load_scene(folder.scene, edits).shapes.size(), 4u);
  expect_shown(rendered(folder.scene, edits));
  EXPECT_EQ(browser.run(tab, floor + ".checked"), true);
  browser.run(tab, floor + ".click()");
  EXPECT_EQ(load_scene(folder.scene, final_edits(revision + 1)).shapes.size(), 3u);
}

// Claim: "Set key here" makes the free camera a key of the scene's at the shown frame, and other frames stay. Fails if it is there in
// a scene without frames, or if the camera of all frames changes.
TEST(LongViewKeys, TheCameraGetsAKey) {
  const ViewFolder folder;
  const RunningView view(folder.scene, 0, {1, 2, 3, 4, 5});
  PageHands hands;
  hands.tab = hands.browser.open(view.url());
  ViewClient page(view);
  ASSERT_TRUE(hands.browser.comes_true(hands.tab, kIsFinal + "1"));
  const auto key_at = [&](int frame, double dx) {
    hands.browser.run(hands.tab,
                      "(() => { const field = document.getElementById('playhead'); field.value = " +
                          std::to_string(frame - 1) + "; field.dispatchEvent(new Event('input')); })()");
    const auto [x, y] = hands.middle("#picture");
    hands.browser.drag(hands.tab, x, y, dx, 0);
    ASSERT_TRUE(hands.browser.comes_true(hands.tab, "!document.getElementById('key-look').disabled"));
    hands.click("key-look");
    ASSERT_TRUE(hands.browser.comes_true(hands.tab, "document.getElementById('key-look').disabled"));
  };
  key_at(1, 40);
  key_at(5, 40);
  ASSERT_TRUE(page.read_until([&] {
    return page.texts.contains("scene") && page.texts["scene"].at("edits").size() == 2 &&
           page.texts["scene"].at("look").is_null();
  }));
  const auto edits = page.texts["scene"].at("edits").get<std::vector<std::string>>();
  const auto camera = [&](int frame) { return load_scene(folder.scene, edits, frame).camera; };
  EXPECT_GT(length(camera(5).position - camera(1).position), 5);
  EXPECT_NEAR(length(camera(3).position - .5 * (camera(1).position + camera(5).position)), 0, 1e-9);
  EXPECT_EQ(camera(5).look_at, (Vec3d{0, 8, 0}));
  EXPECT_TRUE(hands.browser.problems.empty());
}

}  // namespace
}  // namespace opaline
