// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <ImfChannelList.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfOutputFile.h>

#include <string>

#include "opaline/image.h"

namespace opaline::test {

/// Writes all values as they are, in float; write_exr writes 0 for those that are not finite.
inline void write_raw_exr(const std::string& path, const Image& image) {
  const int x0 = image.crop_x, y0 = image.crop_y;
  const int full_width = image.full_width > 0 ? image.full_width : image.width,
            full_height = image.full_height > 0 ? image.full_height : image.height;
  const Imath::Box2i display({0, 0}, {full_width - 1, full_height - 1}),
      data({x0, y0}, {x0 + image.width - 1, y0 + image.height - 1});
  Imf::Header header(display, data);
  Imf::FrameBuffer pixels;
  const std::size_t across = image.channels.size() * sizeof(float), down = across * std::size_t(image.width);
  for (std::size_t c = 0; c < image.channels.size(); ++c) {
    header.channels().insert(image.channels[c], Imf::Channel(Imf::FLOAT));
    auto* const values = reinterpret_cast<char*>(const_cast<float*>(image.pixels.data() + c));
    pixels.insert(image.channels[c], Imf::Slice::Make(Imf::FLOAT, values, data, across, down));
  }
  Imf::OutputFile file(path.c_str(), header);
  file.setFrameBuffer(pixels);
  file.writePixels(image.height);
}

}  // namespace opaline::test
