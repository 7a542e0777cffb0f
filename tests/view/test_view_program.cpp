// SPDX-License-Identifier: GPL-3.0-or-later
// The program as a user meets it: a URL, files that are those of `opaline render`, an end by Ctrl-C.
#include <pty.h>

#include "view_program.h"

namespace opaline {
namespace {

using namespace test;

// Claim: the URL is printed, a refused request is a line on stderr, a file rendered from the page has the bytes of the
// command that the page copies, and Ctrl-C ends all with exit code 0, a rendering that has not ended too.
TEST(ViewProgram, ServesUntilCtrlC) {
  const ViewFolder folder;
  const std::string port = std::to_string(free_port());
  Child view({"view", folder.scene, "--port", port, "--token", kToken, "--resolution", "40x24"});
  ASSERT_TRUE(view.prints("http://127.0.0.1:" + port + "/" + kToken + "/\n"));
  ViewClient page = page_of(std::uint16_t(std::stoi(port)));
  ASSERT_TRUE(page.read_final());
  EXPECT_EQ(page.frame.width, 40u);
  EXPECT_THROW(ViewClient(std::uint16_t(std::stoi(port)), "127.0.0.1:" + port,
                          "/" + std::string(kToken) + "/socket", "http://evil.example"),
               WebSocketDeclined);
  EXPECT_TRUE(view.complains("foreign Origin"));
  page.set({{"media.stone.eta", 1.4}});
  ASSERT_TRUE(page.read_final(2));
  page.send({{"do", "render"}, {"name", "page.png"}});
  EXPECT_TRUE(contains(page.read_answer(), "rendering"));
  EXPECT_TRUE(contains(page.read_answer(), "rendered")) << page.texts["told"];
  const std::string command = page.texts.at("scene").at("command");
  EXPECT_TRUE(contains(command, " --set 'film.resolution=[40,24]' --set media.stone.eta=1.4 -o ")) << command;
  ASSERT_EQ(std::system(("cd '" + folder.path.string() + "' && " + command + " >/dev/null").c_str()), 0)
      << command;
  EXPECT_TRUE(bytes_of(folder.file("page.png")) ==
              bytes_of(folder.file(std::filesystem::path(folder.scene).stem().string() + ".png")));
  page.set({{"settings.method", "direct"}, {"settings.entry_samples", 10000000}});
  page.send({{"do", "render"}, {"name", "long.exr"}});
  EXPECT_TRUE(contains(page.read_answer(), "rendering"));
  view.send(SIGINT);
  const Outcome outcome = view.wait(20);
  EXPECT_EQ(outcome.exit_code, 0) << outcome.err << outcome.signal;
  EXPECT_FALSE(std::filesystem::exists(folder.file("long.exr")));
  EXPECT_EQ(folder.entries(), 3u);
}

// Claim: without a scene, the view shows a ball in a folder for dropped files, and renders it there. Fails if the hooks keep
// the scene of the command line, which is none.
TEST(ViewProgram, StartsWithoutAScene) {
  const ScratchFolder folder;
  const std::string port = std::to_string(free_port());
  Child view({"view", "--port", port, "--token", kToken, "--resolution", "24x24"}, folder.path.string());
  ASSERT_TRUE(view.prints("/" + std::string(kToken) + "/\n"));
  ViewClient page = page_of(std::uint16_t(std::stoi(port)));
  ASSERT_TRUE(page.read_final());
  EXPECT_TRUE(contains(page.texts.at("scene").at("command"), "opaline-view/ball.json"));
  page.send({{"do", "render"}, {"name", "ball.png"}});
  EXPECT_TRUE(contains(page.read_answer(), "rendering"));
  EXPECT_TRUE(contains(page.read_answer(), "rendered")) << page.texts["told"];
  view.send(SIGINT);
  EXPECT_EQ(view.wait(20).exit_code, 0);
  EXPECT_TRUE(std::filesystem::exists(folder.file("opaline-view/ball.png")));
  EXPECT_TRUE(std::filesystem::exists(folder.file("opaline-view/ball.json")));
  EXPECT_EQ(folder.entries(), 1u);
}

/// `opaline view` on a terminal of its own.
class ViewOnTerminal {
 public:
  explicit ViewOnTerminal(const std::vector<std::string>& arguments) {
    std::vector<std::string> words{OPALINE_PROGRAM};
    words.insert(words.end(), arguments.begin(), arguments.end());
    std::vector<char*> argv;
    for (std::string& word : words) argv.push_back(word.data());
    argv.push_back(nullptr);
    pid_ = ::forkpty(&terminal_, nullptr, nullptr, nullptr);
    if (pid_ < 0) throw std::runtime_error("no child process");
    if (pid_ > 0) return;
    ::execv(argv[0], argv.data());
    ::_exit(127);
  }
  ~ViewOnTerminal() { ::close(terminal_); }
  ViewOnTerminal(const ViewOnTerminal&) = delete;
  ViewOnTerminal& operator=(const ViewOnTerminal&) = delete;

