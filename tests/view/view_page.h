// SPDX-License-Identifier: GPL-3.0-or-later
// The page in a tab of the browser: what a person does there.
#pragma once

#include <cmath>

#include "browser.h"
#include "image/view_transform.h"

namespace opaline::test {

inline const std::string kIsFinal =
    "document.getElementById('error')?.dataset.revision == document.getElementById('step')?.dataset.revision "
    "&& "
    "document.getElementById('step')?.dataset.step === 'final' && "
    "Number(document.getElementById('step').dataset.revision) === ";

/// What a person does at a page, and sees there.
struct PageHands {
  Browser browser;
  Tab tab;

  /// Types a value into the field of a knob.
  void type(const std::string& path, const std::string& label, const std::string& value) {
    browser.run(tab, "(() => { const field = document.querySelector(`[aria-label^=\"" + path +
                         ",\"] [aria-label=\"" + label +
                         "\"]`); field.closest('details').open = true; "
                         "if (field.type === 'checkbox') field.checked = " +
                         value + " == 'true'; else field.value = '" + value +
                         "'; field.dispatchEvent(new Event('change')); })()");
  }
  void click(const std::string& id) { browser.run(tab, "document.getElementById('" + id + "').click()"); }
  std::array<double, 4> box(const std::string& selector) {
    const Json b =
        browser.run(tab, "(() => { const b = document.querySelector('" + selector +
                             "').getBoundingClientRect(); return [b.x, b.y, b.width, b.height]; })()");
    return b.get<std::array<double, 4>>();
  }
  std::array<double, 2> middle(const std::string& selector) {
    const auto [x, y, width, height] = box(selector);
    return {x + width / 2, y + height / 2};
  }

  /// Expects what the canvas shows to be the picture, as the view has it.
  void expect_shown(const std::vector<std::uint16_t>& picture, ViewTransform view_of = ViewTransform::soft) {
    const Json shown = browser.run(tab,
                                   "(() => { const picture = document.getElementById('picture'); return "
                                   "[...picture.getContext('2d').getImageData(0, 0, picture.width, "
                                   "picture.height).data]; })()");
    ASSERT_EQ(shown.size(), picture.size());
    double worst = 0;
    for (std::size_t i = 0; i < picture.size(); i += 4) {
      RgbF color;
      for (std::size_t c = 0; c < 3; ++c) {
        half value;
        value.setBits(picture[i + c]);
        color[c] = value;
      }
      color = shown_color(view_of, color);
      for (std::size_t c = 0; c < 3; ++c) {
        const double x = double(color[c]);
        const double srgb = x <= .0031308 ? 12.92 * x : 1.055 * std::pow(x, 1 / 2.4) - .055;
        worst = std::max(worst, std::abs(shown[i + c].get<double>() - 255 * srgb));
      }
    }
    EXPECT_LE(worst, .51);
  }
};

/// A view, and a tab of the browser that shows it.
struct LongViewPage : ::testing::Test, PageHands {
  ViewFolder folder;
  std::optional<RunningView> view{std::in_place, folder.scene};

  LongViewPage() { tab = browser.open(view->url()); }

  void TearDown() override {
    for (const std::string& problem : browser.problems) {
      const bool is_of_lost_server = problem.find("ERR_CONNECTION_REFUSED") != std::string::npos;
      EXPECT_TRUE(is_of_lost_server && loses_server) << problem;
    }
  }
  bool loses_server = false;

  /// The edits once the picture of all of them is there: known by another page, which speaks for the server.
  std::vector<std::string> final_edits(std::uint32_t least_revision = 1) {
    ViewClient page(*view);
    EXPECT_TRUE(page.read_final(least_revision));
    EXPECT_TRUE(browser.comes_true(tab, kIsFinal + std::to_string(page.revision())));
    revision = page.revision();
    const Json& scene = page.texts.at("scene");
    const Json& own = scene.at("look");
    look.clear();
    if (!own.is_null())
      look = {"camera.position=" + own.at("position").dump(), "camera.look_at=" + own.at("look_at").dump()};
    return scene.at("edits").get<std::vector<std::string>>();
  }
  std::uint32_t revision = 0;
  /// The view's own camera when final_edits was last called, as overrides of the scene's; empty: the view has none.
  std::vector<std::string> look;
};

}  // namespace opaline::test
