// SPDX-License-Identifier: GPL-3.0-or-later
#include "view/page_message.h"

#include <algorithm>
#include <array>
#include <span>

#include "input/schema.h"
#include "opaline/error.h"
#include "values/json_tree.h"
#include "values/nearest_name.h"

namespace opaline {
namespace {

constexpr const char* kFile = "message";

/// A message's members, each read once; unread ones are an error.
class MessageReader {
 public:
  explicit MessageReader(const Document& document) : document_(document) {
    if (document.root.kind != Node::Kind::object) fail(document.root, "is not an object", "{\"do\": ...}");
  }

  [[noreturn]] void fail(const Node& node, const std::string& message, const std::string& expected) const {
    throw error_at(document_, node.offset, -1, "'" + printable(node.key) + "' " + message, expected);
  }
  const Node& need(std::string_view key, Node::Kind kind, const std::string& expected) const {
    const Node* node = find_member(document_.root, key);
    if (node == nullptr)
      throw error_at(document_, 0, -1, "lacks the key '" + std::string(key) + "'", expected);
    if (node->kind != kind) fail(*node, "has the wrong type", expected);
    return *node;
  }
  const std::string& text(std::string_view key) const {
    return need(key, Node::Kind::string, "a string").text;
  }
  std::uint64_t whole(std::string_view key) const {
    const Node& node = need(key, Node::Kind::number, "a whole number");
    if (!node.whole) fail(node, "is not a whole number", "a whole number");
    return *node.whole;
  }
  std::vector<std::string> texts(std::string_view key, const std::string& expected) const {
    std::vector<std::string> texts;
    for (const Node& child : need(key, Node::Kind::array, "a list of strings").children) {
      if (child.kind != Node::Kind::string) fail(child, "is not a string", expected);
      texts.push_back(child.text);
    }
    return texts;
  }
  int index(std::string_view key) const { return int(std::min<std::uint64_t>(whole(key), 1 << 30)); }
  bool flag(std::string_view key) const { return need(key, Node::Kind::boolean, "true or false").boolean; }
  void check_keys(std::span<const std::string_view> keys) const {
    for (const Node& child : document_.root.children)
      if (std::ranges::find(keys, child.key) == keys.end())
        fail(child, "is an unknown key" + did_you_mean(child.key, keys), "one of " + join(keys));
  }

