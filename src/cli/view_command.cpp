// SPDX-License-Identifier: GPL-3.0-or-later
#include <fcntl.h>
#include <fmt/format.h>
#include <spawn.h>
#include <sys/wait.h>
#include <tbb/global_control.h>
#include <unistd.h>

#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <optional>
#include <thread>

#include "benchmark/child_process.h"
#include "cli/commands.h"
#include "cli/metadata.h"
#include "core/atomic_file.h"
#include "opaline/error.h"
#include "view/view_server.h"

namespace opaline {
namespace {

/// Renders a file in a process of its own, with the same bytes as `opaline render`, while the view continues.
void render_file(const ViewArguments& arguments, const std::string& scene,
                 const std::vector<std::string>& overrides, std::optional<int> frame, const std::string& path,
                 Monitor& monitor) {
  std::vector<std::string> words{"render", scene, "-o", path, "--log", "json"};
  for (const std::string& text : overrides) words.insert(words.end(), {"--set", text});
  if (frame) words.insert(words.end(), {"--frames", std::to_string(*frame)});
  if (arguments.threads > 0) words.insert(words.end(), {"--threads", std::to_string(arguments.threads)});
  const OwnChild child = run_own_child(words, monitor);
  if (!child.failure.empty()) throw run_failed({}, child.failure);
}

/// True if a person at a desktop reads the output.
bool is_at_desktop() {
  return (std::getenv("DISPLAY") != nullptr || std::getenv("WAYLAND_DISPLAY") != nullptr) &&
         ::isatty(STDOUT_FILENO) == 1;
}

/// Opens a URL in the desktop's browser; fails silently, as the URL is printed.
void open_on_desktop(std::string url) {
  posix_spawn_file_actions_t silent;
  ::posix_spawn_file_actions_init(&silent);
  for (const int stream : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO})
    ::posix_spawn_file_actions_addopen(&silent, stream, "/dev/null", O_RDWR, 0);
  std::string word = "xdg-open";
  char* const words[] = {word.data(), url.data(), nullptr};
  pid_t opener = 0;
  if (::posix_spawnp(&opener, word.c_str(), &silent, nullptr, words, environ) == 0)
    std::thread([opener] { ::waitpid(opener, nullptr, 0); }).detach();
  ::posix_spawn_file_actions_destroy(&silent);
}

constexpr const char* kFolder = "opaline-view";
constexpr const char* kExample = R"({
  "media": {"marble": {"preset": "marble"}},
  "shapes": [{"name": "ball", "sphere": {"radius": 15}, "medium": "marble"}],
  "lights": [
    {"name": "key", "type": "sphere", "center": [-40, 50, 40], "radius": 8, "radiance": 25, "visible": false},
    {"name": "rim", "type": "sphere", "center": [40, 20, -50], "radius": 8, "radiance": 40, "visible": false}
  ],
  "surroundings": 0.1,
  "backdrop": 0.05,
  "camera": {"position": [0, 12, 78], "look_at": [0, 0, 0], "field_of_view": 30}
}
)";

/// Scene to start from without one.
std::string example_scene() {
  const std::filesystem::path path = std::filesystem::path(kFolder) / "ball.json";
  std::error_code unwritable;  // reported by write_file
  std::filesystem::create_directories(kFolder, unwritable);
  if (!std::filesystem::exists(path)) write_file(path.string(), kExample);
  return path.string();
}

}  // namespace

void view_command(const ViewArguments& arguments) {
  std::signal(SIGPIPE, SIG_IGN);  // a page leaving must not end the others'
  std::optional<tbb::global_control> threads;
  if (arguments.threads > 0)
    threads.emplace(tbb::global_control::max_allowed_parallelism, std::size_t(arguments.threads));
  const std::string scene = arguments.scene.empty() ? example_scene() : arguments.scene;
  ViewOptions options = arguments.options;
  options.folder = kFolder;
  RenderArguments render;
  render.program = arguments.program;
  const ViewHooks hooks{
      [&](const std::string& text) {
        if (!arguments.log.quiet) print_warning(arguments.log, "refused " + text);
      },
      [&](const std::string& file, const std::vector<std::string>& overrides, std::optional<int> frame) {
        render.scene = file;
        render.outputs = {std::filesystem::path(file).stem().string() + ".png"};
        render.overrides = overrides;
        return command_again(render) + (frame ? " --frames " + std::to_string(*frame) : "");
      },
      [&](const std::string& file, const std::vector<std::string>& overrides, std::optional<int> frame,
          const std::string& path,
          Monitor& stopped) { render_file(arguments, file, overrides, frame, path, stopped); }};
  ViewServer server(SceneEdits(scene, arguments.overrides, arguments.frames), options, hooks);
  server.stop_at_signals();
  print_event(arguments.log, "view", {{"url", server.url()}});
  if (arguments.log.format == LogFormat::text) write_line(stdout, "view        " + server.url());
  if (arguments.opens_browser && is_at_desktop()) open_on_desktop(server.url());
  server.run();
}

}  // namespace opaline
