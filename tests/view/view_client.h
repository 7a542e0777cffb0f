// SPDX-License-Identifier: GPL-3.0-or-later
// A server in this process, and a page without a browser: the protocol as a program speaks it.
#pragma once

#include <Imath/half.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <cstring>
#include <filesystem>
#include <map>
#include <mutex>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "../core/ball_file.h"
#include "input/load_scene.h"
#include "session/session_records.h"
#include "view/view_frame.h"
#include "view/view_server.h"
#include "web_client.h"

namespace opaline::test {

using Json = nlohmann::json;

inline constexpr const char* kToken = "a-token-of-this-test";

/// Two balls of one medium on a floor: 48 x 32 pixels, little of everything.
struct ViewFolder : ScratchFolder {
  std::string scene = file("balls.json");

  ViewFolder() {
    put_bytes(scene, R"(// comments are no part of a scene
{
  "media": {"stone": {"preset": "marble"}},
  "shapes": [
    {"name": "left", "sphere": {"center": [-15, 10, 0], "radius": 10}, "medium": "stone"},
    {"name": "right", "file": ")" +
                         ball_file(10) +
                         R"(", "transform": [{"translate": [15, 10, 0]}], "medium": "stone"},
    {"name": "floor", "quad": {"corner": [-60, -1, 60], "u": [120, 0, 0], "v": [0, 0, -120]}}
  ],
  "lights": [
    {"name": "key", "type": "point", "position": [0, 100, 20], "intensity": [3e4, 2e4, 1e4]},
    {"name": "panel", "type": "quad", "corner": [-60, 90, 30], "u": [40, 0, 0], "v": [0, 0, 20], "radiance": 5},
    {"name": "sun", "type": "directional", "direction": [0, -2, -1], "irradiance": 0.1}
  ],
  "camera": {"position": [0, 30, 120], "look_at": [0, 8, 0], "field_of_view": 32},
  "film": {"resolution": [48, 32]},
  "settings": {"light_samples": 4, "max_samples": 2000}
})");
  }
};

/// Serves a scene on a thread, as `opaline view` does.
class RunningView {
 public:
  explicit RunningView(const std::string& scene, std::uint16_t port = 0, std::vector<int> frames = {})
      : server_(
            SceneEdits(scene, {}, std::move(frames)),
            {"127.0.0.1", port, kToken, std::filesystem::path(scene).replace_filename("dropped").string()},
            hooks()),
        thread_([this] { server_.run(); }) {}
  ~RunningView() { server_.stop(); }
  RunningView(const RunningView&) = delete;
  RunningView& operator=(const RunningView&) = delete;

  std::string url() const { return server_.url(); }
  std::string host() const {
    const std::string address = url();
    return address.substr(7, address.find('/', 7) - 7);
  }
  std::uint16_t port() const {
    const std::string name = host();
    return std::uint16_t(std::stoi(name.substr(name.find(':') + 1)));
  }
  /// Whether a line of the log holds the text, now or within seconds.
  bool has_refused(const std::string& text) {
    for (int i = 0; i < 500; ++i) {
      {
        const std::lock_guard lock(mutex_);
        if (log_.find(text) != std::string::npos) return true;
      }
      std::this_thread::sleep_for(std::chrono::milliseconds(10));
    }
    return false;
  }

 private:
  ViewHooks hooks() {
    return {[this](const std::string& text) {
              const std::lock_guard lock(mutex_);
              log_ += text + '\n';
            },
            [](const std::string&, const std::vector<std::string>& overrides, std::optional<int>) {
              return "render with " + std::to_string(overrides.size());
            },
            [](const std::string&, const std::vector<std::string>&, std::optional<int>,
               const std::string& path, Monitor& monitor) {
              const bool is_endless = path.find("endless") != path.npos;
              while (is_endless) {
                std::this_thread::sleep_for(std::chrono::milliseconds(5));
                advance(&monitor, 1);
              }
              put_bytes(path, "a picture");
            }};
  }

