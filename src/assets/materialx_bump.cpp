// SPDX-License-Identifier: GPL-3.0-or-later
#include "assets/materialx_bump.h"

#include <charconv>
#include <cmath>
#include <string_view>

namespace opaline {
namespace {

using Node = pugi::xml_node;

Node input_of(const Node& node, const char* name) {
  return node.find_child_by_attribute("input", "name", name);
}

/// Node connected to an input or output, in the same graph or through another's output.
Node source_of(const Node& port) {
  const Node graph = port.name() == std::string_view("output") ? port.parent() : port.parent().parent();
  if (const auto name = port.attribute("nodename"))
    return graph.find_child_by_attribute("name", name.value());
  const auto other = port.attribute("nodegraph");
  if (!other) return {};
  const Node inner = graph.find_child_by_attribute("nodegraph", "name", other.value());
  const auto output = port.attribute("output");
  const Node from =
      output ? inner.find_child_by_attribute("output", "name", output.value()) : inner.child("output");
  return inner.find_child_by_attribute("name", from.attribute("nodename").value());
}

/// Numbers of an input's value; false if their count differs, or if it is connected.
template <std::size_t count>
bool read_numbers(const Node& input, std::array<double, count>& numbers) {
  std::string_view text = input.attribute("value").value();
  for (double& number : numbers) {
    text.remove_prefix(std::min(text.find_first_not_of(" ,"), text.size()));
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
    if (error != std::errc() || !std::isfinite(number)) return false;
    text.remove_prefix(std::size_t(end - text.data()));
  }
  return text.find_first_not_of(' ') == text.npos;
}

std::string file_of(const Node& image) {
  const std::string file = input_of(image, "file").attribute("value").value();
  std::string prefix;
  for (Node at = input_of(image, "file"); at && prefix.empty(); at = at.parent())
    prefix = at.attribute("fileprefix").value();
  return file.empty() ? file : prefix + file;
}

ImageNode none(std::string problem) {
  return {{}, {1, 1}, {}, std::move(problem)};
}

}  // namespace

ImageNode connected_image(const pugi::xml_node& input) {
  const Node image = source_of(input);
  const bool is_tiled = image.name() == std::string_view("tiledimage");
  if (!is_tiled && image.name() != std::string_view("image")) return none("it is connected to no image");
  const Node coordinates = source_of(input_of(image, "texcoord"));
  if (coordinates && coordinates.name() != std::string_view("texcoord"))
    return none("its image uses coordinates other than the UVs of the mesh");
  ImageNode map{.file = file_of(image), .problem = "its image has no file"};
  for (Node at = input_of(image, "file"); at && map.color_space.empty(); at = at.parent())
    map.color_space = at.attribute("colorspace").value();
  for (const char* other : {"uvoffset", "realworldimagesize", "realworldtilesize"})
    if (is_tiled && input_of(image, other)) return none(std::string("its image has a ") + other);
  if (const Node given = input_of(image, "uvtiling"); is_tiled && given && !read_numbers(given, map.tiling))
    return none("the tiling of its image is not a pair of numbers");
  return map;
}

HeightMap height_map(const pugi::xml_node& normal) {
  const Node bump = source_of(normal);
  if (bump.name() != std::string_view("bump")) return {none("it is connected to no bump node")};
  const Node heights = source_of(input_of(bump, "height"));
  if (heights.name() != std::string_view("tiledimage") && heights.name() != std::string_view("image"))
    return {none("its heights are not an image")};
  if (source_of(input_of(bump, "normal"))) return {none("its bump perturbs another normal")};
  std::array<double, 1> scale{1};
  if (const Node given = input_of(bump, "scale"); given && !(read_numbers(given, scale) && scale[0] >= 0))
    return {none("the scale of its bump is not a number of at least 0")};
  return {connected_image(input_of(bump, "height")), scale[0]};
}

}  // namespace opaline
