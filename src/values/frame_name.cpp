// SPDX-License-Identifier: GPL-3.0-or-later
#include "values/frame_name.h"

#include <cstdlib>

namespace opaline {

std::string with_frame(const std::string& path, int frame) {
  const std::size_t begin = path.rfind("##");
  if (begin == std::string::npos) return path;
  const std::size_t end = begin + 2, first = path.find_last_not_of('#', begin) + 1;
  std::string number = std::to_string(std::abs(frame));
  if (number.size() < end - first) number.insert(0, end - first - number.size(), '0');
  return path.substr(0, first) + (frame < 0 ? "-" : "") + number + path.substr(end);
}

}  // namespace opaline
