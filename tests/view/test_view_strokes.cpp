// SPDX-License-Identifier: GPL-3.0-or-later
// Whatever a person does at the page of `opaline view`, and however fast: nothing that was done is lost, the final
// picture is that of `opaline render` of the scene that the page saves, and memory stays.
#include "opaline/error.h"
#include "opaline/image.h"
#include "strokes.h"
#include "values/frame_name.h"
#include "view/page_message.h"
#include "view/scene_edits.h"
#include "view_program.h"

namespace opaline {
namespace {

using namespace test;

/// A room, a point, a panel and a sun over two balls of one medium on a floor.
struct StrokesFolder : ScratchFolder {
  std::string scene = file("strokes.json");

  /// left: where the left ball is, as JSON
  explicit StrokesFolder(const std::string& left) {
    Image room;
    room.width = 16, room.height = 8;
    room.channels = {"R", "G", "B"};
    for (int p = 0; p < 16 * 8; ++p)
      for (const float value : {.002f, .003f, .004f}) room.pixels.push_back(p == 35 ? 40 * value : value);
    write_exr(file("room.exr"), room, false);
    put_bytes(scene, R"({
  "media": {"stone": {"preset": "marble"}},
  "shapes": [
    {"name": "left", "sphere": {"center": )" +
                         left + R"(, "radius": 10}, "medium": "stone"},
    {"name": "right", "file": ")" +
                         ball_file(10) +
                         R"(", "transform": [{"translate": [15, 10, 0]}], "medium": "stone"},
    {"name": "floor", "quad": {"corner": [-60, -1, 60], "u": [120, 0, 0], "v": [0, 0, -120]}}
  ],
  "lights": [
    {"name": "key", "type": "point", "position": [0, 60, 20], "intensity": [3e4, 2e4, 1e4]},
    {"name": "panel", "type": "quad", "corner": [-60, 50, 30], "u": [40, 0, 0], "v": [0, 0, 20], "radiance": 5},
    {"name": "sun", "type": "directional", "direction": [0, -2, -1], "irradiance": 0.1},
    {"name": "room", "type": "environment", "file": "room.exr"}
  ],
  "camera": {"position": [0, 30, 120], "look_at": [0, 8, 0], "field_of_view": 32},
  "film": {"resolution": [48, 32]},
  "settings": {"light_samples": 4, "max_samples": 1500, "cell_size": 2}
})");
  }
};

/// The same edits as the server's, from what the page has sent.
class EditsModel {
 public:
  explicit EditsModel(const std::string& scene) : edits(scene, {}) {}

  void take(const std::string& text) try {
    const PageMessage message = parse_page_message(text);
    if (const auto* set = std::get_if<SetValues>(&message)) edits.set(*set);
    if (std::holds_alternative<Undo>(message)) edits.undo();
    if (std::holds_alternative<Redo>(message)) edits.redo();
    if (std::holds_alternative<Reset>(message)) edits.reset();
    if (const auto* frame = std::get_if<GoToFrame>(&message)) edits.go_to_frame(frame->frame);
    if (const auto* look = std::get_if<LookFrom>(&message)) edits.look(*look);
    if (std::holds_alternative<LookBack>(message)) edits.look_back();
    if (std::holds_alternative<KeepLook>(message)) edits.keep_look();
  } catch (const Error&) {  // refused, as by the server
  }

  SceneEdits edits;
};

/// The program with its page in a browser.
class StrokedView {
 public:
  StrokedView(const std::string& left, unsigned seed)
      : folder_(left),
        port_(free_port()),
        program_({"view", folder_.scene, "--port", std::to_string(port_), "--token", kToken, "--no-open"}),
        model_(folder_.scene),
        strokes_(hands_, seed) {
    EXPECT_TRUE(program_.prints(std::string(kToken) + "/\n"));
    const std::string url = "http://127.0.0.1:" + std::to_string(port_) + "/" + kToken + "/";
    hands_.tab = hands_.browser.open(url, 1280, 720, kStrokeScript);
    EXPECT_TRUE(hands_.browser.comes_true(hands_.tab, kIsFinal + "1"));
  }
  ~StrokedView() {
    for (const std::string& problem : hands_.browser.problems) ADD_FAILURE() << problem;
    if (::testing::Test::HasFailure())
      for (const std::string& stroke : strokes_.done) fmt::print(stderr, "stroke: {}\n", stroke);
    program_.send(SIGINT);
    EXPECT_EQ(program_.wait(20).exit_code, 0);
  }
  StrokedView(const StrokedView&) = delete;
  StrokedView& operator=(const StrokedView&) = delete;

  /// Strokes one render at a time without a pause, and then what came of them.
  void strike(int count) {
    for (int i = 0; i < count; ++i) strokes_.next();
    SCOPED_TRACE(fmt::format("after {} strokes", strokes_.done.size()));
    run("new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(done)))");
    expect_all_sent();
    expect_final();
  }

