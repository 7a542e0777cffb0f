// SPDX-License-Identifier: GPL-3.0-or-later
// Renders mutations of whole scenes at 16 x 16 pixels, in processes of their own. A finding is a crash, 20 s
// of CPU, more memory than the plan said, pixels that are not finite, and any end but a picture or an Error.
// Each is written down as a scene file and named.
//   fuzz_render SCENES... [--scenes N] [--seconds S] [--seed K]
#include <sys/mman.h>
#include <sys/resource.h>
#include <sys/time.h>
#include <sys/wait.h>
#include <tbb/global_control.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cstring>

#include "core/machine_memory.h"
#include "fuzz_target.h"
#include "input/load_scene.h"
#include "mutate_scene.h"
#include "session/session_records.h"

namespace opaline::fuzz {
namespace {

using Clock = std::chrono::steady_clock;

constexpr std::size_t kBatch = 100;  // scenes of one process
constexpr std::size_t kMostFindings = 20;
constexpr std::size_t kLargest =
    1200u << 20;  // bytes of a plan: a larger one is said before the work, and not begun
constexpr std::size_t kSlack = 64u << 20;  // bytes, of what earlier scenes left in the heap
constexpr int kSeconds = 20;               // of CPU

struct Options {
  std::vector<std::string> scenes;
  std::size_t count = 500, seed = 1;
  double seconds = 1e6;
};

enum class Phase { loading, too_large, rendering };
constexpr std::array kPhases{"while loading", "too large", "while rendering"};

/// What the process that works on a batch is at, for the one that waits for it.
struct Progress {
  std::size_t next, refused, too_large, rendered;
  Phase phase;
  std::size_t length;
  char scene[1 << 20], finding[256];
};

Options options_of(int argc, char** argv) {
  Options options;
  for (int i = 1; i < argc; ++i) {
    const std::string word = argv[i];
    const bool has_value = i + 1 < argc;
    if (word == "--scenes" && has_value)
      options.count = std::stoull(argv[++i]);
    else if (word == "--seconds" && has_value)
      options.seconds = std::stod(argv[++i]);
    else if (word == "--seed" && has_value)
      options.seed = std::stoull(argv[++i]);
    else
      options.scenes.push_back(word);
  }
  return options;
}

std::size_t peak_memory() {
  std::ifstream file("/proc/self/status");
  for (std::string line; std::getline(file, line);)
    if (line.starts_with("VmHWM:")) return std::stoull(line.substr(6)) << 10;
  return 0;
}

/// What is wrong with the scene; empty if nothing is.
std::string finding_of(const std::string& text, Progress& progress) {
  std::ofstream("/proc/self/clear_refs") << 5;  // the peak is the present from here on
  const std::size_t before = resident_memory();
  progress.phase = Phase::loading;
  Session session;
  session.expect_edits(false);
  session.edit(parse_scene(text, "scene.json"));
  progress.phase = session.plan().bytes > kLargest ? Phase::too_large : Phase::rendering;
  if (progress.phase == Phase::too_large) return {};
  const RenderResult result = session.render();
  if (result.non_finite > 0) return std::to_string(result.non_finite) + " pixels are not finite";
  if (peak_memory() > before + session.plan().bytes + kSlack)
    return std::to_string((peak_memory() - before) >> 20) + " MB where the plan said " +
           std::to_string(session.plan().bytes >> 20);
  return {};
}

std::string end_of(const std::string& text, Progress& progress) {
  try {
    const std::string finding = finding_of(text, progress);
    ++(progress.phase == Phase::too_large ? progress.too_large : progress.rendered);
    return finding;
  } catch (const Error&) {
    ++progress.refused;
    return {};
  } catch (const std::exception& other) {
    return std::string("not an Error but: ") + other.what();
  }
}

/// Each scene depends on its number alone.
std::string scene_text(const std::vector<Json>& scenes, const Options& options, std::size_t number) {
  Random random(options.seed * 1000003 + number);
  random.discard(4);
  return mutated_scene(scenes[below(random, scenes.size())], random).dump(1);
}

void run_batch(const std::vector<Json>& scenes, const Options& options, Clock::time_point end,
               Progress& progress) {
  for (std::size_t i = 0; i < kBatch && progress.next < options.count && Clock::now() < end; ++i) {
    const std::string text = scene_text(scenes, options, progress.next);
    progress.length = std::min(text.size(), sizeof progress.scene);
    std::memcpy(progress.scene, text.data(), progress.length);
    const itimerval patience{{0, 0}, {kSeconds, 0}};
    ::setitimer(ITIMER_PROF, &patience, nullptr);  // its signal ends the process
    const std::string finding = end_of(text, progress);
    std::snprintf(progress.finding, sizeof progress.finding, "%s", finding.c_str());
    ++progress.next;
    if (!finding.empty()) return;
  }
  progress.finding[0] = '\0';
}

void write_finding(const Progress& progress, const std::string& what) {
  const std::string path = "fuzz-finding-" + std::to_string(progress.next) + ".json";
  std::ofstream(path, std::ios::binary).write(progress.scene, std::streamsize(progress.length));
  std::fprintf(stderr, "%s: %s\n", path.c_str(), what.c_str());
}

/// Whether there was a finding.
bool look_at_end(Progress& progress, int status) {
  if (WIFSIGNALED(status)) {
    write_finding(progress,
                  std::string(WTERMSIG(status) == SIGPROF ? "20 s of CPU" : strsignal(WTERMSIG(status))) +
                      ' ' + kPhases[std::size_t(progress.phase)]);
    ++progress.next;
    return true;
  }
  if (progress.finding[0] == '\0') return false;
  --progress.next;  // its number
  write_finding(progress, progress.finding);
  ++progress.next;
  progress.finding[0] = '\0';
  return true;
}

/// Files of meshes and pictures as they are found from anywhere.
void make_absolute(Json& value, const std::filesystem::path& folder) {
  if (!value.is_structured()) return;
  for (auto& [key, child] : value.items())
    if ((key == "file" || key == "texture") && child.is_string())
      child = (folder / child.get<std::string>()).string();
    else
      make_absolute(child, folder);
}

int run(const Options& options) {
  void* const memory = ::mmap(nullptr, sizeof(Progress), PROT_READ | PROT_WRITE,
                              MAP_SHARED | MAP_ANONYMOUS | MAP_NORESERVE, -1, 0);
  expect(memory != MAP_FAILED && !options.scenes.empty(), "memory and scenes");
  Progress& progress = *static_cast<Progress*>(memory);
  std::vector<Json> scenes;
  for (const std::string& path : options.scenes) {
    const std::filesystem::path folder = std::filesystem::absolute(path).parent_path();
    scenes.push_back(Json::parse(file_bytes(path), nullptr, true, true));
    make_absolute(scenes.back(), folder);
  }
  const auto end = Clock::now() + std::chrono::duration_cast<Clock::duration>(
                                      std::chrono::duration<double>(std::min(options.seconds, 1e6)));
  std::size_t findings = 0;
  while (progress.next < options.count && Clock::now() < end && findings < kMostFindings) {
    const pid_t child = ::fork();
    if (child == 0) {
      run_batch(scenes, options, end, progress);
      std::_Exit(0);
    }
    int status = 0;
    ::waitpid(child, &status, 0);
    findings += look_at_end(progress, status) ? 1 : 0;
  }
  std::printf("%zu scenes: %zu rendered, %zu refused, %zu too large; %zu findings\n", progress.next,
              progress.rendered, progress.refused, progress.too_large, findings);
  return findings == 0 ? 0 : 1;
}

}  // namespace
}  // namespace opaline::fuzz

int main(int argc, char** argv) {
  const tbb::global_control one_thread(tbb::global_control::max_allowed_parallelism, 1);
  return opaline::fuzz::run(opaline::fuzz::options_of(argc, argv));
}
