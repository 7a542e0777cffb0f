// SPDX-License-Identifier: GPL-3.0-or-later
#include "benchmark/page.h"

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string_view>

#include "core/atomic_file.h"
#include "core/input_file.h"
#include "core/log.h"
#include "opaline/error.h"

namespace opaline {

std::string page_of(const Json& data) {
  std::string text;  // "<" escaped, so no "</script>" or "<!--" in a name ends the script element
  for (const char c : data.dump(-1, ' ', false, Json::error_handler_t::replace))
    text += c == '<' ? std::string("\\u003c") : std::string(1, c);
  constexpr std::string_view mark = "{{data}}";
  std::string page = kPage;
  return page.replace(page.find(mark), mark.size(), text);
}

void check_page_file(const std::string& path) {
  const AtomicFile checked(path);
  constexpr std::uintmax_t kHead = 4096;  // has the title
  const std::string head = std::filesystem::exists(path) ? InputFile(path).read(0, kHead) : "";
  if (!head.empty() && head.find("opaline") == std::string::npos)
    throw bad_file(path, "exists and is not a page of opaline", "another folder");
}

}  // namespace opaline
