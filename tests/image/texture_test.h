// SPDX-License-Identifier: GPL-3.0-or-later
// Images for tests of textures, and lookups in them.
#pragma once

#include <OpenImageIO/imageio.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <string>
#include <vector>

#include "image/texture_file.h"
#include "opaline/error.h"
#include "support/pictures.h"

namespace opaline::test {

inline Bytes checker(int x, int y) {
  return (x + y) % 2 == 0 ? Bytes{255, 255, 255} : Bytes{0, 0, 0};
}

/// A lookup at a point without a footprint.
inline TexturePlace at(double u, double v) {
  return {float(u), float(v), {}, {}};
}

inline std::string message_of(const std::string& path) {
  try {
    TextureFile::open(path, ColorSpace::srgb);
  } catch (const Error& failure) {
    EXPECT_EQ(failure.kind, ErrorKind::bad_input);
    return failure.what();
  }
  return "";
}

/// A picture of floats or bytes with these channels: the values of the left half, then of the right.
inline void put_channels(const std::string& path, OIIO::ImageSpec spec, const std::vector<std::string>& names,
                         const std::array<std::vector<float>, 2>& values) {
  spec.nchannels = int(names.size());
  spec.channelnames = names;
  spec.alpha_channel = int(std::ranges::find(names, "A") - names.begin());
  if (spec.alpha_channel == spec.nchannels) spec.alpha_channel = -1;
  spec.attribute("oiio:UnassociatedAlpha", 1);
  const auto output = OIIO::ImageOutput::create(path);
  std::vector<float> pixels;
  for (int y = 0; y < spec.height; ++y)
    for (int x = 0; x < spec.width; ++x)
      for (const float value : values[2 * x < spec.width ? 0 : 1]) pixels.push_back(value);
  ASSERT_TRUE(output->open(path, spec)) << path << output->geterror();
  const bool is_written = spec.tile_width > 0 ? output->write_tiles(0, spec.width, 0, spec.height, 0, 1,
                                                                    OIIO::TypeFloat, pixels.data())
                                              : output->write_image(OIIO::TypeFloat, pixels.data());
  ASSERT_TRUE(is_written && output->close()) << path << output->geterror();
}

}  // namespace opaline::test
