// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include <cstdlib>
#include <nlohmann/json.hpp>

#include "values/json_tree.h"

namespace opaline {
namespace {

constexpr std::size_t kWidest = 100;  // maximum bytes of a value on one line

std::string quoted(const std::string& text) {
  return nlohmann::json(text).dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
}

std::string number_text(const Node& node) {
  return std::strtod(node.text.c_str(), nullptr) == node.number ? node.text : fmt::format("{}", node.number);
}

std::string written(const Node& node, std::size_t indent) {
  switch (node.kind) {
    case Node::Kind::null:
      return "null";
    case Node::Kind::boolean:
      return node.boolean ? "true" : "false";
    case Node::Kind::number:
      return number_text(node);
    case Node::Kind::string:
      return quoted(node.text);
    case Node::Kind::array:
    case Node::Kind::object:
      break;
  }
  const bool is_object = node.kind == Node::Kind::object;
  std::vector<std::string> parts;
  std::size_t width = indent + 2;
  bool fits = true;
  for (const Node& child : node.children) {
    parts.push_back((is_object ? quoted(child.key) + ": " : "") + written(child, indent + 2));
    width += parts.back().size() + 2;
    fits = fits && width <= kWidest && parts.back().find('\n') == std::string::npos;
  }
  const std::string space(fits ? 0 : indent + 2, ' ');
  std::string text(1, is_object ? '{' : '[');
  for (std::size_t i = 0; i < parts.size(); ++i)
    text += (i > 0 ? fits ? ", " : "," : "") + std::string(fits ? "" : "\n") + space + parts[i];
  if (!fits) text += '\n' + std::string(indent, ' ');
  return text + (is_object ? '}' : ']');
}

}  // namespace

std::string to_json(const Node& node) {
  return written(node, 0);
}

}  // namespace opaline
