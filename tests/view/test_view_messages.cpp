// SPDX-License-Identifier: GPL-3.0-or-later
// Thousands of messages as no page sends them, against a server that renders meanwhile.
#include <cmath>
#include <map>

#include "../fuzz/mutate_bytes.h"
#include "input/schema.h"
#include "view_client.h"

namespace opaline {
namespace {

using namespace test;
using fuzz::below;

/// Messages of every kind: values of every type for every key of the schema, parts of the scene that go or double, frames,
/// cameras, names; and a third of them with broken bytes.
class OddMessages {
 public:
  explicit OddMessages(std::uint64_t seed) : random_(seed) {}

  std::string next() {
    std::string text = message().dump();
    if (below(random_, 3) == 0)
      text = fuzz::mutated(text, last_, {"\"do\"", "null", "1e999", "[", "{"}, random_);
    last_ = text;
    return text;
  }

 private:
  template <class Value>
  const Value& one_of(const std::vector<Value>& values) {
    return values[below(random_, values.size())];
  }

  Json number() {
    static const std::vector<double> kNumbers{0,   -0.0, 1,   2,    3,      -1,    .5,     1e-3,  64,
                                              500, 1e5,  1e9, 1e30, 1e-300, 1e300, 1.0001, -1e-9, 4294967296};
    return one_of(kNumbers);
  }
  Json list(std::size_t length) {
    Json all = Json::array();
    for (std::size_t i = 0; i < length; ++i) all.push_back(below(random_, 12) == 0 ? Json("x") : number());
    return all;
  }
  Json value() {
    static const std::vector<Json> kOdd{nullptr,
                                        true,
                                        false,
                                        "",
                                        "marble",
                                        "stone",
                                        "#ff8000",
                                        "volume_diffusion",
                                        "direct",
                                        "spline",
                                        Json::array(),
                                        Json::object(),
                                        {{"keyed", {{"1", 1}, {"9", 2}}}},
                                        {{"keyed", Json::object()}},
                                        {{"preset", "skin1"}},
                                        {{"type", "point"}, {"position", {0, 90, 0}}, {"intensity", 1e4}},
                                        {{{"scale", 0}}},
                                        {{{"scale", {1, -1, 1}}}}};
    switch (below(random_, 6)) {
      case 0:
        return one_of(kOdd);
      case 1:
        return list(3);
      case 2:
        return list(below(random_, 5));
      default:
        return number();
    }
  }
  /// A key's value that is likely to be taken.
  Json fitting(const KeyInfo& info) {
    if (!info.choices.empty()) return std::string(info.choices[below(random_, info.choices.size())]);
    if (info.type == ValueType::flag) return below(random_, 2) == 0;
    return value();
  }

  /// Where the section's keys are in the scene; empty: nowhere.
  std::string owner_of(std::string_view section) {
    static const std::map<std::string_view, std::vector<std::string>> kOwners{
        {"scene", {""}},
        {"medium", {"media.stone."}},
        {"shape", {"shapes.left.", "shapes.right.", "shapes.floor.", "shapes.7."}},
        {"light.point", {"lights.key."}},
        {"light.quad", {"lights.panel."}},
        {"light.directional", {"lights.sun."}},
        {"camera", {"camera."}},
        {"film", {"film."}},
        {"settings", {"settings."}}};
    const auto found = kOwners.find(section);
    return found == kOwners.end() ? "nowhere." : one_of(found->second);
  }
  void add_value(Json& values) {
    static const std::vector<std::string> kParts{"lights",
                                                 "media",
                                                 "shapes",
                                                 "lights.key",
                                                 "lights.0",
                                                 "media.stone",
                                                 "camera",
                                                 "film",
                                                 "settings",
                                                 "",
                                                 "shapes.left.transform",
                                                 "shapes.+",
                                                 "shapes.left.sphere.radius",
                                                 "shapes.floor.quad.u",
                                                 "camera.position.keyed.3"};
    if (below(random_, 5) == 0) {
      values[one_of(kParts)] = value();
      return;
    }
    const KeyInfo& info = schema()[below(random_, schema().size())];
    values[owner_of(info.section) + std::string(info.key)] = fitting(info);
  }

