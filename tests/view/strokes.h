// SPDX-License-Identifier: GPL-3.0-or-later
// Random strokes at the page: knobs of every kind, the camera, lights and their handles, the room, frames, the way back.
#pragma once

#include <fmt/format.h>

#include <random>

#include "view_page.h"

namespace opaline::test {

/// Runs before the page's own script: notes what the page sends, and has the fields of knobs at hand.
inline constexpr const char* kStrokeScript = R"(
  window.sent = [];
  const send = WebSocket.prototype.send;
  WebSocket.prototype.send = function(text) {
    if (JSON.parse(text).do !== 'shown') window.sent.push(text);
    return send.call(this, text);
  };
  window.hand = {
    field: (path, label) => document.querySelector(`[aria-label^="${path},"] [aria-label="${label}"]`),
    type(field, value) {
      if (!field) return false;
      if (field.type === 'checkbox') field.checked = value;
      else field.value = value;
      field.dispatchEvent(new Event('change'));
      return true;
    },
    slide(field, values) {
      if (!field) return false;
      for (const value of values) {
        field.value = field.type === 'color' ? value : Number(field.min) + value * (field.max - field.min);
        field.dispatchEvent(new Event('input'));
      }
      field.dispatchEvent(new Event('change'));
      return true;
    },
  };
)";

class Strokes {
 public:
  Strokes(PageHands& hands, unsigned seed) : hands_(hands), random_(seed) {}

  /// Draws one and does it.
  void next() {
    using Stroke = std::string (Strokes::*)();
    static constexpr std::array<Stroke, 12> kStrokes{
        &Strokes::type_number, &Strokes::type_number,  &Strokes::type_one_of_three, &Strokes::slide,
        &Strokes::choose,      &Strokes::drag_picture, &Strokes::drag_picture,      &Strokes::drag_light,
        &Strokes::press_key,   &Strokes::turn_wheel,   &Strokes::step_back,         &Strokes::look};
    done.push_back((this->*kStrokes[pick(kStrokes.size())])());
  }

  /// A line each.
  std::vector<std::string> done;
  /// What the page must have sent for the values that were typed: path and JSON.
  std::vector<std::pair<std::string, Json>> typed;

 private:
  struct Number {
    const char *path, *key;
    double low, high;
    bool is_whole = false;
  };

  std::size_t pick(std::size_t count) { return random_() % count; }
  double between(double low, double high) {
    return std::round(1e4 * std::uniform_real_distribution<>(low, high)(random_)) / 1e4;
  }
  bool run(const std::string& script) { return hands_.browser.run(hands_.tab, script) == true; }
  static std::string field(const std::string& path, const std::string& label) {
    return fmt::format("hand.field('{}', '{}')", path, label);
  }

  std::string type_number() {
    static constexpr std::array<Number, 12> kNumbers{
        {{"media.stone.specular_ior", "specular_ior", 1.1, 1.9},
         {"media.stone.specular_roughness", "specular_roughness", 0, .6},
         {"lights.room.rotation", "rotation", -180, 180},
         {"lights.sun.angle", "angle", 0, 20},
         {"camera.field_of_view", "field_of_view", 20, 60},
         {"film.samples_per_pixel", "samples_per_pixel", 1, 3, true},
         {"settings.tolerance", "tolerance", .002, .05},
         {"settings.light_samples", "light_samples", 1, 6, true},
         {"settings.samples", "samples", 100, 1500, true},
         {"settings.bounces", "bounces", 0, 1, true},
         {"settings.laboratory.max_solid_angle", "max_solid_angle", .01, .2},
         {"settings.seed", "seed", 0, 5, true}}};
    const Number& number = kNumbers[pick(kNumbers.size())];
    double value = between(number.low, number.high);
    if (number.is_whole) value = std::round(value);
    if (run(fmt::format("hand.type({}, {})", field(number.path, number.key), value)))
      typed.emplace_back(number.path, value);
    return fmt::format("type {} = {}", number.path, value);
  }

  std::string type_one_of_three() {
    static constexpr std::array<Number, 9> kThrees{
        {{"lights.key.position", "position x", -80, 80},
         {"lights.key.intensity", "intensity red", 0, 4e4},
         {"lights.panel.radiance", "radiance blue", 0, 20},
         {"lights.room.strength", "strength green", 0, 2},
         {"camera.position", "position y", 10, 60},
         {"film.resolution", "resolution width", 24, 64, true},
         {"shapes.floor.reflectance", "reflectance green", 0, 1},
         {"media.stone.sigma_s_prime", "sigma_s_prime blue", 1, 5},
         {"media.stone.subsurface_color", "subsurface_color red", .1, .95}}};
    const Number& three = kThrees[pick(kThrees.size())];
    double value = between(three.low, three.high);
    if (three.is_whole) value = std::round(value);
    run(fmt::format("hand.type({}, {})", field(three.path, three.key), value));
    return fmt::format("type {}: {} = {}", three.path, three.key, value);
  }

  std::string slide() {
    static constexpr std::array<std::array<const char*, 2>, 8> kSliders{
        {{"media.stone.specular_ior", "specular_ior, slider"},
         {"media.stone.specular_roughness", "specular_roughness, slider"},
         {"media.stone.subsurface_color", "subsurface_color, slider"},
         {"lights.key.intensity", "intensity, slider"},
         {"lights.panel.radiance", "radiance, slider"},
         {"lights.room.strength", "strength, slider"},
         {"camera.field_of_view", "field_of_view, slider"},
         {"shapes.floor.reflectance", "reflectance, colour"}}};
    const auto& [path, label] = kSliders[pick(kSliders.size())];
    std::vector<std::string> values;
    for (int i = 0; i < 5; ++i)
      values.push_back(std::string(label).ends_with("colour") ? fmt::format("'#{:06x}'", random_() & 0xffffff)
                                                              : fmt::format("{}", between(.2, .8)));
    run(fmt::format("hand.slide({}, [{}])", field(path, label), fmt::join(values, ", ")));
    return fmt::format("slide {}: {} to {}", path, label, fmt::join(values, ", "));
  }

