// SPDX-License-Identifier: GPL-3.0-or-later
// Texels as linear Rec.709 colours: primaries and alpha as the file states them.
#include <OpenImageIO/imageio.h>
#include <gtest/gtest.h>

#include <algorithm>

#include "../core/scratch_folder.h"
#include "core/rgb_primaries.h"
#include "core/srgb.h"
#include "image/texture_file.h"
#include "opaline/error.h"
#include "opaline/image.h"
#include "texture_test.h"

namespace opaline::test {
namespace {

constexpr RgbPrimaries kRec2020{{.708, .292}, {.170, .797}, {.131, .046}, {.3127, .3290}};
constexpr RgbPrimaries kXyz{{1, 0}, {0, 1}, {0, 0}, {1 / 3., 1 / 3.}};

/// Writes an image whose left half has one value per channel and whose right half has another.
void put_halves(const std::string& path, OIIO::ImageSpec spec, const std::vector<float>& left,
                const std::vector<float>& right) {
  std::vector<float> pixels;
  for (int y = 0; y < spec.height; ++y)
    for (int x = 0; x < spec.width; ++x)
      for (const float value : 2 * x < spec.width ? left : right) pixels.push_back(value);
  const auto output = OIIO::ImageOutput::create(path);
  ASSERT_TRUE(output->open(path, spec)) << path << output->geterror();
  const bool is_written = spec.tile_width > 0 ? output->write_tiles(0, spec.width, 0, spec.height, 0, 1,
                                                                    OIIO::TypeFloat, pixels.data())
                                              : output->write_image(OIIO::TypeFloat, pixels.data());
  ASSERT_TRUE(is_written && output->close()) << path << output->geterror();
}

OIIO::ImageSpec spec_of(int channels, OIIO::TypeDesc type, int tile = 0) {
  OIIO::ImageSpec spec(64, 64, channels, type);
  spec.tile_width = spec.tile_height = tile;
  return spec;
}

void state_primaries(OIIO::ImageSpec& spec, const RgbPrimaries& p) {
  const float values[8] = {float(p.red[0]),  float(p.red[1]),  float(p.green[0]), float(p.green[1]),
                           float(p.blue[0]), float(p.blue[1]), float(p.white[0]), float(p.white[1])};
  spec.attribute("chromaticities", OIIO::TypeDesc(OIIO::TypeDesc::FLOAT, 8), values);
}

std::array<float, 4> left_of(const TextureFile& texture) {
  return texture.at({.25f, .5f, {}, {}});
}

std::array<float, 4> right_of(const TextureFile& texture) {
  return texture.at({.75f, .5f, {}, {}});
}

/// A colour of other primaries as texels have it.
Vec3d converted(const RgbPrimaries& primaries, const Vec3d& color) {
  const Vec3d result = color_matrix(primaries, kRec709Primaries) * color;
  return component_min(component_max(result, Vec3d(0)), Vec3d(1));
}

// Claim: colours of an EXR that states its primaries become Rec.709, as those of environments do: texels, mean and constant, by
// rows, by tiles and beside a data window; data stay the file's numbers, and Rec.709 itself stays. Source: color_matrix.
// Tolerance: halves, 2^-10. Fails if: chromaticities are not read, or are read for data, too.
TEST(TextureColors, PrimariesOfTheFileAreConverted) {
  const ScratchFolder folder;
  const Vec3d left{.5, .25, .125}, right{.2, .7, .1};
  const std::vector<float> a{.5f, .25f, .125f}, b{.2f, .7f, .1f};
  int number = 0;
  for (const RgbPrimaries& primaries : {kAp1Primaries, kRec2020, kXyz, kRec709Primaries})
    for (const OIIO::TypeDesc& type : {OIIO::TypeDesc(OIIO::TypeHalf), OIIO::TypeDesc(OIIO::TypeFloat)})
      for (const int tile : {0, 32})
        for (const bool is_windowed : {false, true}) {
          OIIO::ImageSpec spec = spec_of(3, type, tile);
          if (is_windowed) spec.full_height = 80;
          state_primaries(spec, primaries);
          const std::string path = folder.file(std::to_string(number++) + ".exr");
          SCOPED_TRACE(path);
          put_halves(path, spec, a, b);
          const auto colors = TextureFile::open(path, ColorSpace::linear, TextureContent::colors),
                     data = TextureFile::open(path, ColorSpace::linear);
          const Vec3d wanted_left = converted(primaries, left), wanted_right = converted(primaries, right);
          for (std::size_t c = 0; c < 3; ++c) {
            EXPECT_NEAR(double(left_of(*colors)[c]), wanted_left[c], 1e-3) << c;
            EXPECT_NEAR(double(right_of(*colors)[c]), wanted_right[c], 1e-3) << c;
            EXPECT_NEAR(double(left_of(*data)[c]), left[c], 1e-3) << c;
            const double filled = is_windowed ? .8 : 1;
            EXPECT_NEAR(colors->mean()[c], filled * (wanted_left[c] + wanted_right[c]) / 2, 1e-3) << c;
            EXPECT_NEAR(data->mean()[c], filled * (left[c] + right[c]) / 2, 1e-3) << c;
          }
          EXPECT_NE(colors->hash(), data->hash());
          put_halves(path, spec, a, a);
          const auto even = TextureFile::open(path, ColorSpace::linear, TextureContent::colors);
          ASSERT_EQ(even->constant().has_value(), !is_windowed);
          for (std::size_t c = 0; c < 3 && !is_windowed; ++c)
            EXPECT_NEAR((*even->constant())[c], wanted_left[c], 1e-3) << c;
        }
}

// Claim: whole images, such as environments, are converted by any primaries, not by those of ACEScg alone. Source: color_matrix.
// Tolerance: halves. Fails if: only ACEScg is known.
TEST(TextureColors, WholeImagesAreConvertedAlike) {
  const ScratchFolder folder;
  for (const RgbPrimaries& primaries : {kAp1Primaries, kRec2020, kXyz}) {
    OIIO::ImageSpec spec = spec_of(3, OIIO::TypeHalf);
    state_primaries(spec, primaries);
    put_halves(folder.file("a.exr"), spec, {.5f, .25f, .125f}, {0, 0, 0});
    const Image image = read_image(folder.file("a.exr"));
    const Vec3d wanted = color_matrix(primaries, kRec709Primaries) * Vec3d{.5, .25, .125};
    for (std::size_t c = 0; c < 3; ++c) EXPECT_NEAR(double(image.pixels[c]), wanted[c], 1e-3) << c;
  }
}

// Claim: grey has no primaries, and white stays white. Source: color_matrix. Tolerance: halves. Fails if: a channel is taken for
// red alone.
TEST(TextureColors, GreyAndWhiteStay) {
  const ScratchFolder folder;
  const auto check = [&](const char* file, int channels) {
    OIIO::ImageSpec spec = spec_of(channels, OIIO::TypeHalf);
    if (channels == 1) spec.channelnames = {"Y"};
    state_primaries(spec, kRec2020);
    const std::vector<float> one(std::size_t(channels), 1), half(std::size_t(channels), .5f);
    put_halves(folder.file(file), spec, one, half);
    const auto texture = TextureFile::open(folder.file(file), ColorSpace::linear, TextureContent::colors);
    for (std::size_t c = 0; c < 3; ++c) {
      EXPECT_NEAR(double(left_of(*texture)[c]), 1, 1e-3);
      EXPECT_NEAR(double(right_of(*texture)[c]), .5, 1e-3);
    }
  };
  check("y.exr", 1);
  check("rgb.exr", 3);
}

// Claim: primaries on a line are refused, naming the file and what it states. Source: by hand. Fails if: texels become infinite.
TEST(TextureColors, ImpossiblePrimariesAreRefused) {
  const ScratchFolder folder;
  OIIO::ImageSpec spec = spec_of(3, OIIO::TypeHalf);
  state_primaries(spec, {{.1, .1}, {.2, .2}, {.3, .3}, {.3127, .3290}});
  put_halves(folder.file("line.exr"), spec, {1, 1, 1}, {0, 0, 0});
  EXPECT_NO_THROW(TextureFile::open(folder.file("line.exr"), ColorSpace::linear));
  try {
    TextureFile::open(folder.file("line.exr"), ColorSpace::linear, TextureContent::colors);
    FAIL();
  } catch (const Error& error) {
    const std::string text = error.what();
    EXPECT_NE(text.find("line.exr: has chromaticities that span no colour space"), std::string::npos) << text;
    EXPECT_NE(text.find("red 0.1 0.1, green 0.2 0.2"), std::string::npos) << text;
  }
}

// Claim: a colour is that of the surface, whether the file has alpha multiplied in (EXR; TIFF that says associated) or not (PNG;
// TIFF that says unassociated); data stay the file's numbers. Source: OpenEXR and TIFF 6 specifications. Tolerance: a byte, 1 /
// 255 of alpha .5. Fails if: associated colours are darkened by alpha, or others are divided by it.
TEST(TextureColors, AlphaIsNotMultipliedIn) {
  const ScratchFolder folder;
  struct Case {
    const char* file;
    bool is_associated;
    std::vector<float> stored, right;
  };
  const std::vector<float> color{.2f, .4f, .8f, .5f}, times_alpha{.1f, .2f, .4f, .5f}, clear{0, 0, 0, 0};
  const Case cases[] = {{"a.exr", true, times_alpha, clear},
                        {"a.tif", true, times_alpha, clear},
                        {"u.tif", false, color, clear},
                        {"u.png", false, color, clear},
                        {"grey.exr", true, {.1f, .5f}, {0, 0}}};
  for (const Case& c : cases) {
    const std::string path = folder.file(c.file);
    SCOPED_TRACE(path);
    OIIO::ImageSpec spec =
        spec_of(int(c.stored.size()), path.ends_with("exr") ? OIIO::TypeHalf : OIIO::TypeUInt8);
    if (spec.nchannels == 2) spec.channelnames = {"Y", "A"}, spec.alpha_channel = 1;
    if (!c.is_associated) spec.attribute("oiio:UnassociatedAlpha", 1);
    put_halves(path, spec, c.stored, c.right);
    const auto colors = TextureFile::open(path, ColorSpace::linear, TextureContent::colors),
               data = TextureFile::open(path, ColorSpace::linear);
    const bool is_grey = spec.nchannels == 2;
    for (std::size_t k = 0; k < 4; ++k) {
      const double wanted = double(is_grey && k < 3 ? .2f : color[k]);
      EXPECT_NEAR(double(left_of(*colors)[k]), wanted, .011) << k;
      EXPECT_NEAR(double(left_of(*data)[k]), double(c.stored[is_grey ? k / 3 : k]), .005) << k;
      EXPECT_EQ(right_of(*colors)[k], 0) << k;
      EXPECT_NEAR(colors->mean()[k], wanted / 2, .006) << k;
    }
  }
}

// Claim: sRGB colours with alpha multiplied in are divided by alpha before they become linear, as they were multiplied. Source:
// TIFF 6, associated alpha of stored values. Tolerance: a byte over alpha. Fails if: the order is the other one (0.10 for 0.13).
TEST(TextureColors, EncodedColorsAreDividedByAlphaFirst) {
  const ScratchFolder folder;
  put_halves(folder.file("a.tif"), spec_of(4, OIIO::TypeUInt8), {.2f, .2f, .2f, .5f}, {0, 0, 0, 0});
  const auto texture = TextureFile::open(folder.file("a.tif"), ColorSpace::srgb, TextureContent::colors);
  EXPECT_NEAR(double(left_of(*texture)[0]), srgb_to_linear(.4), .004);
}

// Claim: a grey TIFF image whose other channels have no stated meaning is grey, with a warning that names it. Source: TIFF 6,
// ExtraSamples 0. Tolerance: a byte. Fails if: it is refused, or its channels are taken for red and green.
TEST(TextureColors, GreyTiffWithUnspecifiedChannelIsGrey) {
  const ScratchFolder folder;
  OIIO::ImageSpec spec = spec_of(2, OIIO::TypeUInt8);
  spec.channelnames = {"Y", "Z"};
  put_halves(folder.file("yz.tif"), spec, {.2f, .9f}, {.6f, .1f});
  const auto texture = TextureFile::open(folder.file("yz.tif"), ColorSpace::linear);
  for (std::size_t c = 0; c < 3; ++c) {
    EXPECT_TRUE(texture->has_channel(c));
    EXPECT_NEAR(double(left_of(*texture)[c]), .2, .005);
    EXPECT_NEAR(double(right_of(*texture)[c]), .6, .005);
  }
  EXPECT_FALSE(texture->has_channel(3));
  EXPECT_NE(texture->warning().find("yz.tif: the file does not define the meaning of a channel besides grey"),
            std::string::npos)
      << texture->warning();
  spec.channelnames = {"Y", "A"};
  spec.alpha_channel = 1;
  put_halves(folder.file("ya.tif"), spec, {.2f, .9f}, {.6f, .1f});
  const auto with_alpha = TextureFile::open(folder.file("ya.tif"), ColorSpace::linear);
  EXPECT_TRUE(with_alpha->has_channel(3));
  EXPECT_EQ(with_alpha->warning(), "");
}

// Claim: colours below 0 are a warning that counts them and names the lowest, by rows, by tiles and beside a data window; data, and
// the small negative values that filters leave, are taken without a word. Source: by hand. Fails if a reflectance of -0.3 is
// rendered black in silence, or every texel of a normal map counts.
TEST(TextureColors, NegativeColoursAreAWarning) {
  const ScratchFolder folder;
  int number = 0;
  const auto warning = [&](const char* extension, int tile, bool is_windowed, float red,
                           TextureContent content) {
    OIIO::ImageSpec spec = spec_of(3, OIIO::TypeFloat, tile);
    if (is_windowed) spec.full_height = 80;
    const std::string path = folder.file(std::to_string(number++) + extension);
    put_halves(path, spec, {red, .25f, .125f}, {.2f, .7f, .1f});
    const std::string text = TextureFile::open(path, ColorSpace::linear, content)->warning();
    return text.empty() ? text : text.substr(path.size());
  };
  const auto colors = TextureContent::colors;
  const std::string negative = " texels have a negative colour, rendered as 0; the lowest is -0.3";
  EXPECT_EQ(warning(".tif", 0, false, -.3f, colors), ": 2048 of 4096" + negative);
  for (const int tile : {0, 32}) {
    EXPECT_EQ(warning(".exr", tile, false, -.3f, colors), ": 2048 of 4096" + negative);
    EXPECT_EQ(warning(".exr", tile, true, -.3f, colors), ": 2048 of 5120" + negative);
    EXPECT_EQ(warning(".exr", tile, false, -.9e-4f, colors), "");
    EXPECT_EQ(warning(".exr", tile, false, -.3f, TextureContent::data), "");
  }
}

}  // namespace
// Claim: an EXR whose colours are 32-bit integers is refused as texture and as image, naming the channel; an identifier
// beside colours is none. Source: OpenEXR's documentation: UINT is for object identifiers. Tolerance: none. Fails if: ones
// are divided by 4294967295, as OpenImageIO does.
TEST(TextureColors, IntegerColoursOfExrAreRefused) {
  const ScratchFolder folder;
  const auto put = [&](const std::string& name, const std::vector<std::string>& channels,
                       OIIO::TypeDesc color_type) {
    OIIO::ImageSpec spec(4, 2, int(channels.size()), OIIO::TypeFloat);
    for (const std::string& channel : channels)
      spec.channelformats.push_back(channel == "id" ? OIIO::TypeDesc(OIIO::TypeUInt32) : color_type);
    test::put_channels(folder.file(name), spec, channels,
                       {std::vector<float>(channels.size(), .5f), std::vector<float>(channels.size(), .5f)});
    return folder.file(name);
  };
  const std::string expected =
      "the channel R stores integers (UINT), which are not colours (expected channels of type HALF or FLOAT)";
  const std::string ids = put("ids.exr", {"R", "G", "B"}, OIIO::TypeUInt32);
  EXPECT_EQ(test::message_of(ids), ids + ": " + expected);
  EXPECT_THROW(read_image(ids), Error);
  const std::string one = put("one.exr", {"mask"}, OIIO::TypeUInt32);
  EXPECT_NE(test::message_of(one).find("the channel mask stores integers"), std::string::npos);
  EXPECT_EQ(test::message_of(put("both.exr", {"R", "G", "B", "id"}, OIIO::TypeFloat)), "");
}

}  // namespace opaline::test
