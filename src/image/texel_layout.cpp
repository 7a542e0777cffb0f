// SPDX-License-Identifier: GPL-3.0-or-later
#include "image/texel_layout.h"

#include <algorithm>
#include <cstring>

#include "image/display_window.h"
#include "opaline/error.h"

namespace opaline {
namespace {

bool is_grey_tiff(const OIIO::ImageSpec& file) {
  constexpr int kWhiteIsZero = 0, kBlackIsZero = 1, kNone = -1;
  const int photometric = file.get_int_attribute("tiff:PhotometricInterpretation", kNone);
  return photometric == kWhiteIsZero || photometric == kBlackIsZero;
}

/// Names of the channels. OpenImageIO names two or three channels of a grey TIFF file R, G and B.
std::vector<std::string> names_of(const OIIO::ImageSpec& file) {
  std::vector<std::string> names = file.channelnames;
  if (!is_grey_tiff(file) || names.size() < 2) return names;
  for (std::size_t c = 0; c < names.size(); ++c)
    names[c] = c == 0 ? "Y" : int(c) == file.alpha_channel ? "A" : "channel" + std::to_string(c);
  return names;
}

}  // namespace

TexelLayout::TexelLayout(const OIIO::ImageSpec& file, const std::string& path)
    : places(channel_places(names_of(file), path)) {
  if (is_grey_tiff(file) && file.nchannels > 1) ignored = file.nchannels - (places[3] >= 0 ? 2 : 1);
  const bool is_grey = places[0] == places[1] && places[0] == places[2];
  if (is_grey)
    sources = {places[0], places[3], -1, -1};
  else
    sources = places;
  channels = (is_grey ? 1 : 3) + (places[3] >= 0 ? 1 : 0);
  begin = file.nchannels;
  for (int c = 0; c < channels; ++c) {
    if (sources[std::size_t(c)] < 0) continue;
    begin = std::min(begin, sources[std::size_t(c)]);
    end = std::max(end, sources[std::size_t(c)] + 1);
  }
  const PixelWindow data{file.x, file.y, file.width, file.height},
      display{file.full_x, file.full_y, file.full_width, file.full_height};
  // OpenImageIO computes smaller sizes of a window away from the origin wrongly.
  is_windowed = data != display || file.x != 0 || file.y != 0;
  check_windows(path, data, display);
}

bool TexelLayout::is_plain() const {
  for (int c = 0; c < channels; ++c)
    if (sources[std::size_t(c)] != begin + c) return false;
  return end - begin == channels;
}

OIIO::ImageSpec TexelLayout::spec(const OIIO::ImageSpec& file) const {
  OIIO::ImageSpec texels = file;
  texels.nchannels = channels;
  texels.channelformats.clear();
  texels.default_channel_names();
  texels.alpha_channel = places[3] >= 0 ? channels - 1 : -1;
  if (!is_windowed) return texels;
  texels.x = texels.y = texels.full_x = texels.full_y = 0;
  texels.width = file.full_width;
  texels.height = file.full_height;
  texels.tile_width = texels.tile_height = texels.tile_depth = 0;
  return texels;
}

void TexelLayout::take(const unsigned char* values, std::size_t pixels, std::size_t bytes,
                       unsigned char* texels) const {
  const std::size_t step = bytes * std::size_t(end - begin);
  for (std::size_t i = 0; i < pixels; ++i, values += step)
    for (int c = 0; c < channels; ++c, texels += bytes) {
      const int source = sources[std::size_t(c)];
      if (source < 0)
        std::memset(texels, 0, bytes);
      else
        std::memcpy(texels, values + bytes * std::size_t(source - begin), bytes);
    }
}

}  // namespace opaline