  std::mutex mutex_;
  std::string log_;
  ViewServer server_;
  std::jthread thread_;
};

struct Frame {
  std::uint32_t number = 0, revision = 0, width = 0, height = 0, layer_channels = 0;
  PictureStep step = PictureStep::moving;
  std::vector<std::uint16_t> colours;  ///< bits of halves, R G B A a pixel
  std::vector<float> layer;
};

/// Unpacks what pack_frame has packed, by code of its own.
inline Frame frame_of(const std::string& bytes) {
  std::uint32_t words[8] = {};
  EXPECT_GE(bytes.size(), sizeof words);
  std::memcpy(words, bytes.data(), std::min(bytes.size(), sizeof words));
  EXPECT_EQ(words[0], kFrameMark);
  Frame frame{words[1], words[2], words[4], words[5], words[6], PictureStep(words[3]), {}, {}};
  const std::size_t pixels = std::size_t(frame.width) * frame.height,
                    layer = sizeof words + pixels * 4 * sizeof(std::uint16_t);
  frame.colours.resize(pixels * 4);
  frame.layer.resize(pixels * frame.layer_channels);
  EXPECT_EQ(bytes.size(), layer + frame.layer.size() * sizeof(float));
  std::memcpy(frame.colours.data(), bytes.data() + sizeof words, layer - sizeof words);
  if (!frame.layer.empty())
    std::memcpy(frame.layer.data(), bytes.data() + layer, frame.layer.size() * sizeof(float));
  return frame;
}

/// A page: keeps the newest text of each kind and the newest frame.
class ViewClient {
 public:
  /// receive_buffer: bytes that wait unread before the server notices; 0: as the machine has it
  explicit ViewClient(const RunningView& view, const std::string& origin = "", int receive_buffer = 0)
      : ViewClient(view.port(), view.host(), "/" + std::string(kToken) + "/socket",
                   origin.empty() ? "http://" + view.host() : origin, receive_buffer) {}

  ViewClient(std::uint16_t port, const std::string& host, const std::string& path, const std::string& origin,
             int receive_buffer = 0)
      : socket(port, host, path, origin, receive_buffer) {}

  void send(const Json& message) { socket.send_text(message.dump()); }
  void set(const Json& values, std::uint64_t stroke = 0) {
    send({{"do", "set"}, {"values", values}, {"stroke", stroke}});
  }

  /// Reads one message; false where none comes within a minute, or the server has closed.
  bool read() {
    if (read_within(std::chrono::minutes(1))) return true;
    socket.close();
    return false;
  }

  /// The same within a time, after which reading may go on.
  bool read_within(std::chrono::milliseconds time) {
    const std::optional<WebSocket::Message> message = socket.read_within(time);
    if (!message) return false;
    if (message->is_text) {
      const Json text = Json::parse(message->bytes);
      texts[text.at("is")] = text;
      newest = text.at("is");
    } else {
      const Frame news = frame_of(message->bytes);
      const bool is_reference = news.step == PictureStep::reference;
      (is_reference ? reference : frame) = news;
      ++frames;
      newest = is_reference ? "reference frame" : "frame";
      if (answers_frames) send({{"do", "shown"}, {"frame", news.number}});
    }
    return true;
  }

  template <class Condition>
  bool read_until(const Condition& condition) {
    while (!condition())
      if (!read()) return false;
    return true;
  }
  std::uint32_t revision() const {
    return texts.contains("scene") ? texts.at("scene").at("revision").get<std::uint32_t>() : 0;
  }
  /// Until the picture of the newest scene that it knows is final.
  bool read_final(std::uint32_t least_revision = 1) {
    return read_until([&] {
      return frame.step == PictureStep::final && frame.revision == revision() && revision() >= least_revision;
    });
  }
  /// An answer to this page alone.
  std::string read_answer() {
    texts.erase("told");
    return read_until([&] { return texts.contains("told"); }) ? texts["told"].at("text") : "";
  }

  WebSocket socket;
  std::map<std::string, Json> texts;
  std::string newest;
  Frame frame, reference;
  std::size_t frames = 0;
  bool answers_frames = true;
};

/// The picture that `opaline render` makes, R G B A as bits of halves.
inline std::vector<std::uint16_t> rendered(const std::string& scene,
                                           const std::vector<std::string>& overrides = {}) {
  Session session;
  session.edit(load_scene(scene, overrides));
  const Image image = session.render().image;
  std::vector<std::uint16_t> bits;
  for (std::size_t p = 0; p < std::size_t(image.width) * std::size_t(image.height); ++p)
    for (std::size_t c = 0; c < 4; ++c)
      bits.push_back(half(image.pixels[p * image.channels.size() + c]).bits());
  return bits;
}

}  // namespace opaline::test
