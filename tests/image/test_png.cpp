// SPDX-License-Identifier: GPL-3.0-or-later
// The PNG is the picture in sRGB, exposed; read back, it is linear again.
#include <OpenImageIO/imageio.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <memory>
#include <string>
#include <vector>

#include "../core/scratch_folder.h"
#include "opaline/image.h"

namespace opaline {
namespace {

/// IEC 61966-2-1, in double.
double srgb(double linear) {
  const double x = std::clamp(linear, 0.0, 1.0);
  return x <= 0.0031308 ? 12.92 * x : 1.055 * std::pow(x, 1 / 2.4) - 0.055;
}

/// The bytes in the file as a decoder gives them, without our conversion.
std::vector<std::uint8_t> decode(const std::string& path, int& channels) {
  const auto input = OIIO::ImageInput::open(path);
  channels = input->spec().nchannels;
  std::vector<std::uint8_t> bytes(static_cast<std::size_t>(input->spec().image_pixels()) *
                                  static_cast<std::size_t>(channels));
  input->read_image(0, 0, 0, channels, OIIO::TypeUInt8, bytes.data());
  return bytes;
}

/// n pixels from 0 to 1, G and B other powers of R; the layer between must not show.
Image ramp(int n) {
  Image image;
  image.width = n;
  image.height = 1;
  image.channels = {"R", "albedo.R", "G", "B"};
  for (int i = 0; i < n; ++i) {
    const float x = static_cast<float>(i) / static_cast<float>(n - 1);
    image.pixels.insert(image.pixels.end(), {x, 0.5f, x * x, x * x * x});
  }
  return image;
}

// Claim: a byte is 255 sRGB(2^exposure x value), rounded: within .5 and float rounding, tenfold below the
// 1/255 asked. Source: image.h, IEC 61966-2-1. Fails if: gamma 2.2 stands for sRGB (off by 5), no rounding,
// or wrong channels.
TEST(Png, BytesAreSrgb) {
  const ScratchFolder folder;
  const Image image = ramp(4001);
  for (const double exposure : {0.0, -3.0, 1.5}) {
    write_png(folder.file("a.png"), image, exposure);
    int channels = 0;
    const std::vector<std::uint8_t> bytes = decode(folder.file("a.png"), channels);
    ASSERT_EQ(channels, 3);
    double worst = 0;
    for (std::size_t i = 0; i < bytes.size(); ++i) {
      const std::size_t source = i / 3 * 4 + (i % 3 == 0 ? 0 : i % 3 + 1);
      const double exact = 255 * srgb(std::exp2(exposure) * static_cast<double>(image.pixels[source]));
      worst = std::max(worst, std::abs(bytes[i] - exact));
    }
    EXPECT_LE(worst, 0.501) << exposure;
  }
}

// Claim: out of range is clamped and non-finite is black, at any exposure: no byte wraps around.
// Source: image.h. Fails if: NaN is cast to a byte, or 0 x infinity (exposure 1e5) is not looked at.
TEST(Png, ClampsAndBlackensNonFinite) {
  const ScratchFolder folder;
  const float infinity = std::numeric_limits<float>::infinity();
  Image image;
  image.width = 2;
  image.height = 1;
  image.channels = {"R", "G", "B"};
  image.pixels = {std::nanf(""), infinity, -infinity, -5.0f, 1e30f, 0.0f};
  for (const double exposure : {0.0, 1e5}) {
    write_png(folder.file("a.png"), image, exposure);
    int channels = 0;
    EXPECT_EQ(decode(folder.file("a.png"), channels), (std::vector<std::uint8_t>{0, 0, 0, 0, 255, 0}));
  }
}

// Claim: read back, each of the 256 levels is linear again: the same byte on a second writing, and the exact
// inverse within 1e-6. Source: image.h, IEC 61966-2-1. Fails if: read_image returns the bytes / 255.
TEST(Png, ReadsBackLinear) {
  const ScratchFolder folder;
  write_png(folder.file("a.png"), ramp(4001), 0);
  const Image read = read_image(folder.file("a.png"));
  EXPECT_EQ(read.channels, (std::vector<std::string>{"R", "G", "B"}));
  int channels = 0;
  const std::vector<std::uint8_t> bytes = decode(folder.file("a.png"), channels);
  ASSERT_EQ(read.pixels.size(), bytes.size());
  double worst = 0;
  for (std::size_t i = 0; i < bytes.size(); ++i)
    worst = std::max(worst, std::abs(srgb(static_cast<double>(read.pixels[i])) - bytes[i] / 255.0));
  EXPECT_LE(worst, 1e-6);
  write_png(folder.file("b.png"), read, 0);
  EXPECT_TRUE(bytes_of(folder.file("a.png")) == bytes_of(folder.file("b.png")));
}

// Claim: an alpha channel is coverage, not light: neither it nor the colours are changed by it.
// Source: PNG specification, section 4 (alpha is linear and not premultiplied). Tolerance: float rounding.
// Fails if: alpha goes through the transfer function, or OpenImageIO premultiplies.
TEST(Png, AlphaIsLeftAlone) {
  const ScratchFolder folder;
  const std::unique_ptr<OIIO::ImageOutput> output = OIIO::ImageOutput::create("png");
  OIIO::ImageSpec spec(1, 1, 4, OIIO::TypeUInt8);
  spec.attribute("oiio:UnassociatedAlpha", 1);
  const std::uint8_t pixel[4] = {255, 188, 0, 128};
  ASSERT_TRUE(output->open(folder.file("a.png"), spec) && output->write_image(OIIO::TypeUInt8, pixel));
  ASSERT_TRUE(output->close());
  const Image read = read_image(folder.file("a.png"));
  ASSERT_EQ(read.pixels.size(), 4u);
  EXPECT_FLOAT_EQ(read.pixels[0], 1.0f);
  EXPECT_NEAR(srgb(static_cast<double>(read.pixels[1])), 188 / 255.0, 1e-6);
  EXPECT_FLOAT_EQ(read.pixels[3], 128 / 255.0f);
}

// Claim: what describes a picture is written and read back, in any language, and the pixels stay. Source: image.h; PNG
// specification, section 11.3.4.5. Fails if: a chunk stands before IHDR or its length counts the type (the decoder then
// finds no picture).
TEST(Png, HasMetadata) {
  const ScratchFolder folder;
  Image image = ramp(64);
  image.metadata = {{"opaline:scene", "Büste ミロ.json"}, {"opaline:empty", ""}};
  write_png(folder.file("a.png"), image, 0);
  const Image read = read_image(folder.file("a.png"));
  EXPECT_EQ(read.metadata, image.metadata);
  image.metadata.clear();
  write_png(folder.file("b.png"), image, 0);
  EXPECT_EQ(read.pixels, read_image(folder.file("b.png")).pixels);
}

}  // namespace
}  // namespace opaline
