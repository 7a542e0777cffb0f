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
#include "image/picture_layers.h"

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

// Claim: the header has the width of a pixel over its height, 1 unless set, and it comes back. Source: OpenEXR's
// pixelAspectRatio, read by OpenImageIO. Tolerance: none. Fails if: it is inverted or left at 1.
TEST(Exr, PixelAspect) {
  const ScratchFolder folder;
  Image image = layered();
  for (const double aspect : {1., 2., .5}) {
    image.pixel_aspect = aspect;
    write_exr(folder.file("a.exr"), image, false);
    const auto file = OIIO::ImageInput::open(folder.file("a.exr"));
    ASSERT_TRUE(file);
    EXPECT_EQ(file->spec().get_float_attribute("PixelAspectRatio", -1), float(aspect));
    EXPECT_EQ(read_image(folder.file("a.exr")).pixel_aspect, aspect);
  }
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

/// The header's numbers or text of this name.
struct StatedSpace {
  float chromaticities[8] = {};
  std::string id;
  explicit StatedSpace(const std::string& path) {
    const auto input = OIIO::ImageInput::open(path);
    input->spec().getattribute("chromaticities", OIIO::TypeDesc(OIIO::TypeDesc::FLOAT, 8), chromaticities);
    id = input->spec().get_string_attribute("colorInteropID");
  }
};

// Claim: the header states the space of the colours: the primaries and white of Rec.709 or AP1, and the name of the
// Color Interop Forum. Source: ITU-R BT.709, SMPTE ST 2065-1, the forum's recommendation. Fails if either is left out
// or does not follow the space.
TEST(Exr, StatesTheColorSpace) {
  const ScratchFolder folder;
  write_exr(folder.file("a.exr"), layered(), true);
  const StatedSpace plain(folder.file("a.exr"));
  const float rec709[8] = {.64f, .33f, .3f, .6f, .15f, .06f, .3127f, .329f};
  EXPECT_TRUE(std::equal(rec709, rec709 + 8, plain.chromaticities));
  EXPECT_EQ(plain.id, "lin_rec709_scene");
  write_exr(folder.file("a.exr"), layered(), true, LayerChoice{}, FilmColorSpace::acescg);
  const StatedSpace aces(folder.file("a.exr"));
  const float ap1[8] = {.713f, .293f, .165f, .83f, .128f, .044f, .32168f, .33766f};
  EXPECT_TRUE(std::equal(ap1, ap1 + 8, aces.chromaticities));
  EXPECT_EQ(aces.id, "lin_ap1_scene");
}

/// A pixel of colours, a vector, errors and mattes.
Image coloured() {
  Image image;
  image.width = image.height = 1;
  image.channels = {"R",
                    "G",
                    "B",
                    "N.X",
                    "N.Y",
                    "N.Z",
                    "error.R",
                    "error.G",
                    "error.B",
                    "variance.R",
                    "variance.G",
                    "variance.B",
                    "Z",
                    "CryptoObject00.R",
                    "CryptoObject00.G",
                    "CryptoObject00.B"};
  image.pixels.assign({.8f, .1f, .2f, .6f, 0, .8f, .3f, 0, 0, .09f, 0, 0, 7, 1e30f, .5f, 2});
  return image;
}

// Claim: in ACEScg a file's colours are those of its matrix, errors and roots of variances alike; normals, depths and
// Cryptomatte stay; and what reads it has Rec.709 again. Source: image.h; the published matrix, whose first column is
// .613097, .070194, .020616, to five digits. Fails if a layer is converted that is no colour, or read as it stands.
TEST(Exr, AcescgThereAndBack) {
  const ScratchFolder folder;
  const std::string path = folder.file("a.exr");
  const Image written = coloured();
  write_exr(path, written, false, LayerChoice{}, FilmColorSpace::acescg);
  const auto input = OIIO::ImageInput::open(path);
  std::vector<float> stored(written.channels.size());
  ASSERT_TRUE(input->read_image(0, 0, 0, int(stored.size()), OIIO::TypeFloat, stored.data()));
  const auto in_file = [&](const std::string& channel) {
    return stored[std::size_t(input->spec().channelindex(channel))];
  };
  EXPECT_NEAR(in_file("R"), .613097f * .8f + .339523f * .1f + .047379f * .2f, 1e-5f);
  EXPECT_NEAR(in_file("B"), .020616f * .8f + .109570f * .1f + .869815f * .2f, 1e-5f);
  EXPECT_NEAR(in_file("error.G"), .070194f * .3f, 1e-5f);
  EXPECT_NEAR(in_file("variance.G"), .070194f * .070194f * .09f, 1e-7f);
  for (const char* channel : {"N.X", "N.Z", "Z", "CryptoObject00.R", "CryptoObject00.G", "CryptoObject00.B"})
    EXPECT_EQ(in_file(channel), value(written, channel, 0)) << channel;
  const Image read = read_image(path);
  for (const std::string& channel : written.channels)
    EXPECT_NEAR(value(read, channel, 0), value(written, channel, 0),
                3e-7f * std::abs(value(written, channel, 0)) + 3e-7f)
        << channel;
}

// Claim: Cryptomatte's channels are floats where others are halves: a name is all bits of a float. Source: Cryptomatte
// specification 1.2.0. Fails if they are stored as colours.
TEST(Exr, MattesStayFloats) {
  const ScratchFolder folder;
  write_exr(folder.file("a.exr"), coloured(), true);
  EXPECT_EQ(value(read_image(folder.file("a.exr")), "CryptoObject00.R", 0), 1e30f);
}

}  // namespace
}  // namespace opaline
