// SPDX-License-Identifier: GPL-3.0-or-later
#include "input/overrides.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <set>
#include <span>
#include <string_view>

#include "input/deprecated_spellings.h"
#include "input/schema.h"
#include "values/nearest_name.h"

namespace opaline {
namespace {

/// Name of a list's element: its own, or the default one ("shape0" in "shapes").
std::string element_name(const Node& list, std::size_t i) {
  const Node* name = find_member(list.children[i], "name");
  if (name != nullptr && name->kind == Node::Kind::string) return name->text;
  return list.key.substr(0, list.key.size() - list.key.ends_with('s')) + std::to_string(i);
}

/// ".5" and "-.5" with a leading zero, as in JSON; empty for anything else.
std::string with_leading_zero(std::string_view value) {
  if (value.starts_with('.')) return '0' + std::string(value);
  if (value.starts_with("-.")) return "-0" + std::string(value.substr(1));
  return {};
}

/// The same for all numbers in a list or object; empty: nothing changes.
std::string with_leading_zeros(std::string_view value) {
  const auto is_digit = [&](std::size_t i) { return i < value.size() && value[i] >= '0' && value[i] <= '9'; };
  std::string text;
  bool is_quoted = false;
  for (std::size_t i = 0; i < value.size(); ++i) {
    if (value[i] == '"' && (i == 0 || value[i - 1] != '\\')) is_quoted = !is_quoted;
    if (!is_quoted && value[i] == '.' && is_digit(i + 1) && (i == 0 || !is_digit(i - 1))) text += '0';
    text += value[i];
  }
  return text.size() > value.size() ? text : std::string();
}

/// True for an intended list or object, valid or not.
bool is_bracketed(std::string_view value) {
  return (value.starts_with('[') && value.ends_with(']')) || (value.starts_with('{') && value.ends_with('}'));
}

bool is_json(std::string_view value) {
  return nlohmann::json::accept(value.begin(), value.end(), /*ignore_comments=*/true);
}

/// The next name of a path.
struct PathName {
  std::string_view name;
  std::size_t end = 0;  ///< end of it in the path, with its quotes
};

class Override {
 public:
  Override(Document& document, int index)
      : document_(document), index_(index), text_(document.overrides[static_cast<std::size_t>(index)]) {}

  void apply() {
    const std::size_t equals = end_of_path();
    if (equals == std::string_view::npos) fail("no value given", "path.to.key=value");
    if (equals == 0) fail("no path given", "path.to.key=value");
    const std::string_view path = text_.substr(0, equals);
    if (std::ranges::count(path, '.') >= max_depth)
      fail("the path is nested too deeply", "at most " + std::to_string(max_depth) + " levels");
    set_below(document_.root, path, 0, text_.substr(equals + 1));
  }

 private:
  /// begin: of the rest of the path, from `node` on
  void set_below(Node& node, std::string_view path, std::size_t begin, std::string_view value) const {
    if (begin > path.size()) return replace(node, value);
    const auto [name, end] = next_name(path, begin, node);
    if (name.empty()) fail("an empty name in the path", "path.to.key=value");
    const std::string_view so_far = path.substr(0, begin > 0 ? begin - 1 : 0);
    if (name != "*" || node.kind != Node::Kind::array)
      return set_below(step(node, name, so_far), path, end + 1, value);
    if (node.children.empty()) fail("'" + printable(so_far) + "' is empty", "at least one element for *");
    for (Node& child : node.children) set_below(child, path, end + 1, value);
  }

  [[noreturn]] void fail(const std::string& message, const std::string& expected = {}) const {
    throw error_at(document_, 0, index_, message, expected);
  }

  /// The first equals sign outside of quotes.
  std::size_t end_of_path() const {
    char quote = 0;
    for (std::size_t i = 0; i < text_.size(); ++i) {
      if (quote != 0 ? text_[i] == quote
                     : (text_[i] == '"' || text_[i] == '\'') && (i == 0 || text_[i - 1] == '.'))
        quote = quote != 0 ? '\0' : text_[i];
      else if (quote == 0 && text_[i] == '=')
        return i;
    }
    return text_.find('=');
  }

  /// A name containing dots is one of the node's children, or quoted.
  PathName next_name(std::string_view path, std::size_t begin, const Node& node) const {
    const std::string_view rest = path.substr(begin);
    if (rest.starts_with('"') || rest.starts_with('\'')) {
      const std::size_t close = rest.find(rest[0], 1);
      const bool is_closed = close != rest.npos && (close + 1 == rest.size() || rest[close + 1] == '.');
      if (!is_closed)
        fail("a quoted name in the path has no closing quote", "path.\"name.with.dots\".key=value");
      return {rest.substr(1, close - 1), begin + close + 1};
    }
    std::size_t length = std::min(rest.find('.'), rest.size());
    for (std::size_t i = 0; i < node.children.size(); ++i) {
      const bool is_list = node.kind == Node::Kind::array;
      const std::string name = is_list ? element_name(node, i) : node.children[i].key;
      const bool is_next = rest.starts_with(name) && (name.size() == rest.size() || rest[name.size()] == '.');
      if (is_next && name.size() > length) length = name.size();
    }
    return {rest.substr(0, length), begin + length};
  }

