// SPDX-License-Identifier: GPL-3.0-or-later
#include "image/picture_file.h"

#include <algorithm>

#include "image/color_channels.h"
#include "image/exr_chunks.h"
#include "image/picture_size.h"
#include "image/png_chunks.h"
#include "image/tiff_strips.h"
#include "opaline/error.h"

namespace opaline {
namespace {

// Constant and one-bit palette PNGs, progressive JPEGs of empty blocks, with a margin. A constant WebP has no
// bits per pixel, and is refused if large.
double densest(const OIIO::ImageSpec& spec, std::string_view format) {
  if (format == "png" || format == "webp") return 131072;
  if (format == "jpeg" || format == "tiff") return 16384;
  return densest_exr(spec.get_string_attribute("compression").substr(0, 3) == "dwa");
}

std::string one_line(std::string message) {
  while (!message.empty() && message.back() == '\n') message.pop_back();
  std::replace(message.begin(), message.end(), '\n', ' ');
  return message;
}

/// Format by the first bytes; empty: unknown. OpenImageIO would try every known format, and detects a Targa
/// in noise.
std::string_view format_of(const PictureBytes& bytes) {
  const std::string begin = bytes.read(0, 8);
  if (begin.starts_with("RIFF") && bytes.read(8, 4) == "WEBP") return "webp";
  const std::string_view start = begin;
  if (start.starts_with("\x76\x2f\x31\x01")) return "exr";
  if (start == "\x89PNG\r\n\x1a\n") return "png";
  if (start.starts_with("#?RADIAN") || start.starts_with("#?RGBE")) return "hdr";
  if (start.starts_with("\xff\xd8\xff")) return "jpeg";
  const std::string_view tiffs[] = {{"II*\0", 4}, {"MM\0*", 4}, {"II+\0", 4}, {"MM\0+", 4}};
  return std::ranges::any_of(tiffs, [&](std::string_view tiff) { return start.starts_with(tiff); }) ? "tiff"
                                                                                                    : "";
}

void check_size(const std::string& path, const OIIO::ImageSpec& spec, std::string_view format,
                std::uintmax_t file_size) {
  check_picture_size(
      path,
      {spec.width, spec.height, spec.nchannels, spec.full_width, spec.full_height, densest(spec, format)},
      file_size);
}

/// Refuses integer_colors in an EXR, which OpenImageIO divides by 4294967295.
void check_color_types(const std::string& path, const OIIO::ImageSpec& spec) {
  for (int c = 0; c < spec.nchannels; ++c) {
    const std::string& name = spec.channelnames[std::size_t(c)];
    if (spec.channelformat(c) == OIIO::TypeUInt32 && (spec.nchannels == 1 || is_color_channel(name)))
      throw integer_colors(path, name);
  }
}

/// Checks the size that a WebP's first chunk claims (RFC 9649): OpenImageIO allocates it on opening.
void check_webp_size(const PictureBytes& bytes, const std::string& path) {
  const std::string start = bytes.read(0, 30);
  if (start.size() < 30) throw bad_file(path, "the image is truncated");
  const auto number = [&](std::size_t at, std::size_t count) {
    unsigned value = 0;
    for (std::size_t i = count; i-- > 0;) value = value << 8 | std::uint8_t(start[at + i]);
    return int(value);
  };
  constexpr int k14Bits = 0x3fff;
  const std::string kind = start.substr(12, 4);
  int width = number(26, 2) & k14Bits, height = number(28, 2) & k14Bits;  // VP8
  if (kind == "VP8X") width = number(24, 3) + 1, height = number(27, 3) + 1;
  if (kind == "VP8L") width = (number(21, 2) & k14Bits) + 1, height = (number(22, 3) >> 6 & k14Bits) + 1;
  check_size(path, OIIO::ImageSpec(width, height, 4), "webp", bytes.size());
}

// libjpeg accepts a missing end, and fills missing pixels with grey.
void check_jpeg_end(const PictureBytes& bytes, const std::string& path) {
  constexpr std::uintmax_t kTail = 1 << 16;  // programs append notes of their own
  const std::string tail = bytes.read(bytes.size() - std::min(kTail, bytes.size()), kTail);
  if (tail.rfind("\xff\xd9") == tail.npos) throw bad_file(path, "the image is truncated");
}

/// "EXR, HDR or PNG"
std::string in_words(std::span<const std::string_view> formats) {
  std::string words;
  for (std::size_t i = 0; i < formats.size(); ++i) {
    words += i == 0 ? "" : i + 1 < formats.size() ? ", " : " or ";
    for (const char c : formats[i]) words += char(c - 'a' + 'A');
  }
  return words;
}

}  // namespace

std::string complaint_of(const OIIO::ImageInput* input) {
  const std::string complaint = input ? input->geterror() : OIIO::geterror();
  return one_line(complaint.empty() ? "no reason given" : complaint);
}

OpenPicture open_picture(const PictureSource& source, std::span<const std::string_view> formats) {
  const PictureBytes bytes(source);
  const std::string readable = "an image file: " + in_words(formats);
  if (bytes.size() == 0) throw bad_file(source.path, "the file is empty", readable);
  OpenPicture picture{format_of(bytes), {}, {}};
  if (std::ranges::find(formats, picture.format) == formats.end())
    throw bad_file(source.path, "not a readable image", readable);
  if (picture.format == "webp") check_webp_size(bytes, source.path);
  picture.input = OIIO::ImageInput::create(picture.format);
  OIIO::ImageSpec spec, config;
  config.attribute("oiio:UnassociatedAlpha", 1);
  if (!source.bytes.empty() && picture.input) {
    picture.memory =
        std::make_unique<OIIO::Filesystem::IOMemReader>(source.bytes.data(), source.bytes.size());
    if (!picture.input->set_ioproxy(picture.memory.get()))
      throw bad_file(source.path, "cannot be read from within an asset", "a PNG, JPEG or WebP image",
                     std::string(picture.format));
  }
  if (!picture.input || !picture.input->open(source.path, spec, config))
    throw bad_file(source.path,
                   "not a readable image: " + without_name(complaint_of(picture.input.get()), source.path));
  if (spec.deep) throw bad_file(source.path, "deep images are not supported");
  check_size(source.path, spec, picture.format, bytes.size());
  if (picture.format == "exr") check_color_types(source.path, spec);
  return picture;
}

void check_is_whole(const PictureSource& source) {
  const PictureBytes bytes(source);
  const std::string_view format = format_of(bytes);
  if (format == "png") check_png_chunks(bytes, source.path);
  if (format == "jpeg") check_jpeg_end(bytes, source.path);
  if (format == "tiff") check_tiff_strips(bytes, source.path);
}

}  // namespace opaline
