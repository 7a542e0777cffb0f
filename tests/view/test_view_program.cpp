// SPDX-License-Identifier: GPL-3.0-or-later
// The program as a user meets it: a URL, files that are those of `opaline render`, an end by Ctrl-C.
#include "../cli/run_program.h"
#include "view_client.h"

namespace opaline {
namespace {

using namespace test;

/// One that was free a moment ago.
std::uint16_t free_port() {
  asio::io_context io;
  return Tcp::acceptor(io, Tcp::endpoint(asio::ip::make_address("127.0.0.1"), 0)).local_endpoint().port();
}

ViewClient page_of(std::uint16_t port) {
  const std::string host = "127.0.0.1:" + std::to_string(port);
  return ViewClient({asio::ip::make_address("127.0.0.1"), port}, host, "/" + std::string(kToken) + "/socket",
                    "http://" + host);
}

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
  EXPECT_THROW(ViewClient({asio::ip::make_address("127.0.0.1"), std::uint16_t(std::stoi(port))},
                          "127.0.0.1:" + port, "/" + std::string(kToken) + "/socket", "http://evil.example"),
               beast::system_error);
  EXPECT_TRUE(view.complains("foreign Origin"));
  page.set({{"media.stone.eta", 1.4}});
  ASSERT_TRUE(page.read_final(2));
  page.send({{"do", "render"}, {"name", "page.exr"}});
  EXPECT_TRUE(contains(page.read_answer(), "rendering"));
  EXPECT_TRUE(contains(page.read_answer(), "rendered")) << page.texts["told"];
  EXPECT_EQ(page.texts.at("scene").at("command"),
            "opaline render " + folder.scene + " --set 'film.resolution=[40,24]' --set media.stone.eta=1.4");
  ASSERT_EQ(run_program({"render", folder.scene, "-o", folder.file("command.exr"), "--set",
                         "film.resolution=[40,24]", "--set", "media.stone.eta=1.4"})
                .exit_code,
            0);
  EXPECT_TRUE(bytes_of(folder.file("page.exr")) == bytes_of(folder.file("command.exr")));
  page.set({{"settings.method", "direct"}, {"settings.entry_samples", 10000000}});
  page.send({{"do", "render"}, {"name", "long.exr"}});
  EXPECT_TRUE(contains(page.read_answer(), "rendering"));
  view.send(SIGINT);
  const Outcome outcome = view.wait(20);
  EXPECT_EQ(outcome.exit_code, 0) << outcome.err << outcome.signal;
  EXPECT_FALSE(std::filesystem::exists(folder.file("long.exr")));
  EXPECT_EQ(folder.entries(), 3u);
}

// Claim: the URL is opened where there is a desktop, unless --no-open says not to, and nowhere else. Source: the help of
// view. Fails if: no desktop is asked for, or the flag is not looked at.
TEST(ViewProgram, OpensItsUrlOnADesktop) {
  const ViewFolder folder;
  const std::string opener = folder.file("xdg-open"), opened = folder.file("opened");
  put_bytes(opener, "#!/bin/sh\necho $1 >> " + opened + "\n");
  std::filesystem::permissions(opener, std::filesystem::perms::owner_all);
  const std::string path = std::getenv("PATH");
  const auto urls_opened = [&](const char* desktop, const std::vector<std::string>& more) {
    ::setenv("PATH", (folder.path.string() + ":" + path).c_str(), 1);
    ::setenv("DISPLAY", desktop, 1);
    if (*desktop == '\0') ::unsetenv("DISPLAY");
    std::vector<std::string> words{"view", folder.scene, "--token", kToken};
    words.insert(words.end(), more.begin(), more.end());
    Child view(words);
    ::setenv("PATH", path.c_str(), 1);
    ::unsetenv("DISPLAY");
    EXPECT_TRUE(view.prints(std::string(kToken) + "/\n"));
    if (*desktop != '\0' && more.empty())
      for (int i = 0; i < 500 && !std::filesystem::exists(opened); ++i)
        std::this_thread::sleep_for(std::chrono::milliseconds(10));
    view.send(SIGINT);
    EXPECT_EQ(view.wait(20).exit_code, 0);
    std::string url = std::filesystem::exists(opened) ? bytes_of(opened) : "";
    std::filesystem::remove(opened);
    return url;
  };
  const std::string url = urls_opened(":7", {});
  EXPECT_TRUE(url.starts_with("http://127.0.0.1:") && url.ends_with(std::string(kToken) + "/\n")) << url;
  EXPECT_EQ(urls_opened(":7", {"--no-open"}), "");
  EXPECT_EQ(urls_opened("", {}), "");
}

// Claim: what cannot be is said in one line, with the exit codes of all commands.
TEST(ViewProgram, BadArguments) {
  const ViewFolder folder;
  asio::io_context io;
  const Tcp::acceptor other(io, Tcp::endpoint(asio::ip::make_address("127.0.0.1"), 0));
  const std::string taken = std::to_string(other.local_endpoint().port());
  struct Row {
    std::vector<std::string> words;
    int exit_code;
    std::string text;
  };
  for (const Row& row :
       std::vector<Row>{{{"view"}, 2, "SCENE is required"},
                        {{"view", folder.file("none.json")}, 2, "no such scene file"},
                        {{"view", folder.scene, "--listen", "nowhere"}, 2, "an IP address"},
                        {{"view", folder.scene, "--port", "65536"}, 2, "--port"},
                        {{"view", folder.scene, "--token", "short"}, 2, "16 to 64"},
                        {{"view", folder.scene, "--resolution", "5000x5000"}, 2, "too large to be viewed"},
                        {{"view", folder.scene, "--port", taken}, 3, "cannot listen: Address already in use"},
                        {{"view", folder.scene, "--listen", "192.0.2.1"}, 3, "cannot listen"}}) {
    const Outcome outcome = run_program(row.words);
    EXPECT_EQ(outcome.exit_code, row.exit_code) << outcome.err;
    EXPECT_TRUE(contains(outcome.err, row.text)) << outcome.err;
  }
}

}  // namespace
}  // namespace opaline
