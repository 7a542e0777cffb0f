// SPDX-License-Identifier: GPL-3.0-or-later
// Separate module with all code using OpenImageIO (picture_reader.h).
#include "image/picture_reader.h"

#include <OpenImageIO/color.h>
#include <OpenImageIO/imageio.h>

#include <algorithm>
#include <string_view>

#include "image/color_channels.h"
#include "image/picture_file.h"
#include "image/texel_colors.h"
#include "opaline/error.h"
#include "opaline/image.h"

namespace opaline {
namespace {

/// Copies metadata of the image, without those of the file.
void copy_metadata(const OIIO::ImageSpec& spec, Image& image) {
  for (const OIIO::ParamValue& attribute : spec.extra_attribs) {
    const std::string_view name(attribute.name().data(), attribute.name().size());
    if (attribute.type() != OIIO::TypeString || name.starts_with("oiio:") || name == "compression" ||
        name == "Software" || name == "DateTime")
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
  if (const double aspect = double(spec.get_float_attribute("PixelAspectRatio", 1)); aspect > 0)
    image.pixel_aspect = aspect;
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
  constexpr std::string_view formats[] = {"exr", "hdr", "png"};  // those of read_image; read_exr.h reads EXRs
  const PictureSource source{path, {}};
  check_is_whole(source);
  const OpenPicture picture = open_picture(source, formats);
  OIIO::ImageInput& input = *picture.input;
  const OIIO::ImageSpec& spec = input.spec();
  Image image = describe(spec);
  image.pixels.resize(static_cast<std::size_t>(spec.width) * static_cast<std::size_t>(spec.height) *
                      image.channels.size());
  if (!input.read_image(0, 0, 0, spec.nchannels, OIIO::TypeFloat, image.pixels.data()))
    throw bad_file(path, "the image is damaged: " + complaint_of(&input));
  if (picture.format == "png") linearize(image, spec.alpha_channel);
  if (const auto matrix = matrix_to_rec709(spec, path))
    convert_colors(image.pixels, image.channels.size(), color_channels(image.channels), *matrix);
  return image;
}

}  // namespace opaline

opaline::ReadPicture opaline_picture_reader() {
  return opaline::read_picture;
}
