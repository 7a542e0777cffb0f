// SPDX-License-Identifier: GPL-3.0-or-later
// What libFuzzer is told about a target: its seeds as files of the first corpus folder, and its words.
#include <tbb/global_control.h>

#include <cstring>

#include "fuzz_target.h"
#include "mutate_bytes.h"

extern "C" std::size_t LLVMFuzzerMutate(std::uint8_t* data, std::size_t size, std::size_t max_size);

extern "C" int LLVMFuzzerInitialize(int* argc, char*** argv) {
  static const tbb::global_control one_thread(tbb::global_control::max_allowed_parallelism, 1);
  for (int i = 1; i < *argc; ++i) {
    const std::string folder = (*argv)[i];
    if (folder.starts_with('-') || !std::filesystem::is_directory(folder)) continue;
    std::size_t number = 0;
    for (const std::string& seed : opaline::fuzz::seeds())
      std::ofstream(folder + "/seed-" + std::to_string(number++), std::ios::binary) << seed;
    break;
  }
  return 0;
}

extern "C" std::size_t LLVMFuzzerCustomMutator(std::uint8_t* data, std::size_t size, std::size_t max_size,
                                               unsigned int seed) {
  static const std::vector<std::string> vocabulary = opaline::fuzz::words();
  opaline::fuzz::Random random(seed);
  if (random() % 2 == 0) return LLVMFuzzerMutate(data, size, max_size);
  const std::string before(reinterpret_cast<const char*>(data), size);
  const std::string after = opaline::fuzz::mutated(before, before, vocabulary, random);
  const std::size_t length = std::min(after.size(), max_size);
  std::memcpy(data, after.data(), length);
  return length;
}