  /// Child of `parent` at this step of the path, created if missing.
  Node& step(Node& parent, std::string_view name, std::string_view so_far) const {
    if (name == "texture" && is_plain_value(parent)) make_object(parent);
    if (name == "+" && parent.override_index == index_ && parent.children.empty())
      parent.kind = Node::Kind::array;  // there was none
    if (parent.kind == Node::Kind::array) return element(parent, name, so_far);
    if (parent.kind != Node::Kind::object)
      fail("'" + printable(so_far) + "' is a single value, there is no '" + printable(name) + "' in it",
           "--set " + printable(so_far) + "=VALUE");
    for (Node& child : parent.children)
      if (child.key == name) return child;
    Node& child = parent.children.emplace_back();
    child.kind = Node::Kind::object;
    child.key = name;
    child.override_index = index_;
    return child;
  }

  /// True for a colour or a number, replaceable by a texture.
  static bool is_plain_value(const Node& node) {
    const auto is_number = [](const Node& n) { return n.kind == Node::Kind::number; };
    const bool is_triple = node.kind == Node::Kind::array && std::ranges::all_of(node.children, is_number);
    return is_triple || is_number(node) || (node.kind == Node::Kind::string && node.text.starts_with('#'));
  }

  void make_object(Node& node) const {
    Node object;
    object.kind = Node::Kind::object;
    object.key = std::move(node.key);
    object.override_index = index_;
    node = std::move(object);
  }

  Node& element(Node& list, std::string_view name, std::string_view so_far) const {
    if (name == "+") {
      Node& added = list.children.emplace_back();
      added.kind = Node::Kind::object;
      added.override_index = index_;
      return added;
    }
    std::size_t i = 0;
    const auto [end, error] = std::from_chars(name.data(), name.data() + name.size(), i);
    if (error == std::errc{} && end == name.data() + name.size() && i < list.children.size())
      return list.children[i];
    std::vector<std::string> names;
    for (i = 0; i < list.children.size(); ++i) {
      names.push_back(element_name(list, i));
      if (names.back() == name) return list.children[i];
    }
    if (so_far == "shapes" || so_far == "lights") fail_name(name, so_far.substr(0, so_far.size() - 1), names);
    fail("no element '" + printable(name) + "' in '" + printable(so_far) + "'",
         names.empty() ? "none: it is empty" : "an index below " + std::to_string(names.size()));
  }

  /// No shape or light has this name.
  [[noreturn]] void fail_name(std::string_view name, std::string_view kind,
                              const std::vector<std::string>& names) const {
    constexpr std::size_t most = 8;
    std::vector<std::string_view> views(names.begin(), names.end());
    const std::string hint = did_you_mean(name, views);
    views.resize(std::min(views.size(), most));
    const std::string more =
        names.size() > most ? " and " + std::to_string(names.size() - most) + " more" : "";
    fail("no " + std::string(kind) + " '" + printable(name) + '\'' + hint +
         (names.empty() ? "; there is none" : "; available: " + printable(join(views)) + more));
  }

  void replace(Node& node, std::string_view value) const {
    Node fresh;
    const std::string zeroed = is_bracketed(value) ? with_leading_zeros(value) : with_leading_zero(value);
    if (is_json(zeroed)) {
      fresh = parse_tree(document_, zeroed, index_);
    } else if (is_json(value) || is_bracketed(value)) {
      fresh = parse_tree(document_, value, index_);
    } else {
      fresh.kind = Node::Kind::string;
      fresh.text = value;
      fresh.override_index = index_;
    }
    fresh.key = std::move(node.key);
    node = std::move(fresh);
  }

