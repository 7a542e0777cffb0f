// SPDX-License-Identifier: GPL-3.0-or-later
// The scene reader: a scene's text, and after it a line "--set path=value" for each override.
#include "fuzz_target.h"
#include "input/load_scene.h"
#include "input/schema.h"

namespace opaline::fuzz {

std::vector<std::string> seeds() {
  return {};
}

std::vector<std::string> words() {
  std::vector<std::string> all{"{",       "}",        "[",    "]",    "//",    "/*",      "*/",
                               "\\u0000", "\n--set ", "null", "true", "keyed", "between", "spline"};
  for (const KeyInfo& info : schema()) {
    const std::string key(info.key);
    all.push_back('"' + key + "\": ");
    all.push_back("\n--set " + std::string(info.section) + '.' + key + '=');
    all.push_back('.' + key);
  }
  return all;
}

}  // namespace opaline::fuzz

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  constexpr std::string_view option = "\n--set ";
  const std::string_view input(reinterpret_cast<const char*>(data), size);
  std::size_t at = input.find(option);
  const std::string_view text = input.substr(0, at);
  std::vector<std::string> overrides;
  while (at != input.npos) {
    const std::size_t begin = at + option.size();
    at = input.find(option, begin);
    overrides.emplace_back(input.substr(begin, at == input.npos ? at : at - begin));
  }
  opaline::fuzz::try_input([&] { opaline::parse_scene(text, "scene.json", overrides, int(size % 5)); });
  return 0;
}