  std::string choose() {
    using Words = std::vector<std::string>;
    static const std::vector<std::pair<std::string, Words>> kChoices{
        {"media.stone.preset", {"marble", "skin1", "wholemilk", "potato"}},
        {"media.stone.profile", {"auto", "dipole", "better_dipole", "normalized_diffusion"}},
        {"settings.method", {"hierarchical", "lambert", "volume_diffusion"}},
        {"settings.evaluator", {"automatic", "dual_tree", "surface_cache", "classic"}},
        {"settings.laboratory.near_irradiance", {"mixed", "samples", "point"}},
        {"film.filter", {"box", "gaussian"}},
        {"shapes.left.normals", {"smooth", "faceted"}}};
    const std::size_t choice = pick(kChoices.size() + 2);
    if (choice == kChoices.size()) {
      const bool value = pick(2) == 1;
      run(fmt::format("hand.type({}, {})", field("settings.laboratory.near_field", "near_field"), value));
      return fmt::format("tick settings.laboratory.near_field: {}", value);
    }
    if (choice == kChoices.size() + 1) {
      static const Words kForms{"preset", "sigma_s_prime", "sigma_s", "subsurface_color"};
      const std::string& form = kForms[pick(kForms.size())];
      run("hand.type(document.querySelector('[data-group=\"media.stone\"] label.knob select'), '" + form +
          "')");
      return "medium given by " + form;
    }
    const auto& [path, words] = kChoices[choice];
    const std::string& word = words[pick(words.size())];
    run(fmt::format("hand.type({}, '{}')", field(path, path.substr(path.rfind('.') + 1)), word));
    return "choose " + path + " = " + word;
  }

  std::string drag_picture() {
    static constexpr std::array<int, 6> kModifiers{0, 0, 8, 2, 1, 1};  // orbit, pan, dolly, the room
    const int modifiers = kModifiers[pick(kModifiers.size())];
    const double dx = between(-90, 90), dy = between(-40, 40);
    const auto [x, y] = hands_.middle("#picture");
    hands_.browser.drag(hands_.tab, x, y, dx, dy, modifiers);
    return fmt::format("drag the picture by {}, {} with modifiers {}", dx, dy, modifiers);
  }

  std::string handle() { return fmt::format("[data-path=\"lights.{}\"]", pick(2) == 1 ? "key" : "panel"); }

  std::string drag_light() {
    const std::string light = handle();
    const double dx = between(-60, 60), dy = between(-30, 30);
    const auto [x, y] = hands_.middle(light + " circle");
    hands_.browser.drag(hands_.tab, x, y, dx, dy);
    return fmt::format("drag {} by {}, {}", light, dx, dy);
  }

  std::string press_key() {
    static const std::vector<std::string> kKeys{"ArrowLeft", "ArrowRight", "ArrowUp", "ArrowDown", "+", "-"};
    const std::string at = pick(2) == 1 ? "#picture" : handle(), &key = kKeys[pick(kKeys.size())];
    const int modifiers = pick(3) == 0 && at == "#picture" ? 8 : 0;
    run("document.querySelector('" + at + "').focus()");
    const std::size_t times = 1 + pick(4);
    for (std::size_t i = 0; i < times; ++i) hands_.browser.key(hands_.tab, key, modifiers);
    return fmt::format("press {} {} times at {} with modifiers {}", key, times, at, modifiers);
  }

  std::string turn_wheel() {
    const std::string at = pick(2) == 1 ? "#picture" : handle() + " circle";
    const int by = pick(2) == 1 ? 100 : -100;
    const std::size_t times = 1 + pick(4);
    const auto [x, y] = hands_.middle(at);
    for (std::size_t i = 0; i < times; ++i)
      hands_.browser.mouse(hands_.tab, "mouseWheel", x, y, {{"deltaX", 0}, {"deltaY", by}});
    return fmt::format("turn the wheel by {} {} times at {}", by, times, at);
  }

  std::string step_back() {
    static const std::vector<std::string> kButtons{"undo",   "undo",  "undo",      "redo",     "redo",
                                                   "Ctrl+Z", "reset", "keep-look", "look-back"};
    std::string button = kButtons[pick(kButtons.size())];
    if (button == "reset" && pick(4) != 0) button = "undo";
    if (button == "Ctrl+Z")
      hands_.browser.key(hands_.tab, "z", 2);
    else
      hands_.click(button);
    return button;
  }

  /// Another frame where there are any; else what changes nothing but what is on the screen.
  std::string look() {
    const double share = between(0, 1);
    if (run("!document.getElementById('frames').hidden")) {
      run(fmt::format("hand.slide(document.getElementById('playhead'), [{}])", share));
      return fmt::format("frame at {} of the range", share);
    }
    static const std::vector<std::string> kChannels{"", "R", "diffuse", "N", "irradiance"};
    const std::string& channel = kChannels[pick(kChannels.size())];
    run("hand.type(document.getElementById('channel'), '" + channel + "')");
    hands_.click("pin");
    run(fmt::format("hand.slide(document.getElementById('exposure'), [{}])", share));
    return fmt::format("channel '{}', pin, exposure at {}", channel, share);
  }

  PageHands& hands_;
  std::mt19937 random_;
};

}  // namespace opaline::test
