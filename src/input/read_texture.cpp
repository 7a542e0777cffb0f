// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include <algorithm>
#include <initializer_list>
#include <memory>
#include <string_view>
#include <utility>

#include "image/solid_noise.h"
#include "image/texture_file.h"
#include "input/readers.h"
#include "opaline/error.h"
#include "scene/scene_properties.h"

namespace opaline {
namespace {

bool is_texture(const Value& value) {
  return value.node().kind == Node::Kind::object;
}

/// Channels of a texel used by a value. A direction has red and green.
enum class TexturePart { color, triple, number, angle, direction };

constexpr std::size_t kDirection = 4;  // choice of "channel"

bool has_channel(TexturePart part) {
  return part == TexturePart::number || part == TexturePart::angle;
}

TextureContent content_of(TexturePart part) {
  return part == TexturePart::color       ? TextureContent::colors
         : part == TexturePart::angle     ? TextureContent::angle_cosines
         : part == TexturePart::direction ? TextureContent::directions
                                          : TextureContent::data;
}

DetailBlend blend_of(const ObjectReader& reader) {
  const auto blend = reader.find("blend");
  return blend ? static_cast<DetailBlend>(blend->choice()) : DetailBlend::relative;
}

ColorSpace space_of(const ObjectReader& reader, const std::string& path, TexturePart part) {
  ColorSpace space = ColorSpace::automatic;
  if (const auto declared = reader.find("color_space")) space = static_cast<ColorSpace>(declared->choice());
  if (space != ColorSpace::automatic) return space;
  return part == TexturePart::color && blend_of(reader) != DetailBlend::overlay
             ? TextureFile::space_of_colors(path)
             : ColorSpace::linear;
}

/// error unless the image has the channels; a missing alpha is 1
void check_channels(const Value& file, const std::optional<Value>& channel, const Texture& texture,
                    TexturePart part) {
  constexpr std::array<char, 4> names{'r', 'g', 'b', 'a'};
  std::string missing, there;
  for (std::size_t c = 0; c < names.size(); ++c) {
    const bool is_taken = part == TexturePart::direction ? c < 2
                          : has_channel(part)            ? c == texture.channel
                                                         : c < 3;
    const bool is_there = texture.source->has_channel(c);
    if (is_taken && !is_there && names[c] != 'a') missing += names[c];
    if (is_there) there += (there.empty() ? "" : ", ") + std::string(1, names[c]);
  }
  if (missing.empty()) return;
  const std::string expected = "a channel of the image: " + there;
  if (channel) channel->fail("is not in " + printable(texture.source->path()), expected);
  file.fail("refers to an image without the channel " + missing.substr(0, 1),
            has_channel(part) ? "\"channel\": " + expected : "the channels R, G and B, or Y, or one alone");
}

/// Colours become values at the document's wavelengths.
void mix_channels(const Value& value, TexturePart part, bool has_details, Texture& texture) {
  const ThreeWavelengths& wavelengths = *value.wavelengths();
  if (part == TexturePart::color) {
    texture.from_rgb = wavelengths.from_rgb;
    const Vec3d& scale = texture.scale;
    // A grey scale commutes with the mixing; beside details it stays apart, as overlays precede it.
    if (has_details && scale.x == scale.y && scale.y == scale.z) return;
    for (Rgb& row : *texture.from_rgb) row = row * texture.scale;
    texture.scale = Vec3d(1);
  } else if (part == TexturePart::triple && value.info().type == ValueType::number_or_triple &&
             wavelengths.bands[0][0] != wavelengths.bands[0][1]) {
    value.fail("is a texture of lengths in red, green and blue, in a scene of more than three wavelengths",
               "\"film\": {\"wavelengths\": 3}");
  }
}

constexpr std::array<std::string_view, 2> kOrigins{"texture", "noise"};

std::shared_ptr<const TextureSource> read_image(const ObjectReader& reader, const Value& file,
                                                TexturePart part) {
  try {
    const std::string path = file.file_path();
    return TextureFile::open(path, space_of(reader, path, part), content_of(part));
  } catch (const Error& failure) {
    throw told_at(file.place(), failure);
  }
}

std::shared_ptr<const TextureSource> read_noise(const ObjectReader& reader, const Value& pattern) {
  NoiseParameters noise;
  noise.pattern = static_cast<NoisePattern>(pattern.choice());
  noise.size = reader.need("size").length(reader.mm_per_unit());
  if (const auto octaves = reader.find("octaves")) noise.octaves = int(octaves->whole_number());
  if (const auto low = reader.find("low")) noise.low = low->number_or_triple();
  if (const auto high = reader.find("high")) noise.high = high->number_or_triple();
  if (const auto seed = reader.find("seed")) noise.seed = seed->whole_number();
  return SolidNoise::shared(noise);
}

/// error at a key without an effect
void check_keys(const ObjectReader& reader, bool is_image) {
  const auto refuse = [&](std::initializer_list<std::string_view> keys, const std::string& why) {
    for (const std::string_view key : keys)
      if (const auto found = reader.find(key)) found->fail_key("has no effect " + why);
  };
  if (is_image)
    refuse({"size", "octaves", "low", "high", "seed"}, "without 'noise'");
  else
    refuse({"triplanar", "color_space"}, "with 'noise'");
  if (!is_image || reader.find("triplanar"))
    refuse({"uv_scale", "uv_rotation", "uv_offset"}, is_image ? "with 'triplanar'" : "with 'noise'");
}

Texture read_texture(const Value& value, TexturePart part, bool is_detail = false);

/// Relative colours are normalised by their mean; constant ones have no effect.
void read_details(const Value& details, const Value& owner, TexturePart part, Texture& texture) {
  const bool is_normal = part == TexturePart::triple && owner.info().type == ValueType::object;
  if (part != TexturePart::color && !is_normal)
    details.fail_key("applies to colours and normal maps", "a texture without it");
  for (const Value& one : details.list()) {
    Texture detail = read_texture(one, part, true);
    if (!detail.details.empty()) one.fail("has details of its own", "a list of one level");
    if (!is_normal && detail.blend == DetailBlend::relative) {
      if (detail.source->constant()) continue;
      take_mean(detail);
    }
    texture.details.push_back(std::move(detail));
  }
}

Texture read_texture(const Value& value, TexturePart part, bool is_detail) {
  const ObjectReader reader(value, "texture");
  Texture texture;
  texture.place = value.place();
  if (const auto blend = reader.find("blend"); blend && !(is_detail && part == TexturePart::color))
    blend->fail_key("applies to a detail of a colour", "a texture without it");
  texture.blend = blend_of(reader);
  const Value origin = reader.need(reader.exactly_one_of(kOrigins));
  const bool is_image = origin.node().key == kOrigins[0];
  texture.source = is_image ? read_image(reader, origin, part) : read_noise(reader, origin);
  check_keys(reader, is_image);
  if (const auto width = reader.find("triplanar"))
    texture.triplanar_width = width->length(value.mm_per_unit());
  if (const auto scale = reader.find("scale")) texture.scale = scale->number_or_triple();
  if (value.wavelengths() != nullptr) mix_channels(value, part, reader.find("detail").has_value(), texture);
  const std::optional<Value> channel = reader.find("channel");
  if (channel && part != TexturePart::direction) {
    if (!has_channel(part))
      value.fail(part == TexturePart::color ? "is a colour" : "requires three numbers", "no 'channel'");
    texture.channel = channel->choice();
    if (texture.channel == kDirection) channel->fail("is a direction, here of no use", "r, g, b or a");
  }
  if (channel && !is_image && !texture.source->has_channel(texture.channel))
    channel->fail("is not in 'noise'", "r, g or b");
  check_channels(origin, channel, texture, part);
  if (const auto uv_scale = reader.find("uv_scale")) texture.uv_scale = read_pair(*uv_scale);
  if (const auto rotation = reader.find("uv_rotation")) texture.uv_rotation = rotation->number();
  if (const auto offset = reader.find("uv_offset")) texture.uv_offset = read_pair(*offset);
  if (const auto details = reader.find("detail")) read_details(*details, value, part, texture);
  return texture;
}

/// error outside the range of the value's row
/// number: of all texels of the texture, scaled
double checked(const Value& value, const Texture& texture, double number) {
  const Range& range = value.info().range;
  if (!(number >= range.low && number <= range.high))
    value.fail(fmt::format("is out of range: {:.4g} at every texel of {}, with its scale", number,
                           texture.source->path()),
               fmt::format("values from {:g} to {:g}", range.low, range.high));
  return number;
}

}  // namespace

void read_textured(const Value& value, double& number, std::optional<Texture>& texture) {
  number = is_texture(value) ? 1 : value.number();
  if (!is_texture(value)) return;
  texture = read_texture(value, TexturePart::number);
  const std::optional<Texel>& constant = texture->source->constant();
  if (!constant) return;
  number = checked(value, *texture, (*constant)[texture->channel] * texture->scale.x);
  texture.reset();
}

void read_textured(const Value& value, Vec3d& triple, std::optional<Texture>& texture) {
  const bool is_color = value.info().type == ValueType::color;
  triple = is_texture(value) ? Vec3d(1) : is_color ? value.color() : value.number_or_triple();
  if (!is_texture(value)) return;
  texture = read_texture(value, is_color ? TexturePart::color : TexturePart::triple);
  const std::optional<Texel>& constant = texture->source->constant();
  if (!constant || !texture->details.empty()) return;
  const Rgb color = at_wavelengths(*texture, {(*constant)[0], (*constant)[1], (*constant)[2]});
  for (std::size_t c = 0; c < 3; ++c) triple[c] = checked(value, *texture, color[c] * texture->scale[c]);
  texture.reset();
}

Rgb take_mean(Texture& texture) {
  const Texel texel = texture.source->mean();
  const Rgb mean = at_wavelengths(texture, {texel[0], texel[1], texel[2]});
  Rgb taken;
  for (std::size_t c = 0; c < 3; ++c) {
    taken[c] = std::max(0., mean[c]) * texture.scale[c];
    texture.scale[c] = mean[c] > 0 ? 1 / mean[c] : 1;
  }
  texture.is_relative = true;
  return taken;
}

Texture read_normal_map(const Value& value) {
  Texture map = read_texture(value, TexturePart::triple);
  if (is_solid(map) || std::ranges::any_of(map.details, is_solid))
    value.fail("needs images mapped by UVs", "a 'bump_map', or images without 'triplanar'");
  return map;
}

void read_rotation(const Value& value, Grain& grain) {
  if (!is_texture(value)) {
    grain.rotation = value.number();
    return;
  }
  const ObjectReader reader(value, "texture");
  const auto channel = reader.find("channel");
  const bool is_direction = channel && channel->choice() == kDirection;
  grain.cosine_texture = read_texture(value, is_direction ? TexturePart::direction : TexturePart::angle);
  Texture& cosine = *grain.cosine_texture;
  if (is_solid(cosine)) value.fail("needs an image mapped by UVs", "an image without 'triplanar'");
  if (const auto scale = reader.find("scale"))
    scale->fail_key("has no effect on angles", "texels from 0 to 1, a full turn");
  if (!is_direction && cosine.channel == 3) channel->fail("is no channel of angles", "r, g or b");
  Texture& sine = grain.sine_texture.emplace(cosine);
  if (is_direction)
    sine.channel = 1;
  else
    sine.source =
        TextureFile::open(cosine.source->path(), space_of(reader, cosine.source->path(), TexturePart::angle),
                          TextureContent::angle_sines);
}

Texture read_displacement(const Value& value, double mm_per_unit) {
  Texture texture = read_texture(value, TexturePart::number);
  texture.scale = texture.scale * mm_per_unit;
  return texture;
}

Texture read_opacity(const Value& value) {
  Texture texture = read_texture(value, TexturePart::number);
  if (is_solid(texture)) value.fail("needs an image mapped by UVs", "an image without 'triplanar'");
  return texture;
}

std::optional<Texture> read_bump_map(const Value& value, double mm_per_unit) {
  Texture texture = read_texture(value, TexturePart::number);
  if (texture.source->constant()) return {};
  texture.scale = texture.scale * mm_per_unit;
  return texture;
}

}  // namespace opaline
