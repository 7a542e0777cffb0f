// SPDX-License-Identifier: GPL-3.0-or-later
// What is tried with made-up bytes. A target defines these three; it is linked with run_target.cpp, which
// replays and mutates by a seed, or with libFuzzer and explore_target.cpp.
#pragma once

#include <unistd.h>

#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>
#include <string_view>
#include <vector>

#include "opaline/error.h"

/// Tries one input; returns unless the program is at fault.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size);

namespace opaline::fuzz {

/// Inputs to begin with that are no files of the corpus, because the program makes them.
std::vector<std::string> seeds();

/// Words of the format, which chance would not find.
std::vector<std::string> words();

/// Bad input may be refused, by that error alone. All others, std::bad_alloc among them, end the process:
/// what a file makes the program allocate is bounded by the file's own length.
template <class Action>
void try_input(const Action& action) {
  try {
    action();
  } catch (const Error& error) {
    if (error.kind == ErrorKind::bad_input) return;
    std::fprintf(stderr, "not bad input but: %s\n", error.what());
    std::abort();
  }
}

/// Ends the process where something is not so.
inline void expect(bool holds, const char* what) {
  if (holds) return;
  std::fprintf(stderr, "expected %s\n", what);
  std::abort();
}

/// A file of the process's own, in memory where the machine has such a folder.
class ScratchFile {
 public:
  explicit ScratchFile(const std::string& extension) {
    const std::filesystem::path memory = "/dev/shm";
    folder_ = (std::filesystem::is_directory(memory) ? memory : std::filesystem::temp_directory_path()) /
              ("opaline-fuzz-" + std::to_string(::getpid()));
    std::filesystem::create_directories(folder_);
    path_ = (folder_ / ("input." + extension)).string();
  }
  ~ScratchFile() {
    std::error_code ignored;
    std::filesystem::remove_all(folder_, ignored);
  }
  ScratchFile(const ScratchFile&) = delete;
  ScratchFile& operator=(const ScratchFile&) = delete;

  const std::string& path() const { return path_; }
  std::string folder() const { return folder_.string(); }
  void put(std::string_view bytes) const {
    std::ofstream(path_, std::ios::binary).write(bytes.data(), std::streamsize(bytes.size()));
  }

 private:
  std::filesystem::path folder_;
  std::string path_;
};

inline std::string file_bytes(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

}  // namespace opaline::fuzz
