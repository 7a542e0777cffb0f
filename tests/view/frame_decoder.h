// SPDX-License-Identifier: GPL-3.0-or-later
// Frames of the view's protocol as a page decodes them (src/view/view_frame.h), by code of its own.
#pragma once

#include <Imath/half.h>
#include <gtest/gtest.h>
#include <turbojpeg.h>
#include <zlib.h>

#include <cmath>
#include <cstring>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "view/view_frame.h"

namespace opaline::test {

struct Frame {
  std::uint32_t number = 0, revision = 0, width = 0, height = 0, layer_channels = 0;
  PictureStep step = PictureStep::moving;
  std::vector<std::uint16_t> colours;  ///< bits of halves, R G B A a pixel
  std::vector<float> layer;
  bool is_jpeg = false;
};

inline void decode_jpeg(Frame& frame, const std::string& bytes, std::size_t start) {
  float largest = 0;
  std::memcpy(&largest, bytes.data() + start, sizeof largest);
  std::vector<unsigned char> rgb(std::size_t(frame.width) * frame.height * 3);
  const tjhandle decoder = tjInitDecompress();
  const auto* jpeg = reinterpret_cast<const unsigned char*>(bytes.data()) + start + sizeof largest;
  EXPECT_EQ(tjDecompress2(decoder, jpeg, bytes.size() - start - sizeof largest, rgb.data(), int(frame.width),
                          0, int(frame.height), TJPF_RGB, 0),
            0);
  tjDestroy(decoder);
  for (std::size_t i = 0; i < frame.colours.size(); ++i) {
    const double code = double(rgb[i / 4 * 3 + std::min<std::size_t>(i % 4, 2)]) / 255;
    const double value = (std::pow(1 + 16 * double(largest), code) - 1) / 16;
    frame.colours[i] = half(i % 4 == 3 ? 1.0f : float(value)).bits();
  }
  frame.is_jpeg = true;
}

class FrameDecoder {
 public:
  /// A picture where the message completes one.
  std::optional<Frame> take(const std::string& bytes) {
    std::uint32_t words[8];
    EXPECT_GE(bytes.size(), sizeof words);
    std::memcpy(words, bytes.data(), sizeof words);
    Frame frame{words[1], words[2], words[4], words[5], words[6], PictureStep(words[3]), {}, {}};
    const std::size_t pixels = std::size_t(frame.width) * frame.height;
    frame.colours.resize(pixels * 4);
    frame.layer.resize(pixels * frame.layer_channels);
    if (words[0] == kBandMark) return take_band(std::move(frame), bytes);
    if (words[0] == kJpegMark) {
      decode_jpeg(frame, bytes, sizeof words);
      return frame;
    }
    EXPECT_EQ(words[0], kFrameMark);
    EXPECT_EQ(bytes.size(), sizeof words + frame.colours.size() * 2 + frame.layer.size() * 4);
    std::memcpy(frame.colours.data(), bytes.data() + sizeof words, frame.colours.size() * 2);
    if (!frame.layer.empty())
      std::memcpy(frame.layer.data(), bytes.data() + sizeof words + frame.colours.size() * 2,
                  frame.layer.size() * 4);
    return frame;
  }

  std::size_t bands = 0;  ///< with rows

 private:
  std::optional<Frame> take_band(Frame frame, const std::string& bytes) {
    constexpr std::size_t start = 10 * sizeof(std::uint32_t);
    std::uint32_t place[2];
    std::memcpy(place, bytes.data() + start - sizeof place, sizeof place);
    Frame& held = held_[frame.step == PictureStep::reference];
    if (held.width != frame.width || held.height != frame.height ||
        held.layer_channels != frame.layer_channels)
      held = frame;
    frame.colours.swap(held.colours);
    frame.layer.swap(held.layer);
    held = frame;
    if (place[1] == 0) return frame;
    ++bands;
    const std::size_t first = std::size_t(place[0]) * frame.width,
                      pixels = std::size_t(place[1]) * frame.width;
    std::string planes(pixels * (8 + 4 * std::size_t(frame.layer_channels)), '\0');
    uLongf size = planes.size();
    EXPECT_EQ(uncompress(reinterpret_cast<Bytef*>(planes.data()), &size,
                         reinterpret_cast<const Bytef*>(bytes.data()) + start, bytes.size() - start),
              Z_OK);
    EXPECT_EQ(size, planes.size());
    const auto byte = [&](std::size_t plane, std::size_t p) {
      return std::uint32_t(static_cast<unsigned char>(planes[plane * pixels + p]));
    };
    for (std::size_t p = 0; p < pixels; ++p) {
      for (std::size_t c = 0; c < 4; ++c)
        held.colours[(first + p) * 4 + c] = std::uint16_t(byte(2 * c, p) | byte(2 * c + 1, p) << 8);
      for (std::size_t c = 0; c < frame.layer_channels; ++c) {
        const std::size_t plane = 8 + 4 * c;
        const std::uint32_t bits =
            byte(plane, p) | byte(plane + 1, p) << 8 | byte(plane + 2, p) << 16 | byte(plane + 3, p) << 24;
        std::memcpy(&held.layer[(first + p) * frame.layer_channels + c], &bits, sizeof bits);
      }
    }
    return {};
  }

  std::map<bool, Frame> held_;  // of bands, by whether they are of the reference
};

}  // namespace opaline::test
