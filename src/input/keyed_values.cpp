// SPDX-License-Identifier: GPL-3.0-or-later
#include "input/keyed_values.h"

#include <algorithm>
#include <charconv>
#include <set>

#include "values/frame_name.h"

namespace opaline {
namespace {

struct Key {
  double frame;
  const Node* value;
};

class KeyedValue {
 public:
  KeyedValue(const Document& document, const Node& node) : document_(document), node_(node) {
    const Node* keyed = find_member(node, "keyed");
    if (keyed->kind != Node::Kind::object || keyed->children.empty())
      fail(*keyed, "'keyed' has no values", "values by frame such as {\"1\": 0, \"24\": 5}");
    for (const Node& value : keyed->children) keys_.push_back({frame_of(value), &value});
    std::ranges::stable_sort(keys_, {}, &Key::frame);
    const auto twice = std::ranges::adjacent_find(keys_, {}, &Key::frame);
    if (twice != keys_.end()) {
      const Node &first = *twice->value, &second = *std::next(twice)->value;
      fail(second, "'" + printable(first.key) + "' and '" + printable(second.key) + "' denote the same frame",
           "each frame once");
    }
    for (const Node& member : node.children) {
      if (member.key == "keyed") continue;
      if (member.key != "between")
        fail(member, "unknown key '" + printable(member.key) + "' with 'keyed'", "between");
      if (member.kind != Node::Kind::string || (member.text != "linear" && member.text != "spline"))
        fail(member, "'between' is not known", "\"linear\" or \"spline\"");
      spline_ = member.text == "spline";
    }
    check_between();
  }

  Node at(double frame) const {
    const std::vector<double> weights =
        weights_at(std::clamp(frame, keys_.front().frame, keys_.back().frame));
    std::vector<const Node*> values;
    for (const Key& key : keys_) values.push_back(key.value);
    Node result = blended(values, weights);
    result.key = node_.key;
    result.key_offset = node_.key_offset;
    return result;
  }

 private:
  /// A frame between two keys has a value.
  void check_between() const {
    for (std::size_t i = 1; i < keys_.size(); ++i)
      if (keys_[i].frame - keys_[i - 1].frame > 1) {
        at(keys_[i].frame - 1);
        return;
      }
  }

  [[noreturn]] void fail(const Node& at, const std::string& message, const std::string& expected) const {
    throw error_at(document_, at.offset, at.override_index, message, expected);
  }

  double frame_of(const Node& value) const {
    int frame = 0;
    const char* end = value.key.data() + value.key.size();
    const auto [next, error] = std::from_chars(value.key.data(), end, frame);
    if (error != std::errc{} || next != end)
      fail(value, "'" + printable(value.key) + "' is not a frame", "a whole number");
    return frame;
  }

  /// Weights of each key's value; they sum to 1.
  std::vector<double> weights_at(double frame) const {
    std::vector<double> weights(keys_.size());
    const auto after = std::ranges::upper_bound(keys_, frame, {}, &Key::frame);
    const std::size_t i = std::size_t(after - keys_.begin()) - 1;
    if (keys_[i].frame == frame) {
      weights[i] = 1;
      return weights;
    }
    const double step = keys_[i + 1].frame - keys_[i].frame, t = (frame - keys_[i].frame) / step;
    if (!spline_) {
      weights[i] = 1 - t;
      weights[i + 1] = t;
      return weights;
    }
    weights[i] = (1 + 2 * t) * (1 - t) * (1 - t);
    weights[i + 1] = t * t * (3 - 2 * t);
    add_slope(weights, i, step * t * (1 - t) * (1 - t));
    add_slope(weights, i + 1, -step * t * t * (1 - t));
    return weights;
  }

  /// The slope at a key times a factor.
  void add_slope(std::vector<double>& weights, std::size_t key, double factor) const {
    const std::size_t before = key > 0 ? key - 1 : key, after = std::min(key + 1, keys_.size() - 1);
    const double per_frame = factor / (keys_[after].frame - keys_[before].frame);
    weights[after] += per_frame;
    weights[before] -= per_frame;
  }

  Node blended(const std::vector<const Node*>& values, const std::vector<double>& weights) const {
    const auto sole = std::ranges::find(weights, 1.0);
    if (sole != weights.end()) return *values[std::size_t(sole - weights.begin())];
    Node result = *values[0];
    for (const Node* value : values)
      if (value->kind != result.kind || value->children.size() != result.children.size() ||
          (value->kind != Node::Kind::number && value->kind != Node::Kind::array))
        fail(*value, "the values of 'keyed' cannot be blended", "numbers, or lists of the same length");
    result.number = 0;
    for (std::size_t k = 0; k < values.size(); ++k) result.number += weights[k] * values[k]->number;
    result.text = std::to_string(result.number);
    result.whole.reset();
    for (std::size_t c = 0; c < result.children.size(); ++c) {
      std::vector<const Node*> parts;
      for (const Node* value : values) parts.push_back(&value->children[c]);
      result.children[c] = blended(parts, weights);
    }
    return result;
  }

  const Document& document_;
  const Node& node_;
  std::vector<Key> keys_;
  bool spline_ = false;
};

/// in    time: after the frame, in frames; values without interpolation then stay as in the frame
void resolve(const Document& document, Node& node, double time = 0) {
  if (node.kind == Node::Kind::object && find_member(node, "keyed") != nullptr) {
    const KeyedValue keyed(document, node);
    Node value;
    try {
      value = keyed.at(document.frame + time);
    } catch (const Error&) {
      if (time == 0) throw;
      value = keyed.at(document.frame);
    }
    node = std::move(value);
  }
  for (Node& child : node.children) resolve(document, child, time);
}

bool changes(const Node& node) {
  const bool is_keyed = node.kind == Node::Kind::object && find_member(node, "keyed") != nullptr;
  const bool is_file_a_frame =
      node.kind == Node::Kind::string && with_frame(node.text, 1) != with_frame(node.text, 2);
  return is_keyed || is_file_a_frame || std::ranges::any_of(node.children, changes);
}

void collect_keys(const Node& node, std::set<int>& keys) {
  if (node.kind == Node::Kind::object)
    if (const Node* keyed = find_member(node, "keyed"))
      for (const Node& value : keyed->children) {
        int key = 0;
        const char* end = value.key.data() + value.key.size();
        if (std::from_chars(value.key.data(), end, key).ptr == end) keys.insert(key);
      }
  for (const Node& child : node.children) collect_keys(child, keys);
}

}  // namespace

std::size_t count_camera_frames(const Document& document) {
  std::set<int> keys;
  for (const Node& part : document.root.children) {
    if (part.key == "camera" || part.key == "film")
      collect_keys(part, keys);
    else if (part.key == "media" ? std::ranges::any_of(part.children, changes) : changes(part))
      return 1;
  }
  return keys.empty() ? 1 : std::size_t(std::int64_t(*keys.rbegin()) - *keys.begin()) + 1;
}

void resolve_at_shutter(Document& document, double time) {
  for (Node& part : document.root.children)
    if (part.key == "camera" || part.key == "shapes") resolve(document, part, time);
  resolve_keyed_values(document);
}

void resolve_keyed_values(Document& document) {
  for (Node& part : document.root.children)
    if (part.key == "media")  // may contain a medium named "keyed"
      for (Node& medium : part.children) resolve(document, medium);
    else
      resolve(document, part);
}

}  // namespace opaline
