// SPDX-License-Identifier: GPL-3.0-or-later
// Whoever is no page, or a bad one, is refused with a line in the log, and the others are served.
#include <list>

#include "view_client.h"

namespace opaline {
namespace {

using namespace test;

int status_of(const RunningView& view, const std::string& target, const std::string& method = "GET",
              const std::string& host = "") {
  return http_status(view.port(),
                     {method, target, "Host: " + (host.empty() ? view.host() : host) + "\r\n", ""});
}

bool is_refused(const RunningView& view, const std::string& path, const std::string& origin) {
  try {
    ViewClient(view.port(), view.host(), path, origin);
  } catch (const WebSocketDeclined&) {
    return true;
  }
  return false;
}

const std::string kRoot = "/" + std::string(kToken) + "/";

// Claim: without the token, with another host's name or Origin, nothing is served. Fails if one of the checks goes.
TEST(ViewHostile, WhoIsNoPageIsRefused) {
  const ViewFolder folder;
  RunningView view(folder.scene);
  EXPECT_EQ(status_of(view, kRoot), 200);
  EXPECT_EQ(status_of(view, kRoot + "main.js"), 200);
  for (const std::string& target : {std::string("/"), std::string("/favicon.ico"), std::string("//"),
                                    kRoot.substr(0, 8) + "/", "/x" + kRoot, kRoot.substr(1)})
    EXPECT_EQ(status_of(view, target), 403) << target;
  EXPECT_EQ(status_of(view, kRoot + "x"), 404);
  EXPECT_TRUE(view.has_refused("wrong token"));
  EXPECT_EQ(status_of(view, kRoot, "GET", "evil.example:" + std::to_string(view.port())), 403);
  EXPECT_TRUE(view.has_refused("another host's name"));
  EXPECT_EQ(status_of(view, kRoot, "POST"), 405);
  const std::string own = "http://" + view.host();
  EXPECT_TRUE(is_refused(view, kRoot + "socket", "http://evil.example"));
  EXPECT_TRUE(is_refused(view, kRoot + "socket", ""));
  EXPECT_TRUE(view.has_refused("foreign Origin"));
  EXPECT_TRUE(is_refused(view, "/another-token-here/socket", own));
  EXPECT_TRUE(is_refused(view, kRoot, own));
  EXPECT_FALSE(is_refused(view, kRoot + "socket", own));
}

// Claim: a message that is none is answered and changes nothing. Fails if one throws out of the network's thread, or
// is taken.
TEST(ViewHostile, BadMessagesAreAnswered) {
  const ViewFolder folder;
  const RunningView view(folder.scene);
  ViewClient page(view);
  ASSERT_TRUE(page.read_final());
  const std::string deep(30000, '[');
  for (const std::string& text : std::vector<std::string>{
           "",
           "{",
           "[]",
           "null",
           "{}",
           R"({"do": 3})",
           R"({"do": "dance"})",
           R"({"do": "undo", "more": 1})",
           R"({"do": "set", "values": {"media.stone.eta": 1.3}})",
           R"({"do": "set", "values": 3, "stroke": 1})",
           R"({"do": "set", "values": {"": 1}, "stroke": 1})",
           R"({"do": "set", "values": {"a=b": 1}, "stroke": 1})",
           R"({"do": "set", "values": {"media.stone.eat": 1}, "stroke": 1})",
           R"({"do": "set", "values": {"media.stone.eta": 1e999}, "stroke": 1})",
           R"({"do": "set", "values": {"media.stone.eta": null}, "stroke": -1})",
           R"({"do": "set", "values": {"film.resolution": [60000, 60000]}, "stroke": 1})",
           R"({"do": "set", "values": {"film.resolution": [4097, 4097]}, "stroke": 1})",
           R"({"do": "set", "values": {"shapes.left": {"file": "/etc/passwd"}}, "stroke": 1})",
           R"({"do": "set", "values": {"camera.position": [0, 8, 0]}, "stroke": 1})",
           R"({"do": "look", "position": [0, 8, 0], "look_at": [0, 8, 0]})",
           R"({"do": "look", "position": [0, 1e999, 0], "look_at": [0, 8, 0]})",
           R"({"do": "look", "position": 3, "look_at": [0, 8, 0]})",
           R"({"do": "restore", "edits": ["nothing"]})",
           R"({"do": "shown", "frame": "x"})",
           R"({"do": "lights", "change": "steal", "index": 0})",
           R"({"do": "lights", "change": "remove", "index": 3})",
           R"({"do": "lights", "change": "remove", "index": -1})",
           R"({"do": "pick", "x": 0.5, "y": 1})",
           R"({"do": "open", "drop": "1", "names": [3]})",
           deep,
           "{\"do\": \"\xff\xfe\"}"}) {
    if (text.find('\xff') != std::string::npos)
      page.socket.send_binary(text);
    else
      page.socket.send_text(text);
    EXPECT_NE(page.read_answer(), "") << text.substr(0, 80);
    EXPECT_FALSE(page.texts["told"].at("good"));
  }
  EXPECT_EQ(page.revision(), 1u);
  page.set({{"media.stone.eta", 1.3}});
  EXPECT_TRUE(page.read_final(2));
}

// Claim: a message above 64 kB ends its page at the announcement, frames that break the protocol end theirs; another
// page is served. Source: RFC 6455, 7.4.1 (1009: too big).
TEST(ViewHostile, BrokenFramesEndTheirPage) {
  const ViewFolder folder;
  RunningView view(folder.scene);
  ViewClient good(view);
  const std::string large("\x81\xff\x00\x00\x00\x00\x40\x00\x00\x00mask", 14);  // 2^30 bytes are to come
  const std::string bare("\x81\x02{}", 4);                                      // not masked
  const std::string unknown("\x8f\x80mask", 6);                                 // of an unknown kind
  for (const std::string& bytes : {large, bare, unknown}) {
    ViewClient bad(view);
    bad.socket.write_raw(bytes);
    EXPECT_FALSE(bad.read_until([] { return false; }));
    if (bytes == large) {
      EXPECT_EQ(bad.socket.close_code(), 1009u);
    }
  }
  EXPECT_TRUE(view.has_refused("a page: "));
  EXPECT_TRUE(good.read_final());
}

// Claim: a page that does not read, or never says that it shows its frames, costs the others nothing and has few
// frames waiting: at most two. Fails if frames queue up.
TEST(ViewHostile, ASlowPageMissesFrames) {
  const ViewFolder folder;
  const RunningView view(folder.scene);
  ViewClient slow(view), quick(view);
  slow.answers_frames = false;
  ASSERT_TRUE(quick.read_final());
  for (int i = 0; i < 20; ++i) {
    quick.set({{"lights.key.position", {i, 100, 20}}});
    ASSERT_TRUE(quick.read_final(std::uint32_t(i) + 2));
  }
  ASSERT_TRUE(slow.read_until([&] { return slow.revision() == 21; }));
  while (slow.frames < 2 && slow.read()) continue;
  slow.send({{"do", "layer"}, {"name", "nothing"}});
  slow.socket.send_text("?");
  EXPECT_NE(slow.read_answer(), "");
  EXPECT_LE(slow.frames, 2u);
  slow.answers_frames = true;
  slow.send({{"do", "shown"}, {"frame", slow.frame.number}});
  EXPECT_TRUE(slow.read_final(21));
  EXPECT_EQ(slow.frame.colours, quick.frame.colours);
}

// Claim: a page behind a connection that stalls costs the others nothing, and then gets the newest picture: pictures that
// were made meanwhile are dropped, but for the two at most that were being sent. Fails if: pictures queue up.
TEST(ViewHostile, AStalledPageGetsTheNewestFrame) {
  constexpr std::uint32_t kEdits = 5, kLast = 2 + kEdits;
  const ViewFolder folder;
  const RunningView view(folder.scene);
  ViewClient stalled(view, "", 1 << 14), quick(view);
  quick.set({{"film.resolution", {512, 480}}});  // 2 MB a frame: more than the sockets buffer
  ASSERT_TRUE(quick.read_final(2) && stalled.read_final(2));
  for (std::uint32_t i = 0; i < kEdits; ++i) {
    quick.set({{"lights.key.intensity", {1e4 + i, 2e4, 3e4}}});
    ASSERT_TRUE(quick.read_final(3 + i));
  }
  const std::size_t before = stalled.frames;
  std::size_t older = 0;
  while (stalled.frame.revision != kLast || stalled.frame.step != PictureStep::final) {
    const std::size_t frames = stalled.frames;
    ASSERT_TRUE(stalled.read());
    if (stalled.frames != frames && stalled.frame.revision != kLast) ++older;
  }
  EXPECT_LE(older, 2u);
  EXPECT_EQ(stalled.frames - before, older + 1);
  EXPECT_EQ(stalled.frame.colours, quick.frame.colours);
}

// Claim: of 200 connections at most 64 are kept, each other one is closed with a line in the log; the page that was
// there before is served, and a new one is when they are gone.
TEST(ViewHostile, TwoHundredConnections) {
  const ViewFolder folder;
  RunningView view(folder.scene);
  ViewClient page(view);
  {
    std::list<Connection> crowd;
    for (int i = 0; i < 200; ++i) crowd.emplace_back(view.port());
    EXPECT_TRUE(view.has_refused("more than 64 connections"));
    page.set({{"media.stone.eta", 1.3}});
    EXPECT_TRUE(page.read_final(2));
  }
  EXPECT_EQ(status_of(view, kRoot), 200);
  std::vector<std::unique_ptr<ViewClient>> pages;
  try {
    for (std::size_t i = 0; i < kMostPages; ++i) pages.push_back(std::make_unique<ViewClient>(view));
  } catch (const std::exception&) {
  }
  EXPECT_EQ(pages.size(), kMostPages - 1);
  EXPECT_TRUE(view.has_refused("more than 16 pages"));
}

}  // namespace
}  // namespace opaline