 private:
  const Document& document_;
};

SetValues read_values(const MessageReader& reader) {
  SetValues message{{}, reader.whole("stroke")};
  for (const Node& child : reader.need("values", Node::Kind::object, "{\"path\": value}").children) {
    if (child.key.empty() || child.key.find('=') != std::string::npos)
      reader.fail(child, "is not a path", "a path such as media.marble.specular_ior");
    message.values.push_back({child.key, to_json(child)});
  }
  return message;
}

WorkBehind read_work(const MessageReader& reader) {
  const WorkBehind message{reader.flag("trade"), reader.text("reference")};
  if (!message.reference.empty() && message.reference != "direct" && message.reference != "volume")
    reader.fail(reader.need("reference", Node::Kind::string, "a string"), "is not a valid choice",
                "direct, volume or nothing");
  return message;
}

ChooseSettings read_choice(const MessageReader& reader) {
  const Node& node = reader.need("error", Node::Kind::number, "a number");
  if (!(node.number > 0 && node.number < 1))
    reader.fail(node, "is out of range", "a fraction above 0 and below 1");
  return {node.number};
}

LookFrom read_look(const MessageReader& reader) {
  const auto point = [&](std::string_view key) {
    return to_json(reader.need(key, Node::Kind::array, "a point such as [0, 0, 5]"));
  };
  return {point("position"), point("look_at")};
}

ChangeLights read_lights(const MessageReader& reader) {
  constexpr std::array<std::string_view, 3> kChanges{"add", "copy", "remove"};
  const auto change = std::ranges::find(kChanges, reader.text("change"));
  if (change == kChanges.end())
    reader.fail(reader.need("change", Node::Kind::string, "a string"), "is not a valid choice",
                "one of " + join(kChanges));
  return {ChangeLights::Change(change - kChanges.begin()), reader.index("index")};
}

struct Kind {
  std::string_view name;
  std::vector<std::string_view> keys;
  PageMessage (*read)(const MessageReader&);
};

const std::vector<Kind>& kinds() {
  using Reader = const MessageReader&;
  static const std::vector<Kind> table{
      {"set", {"do", "values", "stroke"}, [](Reader r) -> PageMessage { return read_values(r); }},
      {"undo", {"do"}, [](Reader) -> PageMessage { return Undo{}; }},
      {"redo", {"do"}, [](Reader) -> PageMessage { return Redo{}; }},
      {"reset", {"do"}, [](Reader) -> PageMessage { return Reset{}; }},
      {"restore",
       {"do", "edits"},
       [](Reader r) -> PageMessage { return Restore{r.texts("edits", "path=value")}; }},
      {"open",
       {"do", "drop", "names"},
       [](Reader r) -> PageMessage {
         return OpenFiles{r.text("drop"), r.texts("names", "a file name")};
       }},
      {"light_by", {"do", "name"}, [](Reader r) -> PageMessage { return LightBy{r.text("name")}; }},
      {"save", {"do", "name"}, [](Reader r) -> PageMessage { return SaveScene{r.text("name")}; }},
      {"render", {"do", "name"}, [](Reader r) -> PageMessage { return RenderFile{r.text("name")}; }},
      {"layer", {"do", "name"}, [](Reader r) -> PageMessage { return ChooseLayer{r.text("name")}; }},
      {"behind", {"do", "trade", "reference"}, [](Reader r) -> PageMessage { return read_work(r); }},
      {"choose", {"do", "error"}, [](Reader r) -> PageMessage { return read_choice(r); }},
      {"frame", {"do", "frame"}, [](Reader r) -> PageMessage { return GoToFrame{r.index("frame")}; }},
      {"shown",
       {"do", "frame"},
       [](Reader r) -> PageMessage { return FrameShown{std::uint32_t(r.whole("frame"))}; }},
      {"look", {"do", "position", "look_at"}, [](Reader r) -> PageMessage { return read_look(r); }},
      {"look_back", {"do"}, [](Reader) -> PageMessage { return LookBack{}; }},
      {"lights", {"do", "change", "index"}, [](Reader r) -> PageMessage { return read_lights(r); }},
      {"pick",
       {"do", "x", "y"},
       [](Reader r) -> PageMessage {
         return Pick{r.index("x"), r.index("y")};
       }},
      {"keep_look", {"do"}, [](Reader) -> PageMessage { return KeepLook{}; }},
      {"key_look", {"do"}, [](Reader) -> PageMessage { return KeyLook{}; }},
      {"cancel_render", {"do"}, [](Reader) -> PageMessage { return CancelFile{}; }},
      {"recall",
       {"do", "edits"},
       [](Reader r) -> PageMessage { return Recall{r.texts("edits", "path=value")}; }},
      {"rename_medium",
       {"do", "name", "to"},
       [](Reader r) -> PageMessage {
         return RenameMedium{r.text("name"), r.text("to")};
       }},
      {"floor", {"do", "on"}, [](Reader r) -> PageMessage { return SetFloor{r.flag("on")}; }},
  };
  return table;
}

}  // namespace

PageMessage parse_page_message(std::string_view text) {
  Document document{kFile, text, {}, {}, 1, line_starts_of(text)};
  document.root = parse_tree(document, text);
  const MessageReader reader(document);
  const std::string& name = reader.text("do");
  std::vector<std::string_view> names;
  for (const Kind& kind : kinds()) {
    names.push_back(kind.name);
    if (kind.name != name) continue;
    reader.check_keys(kind.keys);
    return kind.read(reader);
  }
  reader.fail(*find_member(document.root, "do"), "has no choice '" + printable(name) + "'",
              "one of " + join(names));
}

}  // namespace opaline
