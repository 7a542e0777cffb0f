// SPDX-License-Identifier: GPL-3.0-or-later
// Memory and time that plans expect, over what renders take, for random scenes.
#include <fmt/format.h>
#include <sys/wait.h>

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "random_scene.h"

namespace {

constexpr const char* kUsage =
    "usage: bench_plan PROGRAM FOLDER [COUNT] [FIRST]\n"
    "Renders COUNT (500) random scenes, from the number FIRST (1) on, with PROGRAM. Prints a line each and a "
    "table by\n"
    "method: the plan's memory and CPU time over the render's. Scenes and images go to FOLDER.\n";

struct Run {
  double planned_memory = 0, memory = 0;    // MB
  double planned_seconds = 0, seconds = 0;  // CPU
  bool is_done = false;
};

Run render(const std::string& program, const std::string& scene) {
  const std::string command =
      fmt::format("'{}' render '{}' -o '{}.exr' --log json 2>&1", program, scene, scene);
  Run run;
  std::FILE* const output = ::popen(command.c_str(), "r");
  if (output == nullptr) return run;
  std::string line;
  for (int c; (c = std::fgetc(output)) != EOF;) {
    if (c != '\n') {
      line += char(c);
      continue;
    }
    const nlohmann::json event = nlohmann::json::parse(line, nullptr, false);
    line.clear();
    if (!event.is_object() || !event.contains("event")) continue;
    if (event["event"] == "plan") {
      run.planned_memory = 1e-6 * event["memory_bytes"].get<double>();
      run.planned_seconds = event["cpu_seconds"].get<double>();
    } else if (event["event"] == "done") {
      run.memory = 1e-6 * event["peak_memory_bytes"].get<double>();
      run.seconds = event["cpu_seconds"].get<double>();
      run.is_done = true;
    }
  }
  ::pclose(output);
  return run;
}

double quantile(std::vector<double> values, double share) {
  std::ranges::sort(values);
  return values[std::size_t(share * double(values.size() - 1))];
}

void print_table(const std::map<std::string, std::vector<Run>>& runs) {
  fmt::print(
      "\n| method | scenes | plan over peak memory: least, median, largest | below 1 | above 1.5 | "
      "plan over CPU, of those above 5 s |\n|---|---|---|---|---|---|\n");
  for (const auto& [method, all] : runs) {
    std::vector<double> memory, time;
    for (const Run& run : all) {
      memory.push_back(run.planned_memory / run.memory);
      if (run.seconds > 5) time.push_back(run.planned_seconds / run.seconds);
    }
    const auto below = std::ranges::count_if(memory, [](double ratio) { return ratio < 1; }),
               above = std::ranges::count_if(memory, [](double ratio) { return ratio > 1.5; });
    fmt::print("| {} | {} | {:.2f}, {:.2f}, {:.2f} | {} | {} | {} |\n", method, all.size(),
               quantile(memory, 0), quantile(memory, .5), quantile(memory, 1), below, above,
               time.empty()
                   ? "none"
                   : fmt::format("{:.2f} to {:.2f}, {}", quantile(time, 0), quantile(time, 1), time.size()));
  }
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 3) {
    fmt::print(stderr, "{}", kUsage);
    return 2;
  }
  const std::string program = argv[1], folder = argv[2];
  const std::uint64_t count = argc > 3 ? std::stoull(argv[3]) : 500,
                      first = argc > 4 ? std::stoull(argv[4]) : 1;
  std::filesystem::create_directories(folder);
  std::map<std::string, std::vector<Run>> runs;
  for (std::uint64_t number = first; number < first + count; ++number) {
    const std::string method = opaline::kPlannedMethods[number % std::size(opaline::kPlannedMethods)];
    const std::string scene = fmt::format("{}/scene{}.json", folder, number);
    std::ofstream(scene) << opaline::random_scene(number, method);
    const Run run = render(program, scene);
    fmt::print("{:>5} {:<16} {}: memory {:.0f} of {:.0f} MB planned, {:.2f}; CPU {:.1f} of {:.1f} s\n",
               number, method, run.is_done ? "done" : "failed", run.memory, run.planned_memory,
               run.planned_memory / run.memory, run.seconds, run.planned_seconds);
    std::fflush(stdout);
    if (run.is_done) runs[method].push_back(run);
  }
  print_table(runs);
}
