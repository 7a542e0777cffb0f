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

std::string member_text(const Node& owner, const Node& member) {
  if (owner.kind == Node::Kind::array) return to_json(member);
  return nlohmann::json(member.key).dump() + ": " + to_json(member);
}

/// End of a JSON string.
std::size_t end_of_string(std::string_view text, std::size_t begin) {
  std::size_t end = begin + 1;
  while (text[end] != '"') end += text[end] == '\\' ? 2 : 1;
  return end + 1;
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

/// Appends members to a nonempty object, or elements to a list. A comment after the last one stays with it.
void append_members(std::string_view text, const Node& owner, const std::vector<const Node*>& added,
                    std::vector<Replacement>& changes) {
  const Node& last = owner.children.back();
  const std::size_t brace = owner.end_offset - 1;
  const std::string_view before_brace = start_of_line(text, brace);
  const std::string_view indent =
      start_of_line(text, owner.kind == Node::Kind::array ? last.offset : last.key_offset);
  const bool has_lines = is_blank(before_brace) && brace - before_brace.size() > last.end_offset;
  std::string members;
  for (const Node* member : added) {
    if (!has_lines || member != added.front()) members += has_lines ? ",\n" : ", ";
    if (has_lines && is_blank(indent)) members += indent;
    members += member_text(owner, *member);
  }
  if (!has_lines) return changes.push_back({last.end_offset, last.end_offset, members});
  changes.push_back({last.end_offset, last.end_offset, ","});
  const std::size_t line = brace - before_brace.size();
  changes.push_back({line, line, members + "\n"});
}

/// True for a list with as many elements or more.
bool keeps_elements(const Node& before, const Node& now) {
  if (before.kind != Node::Kind::array || now.kind != Node::Kind::array) return false;
  if (before.children.size() == now.children.size()) return true;
  return !before.children.empty() && before.children.back().end_offset > 0 &&
         before.children.size() < now.children.size();
}

/// True for the same members, some of them under other keys.
bool has_renamed_member(const Node& before, const Node& now) {
  if (before.kind != Node::Kind::object || now.kind != Node::Kind::object ||
      before.children.size() != now.children.size())
    return false;
  std::size_t renamed = 0;
  for (std::size_t i = 0; i < now.children.size(); ++i) {
    const Node &old = before.children[i], &fresh = now.children[i];
    if (old.end_offset == 0) return false;
    if (old.key == fresh.key) continue;
    if (find_member(before, fresh.key) != nullptr || find_member(now, old.key) != nullptr) return false;
    ++renamed;
  }
  return renamed > 0;
}

void add_changes(std::string_view text, const Node& before, const Node& now,
                 std::vector<Replacement>& changes);

/// Changes of elements or members in the same order, the first ones of `now`.
void add_changes_in_order(std::string_view text, const Node& before, const Node& now,
                          std::vector<Replacement>& changes) {
  for (std::size_t i = 0; i < before.children.size(); ++i) {
    const Node &old = before.children[i], &fresh = now.children[i];
    if (old.key != fresh.key)
      changes.push_back(
          {old.key_offset, end_of_string(text, old.key_offset), nlohmann::json(fresh.key).dump()});
    add_changes(text, old, fresh, changes);
  }
}

/// Adds the changes in the order of the text.
void add_changes(std::string_view text, const Node& before, const Node& now,
                 std::vector<Replacement>& changes) {
  if (to_json(before) == to_json(now)) return;
  std::vector<const Node*> added;
  if (has_renamed_member(before, now)) {
    add_changes_in_order(text, before, now, changes);
  } else if (keeps_elements(before, now)) {
    add_changes_in_order(text, before, now, changes);
    for (std::size_t i = before.children.size(); i < now.children.size(); ++i)
      added.push_back(&now.children[i]);
  } else if (before.kind == Node::Kind::object && now.kind == Node::Kind::object &&
             !before.children.empty() && std::ranges::all_of(before.children, [&](const Node& member) {
               return member.end_offset > 0 && find_member(now, member.key) != nullptr;
             })) {
    for (const Node& member : before.children)
      add_changes(text, member, *find_member(now, member.key), changes);
    for (const Node& member : now.children)
      if (find_member(before, member.key) == nullptr) added.push_back(&member);
  } else {
    changes.push_back({before.offset, before.end_offset, to_json(now)});
  }
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
