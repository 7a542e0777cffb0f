// SPDX-License-Identifier: GPL-3.0-or-later
// Random scenes with random settings, as scene files.
#pragma once

#include <array>
#include <cstddef>
#include <string>

namespace opaline {

struct RandomPair {
  std::string json;    ///< the scene file
  std::string body;    ///< "torus", "slab", ...
  std::string lights;  ///< "quad and point"
  double length = 0;   ///< largest mean free path of the channels over the size of the body
  int samples_per_pixel = 1, light_samples = 1;
  std::string samples;    ///< asked for; "default"
  std::string evaluator;  ///< as the settings name it
};

/// Pair number `index`: the same on every machine. Bodies of a mesh file stand under scenes_folder.
RandomPair random_pair(std::size_t index, const std::string& scenes_folder);

}  // namespace opaline