  double program_bytes() const {
    std::ifstream file("/proc/" + std::to_string(program_.pid()) + "/statm");
    double pages = 0, resident = 0;
    file >> pages >> resident;
    return resident * double(::sysconf(_SC_PAGESIZE));
  }
  double page_bytes() {
    hands_.browser.call(hands_.tab, "HeapProfiler.collectGarbage", {});
    return hands_.browser.call(hands_.tab, "Runtime.getHeapUsage", {}).at("usedSize");
  }
  double page_nodes() { return hands_.browser.call(hands_.tab, "Memory.getDOMCounters", {}).at("nodes"); }

 private:
  Json run(const std::string& script) { return hands_.browser.run(hands_.tab, script); }

  void expect_all_sent() {
    std::vector<Json> sets;
    for (const Json& text : run("sent.splice(0)")) {
      model_.take(text.get<std::string>());
      sets.push_back(Json::parse(text.get<std::string>()).value("values", Json::object()));
    }
    for (const auto& typed : std::exchange(strokes_.typed, {})) {
      const auto is_of = [&](const Json& set) {
        return set.contains(typed.first) &&
               std::abs(set.at(typed.first).get<double>() - typed.second.get<double>()) < 1e-9;
      };
      EXPECT_TRUE(std::ranges::any_of(sets, is_of))
          << typed.first << " = " << typed.second << " was typed and not sent";
    }
  }

  void expect_final() {
    const std::uint32_t revision = model_.edits.revision();
    ViewClient page = page_of(port_);
    const auto has_failed = [&] {
      return page.texts.contains("failed") && page.texts["failed"].at("revision") == revision;
    };
    ASSERT_TRUE(page.read_until([&] {
      return has_failed() || (page.frame.step == PictureStep::final && page.frame.revision >= revision);
    })) << "no final picture of revision "
        << revision;
    EXPECT_EQ(page.texts.at("scene").at("edits"), Json(model_.edits.edits()));
    run("document.getElementById('told').textContent = ''; document.getElementById('save').click()");
    ASSERT_TRUE(hands_.browser.comes_true(hands_.tab,
                                          "document.getElementById('told').textContent.startsWith('saved')"));
    const std::vector<std::uint16_t> rendered = rendered_from(folder_.file("strokes-edited.json"));
    EXPECT_EQ(has_failed(), rendered.empty()) << page.texts["failed"];
    if (has_failed() || rendered.empty()) return;
    ASSERT_EQ(page.frame.colours.size(), rendered.size());
    std::size_t differ = 0;
    for (std::size_t i = 0; i < rendered.size(); ++i) differ += page.frame.colours[i] != rendered[i] ? 1 : 0;
    EXPECT_EQ(differ, 0u) << "of " << rendered.size() << " values of the final picture";
    ASSERT_TRUE(hands_.browser.comes_true(hands_.tab, kIsFinal + std::to_string(revision)));
    run("hand.type(document.getElementById('channel'), ''); document.getElementById('exposure').value = 0; "
        "document.getElementById('exposure').dispatchEvent(new Event('input'))");
    hands_.expect_shown(page.frame.colours);
  }

  /// R G B A as bits of halves, by `opaline render`; empty: it refuses the scene.
  std::vector<std::uint16_t> rendered_from(const std::string& scene) {
    const std::optional<int> frame = model_.edits.frame();
    std::vector<std::string> words{"render", scene, "-o", folder_.file(frame ? "out.####.exr" : "out.exr")};
    if (frame) words.insert(words.end(), {"--frames", std::to_string(*frame)});
    if (const std::optional<LookFrom>& look = model_.edits.own_camera())
      words.insert(words.end(), {"--set", "camera.position=" + look->position, "--set",
                                 "camera.look_at=" + look->look_at});
    const Outcome outcome = run_program(words);
    EXPECT_TRUE(outcome.exit_code == 0 || outcome.exit_code == 3 || outcome.exit_code == 2) << outcome.err;
    if (outcome.exit_code != 0) return {};
    const Image image = read_image(frame ? with_frame(words[3], *frame) : words[3]);
    std::vector<std::uint16_t> bits;
    for (std::size_t p = 0; p < image.pixels.size(); p += image.channels.size())
      for (std::size_t c = 0; c < 4; ++c) bits.push_back(half(image.pixels[p + c]).bits());
    return bits;
  }

