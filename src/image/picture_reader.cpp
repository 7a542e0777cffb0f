// SPDX-License-Identifier: GPL-3.0-or-later
// A module of its own (picture_reader.h): all that stands on OpenImageIO.
#include "picture_reader.h"

#include <OpenImageIO/color.h>
#include <OpenImageIO/imageio.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <memory>
#include <string_view>

#include "opaline/core/error.h"
#include "opaline/image/image.h"
#include "png_chunks.h"

namespace opaline {
namespace {

/// "exr", "hdr" or "png" by the first bytes. OpenImageIO would try every format it knows, and finds a Targa in
/// noise.
const char* format_of(const std::string& path) {
  std::error_code failure;
  const std::filesystem::file_status status = std::filesystem::status(path, failure);
  if (!std::filesystem::exists(status)) throw bad_file(path, "cannot read: " + failure.message());
  if (!std::filesystem::is_regular_file(status)) throw bad_file(path, "cannot read: not a regular file");
  std::ifstream file(path, std::ios::binary);
  if (!file) throw bad_file(path, std::string("cannot read: ") + std::strerror(errno));
  char bytes[8] = {};
  file.read(bytes, sizeof bytes);
  const std::string_view start(bytes, static_cast<std::size_t>(file.gcount()));
  if (start.empty()) throw bad_file(path, "the file is empty", "an EXR, HDR or PNG picture");
  if (start.starts_with("\x76\x2f\x31\x01")) return "exr";
  if (start == "\x89PNG\r\n\x1a\n") return "png";
  if (start.starts_with("#?RADIAN") || start.starts_with("#?RGBE")) return "hdr";
  throw bad_file(path, "not a picture that can be read", "an EXR, HDR or PNG picture");
}

std::string one_line(std::string message) {
  while (!message.empty() && message.back() == '\n') message.pop_back();
  std::replace(message.begin(), message.end(), '\n', ' ');
  return message;
}

/// The pending message; not fetched, OpenImageIO 2.5 and later print it at exit.
std::string complaint_of(const OIIO::ImageInput* input) {
  const std::string complaint = input ? input->geterror() : OIIO::geterror();
  return one_line(complaint.empty() ? "no reason given" : complaint);
}

/// Floats in memory over bytes in the file, at most: a constant picture of 8192 x 8192 halves packs 29330 : 1
/// as DWA, 1945 : 1 as ZIP, less as others (measured); a PNG of one-bit palette entries 99072 : 1 (deflate's
/// 1032).
double densest(const OIIO::ImageSpec& spec, std::string_view format) {
  if (format == "png") return 131072;
  return spec.get_string_attribute("compression").substr(0, 3) == "dwa" ? 32768 : 2048;
}

/// A damaged header can claim any size: memory stays bounded by the file's own. Beside the picture the
/// libraries hold rows: OpenImageIO 256, however few there are, OpenEXR 32 a thread (traced on a picture of
/// 55555 x 2: 850 MB for 2.6).
void check_size(const std::string& path, const OIIO::ImageSpec& spec, std::string_view format) {
  constexpr double always_allowed = 512 << 20, rows_beside = 1024;
  const double claimed =
      sizeof(float) * static_cast<double>(spec.width) * (spec.height + rows_beside) * spec.nchannels;
  const double actual = static_cast<double>(std::filesystem::file_size(path));
  if (claimed > densest(spec, format) * actual + always_allowed)
    throw bad_file(path, "the file is too short for the size it claims", {},
                   std::to_string(spec.width) + " x " + std::to_string(spec.height) + " pixels");
}

/// Text that describes the picture, without what describes the file.
void copy_metadata(const OIIO::ImageSpec& spec, Image& image) {
  for (const OIIO::ParamValue& attribute : spec.extra_attribs) {
    const std::string_view name(attribute.name().data(), attribute.name().size());
    if (attribute.type() != OIIO::TypeString || name.starts_with("oiio:") || name.starts_with("openexr:") ||
        name == "compression" || name == "Software" || name == "DateTime")
      continue;
    image.metadata.emplace_back(name, attribute.get_string());
  }
}

Image describe(const OIIO::ImageSpec& spec) {
  Image image;
  image.width = spec.width;
  image.height = spec.height;
  image.channels = spec.channelnames;
  image.crop_x = spec.x - spec.full_x;
  image.crop_y = spec.y - spec.full_y;
  image.full_width = spec.full_width;
  image.full_height = spec.full_height;
  copy_metadata(spec, image);
  return image;
}

void linearize(Image& image, int alpha) {
  const std::size_t channels = image.channels.size();
  for (std::size_t i = 0; i < image.pixels.size(); ++i)
    if (static_cast<int>(i % channels) != alpha) image.pixels[i] = OIIO::sRGB_to_linear(image.pixels[i]);
}

}  // namespace

Image read_picture(const std::string& path) {
  const std::string format = format_of(path);
  if (format == "png") check_png_chunks(path);
  const std::unique_ptr<OIIO::ImageInput> input = OIIO::ImageInput::create(format);
  OIIO::ImageSpec spec, config;
  config.attribute("oiio:UnassociatedAlpha", 1);
  if (!input || !input->open(path, spec, config))
    throw bad_file(path, "not a picture that can be read: " + complaint_of(input.get()));
  if (spec.deep) throw bad_file(path, "deep pictures are not supported");
  check_size(path, spec, format);

  Image image = describe(spec);
  image.pixels.resize(static_cast<std::size_t>(spec.width) * static_cast<std::size_t>(spec.height) *
                      image.channels.size());
  // A truncated EXR opens, and is found out here.
  if (!input->read_image(0, 0, 0, spec.nchannels, OIIO::TypeFloat, image.pixels.data()))
    throw bad_file(path, "the picture is damaged: " + complaint_of(input.get()));
  if (format == "png") linearize(image, spec.alpha_channel);
  return image;
}

}  // namespace opaline

opaline::ReadPicture opaline_picture_reader() {
  return opaline::read_picture;
}
