// SPDX-License-Identifier: GPL-3.0-or-later
#include "image/read_exr.h"

#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfFrameBuffer.h>
#include <OpenEXR/ImfHeader.h>
#include <OpenEXR/ImfInputPart.h>
#include <OpenEXR/ImfMultiPartInputFile.h>
#include <OpenEXR/ImfPartType.h>
#include <OpenEXR/ImfStandardAttributes.h>
#include <OpenEXR/ImfStringAttribute.h>
#include <OpenEXR/ImfThreading.h>

#include <algorithm>
#include <array>
#include <new>
#include <optional>
#include <string_view>
#include <utility>
#include <vector>

#include "image/color_channels.h"
#include "image/exr_chunks.h"
#include "image/picture_size.h"
#include "opaline/error.h"

namespace opaline {
namespace {

namespace imf = OPENEXR_IMF_NAMESPACE;

void check_channels(const std::string& path, const imf::ChannelList& channels, std::size_t count) {
  for (auto at = channels.begin(); at != channels.end(); ++at) {
    const std::string name = at.name();
    if (at.channel().xSampling != 1 || at.channel().ySampling != 1)
      throw bad_file(path, "the channel " + name + " is subsampled", "as many values as pixels");
    if (at.channel().type == imf::UINT && (count == 1 || is_color_channel(name)))
      throw integer_colors(path, name);
  }
}

/// Channels in the order of their layers, colours first in each.
std::vector<std::string> ordered_names(const imf::ChannelList& channels) {
  std::vector<std::string> names;
  for (auto at = channels.begin(); at != channels.end(); ++at) names.emplace_back(at.name());
  const auto order = [](const std::string& name) {
    constexpr std::string_view kFirst = "RGBYA";
    const std::size_t dot = name.rfind('.') + 1;
    const std::string_view layer = std::string_view(name).substr(0, dot),
                           component = std::string_view(name).substr(dot);
    return std::pair(layer, component.size() == 1 ? kFirst.find(component) : kFirst.npos);
  };
  std::ranges::stable_sort(names, {}, order);
  return names;
}

void copy_metadata(const imf::Header& header, Image& image) {
  constexpr std::string_view kOfTheFile[] = {"name",     "type",    "view",          "Software",
                                             "DateTime", "capDate", "colorInteropID"};
  for (auto at = header.begin(); at != header.end(); ++at)
    if (const auto* const text = dynamic_cast<const imf::StringAttribute*>(&at.attribute());
        text != nullptr && std::ranges::find(kOfTheFile, std::string_view(at.name())) == std::end(kOfTheFile))
      image.metadata.emplace_back(at.name(), text->value());
}

std::optional<ColorMatrix> matrix_of(const imf::Header& header, const std::string& path) {
  if (!imf::hasChromaticities(header)) return {};
  const imf::Chromaticities& stated = imf::chromaticities(header);
  const auto xy = [](const Imath::V2f& at) { return std::array<double, 2>{double(at.x), double(at.y)}; };
  return matrix_to_rec709(RgbPrimaries{xy(stated.red), xy(stated.green), xy(stated.blue), xy(stated.white)},
                          path);
}

Image checked_description(const std::string& path, const imf::Header& header, std::uintmax_t bytes) {
  if (header.hasType() && imf::isDeepData(header.type()))
    throw bad_file(path, "deep images are not supported");
  const auto &data = header.dataWindow(), &display = header.displayWindow();
  const auto pixels = [](int first, int last) { return std::int64_t(last) - first + 1; };
  Image image;
  image.channels = ordered_names(header.channels());
  PictureSize size{pixels(data.min.x, data.max.x),
                   pixels(data.min.y, data.max.y),
                   int(image.channels.size()),
                   pixels(display.min.x, display.max.x),
                   pixels(display.min.y, display.max.y),
                   densest_exr(header.compression() == imf::DWAA_COMPRESSION ||
                               header.compression() == imf::DWAB_COMPRESSION)};
  check_picture_size(path, size, bytes);
  if (header.hasTileDescription()) {
    size.width = std::max<std::int64_t>(size.width, header.tileDescription().xSize);
    size.height = std::max<std::int64_t>(size.height, header.tileDescription().ySize);
    check_picture_size(path, size, bytes);
  }
  check_channels(path, header.channels(), image.channels.size());
  image.width = int(pixels(data.min.x, data.max.x));
  image.height = int(pixels(data.min.y, data.max.y));
  image.crop_x = data.min.x - display.min.x;
  image.crop_y = data.min.y - display.min.y;
  image.full_width = int(size.full_width);
  image.full_height = int(size.full_height);
  if (header.pixelAspectRatio() > 0) image.pixel_aspect = double(header.pixelAspectRatio());
  copy_metadata(header, image);
  return image;
}

void read_pixels(imf::MultiPartInputFile& file, Image& image) {
  imf::InputPart part(file, 0);
  const auto window = part.header().dataWindow();
  const std::size_t pixel = image.channels.size() * sizeof(float);
  image.pixels.resize(std::size_t(image.width) * std::size_t(image.height) * image.channels.size());
  imf::FrameBuffer buffer;
  for (std::size_t c = 0; c < image.channels.size(); ++c)
    buffer.insert(image.channels[c],
                  imf::Slice::Make(imf::FLOAT, image.pixels.data() + c, window.min, image.width, image.height,
                                   pixel, pixel * std::size_t(image.width)));
  part.setFrameBuffer(buffer);
  part.readPixels(window.min.y, window.max.y);
}

}  // namespace

// OpenEXR allocates the length of an attribute before reading it, whatever a damaged header claims.
Image read_exr(const std::string& path, std::uintmax_t bytes) {
  bool is_open = false;
  const auto complain = [&](const std::string& complaint) {
    return bad_file(path, (is_open ? "the image is damaged: " : "not a readable image: ") + complaint);
  };
  try {
    imf::MultiPartInputFile file(path.c_str(), imf::globalThreadCount(), false);
    Image image = checked_description(path, file.header(0), bytes);
    is_open = true;
    check_exr_chunks(path);
    read_pixels(file, image);
    if (const auto matrix = matrix_of(file.header(0), path))
      convert_colors(image.pixels, image.channels.size(), color_channels(image.channels), *matrix);
    return image;
  } catch (const Error&) {
    throw;
  } catch (const std::bad_alloc&) {
    if (is_open) throw;
    throw complain("the header claims more memory than there is");
  } catch (const std::exception& complaint) {
    throw complain(without_name(complaint.what(), path));
  }
}

}  // namespace opaline
