// SPDX-License-Identifier: GPL-3.0-or-later
#include "benchmark/machine.h"

#include <OpenImageIO/hash.h>
#include <fmt/chrono.h>
#include <fmt/format.h>
#include <sys/utsname.h>

#include <cstdlib>
#include <ctime>
#include <fstream>
#include <sstream>
#include <thread>

#include "opaline/error.h"

namespace opaline {
namespace {

std::string cpu_model() {
  std::ifstream file("/proc/cpuinfo");
  for (std::string line; std::getline(file, line);)
    if (line.starts_with("model name")) return line.substr(std::min(line.find(": "), line.size() - 2) + 2);
  return "unknown";
}

std::string load() {
  double minutes[1] = {};
  return ::getloadavg(minutes, 1) == 1 ? fmt::format("{:.2f}", minutes[0]) : "unknown";
}

std::string system_name() {
  utsname name{};
  return ::uname(&name) == 0 ? fmt::format("{} {} {}", name.sysname, name.release, name.machine) : "unknown";
}

std::string compiler() {
#ifdef __clang__
  return "Clang " __clang_version__;
#else
  return "GCC " __VERSION__;
#endif
}

}  // namespace

const std::string& program_hash() {
  static const std::string hash = [] {
    std::ifstream file("/proc/self/exe", std::ios::binary);
    std::ostringstream bytes;
    if (!(bytes << file.rdbuf())) throw run_failed("/proc/self/exe", "cannot read the program");
    const std::string program = bytes.str();
    return OIIO::SHA1(program.data(), program.size()).digest();
  }();
  return hash;
}

std::vector<std::pair<std::string, std::string>> machine_notes() {
  return {{"version", "opaline " OPALINE_VERSION},
          {"commit", OPALINE_COMMIT},
          {"program", program_hash().substr(0, 16)},
          {"date", fmt::format("{:%Y-%m-%dT%H:%M:%SZ}", fmt::gmtime(std::time(nullptr)))},
          {"cpu", cpu_model()},
          {"cores", std::to_string(std::thread::hardware_concurrency())},
          {"load", load()},
          {"system", system_name()},
          {"compiler", compiler()},
          {"build", OPALINE_BUILD_TYPE}};
}

}  // namespace opaline