  StrokesFolder folder_;
  std::uint16_t port_;
  Child program_;
  EditsModel model_;
  PageHands hands_;
  Strokes strokes_;
};

constexpr const char* kStill = "[-15, 10, 0]";
constexpr const char* kRising = R"({"keyed": {"1": [-15, 10, 0], "6": [-15, 22, 4]}})";

/// Many strokes at once, whose pictures are cancelled, and then a few one by one, whose pictures leave each other what they
/// can use again.
void strike_in_turns(StrokedView& view, int at_once, int one_by_one) {
  view.strike(at_once);
  for (int i = 0; i < one_by_one; ++i) view.strike(1);
}

// Claim: after each of these strokes the server has every edit that the page sent, the page has sent what was typed, and
// the final picture has the bits of `opaline render` of the scene that the page saves, from the page's own camera where it
// has one. Fails if: a change is lost
// between page, server and renderer, or a stage that is kept lacks in its key what it depends on.
TEST(ViewStrokes, LeadToTheirPicture) {
  StrokedView view(kStill, 1);
  for (int i = 0; i < 2; ++i) strike_in_turns(view, 7, 8);
}

TEST(ViewStrokes, LeadToTheirPictureInFrames) {
  StrokedView view(kRising, 2);
  for (int i = 0; i < 2; ++i) strike_in_turns(view, 11, 4);
}

/// Whether readings that are taken after equal numbers of strokes stay: the least of the last quarter is not above the most
/// of the quarter after the first 100 strokes, but for a share.
void expect_flat(const std::vector<double>& readings, double share) {
  const std::size_t quarter = readings.size() / 4, first = readings.size() / 10;
  const double before = *std::max_element(readings.begin() + std::ptrdiff_t(first),
                                          readings.begin() + std::ptrdiff_t(first + quarter));
  const double after = *std::min_element(readings.end() - std::ptrdiff_t(quarter), readings.end());
  EXPECT_LT(after, (1 + share) * before);
}

// Tolerance of memory: of the program 3 %, a picture for each third stroke; of the page 10 %, 200 bytes a stroke; both are
// what heaps differ by from one reading to the next.
void strike_a_thousand(const std::string& left, unsigned seed) {
  StrokedView view(left, seed);
  std::vector<double> program, page, nodes;
  for (int i = 0; i < 40 && !::testing::Test::HasFailure(); ++i) {
    strike_in_turns(view, 20, 5);
    program.push_back(view.program_bytes());
    page.push_back(view.page_bytes());
    nodes.push_back(view.page_nodes());
  }
  ASSERT_EQ(program.size(), 40u);
  expect_flat(program, .03);
  expect_flat(page, .1);
  expect_flat(nodes, .1);
}

// Claim: the same after 1000 strokes, and neither the program nor its page takes more memory than after the first of them.
// Fails if: pictures, steps of undo or listeners pile up.
TEST(LongViewStrokes, LeadToTheirPictureAndKeepMemory) {
  strike_a_thousand(kStill, 3);
}

TEST(LongViewStrokes, LeadToTheirPictureInFramesAndKeepMemory) {
  strike_a_thousand(kRising, 4);
}

using ViewMoments = LongViewPage;

// Claim: what is done before the server has answered adds up: numbers of one value that are typed, turns of the wheel and
// keys at a light, and Undo after them. Fails if: a change starts from the last scene that the server told of, or what
// waits for the next frame is sent after what came later.
TEST_F(ViewMoments, AddUp) {
  final_edits();
  const std::string handle = "document.querySelector('[data-path=\"lights.key\"]')";
  browser.run(tab,
              "(() => { for (const [axis, value] of [['x', 30], ['y', 70], ['z', -10]]) {"
              "  const field = document.querySelector(`[aria-label^=\"lights.key.position,\"] "
              "[aria-label=\"position ${axis}\"]`);"
              "  field.value = value; field.dispatchEvent(new Event('change')); }"
              "const light = " +
                  handle +
                  ";"
                  "for (let i = 0; i < 3; ++i) light.dispatchEvent(new WheelEvent('wheel', {deltaY: -100}));"
                  "light.dispatchEvent(new KeyboardEvent('keydown', {key: '+'})); })()");
  std::vector<std::string> edits = final_edits(2);
  Scene scene = load_scene(folder.scene, edits);
  const auto& lamp = std::get<PointLight>(scene.lights[0].source);
  EXPECT_EQ(lamp.position, (Vec3d{30, 70, -10}));
  EXPECT_NEAR(lamp.intensity.x, 3e4 * std::pow(1.1, 4), 1);
  browser.run(tab,
              "(() => { const field = document.querySelector('[aria-label^=\"media.stone.specular_ior,\"] "
              "[aria-label=\"specular_ior\"]'); field.value = 1.3; field.dispatchEvent(new Event('change'));"
              "document.getElementById('undo').click(); })()");
  EXPECT_EQ(final_edits(revision + 2), edits);
  EXPECT_EQ(browser.run(tab, "document.getElementById('redo').disabled"), false);
}

}  // namespace
}  // namespace opaline
