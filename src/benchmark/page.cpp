// SPDX-License-Identifier: GPL-3.0-or-later
#include "benchmark/page.h"

#include <filesystem>
#include <utility>

#include "core/log.h"
#include "opaline/core/atomic_file.h"
#include "opaline/core/error.h"
#include "opaline/core/input_file.h"

namespace opaline {
namespace {

/// JSON for a script element, which no "</script>" or "<!--" in a name can end.
std::string data_text(const Json& data) {
  std::string text;
  for (const char c : data.dump(-1, ' ', false, Json::error_handler_t::replace))
    text += c == '<' ? std::string("\\u003c") : std::string(1, c);
  return text;
}

}  // namespace

std::string page_of(const Json& data) {
  const std::pair<std::string, std::string> parts[] = {{"{{library_hash}}", kPageFiles.library_hash},
                                                       {"{{script_hash}}", kPageFiles.script_hash},
                                                       {"{{style}}", kPageFiles.style},
                                                       {"{{data}}", data_text(data)},
                                                       {"{{library}}", kPageFiles.library},
                                                       {"{{script}}", kPageFiles.script}};
  std::string page = kPageFiles.frame;
  std::size_t at = 0;  // behind what is filled in already
  for (const auto& [mark, text] : parts) {
    at = page.find(mark, at);
    require(at != std::string::npos, "the frame of the page lacks a mark");
    page.replace(at, mark.size(), text);
    at += text.size();
  }
  return page;
}

void check_page_file(const std::string& path) {
  const AtomicFile checked(path);
  constexpr std::uintmax_t kHead = 4096;  // has the title
  const std::string head = std::filesystem::exists(path) ? InputFile(path).read(0, kHead) : "";
  if (!head.empty() && head.find("opaline") == std::string::npos)
    throw bad_file(path, "is there already and is no page of opaline's", "another folder");
}

}  // namespace opaline
