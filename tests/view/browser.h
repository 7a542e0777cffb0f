// SPDX-License-Identifier: GPL-3.0-or-later
// Debian's chromium without a screen, driven by its DevTools protocol: real keys, real mouse, the real page.
#pragma once

#include <fcntl.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <fstream>
#include <sstream>
#include <stdexcept>

#include "view_client.h"

namespace opaline::test {

/// A tab of the browser.
struct Tab {
  std::string target, session;
};

class Browser {
 public:
  Browser() {
    pid_ = ::fork();
    if (pid_ < 0) throw std::runtime_error("no child process");
    if (pid_ == 0) {
      ::setpgid(0, 0);  // Debian's starter waits for the browser: both are to end
      const int log = ::open(folder_.file("log").c_str(), O_WRONLY | O_CREAT, 0600);
      ::dup2(log, STDOUT_FILENO);
      ::dup2(log, STDERR_FILENO);
      const std::string data = "--user-data-dir=" + folder_.file("data");
      ::execlp("chromium-headless-shell", "chromium-headless-shell", "--no-sandbox", "--disable-gpu",
               "--remote-debugging-port=0", data.c_str(), "about:blank", nullptr);
      ::_exit(127);
    }
    ::setpgid(pid_, pid_);
    connect();
  }
  ~Browser() {
    ::kill(-pid_, SIGKILL);
    ::waitpid(pid_, nullptr, 0);
  }
  Browser(const Browser&) = delete;
  Browser& operator=(const Browser&) = delete;

  /// A tab that shows an address. script: is run before the page's own
  Tab open(const std::string& url, int width = 1280, int height = 720, const std::string& script = "") {
    Tab tab;
    tab.target = call({}, "Target.createTarget", {{"url", "about:blank"}}).at("targetId");
    tab.session =
        call({}, "Target.attachToTarget", {{"targetId", tab.target}, {"flatten", true}}).at("sessionId");
    for (const char* domain : {"Runtime", "Log", "Page"}) call(tab, std::string(domain) + ".enable", {});
    resize(tab, width, height);
    if (!script.empty()) call(tab, "Page.addScriptToEvaluateOnNewDocument", {{"source", script}});
    call(tab, "Page.navigate", {{"url", url}});
    return tab;
  }
  void resize(const Tab& tab, int width, int height) {
    call(tab, "Emulation.setDeviceMetricsOverride",
         {{"width", width}, {"height", height}, {"deviceScaleFactor", 1}, {"mobile", false}});
  }

  /// The value of an expression, which may be a promise; a failure where it throws.
  Json run(const Tab& tab, const std::string& expression) {
    const Json answer = call(tab, "Runtime.evaluate",
                             {{"expression", expression}, {"awaitPromise", true}, {"returnByValue", true}});
    if (answer.contains("exceptionDetails"))
      ADD_FAILURE() << expression << ": " << answer.at("exceptionDetails").dump();
    return answer.at("result").value("value", Json());
  }
  /// Whether the condition becomes true within a minute.
  bool comes_true(const Tab& tab, const std::string& condition) {
    for (int i = 0; i < 1200; ++i) {
      if (run(tab, "Boolean(" + condition + ")") == true) return true;
      std::this_thread::sleep_for(std::chrono::milliseconds(50));
    }
    ADD_FAILURE() << "never true: " << condition;
    return false;
  }

  /// kind: mousePressed, mouseMoved, mouseReleased or mouseWheel; modifiers: 2 Ctrl, 8 Shift
  void mouse(const Tab& tab, const std::string& kind, double x, double y, const Json& more = Json::object(),
             int modifiers = 0) {
    Json event{{"type", kind},
               {"x", x},
               {"y", y},
               {"modifiers", modifiers},
               {"button", kind == "mouseWheel" ? "none" : "left"},
               {"buttons", 1},
               {"clickCount", 1}};
    event.update(more);
    call(tab, "Input.dispatchMouseEvent", event);
  }
  void drag(const Tab& tab, double x, double y, double dx, double dy, int modifiers = 0) {
    mouse(tab, "mousePressed", x, y, Json::object(), modifiers);
    for (int i = 1; i <= 8; ++i)
      mouse(tab, "mouseMoved", x + dx * i / 8, y + dy * i / 8, Json::object(), modifiers);
    mouse(tab, "mouseReleased", x + dx, y + dy, Json::object(), modifiers);
  }
  /// code: of the key on the keyboard, as "Digit1"
  void key(const Tab& tab, const std::string& key, int modifiers = 0, const std::string& code = "") {
    for (const char* kind : {"rawKeyDown", "keyUp"})
      call(tab, "Input.dispatchKeyEvent",
           {{"type", kind}, {"key", key}, {"modifiers", modifiers}, {"code", code}});
  }
  Json call(const Tab& tab, const std::string& method, const Json& parameters) {
    Json message{
        {"id", ++calls_}, {"method", method}, {"params", parameters.is_null() ? Json::object() : parameters}};
    if (!tab.session.empty()) message["sessionId"] = tab.session;
    socket_->send_text(message.dump());
    while (true) {
      const Json answer = read();
      if (answer.value("id", 0) != calls_) {
        note(answer);
        continue;
      }
      if (answer.contains("error")) throw std::runtime_error(method + ": " + answer.at("error").dump());
      return answer.at("result");
    }
  }

  /// What went wrong in any page: exceptions, and what the browser logs as errors.
  std::vector<std::string> problems;

 private:
  void connect() {
    std::string port, path;
    for (int i = 0; i < 600 && path.empty(); ++i) {
      std::ifstream file(folder_.file("data/DevToolsActivePort"));
      std::getline(file, port) && std::getline(file, path);
      if (path.empty()) std::this_thread::sleep_for(std::chrono::milliseconds(50));
    }
    if (path.empty())
      throw std::runtime_error("no browser (Debian's chromium-headless-shell): " +
                               bytes_of(folder_.file("log")));
    socket_.emplace(std::uint16_t(std::stoi(port)), "127.0.0.1:" + port, path, "");
  }
  Json read() {
    const std::optional<WebSocket::Message> message = socket_->read_within(std::chrono::minutes(10));
    if (!message) throw std::runtime_error("the browser is gone: " + bytes_of(folder_.file("log")));
    return Json::parse(message->bytes);
  }
  void note(const Json& event) {
    const std::string method = event.value("method", "");
    if (method == "Runtime.exceptionThrown") problems.push_back(event.at("params").dump());
    if (method == "Log.entryAdded" && event.at("params").at("entry").at("level") == "error")
      problems.push_back(event.at("params").at("entry").dump());
  }

  ScratchFolder folder_;
  pid_t pid_ = -1;
  std::optional<WebSocket> socket_;
  int calls_ = 0;
};

}  // namespace opaline::test
