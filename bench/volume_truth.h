// SPDX-License-Identifier: GPL-3.0-or-later
// Radiant exitance by random walks, kept in a file.
#pragma once

#include <cstdint>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "opaline/vec3.h"

namespace opaline {

/// One value a sample's cell, and its standard error.
struct Truth {
  std::vector<RgbF> exitance, error;
};

inline bool read_truth(const std::string& path, Truth& truth) {
  std::ifstream file(path, std::ios::binary);
  std::uint64_t count = 0;
  if (!file.read(reinterpret_cast<char*>(&count), sizeof count)) return false;
  for (std::vector<RgbF>* values : {&truth.exitance, &truth.error}) {
    values->resize(count);
    file.read(reinterpret_cast<char*>(values->data()), std::streamsize(count * sizeof(RgbF)));
  }
  return bool(file);
}

/// Written beside and renamed.
inline void write_truth(const std::string& path, const Truth& truth) {
  const std::string partial = path + ".partial";
  {
    std::ofstream file(partial, std::ios::binary);
    const std::uint64_t count = truth.exitance.size();
    file.write(reinterpret_cast<const char*>(&count), sizeof count);
    for (const std::vector<RgbF>* values : {&truth.exitance, &truth.error})
      file.write(reinterpret_cast<const char*>(values->data()), std::streamsize(count * sizeof(RgbF)));
  }
  std::filesystem::rename(partial, path);
}

}  // namespace opaline
