// SPDX-License-Identifier: GPL-3.0-or-later
#include "input/edited_text.h"

#include <algorithm>
#include <nlohmann/json.hpp>
#include <vector>

namespace opaline {
namespace {

/// Replacement of some bytes of the text.
struct Replacement {
  std::size_t begin, end;
  std::string text;
};

std::string member_text(const Node& member) {
  return nlohmann::json(member.key).dump() + ": " + to_json(member);
}

/// Text between the start of a byte's line and the byte.
std::string_view start_of_line(std::string_view text, std::size_t offset) {
  const std::size_t newline = offset > 0 ? text.rfind('\n', offset - 1) : std::string_view::npos;
  const std::size_t begin = newline == std::string_view::npos ? 0 : newline + 1;
  return text.substr(begin, offset - begin);
}

bool is_blank(std::string_view text) {
  return text.find_first_not_of(" \t\r") == std::string_view::npos;
}

/// Appends members to a nonempty object. A comment after the last member stays with it.
void append_members(std::string_view text, const Node& object, const std::vector<const Node*>& added,
                    std::vector<Replacement>& changes) {
  const Node& last = object.children.back();
  const std::size_t brace = object.end_offset - 1;
  const std::string_view before_brace = start_of_line(text, brace);
  const std::string_view indent = start_of_line(text, last.key_offset);
  const bool has_lines = is_blank(before_brace) && brace - before_brace.size() > last.end_offset;
  std::string members;
  for (const Node* member : added) {
    if (!has_lines || member != added.front()) members += has_lines ? ",\n" : ", ";
    if (has_lines && is_blank(indent)) members += indent;
    members += member_text(*member);
  }
  if (!has_lines) return changes.push_back({last.end_offset, last.end_offset, members});
  changes.push_back({last.end_offset, last.end_offset, ","});
  const std::size_t line = brace - before_brace.size();
  changes.push_back({line, line, members + "\n"});
}

/// Adds the changes in the order of the text.
void add_changes(std::string_view text, const Node& before, const Node& now,
                 std::vector<Replacement>& changes) {
  if (to_json(before) == to_json(now)) return;
  if (before.kind == Node::Kind::array && now.kind == Node::Kind::array &&
      before.children.size() == now.children.size()) {
    for (std::size_t i = 0; i < now.children.size(); ++i)
      add_changes(text, before.children[i], now.children[i], changes);
    return;
  }
  const bool keeps_members = before.kind == Node::Kind::object && now.kind == Node::Kind::object &&
                             !before.children.empty() &&
                             std::ranges::all_of(before.children, [&](const Node& member) {
                               return member.end_offset > 0 && find_member(now, member.key) != nullptr;
                             });
  if (!keeps_members) return changes.push_back({before.offset, before.end_offset, to_json(now)});
  for (const Node& member : before.children)
    add_changes(text, member, *find_member(now, member.key), changes);
  std::vector<const Node*> added;
  for (const Node& member : now.children)
    if (find_member(before, member.key) == nullptr) added.push_back(&member);
  if (!added.empty()) append_members(text, before, added, changes);
}

}  // namespace

std::string edited_text(std::string_view text, const Node& before, const Node& now) {
  std::vector<Replacement> changes;
  add_changes(text, before, now, changes);
  std::string edited;
  std::size_t at = 0;
  for (const Replacement& change : changes) {
    edited += text.substr(at, change.begin - at);
    edited += change.text;
    at = change.end;
  }
  edited += text.substr(at);
  return edited;
}

}  // namespace opaline