  /// Reads until it has printed the text; false where it ends before.
  bool prints(const std::string& text) {
    std::array<char, 256> part;
    for (ssize_t count = 0; out_.find(text) == std::string::npos;
         out_.append(part.data(), std::size_t(count)))
      if (count = ::read(terminal_, part.data(), part.size()); count <= 0) return false;
    return true;
  }
  /// Its exit code after Ctrl-C.
  int interrupted() {
    ::kill(pid_, SIGINT);
    int status = 0;
    ::waitpid(pid_, &status, 0);
    return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  }

 private:
  pid_t pid_ = -1;
  int terminal_ = -1;
  std::string out_;
};

/// A folder whose xdg-open notes what it is to open, found before the machine's while the object lives.
struct FakeDesktop : ScratchFolder {
  std::string opened = file("opened"), path = std::getenv("PATH");

  FakeDesktop() {
    const std::string opener = file("xdg-open");
    put_bytes(opener,
              "#!/bin/sh\necho $1 > " + file("part") + " && mv " + file("part") + " " + opened + "\n");
    std::filesystem::permissions(opener, std::filesystem::perms::owner_all);
    ::setenv("PATH", (this->ScratchFolder::path.string() + ":" + path).c_str(), 1);
    for (const char* name : {"DISPLAY", "WAYLAND_DISPLAY"}) ::unsetenv(name);
  }
  ~FakeDesktop() {
    ::setenv("PATH", path.c_str(), 1);
    for (const char* name : {"DISPLAY", "WAYLAND_DISPLAY"}) ::unsetenv(name);
  }

  /// What was opened within some time, and forgets it.
  std::string url(int milliseconds) const {
    for (int i = 0; i < milliseconds / 10 && !std::filesystem::exists(opened); ++i)
      std::this_thread::sleep_for(std::chrono::milliseconds(10));
    const std::string url = std::filesystem::exists(opened) ? bytes_of(opened) : "";
    std::filesystem::remove(opened);
    return url;
  }
};

// Claim: the URL is opened where a person at a desktop, X11's or Wayland's, reads it on a terminal, unless --no-open says
// not to, and nowhere else. Source: the help of view. Fails if: any of the conditions is not looked at.
TEST(ViewProgram, OpensItsUrlOnADesktop) {
  if (!has_terminals()) GTEST_SKIP() << "no pseudo terminals here";
  constexpr int kLong = 20000, kMoment = 300;  // ms
  const ViewFolder folder;
  const FakeDesktop desktop;
  const auto url_from_terminal = [&](const char* display, const std::vector<std::string>& more, int time) {
    if (*display != '\0') ::setenv(display, ":7", 1);
    std::vector<std::string> words{"view", folder.scene, "--token", kToken};
    words.insert(words.end(), more.begin(), more.end());
    ViewOnTerminal view(words);
    if (*display != '\0') ::unsetenv(display);
    EXPECT_TRUE(view.prints(std::string(kToken) + "/"));
    const std::string url = desktop.url(time);
    EXPECT_EQ(view.interrupted(), 0);
    return url;
  };
  for (const char* display : {"DISPLAY", "WAYLAND_DISPLAY"}) {
    const std::string url = url_from_terminal(display, {}, kLong);
    EXPECT_TRUE(url.starts_with("http://127.0.0.1:") && url.ends_with(std::string(kToken) + "/\n")) << url;
    EXPECT_EQ(url_from_terminal(display, {"--no-open"}, kMoment), "");
  }
  EXPECT_EQ(url_from_terminal("", {}, kMoment), "");
  ::setenv("DISPLAY", ":7", 1);
  const Child into_file({"view", folder.scene, "--token", kToken});
  EXPECT_TRUE(into_file.prints(std::string(kToken) + "/\n"));
  EXPECT_EQ(desktop.url(kMoment), "");
  into_file.send(SIGINT);
}

// Claim: what cannot be is said in one line, with the exit codes of all commands.
TEST(ViewProgram, BadArguments) {
  const ViewFolder folder;
  const Listener other;
  const std::string taken = std::to_string(other.port());
  struct Row {
    std::vector<std::string> words;
    int exit_code;
    std::string text;
  };
  for (const Row& row :
       std::vector<Row>{{{"view", "--size", "5cm"}, 2, "--size needs a scene"},
                        {{"view", folder.file("none.json")}, 2, "no such scene file"},
                        {{"view", folder.scene, "--listen", "nowhere"}, 2, "an IP address"},
                        {{"view", folder.scene, "--port", "65536"}, 2, "--port"},
                        {{"view", folder.scene, "--token", "short"}, 2, "16 to 64"},
                        {{"view", folder.scene, "--resolution", "5000x5000"}, 2, "too large for the view"},
                        {{"view", folder.scene, "--port", taken}, 3, "cannot listen: Address already in use"},
                        {{"view", folder.scene, "--listen", "192.0.2.1"}, 3, "cannot listen"}}) {
    const Outcome outcome = run_program(row.words);
    EXPECT_EQ(outcome.exit_code, row.exit_code) << outcome.err;
    EXPECT_TRUE(contains(outcome.err, row.text)) << outcome.err;
  }
}

}  // namespace
}  // namespace opaline