  Json message() {
    static const std::vector<std::string> kWords{"undo",      "redo",      "reset",
                                                 "look_back", "keep_look", "key_look"};
    static const std::vector<std::string> kNames{"a.json", "../a.json", "a.exr",  "a.####.png",
                                                 "",       "N",         "diffuse"};
    switch (below(random_, 16)) {
      case 0:
        return {{"do", one_of(kWords)}};
      case 1:
        return {{"do", below(random_, 2) == 0 ? "save" : "render"}, {"name", one_of(kNames)}};
      case 2:
        return {{"do", "layer"}, {"name", one_of(kNames)}};
      case 3:
        return {{"do", "frame"}, {"frame", value()}};
      case 4:
        return {{"do", "behind"},
                {"trade", below(random_, 2) == 0},
                {"reference", below(random_, 3) == 0 ? "direct" : ""}};
      case 5:
        return {{"do", "look"}, {"position", list(3)}, {"look_at", list(3)}};
      case 6:
        return {{"do", "restore"}, {"edits", {"media.stone.eta=1.4", value().dump()}}};
      case 7:
        return {{"do", "choose"}, {"error", value()}};
      case 8:
        return {{"do", "floor"}, {"on", below(random_, 2) == 0}};
      case 9:
        return {{"do", "rename_medium"}, {"name", "stone"}, {"to", one_of(kNames)}};
      case 10:
        return {{"do", "recall"}, {"edits", {"media.stone.eta=1.4", value().dump()}}};
      default:
        break;
    }
    Json values = Json::object();
    for (std::size_t i = 0; i <= below(random_, 3); ++i) add_value(values);
    return {{"do", "set"}, {"values", values}, {"stroke", below(random_, 4)}};
  }

  fuzz::Random random_;
  std::string last_ = R"({"do": "undo"})";
};

/// Rounds of messages, each of which is to be read, and after each round the scene as it was opened, whose picture is to
/// come soon: then nothing hangs that an earlier message began.
void send_odd_messages(int rounds, std::uint64_t seed) {
  constexpr int kOfRound = 40;
  constexpr std::chrono::seconds kSoon{20};
  const ViewFolder folder;
  std::string text = bytes_of(folder.scene);
  const std::string still = "[-15, 10, 0]";
  text.replace(text.find(still), still.size(), R"({"keyed": {"1": [-15, 10, 0], "8": [-15, 22, 4]}})");
  put_bytes(folder.scene, text);
  const RunningView view(folder.scene);
  ViewClient page(view);
  ASSERT_TRUE(page.read_final());
  OddMessages messages(seed);
  const auto send = [&](const std::string& message) {
    page.socket.send_binary(message);  // broken bytes are no text
  };
  for (int round = 0; round < rounds; ++round) {
    std::string sent;
    const auto report = [&] { return "round " + std::to_string(round) + ":\n" + sent; };
    send(R"({"do": "layer", "name": "diffuse"})");
    for (int i = 0; i < kOfRound; ++i) {
      const std::string message = messages.next(), probe = "probe" + std::to_string(i);
      sent += message + '\n';
      send(message);
      send("{\"do\": \"" + probe + "\"}");
      ASSERT_TRUE(page.read_until([&] {
        return page.texts.contains("told") &&
               page.texts["told"].at("text").get<std::string>().find(probe + "'") != std::string::npos;
      })) << report();
      for (const float value : page.frame.layer) ASSERT_TRUE(std::isfinite(value)) << report();
    }
    for (const char* word : {"look_back", "reset"}) send("{\"do\": \"" + std::string(word) + "\"}");
    send(R"({"do": "behind", "trade": false, "reference": ""})");
    page.set({{"settings.seed", round}});
    const auto start = std::chrono::steady_clock::now();
    ASSERT_TRUE(page.read_until([&] {
      const Json& scene = page.texts.at("scene");
      return page.frame.step == PictureStep::final && page.frame.revision == page.revision() &&
             scene.at("edits").size() == 1 &&
             scene.at("edits").at(0) == "settings.seed=" + std::to_string(round);
    })) << report();
    EXPECT_LT(std::chrono::steady_clock::now() - start, kSoon) << report();
    send(R"({"do": "reset"})");
  }
}

// Claim: no message ends the server, keeps it busy or brings a value that is not finite into a picture. Fails if: an
// exception leaves a thread, or a stage that the messages begin cannot be cancelled.
TEST(ViewMessages, OddOnesAreSurvived) {
  send_odd_messages(6, 1);
}

TEST(LongViewMessages, OddOnesAreSurvived) {
  send_odd_messages(250, 2);
}

}  // namespace
}  // namespace opaline