  Document& document_;
  int index_;
  std::string_view text_;
};

std::set<std::string> media_names(const Node& scene) {
  std::set<std::string> names;
  if (const Node* media = find_member(scene, "media"))
    for (const Node& medium : media->children) names.insert(medium.key);
  return names;
}

bool has_shape_of(const Node& scene, std::string_view medium) {
  const Node* shapes = find_member(scene, "shapes");
  return shapes != nullptr &&
         std::any_of(shapes->children.begin(), shapes->children.end(), [&](const Node& s) {
           const Node* name = find_member(s, "medium");
           return name != nullptr && name->text == medium;
         });
}

/// Rejects a new medium used by no shape, with a name similar to an existing one: a likely misspelling.
void check_new_media(const Document& document, const std::set<std::string>& names) {
  const Node* media = find_member(document.root, "media");
  if (media == nullptr || media->override_index >= 0) return;  // the whole list is from the command line
  const std::vector<std::string_view> views(names.begin(), names.end());
  for (const Node& medium : media->children) {
    if (medium.override_index < 0 || names.contains(medium.key)) continue;
    const std::string hint = did_you_mean(medium.key, views);
    if (hint.empty() || has_shape_of(document.root, medium.key)) continue;
    throw error_at(document, 0, medium.override_index, "no '" + printable(medium.key) + "' in 'media'" + hint,
                   "a medium of the file, or a new one used by a shape");
  }
}

/// Removes the opaque surface of a shape made translucent by an override, and vice versa. Of two overrides the later one
/// wins ("shapes.*.medium" before "shapes.floor.reflectance"), but both stay if they name the shape alike, for an error.
void drop_replaced_surface(const Document& document, Node& shape) {
  const auto index_of = [&](std::string_view key) {
    const Node* member = find_member(shape, key);
    return member != nullptr ? member->override_index : -1;
  };
  const auto named_by = [&](int index) {
    const std::string& text = document.overrides[std::size_t(index)];
    return text.substr(0, text.rfind('.', text.find('=')));
  };
  const int medium = index_of("medium"), reflectance = index_of("reflectance");
  if (medium == reflectance) return;
  const int winner = std::max(medium, reflectance);
  const std::span<const std::string_view> replaced =
      replaced_surface_keys(winner == medium ? "medium" : "reflectance");
  std::erase_if(shape.children, [&](const Node& c) {
    const bool is_earlier =
        c.override_index < 0 || (c.override_index < winner && named_by(c.override_index) != named_by(winner));
    return is_earlier && std::ranges::find(replaced, c.key) != replaced.end();
  });
}

/// Keeps the later one of two keys for a property of the camera.
void drop_replaced_lens(Node& camera) {
  using Pair = std::array<std::string_view, 2>;
  for (const Pair& keys : {Pair{"field_of_view", "orthographic_height"}, Pair{"aperture", "f_number"},
                           Pair{"orthographic_height", "f_number"}, Pair{"focus_distance", "focus_point"}}) {
    const Node *first = find_member(camera, keys[0]), *second = find_member(camera, keys[1]);
    if (first == nullptr || second == nullptr || first->override_index == second->override_index) continue;
    const std::string_view earlier = first->override_index < second->override_index ? keys[0] : keys[1];
    std::erase_if(camera.children, [&](const Node& child) { return child.key == earlier; });
  }
}

bool has_environment(const Node& scene) {
  const Node* const lights = find_member(scene, "lights");
  return lights != nullptr && std::ranges::any_of(lights->children, [](const Node& light) {
           const Node* const type = find_member(light, "type");
           return type != nullptr && type->text == "environment";
         });
}

/// Removes the backdrop of a file: it would hide an environment added by an override.
void drop_backdrop(Node& scene) {
  std::erase_if(scene.children,
                [](const Node& child) { return child.key == "backdrop" && child.override_index < 0; });
}

}  // namespace

std::vector<std::string> environment_overrides(const std::string& picture) {
  const nlohmann::json light{{"type", "environment"},
                             {"name", "environment"},
                             {"file", std::filesystem::absolute(picture).string()}};
  const auto replace = nlohmann::json::error_handler_t::replace;
  return {"lights=" + nlohmann::json::array({light}).dump(-1, ' ', false, replace), "surroundings=0",
          "film.exposure=0"};
}

std::span<const std::string_view> replaced_surface_keys(std::string_view key) {
  static constexpr std::array<std::string_view, 11> kOpaque{
      "reflectance",     "metalness",           "specular_roughness", "specular_ior",
      "specular_weight", "specular_anisotropy", "specular_rotation",  "fuzz_weight",
      "fuzz_color",      "fuzz_roughness",      "shadow_catcher"};
  static constexpr std::array<std::string_view, 2> kTranslucent{"medium", "group"};
  if (key == "medium") return kOpaque;
  if (key == "reflectance") return kTranslucent;
  return {};
}

void apply_overrides(Document& document) {
  const std::set<std::string> names = media_names(document.root);
  const bool had_environment = has_environment(document.root);
  for (std::size_t i = 0; i < document.overrides.size(); ++i) {
    Override(document, static_cast<int>(i)).apply();
    replace_deprecated_spellings(document);
  }
  check_new_media(document, names);
  if (!had_environment && has_environment(document.root)) drop_backdrop(document.root);
  for (Node& member : document.root.children)
    if (member.key == "shapes")
      for (Node& shape : member.children) drop_replaced_surface(document, shape);
    else if (member.key == "camera")
      drop_replaced_lens(member);
}

}  // namespace opaline
