// SPDX-License-Identifier: GPL-3.0-or-later
// What is written to an EXR comes back: names, values, metadata, crop; and the bytes depend on the picture
// alone.
#include <OpenImageIO/imageio.h>
#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstring>
#include <limits>
#include <map>
#include <set>
#include <thread>

#include "../core/scratch_folder.h"
#include "opaline/image/picture_layers.h"

namespace opaline {
namespace {

/// A picture whose values no half can hold exactly; 70 rows are more than one block of the compression, 600
/// more than one strip of the writer.
Image layered(int height = 70) {
  Image image;
  image.width = 5;
  image.height = height;
  image.channels = {"R",   "G",   "B", "diffuse.R",    "N.X",       "N.Y",
                    "N.Z", "P.X", "Z", "irradiance.G", "variance.B"};
  image.metadata = {{"opaline:seed", "0"}, {"opaline:scene", "bunny, \"50 mm\"\nsecond line"}, {"note", "-"}};
  for (int i = 0; i < 5 * height * 11; ++i)
    image.pixels.push_back(0.1f + 0.37f * static_cast<float>(i % 1013));
  return image;
}

float value(const Image& image, const std::string& channel, int pixel) {
  const auto at = std::find(image.channels.begin(), image.channels.end(), channel) - image.channels.begin();
  return image.pixels.at(static_cast<std::size_t>(pixel) * image.channels.size() +
                         static_cast<std::size_t>(at));
}

// Claim: all layers come back by name, bit for bit as float, with size and metadata in any order.
// Source: image.h. Tolerance: none. Fails if: a channel is dropped or renamed, or strips are misplaced.
TEST(Exr, FloatRoundTrip) {
  const ScratchFolder folder;
  const Image written = layered();
  const WriteReport report = write_exr(folder.file("a.exr"), written, false);
  EXPECT_EQ(report.non_finite + report.half_overflow, 0u);
  const Image read = read_image(folder.file("a.exr"));
  EXPECT_EQ(read.width, 5);
  EXPECT_EQ(read.height, 70);
  EXPECT_EQ(read.full_width, 5);
  EXPECT_EQ(read.full_height, 70);
  ASSERT_TRUE(std::is_permutation(read.channels.begin(), read.channels.end(), written.channels.begin(),
                                  written.channels.end()));
  for (const std::string& channel : written.channels)
    for (int pixel = 0; pixel < 350; ++pixel)
      ASSERT_EQ(value(read, channel, pixel), value(written, channel, pixel)) << channel << ' ' << pixel;
  EXPECT_EQ(std::map(read.metadata.begin(), read.metadata.end()),
            std::map(written.metadata.begin(), written.metadata.end()));
}

// Claim: asked for halves, colour and N are halves within 2^-11 relative (11 significant bits, rounded to
// nearest); P, Z, irradiance and variance stay exact floats, in the file's types too. Source: image.h. Fails
// if: one type is used for all channels, or halves are truncated.
TEST(Exr, HalfOnlyWhereItIsEnough) {
  const ScratchFolder folder;
  const Image written = layered();
  write_exr(folder.file("a.exr"), written, true);
  const Image read = read_image(folder.file("a.exr"));
  for (const std::string& channel : written.channels) {
    const bool exact =
        channel == "Z" || channel == "P.X" || channel == "irradiance.G" || channel == "variance.B";
    float worst = 0;
    for (int pixel = 0; pixel < 350; ++pixel)
      worst = std::max(worst, std::abs(value(read, channel, pixel) / value(written, channel, pixel) - 1));
    EXPECT_EQ(worst == 0.0f, exact) << channel;
    EXPECT_LE(worst, 0x1.01p-11f) << channel;
  }
  const auto input = OIIO::ImageInput::open(folder.file("a.exr"));
  ASSERT_TRUE(input);
  for (int c = 0; c < input->spec().nchannels; ++c) {
    const std::string name = input->spec().channel_name(c);
    const bool exact = name == "Z" || name == "P.X" || name == "irradiance.G" || name == "variance.B";
    EXPECT_EQ(input->spec().channelformat(c), exact ? OIIO::TypeFloat : OIIO::TypeHalf) << name;
  }
}

// Claim: a crop says where it lies in the whole picture, negative corners (overscan) too.
// Source: image.h; OpenEXR's data and display windows. Fails if: crop_x and crop_y are swapped or left out.
TEST(Exr, CropRoundTrip) {
  const ScratchFolder folder;
  for (const int corner : {37, -3}) {
    Image image = layered();
    image.crop_x = corner;
    image.crop_y = 11;
    image.full_width = 640;
    image.full_height = 480;
    write_exr(folder.file("a.exr"), image, false);
    const Image read = read_image(folder.file("a.exr"));
    EXPECT_EQ(read.crop_x, corner);
    EXPECT_EQ(read.crop_y, 11);
    EXPECT_EQ(read.full_width, 640);
    EXPECT_EQ(read.full_height, 480);
    EXPECT_EQ(value(read, "G", 349), value(image, "G", 349));
  }
}

// Claim: the bytes do not depend on the clock, the file's name or the folder. OpenImageIO stamps seconds, so
// wait one. Source: image.h. Fails if: the constant DateTime is left out of the header.
TEST(Exr, SameBytesLater) {
  const ScratchFolder folder, elsewhere;
  for (const bool half : {false, true}) {
    write_exr(folder.file("a.exr"), layered(), half);
    write_png(folder.file("a.png"), layered(), 0);
    std::this_thread::sleep_for(std::chrono::milliseconds(1100));
    write_exr(elsewhere.file("b.exr"), layered(), half);
    write_png(elsewhere.file("b.png"), layered(), 0);
    EXPECT_TRUE(bytes_of(folder.file("a.exr")) == bytes_of(elsewhere.file("b.exr"))) << half;
    EXPECT_TRUE(bytes_of(folder.file("a.png")) == bytes_of(elsewhere.file("b.png")));
  }
}

// Claim: a file holds the layers that were asked for, R and G always; the values are those of a file with all
// of them; and its bytes are the same for one thread and for three. Source: picture_layers.h. Tolerance:
// none. Fails if: a channel is stored with another one's step or type, or a strip's rows depend on the
// threads.
TEST(Exr, HoldsTheLayersThatWereAskedFor) {
  const ScratchFolder folder;
  const std::string all = folder.file("all.exr"), some = folder.file("some.exr");
  for (const std::size_t threads : {1, 3}) {
    const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
    write_exr(all, layered(600), true);
    write_exr(folder.file(std::to_string(threads) + ".exr"), layered(600), true,
              {false, {"N", "Z", "specular"}});
  }
  EXPECT_TRUE(bytes_of(folder.file("1.exr")) == bytes_of(folder.file("3.exr")));
  const Image chosen = read_image(folder.file("1.exr")), whole = read_image(all);
  EXPECT_EQ(std::set<std::string>(chosen.channels.begin(), chosen.channels.end()),
            (std::set<std::string>{"R", "G", "B", "N.X", "N.Y", "N.Z", "Z"}));
  for (const std::string& channel : chosen.channels)
    for (const int pixel : {0, 17, 2999})
      EXPECT_EQ(value(chosen, channel, pixel), value(whole, channel, pixel)) << channel;
}

// Claim: NaN and infinities are written as 0 and counted; values beyond a half become 65504 with their sign
// and are counted, but not in a float channel. Source: image.h.
// Tolerance: none. Fails if: the count is per pixel, the sign is lost, or Z is clamped.
TEST(Exr, CountsWhatCannotBeStored) {
  const ScratchFolder folder;
  const float infinity = std::numeric_limits<float>::infinity();
  Image image;
  image.width = 3;
  image.height = 1;
  image.channels = {"R", "Z"};
  image.pixels = {std::nanf(""), 1e6f, infinity, -infinity, -1e9f, 65504.0f};
  const WriteReport as_half = write_exr(folder.file("half.exr"), image, true);
  EXPECT_EQ(as_half.non_finite, 3u);
  EXPECT_EQ(as_half.half_overflow, 1u);
  EXPECT_EQ(read_image(folder.file("half.exr")).pixels, (ZeroedArray<float>{0, 1e6f, 0, 0, -65504, 65504}));
  const WriteReport as_float = write_exr(folder.file("float.exr"), image, false);
  EXPECT_EQ(as_float.non_finite, 3u);
  EXPECT_EQ(as_float.half_overflow, 0u);
  EXPECT_EQ(read_image(folder.file("float.exr")).pixels, (ZeroedArray<float>{0, 1e6f, 0, 0, -1e9f, 65504}));
}

}  // namespace
}  // namespace opaline
