// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <filesystem>

#include "../core/scratch_folder.h"
#include "core/stopwatch.h"
#include "texture_test.h"

namespace opaline::test {
namespace {

// Claim: u runs to the right and v down from the upper left corner, and pictures repeat. Tolerance: halves, .0005.
// Fails if an axis is turned round, or edges are clamped.
TEST(TextureFile, LooksUpTexels) {
  const ScratchFolder folder;
  const std::string path = folder.file("four.png");
  put_png(path, 2, 2, [](int x, int y) { return Bytes{255 * x, 255 * y, 0}; });
  const auto texture = TextureFile::open(path, ColorSpace::linear);
  EXPECT_FALSE(texture->constant());
  for (const double shift : {0., 1., -3.}) {
    EXPECT_NEAR(double(texture->at(at(.75 + shift, .25))[0]), 1, 5e-4);
    EXPECT_NEAR(double(texture->at(at(.75 + shift, .25))[1]), 0, 5e-4);
    EXPECT_NEAR(double(texture->at(at(.25, .75 + shift))[1]), 1, 5e-4);
  }
}

// Claim: a byte is linear light by IEC 61966-2-1 in sRGB, and its share of 255 in linear; files of floats are linear by
// themselves. Tolerance: halves, relative 2^-11. Fails if a file is linearized twice or not at all.
TEST(TextureFile, KnowsColourSpaces) {
  const ScratchFolder folder;
  const std::string bytes = folder.file("bytes.png"), floats = folder.file("floats.exr");
  put_png(bytes, 8, 8, [](int x, int) { return Bytes{128, x < 4 ? 60 : 61, 0}; });
  put_exr(floats, 8, 8, [](int x, int) { return std::array<double, 3>{.5, x < 4 ? .1 : .2, 3}; });
  EXPECT_EQ(TextureFile::space_of_colors(bytes), ColorSpace::srgb);
  EXPECT_EQ(TextureFile::space_of_colors(floats), ColorSpace::linear);
  EXPECT_NEAR(double(TextureFile::open(bytes, ColorSpace::srgb)->at(at(.2, .5))[0]), linear_of_byte(128),
              2e-4);
  EXPECT_NEAR(double(TextureFile::open(bytes, ColorSpace::srgb)->at(at(.2, .5))[1]), linear_of_byte(60),
              2e-4);
  EXPECT_NEAR(double(TextureFile::open(bytes, ColorSpace::linear)->at(at(.2, .5))[0]), 128 / 255., 2e-4);
  EXPECT_EQ(TextureFile::open(floats, ColorSpace::linear)->at(at(.2, .5))[2], 3);
}

// Claim: JPEG and TIFF are read, too. Tolerance: 2 of 255, JPEG's. Fails if a format's first bytes are not known.
TEST(TextureFile, ReadsJpegAndTiff) {
  const ScratchFolder folder;
  for (const char* name : {"p.jpg", "p.tif"}) {
    const std::string path = folder.file(name);
    const auto output = OIIO::ImageOutput::create(path);
    std::vector<unsigned char> bytes;
    for (int i = 0; i < 64 * 64; ++i)
      for (const int value : {i % 64 < 32 ? 40 : 200, 100, 50})
        bytes.push_back(static_cast<unsigned char>(value));
    ASSERT_TRUE(output->open(path, OIIO::ImageSpec(64, 64, 3, OIIO::TypeUInt8)));
    ASSERT_TRUE(output->write_image(OIIO::TypeUInt8, bytes.data()) && output->close());
    const auto texture = TextureFile::open(path, ColorSpace::linear);
    EXPECT_NEAR(double(texture->at(at(.25, .75))[0]) * 255, 40, 2);
    EXPECT_NEAR(double(texture->at(at(.75, .25))[0]) * 255, 200, 2);
    EXPECT_NEAR(double(texture->at(at(.75, .25))[2]) * 255, 50, 2);
  }
}

// Claim: a WebP's colours are those of its encoder, although OpenImageIO multiplies them by alpha; its alpha is linear. The
// bytes are `cwebp -lossless -exact` of 4 x 2 texels of (200, 100, 50) with alphas of 255, 128, 20 and 0. Tolerance: half a byte
// over alpha. A cut file is refused. Fails if: colours darken where alpha is below 1.
TEST(TextureFile, ReadsWebP) {
  const std::string webp(
      "\x52\x49\x46\x46\x26\x00\x00\x00\x57\x45\x42\x50\x56\x50\x38\x4c\x1a\x00\x00\x00\x2f\x03\x40\x00\x10"
      "\x1f"
      "\x30\x64\x83\x3c\x32\x02\x01\x42\x84\x4c\x0f\xd6\xe3\x40\x84\xd1\x8d\x88\xfe\x07",
      46);
  const ScratchFolder folder;
  put_bytes(folder.file("p.webp"), webp);
  const auto texture = TextureFile::open_as(folder.file("p.webp"), true),
             data = TextureFile::open_as(folder.file("p.webp"), false);
  const double alphas[] = {255, 128, 20};
  for (std::size_t i = 0; i < 3; ++i) {
    const auto texel = texture->at(at((double(i) + .5) / 4, .5));
    EXPECT_NEAR(double(texel[3]), alphas[i] / 255, 1e-3);
    const double rounding = .5 * 255 / alphas[i];
    EXPECT_GE(double(texel[0]), linear_of_byte(200 - rounding) - 1e-3) << i;
    EXPECT_LE(double(texel[0]), linear_of_byte(200 + rounding) + 1e-3) << i;
    EXPECT_NEAR(double(data->at(at((double(i) + .5) / 4, .5))[1]) * 255, 100, rounding + .1) << i;
  }
  put_bytes(folder.file("cut.webp"), webp.substr(0, webp.size() - 12));
  EXPECT_THROW(TextureFile::open(folder.file("cut.webp"), ColorSpace::srgb), Error);
}

// Claim: pictures of all counts of channels give red, green, blue and alpha, and say which of them they have; channels go by
// their names. Tolerance: a byte, 1 / 255; JPEG's 2 of 255. Fails if: channels go by their places (grey and alpha become cyan),
// alpha is linearized, or a missing channel is taken for 0 or 1 without a word.
TEST(TextureFile, TakesChannelsByTheirNames) {
  using Names = std::vector<std::string>;
  const ScratchFolder folder;
  const float none = -1;
  struct Case {
    const char* file;
    Names names;
    std::vector<float> left;     // by the file's channels; the right half has 1 minus them
    std::array<float, 4> texel;  // none: there is no such channel
  };
  const Case cases[] = {
      {"y.png", {"Y"}, {.2f}, {.2f, .2f, .2f, none}},
      {"ya.png", {"Y", "A"}, {.2f, .6f}, {.2f, .2f, .2f, .6f}},
      {"rgb.png", {"R", "G", "B"}, {.2f, .4f, .6f}, {.2f, .4f, .6f, none}},
      {"rgba.png", {"R", "G", "B", "A"}, {.2f, .4f, .6f, .8f}, {.2f, .4f, .6f, .8f}},
      {"y.tif", {"Y"}, {.2f}, {.2f, .2f, .2f, none}},
      {"ya.tif", {"Y", "A"}, {.2f, .6f}, {.2f, .2f, .2f, .6f}},
      {"rgb.tif", {"R", "G", "B"}, {.2f, .4f, .6f}, {.2f, .4f, .6f, none}},
      {"rgba.tif", {"R", "G", "B", "A"}, {.2f, .4f, .6f, .8f}, {.2f, .4f, .6f, .8f}},
      {"y.jpg", {"Y"}, {.2f}, {.2f, .2f, .2f, none}},
      {"rgb.jpg", {"R", "G", "B"}, {.2f, .2f, .2f}, {.2f, .2f, .2f, none}},
      {"rgb.hdr", {"R", "G", "B"}, {.2f, .4f, .6f}, {.2f, .4f, .6f, none}},
      {"y.exr", {"Y"}, {.2f}, {.2f, .2f, .2f, none}},
      {"ya.exr", {"Y", "A"}, {.2f, .6f}, {.2f, .2f, .2f, .6f}},
      {"a.exr", {"A"}, {.2f}, {.2f, .2f, .2f, .2f}},
      {"r.exr", {"R"}, {.2f}, {.2f, .2f, .2f, none}},
      {"mask.exr", {"mask"}, {.2f}, {.2f, .2f, .2f, none}},
      {"rg.exr", {"R", "G"}, {.2f, .4f}, {.2f, .4f, none, none}},
      {"ga.exr", {"G", "A"}, {.4f, .6f}, {none, .4f, none, .6f}},
      {"rgb.exr", {"R", "G", "B"}, {.2f, .4f, .6f}, {.2f, .4f, .6f, none}},
      {"rgba.exr", {"R", "G", "B", "A"}, {.2f, .4f, .6f, .8f}, {.2f, .4f, .6f, .8f}},
      {"words.exr", {"red", "green", "blue"}, {.2f, .4f, .6f}, {.2f, .4f, .6f, none}},
      {"many.exr", {"R", "G", "B", "A", "Z", "N.X"}, {.2f, .4f, .6f, .8f, 9, 9}, {.2f, .4f, .6f, .8f}},
      {"layer.exr", {"Z", "paint.R", "paint.G", "paint.B"}, {9, .2f, .4f, .6f}, {.2f, .4f, .6f, none}}};
  for (const Case& c : cases) {
    const std::string path = folder.file(c.file);
    const bool is_float = path.ends_with("exr") || path.ends_with("hdr");
    std::vector<float> right;
    for (const float value : c.left) right.push_back(1 - value);
    put_channels(path, OIIO::ImageSpec(64, 64, 1, is_float ? OIIO::TypeFloat : OIIO::TypeUInt8), c.names,
                 {c.left, right});
    const auto texture = TextureFile::open(path, ColorSpace::linear),
               srgb = TextureFile::open(path, ColorSpace::srgb);
    const auto left = texture->at(at(.25, .5)), middle = texture->at(at(.75, .5)),
               light = srgb->at(at(.25, .5));
    for (std::size_t k = 0; k < 4; ++k) {
      EXPECT_EQ(texture->has_channel(k), c.texel[k] != none) << path << k;
      if (!texture->has_channel(k)) continue;
      EXPECT_NEAR(left[k], c.texel[k], .01f) << path << k;
      EXPECT_NEAR(middle[k], 1 - c.texel[k], .01f) << path << k;
      EXPECT_NEAR(texture->mean()[k], .5, .01) << path << k;
      EXPECT_NEAR(double(light[k]), k < 3 ? linear_of_byte(255 * double(c.texel[k])) : double(c.texel[k]),
                  .01)
          << path << k;
    }
  }
  const auto refused = [&](const Names& names) {
    const std::vector<float> values(names.size(), .5f);
    put_channels(folder.file("none.exr"), OIIO::ImageSpec(8, 8, 1, OIIO::TypeFloat), names, {values, values});
    return message_of(folder.file("none.exr"));
  };
  EXPECT_NE(refused({"U", "V"})
                .find("has no colours (expected the channels R, G and B, or Y, or one alone, got U, V)"),
            std::string::npos);
  EXPECT_NE(refused({"X", "Y", "Z"}).find("has no colours"), std::string::npos);  // positions
  EXPECT_EQ(refused({"A", "Y", "Z"}), "");                                        // grey with depths
  EXPECT_NE(refused({"a.R", "a.G", "a.B", "b.R", "b.G", "b.B"}).find("several colour layers"),
            std::string::npos);
#if OIIO_VERSION < 20500  // later versions convert these channels to R, G and B
  EXPECT_NE(refused({"Y", "BY", "RY"}).find("luminance and chroma"), std::string::npos);
#endif
}

// Claim: an image is its display window, wherever that begins: 0 beside the data window, without the pixels outside. Source:
// the OpenEXR manual. The same image, written as a whole, gives the same texels at every size, by rows and by tiles.
// Tolerance: none. Fails if: texels are found by their places in the data window, the data window repeats, or smaller sizes
// begin at the display window's origin.
TEST(TextureFile, FillsTheDisplayWindow) {
  const ScratchFolder folder;
  const int size = 96;
  const auto value = [](int x, int y) { return float((x * 7 + y * 13) % 32) / 32; };
  struct Window {
    int x, y, width, height;
  };
  const Window windows[] = {{16, 16, 32, 32},   {0, 48, 96, 17}, {-8, 40, 60, 70},
                            {-5, -5, 120, 120}, {95, 95, 1, 1},  {0, 0, 96, 96}};
  for (std::size_t w = 0; w < std::size(windows); ++w)
    for (const int origin : {0, 70, -9})
      for (const int tile : {0, 32})
        for (const int channels : {1, 3, 4}) {
          const Window& window = windows[w];
          OIIO::ImageSpec spec(window.width, window.height, channels, OIIO::TypeFloat);
          spec.x = origin + window.x;
          spec.y = origin + window.y;
          spec.full_x = spec.full_y = origin;
          spec.full_width = spec.full_height = size;
          spec.tile_width = spec.tile_height = tile;
          OIIO::ImageSpec whole_spec(size, size, channels, OIIO::TypeFloat);
          std::vector<float> part, whole(std::size_t(size * size * channels));
          for (int y = window.y; y < window.y + window.height; ++y)
            for (int x = window.x; x < window.x + window.width; ++x)
              for (int c = 0; c < channels; ++c) {
                part.push_back(value(x, y));
                if (x >= 0 && x < size && y >= 0 && y < size)
                  whole[std::size_t((y * size + x) * channels + c)] = value(x, y);
              }
          const auto put = [&](const std::string& path, const OIIO::ImageSpec& as,
                               const std::vector<float>& pixels) {
            const auto output = OIIO::ImageOutput::create(path);
            ASSERT_TRUE(output->open(path, as) && output->write_image(OIIO::TypeFloat, pixels.data()) &&
                        output->close());
          };
          const std::string name = std::to_string(w) + '_' + std::to_string(origin) + '_' +
                                   std::to_string(tile) + std::to_string(channels);
          put(folder.file(name + "part.exr"), spec, part);
          put(folder.file(name + "whole.exr"), whole_spec, whole);
          const auto a = TextureFile::open(folder.file(name + "part.exr"), ColorSpace::linear),
                     b = TextureFile::open(folder.file(name + "whole.exr"), ColorSpace::linear);
          for (std::size_t c = 0; c < 4; ++c) EXPECT_NEAR(a->mean()[c], b->mean()[c], 1e-12) << name;
          EXPECT_FALSE(a->constant());
          for (int i = 0; i < 400; ++i) {
            const float side = i % 3 == 0 ? .03f : 0;
            const TexturePlace place{float(i) * .0371f, float(i) * .0597f, {side, 0}, {0, side}};
            EXPECT_EQ(a->at(place), b->at(place)) << name << ' ' << i;
          }
        }
  OIIO::ImageSpec beside(8, 8, 1, OIIO::TypeFloat);
  beside.x = 100;
  beside.full_width = beside.full_height = 64;
  put_channels(folder.file("beside.exr"), beside, {"Y"}, {std::vector<float>{1}, std::vector<float>{1}});
  EXPECT_NE(message_of(folder.file("beside.exr"))
                .find("its data window lies outside of its display window (expected within 64 x 64 at 0,0, "
                      "got 8 x 8 at 100,0)"),
            std::string::npos);
}

// Claim: where all texels are alike their value is exact, that of "#808080" in a scene file; one other texel makes the
// difference. Tolerance: none. Fails if the constant is found by a filtered lookup, or only the first rows are looked at.
TEST(TextureFile, FindsConstants) {
  const ScratchFolder folder;
  put_png(folder.file("even.png"), 96, 300, Bytes{128, 0, 255});
  const auto texture = TextureFile::open(folder.file("even.png"), ColorSpace::srgb);
  ASSERT_TRUE(texture->constant());
  EXPECT_EQ(*texture->constant(), (Texel{linear_of_byte(128), 0, 1, 1}));
  put_png(folder.file("spot.png"), 96, 300, [](int x, int y) {
    return Bytes{x == 95 && y == 299 ? 129 : 128, 0, 255};
  });
  EXPECT_FALSE(TextureFile::open(folder.file("spot.png"), ColorSpace::srgb)->constant());
}

// Claim: a footprint as large as the picture gives its mean, of linear light, wherever it lies, and so does mean().
// Tolerance: halves and the sizes' rounding, .002. Fails if smaller sizes are made of sRGB numbers (.5 becomes .2), or
// lookups ignore the footprint.
TEST(TextureFile, FiltersCheckers) {
  const ScratchFolder folder;
  put_png(folder.file("checker.png"), 256, 256, checker);
  const auto texture = TextureFile::open(folder.file("checker.png"), ColorSpace::srgb);
  EXPECT_NEAR(texture->mean()[0], .5, 1e-12);
  for (int i = 0; i < 50; ++i) {
    const TexturePlace place{float(i) * .137f, float(i) * .291f, {.25f, 0}, {0, .25f}};
    EXPECT_NEAR(double(texture->at(place)[0]), .5, .002) << i;
    const TexturePlace oblong{float(i) * .137f, float(i) * .291f, {.5f, .1f}, {-.02f, .1f}};
    EXPECT_NEAR(double(texture->at(oblong)[1]), .5, .002) << i;
  }
}

// Claim: the smaller sizes of a picture without them are bilinear samples of the next larger one, for odd sizes, too. Source: by
// hand: a row of five texels 0, 1, 0, 0, 0 becomes the means of those around 3/4 and 13/4 from the first, which are 3/4 and 0.
// Tolerance: halves. Fails if the last texels of odd sizes are left out, or mixed with the first.
TEST(TextureFile, HalvesOddSizes) {
  const ScratchFolder folder;
  for (const bool is_wide : {false, true}) {
    const std::string path = folder.file(is_wide ? "wide.png" : "high.png");
    put_png(path, is_wide ? 5 : 1, is_wide ? 1 : 5, [](int x, int y) {
      return x + y == 1 ? Bytes{255, 255, 255} : Bytes{0, 0, 0};
    });
    for (const ColorSpace space : {ColorSpace::linear, ColorSpace::srgb}) {
      const auto texture = TextureFile::open(path, space);
      const auto half = [&](float along) {
        TexturePlace place{.5f, .5f, {.4f, 0}, {0, .4f}};
        (is_wide ? place.u : place.v) = along;
        return double(texture->at(place)[0]);
      };
      EXPECT_NEAR(half(.25f), .75, .004) << is_wide;
      EXPECT_NEAR(half(.75f), 0, .004) << is_wide;
    }
  }
}

// Claim: making the smaller sizes of a large PNG costs about as much as decoding it. Tolerance: 6 times the CPU time of
// decoding; it is 2 times, and 14 times where the cache makes the sizes texel by texel. Fails if the cache does.
TEST(TextureFile, SmallerSizesCostLittle) {
  constexpr int kSide = 4096;
  const ScratchFolder folder;
  const std::string path = folder.file("large.png");
  const auto output = OIIO::ImageOutput::create(path);
  OIIO::ImageSpec spec(kSide, kSide, 1, OIIO::TypeUInt8);
  spec.attribute("png:compressionLevel", 1);
  std::vector<unsigned char> texels(std::size_t(kSide) * kSide);
  for (std::size_t i = 0; i < texels.size(); ++i) texels[i] = (i / 8 + i / kSide) % 2 == 0 ? 255 : 0;
  ASSERT_TRUE(output->open(path, spec));
  ASSERT_TRUE(output->write_image(OIIO::TypeUInt8, texels.data()) && output->close());
  const auto texture = TextureFile::open(path, ColorSpace::srgb);
  const Stopwatch decoding;
  ASSERT_TRUE(OIIO::ImageInput::open(path)->read_image(0, 0, 0, 1, OIIO::TypeUInt8, texels.data()));
  const double decode_seconds = decoding.cost({}).cpu_seconds;
  const Stopwatch looking;
  EXPECT_NEAR(double(texture->at({.5f, .5f, {1, 0}, {0, 1}})[0]), .5, .002);
  EXPECT_LT(looking.cost({}).cpu_seconds, 6 * decode_seconds);
  EXPECT_NEAR(double(texture->at({.5f / kSide, .5f / kSide, {}, {}})[0]), 1, 1e-3);
}

// Claim: tiles of a set stand side by side, 1001 + column + 10 row with rows upwards; where there is none the set says
// so. Tolerance: halves. Fails if rows count downwards, or the wrong tile is taken beside its edge.
TEST(TextureFile, PutsTilesSideBySide) {
  const ScratchFolder folder;
  for (const int tile : {1001, 1002, 1011}) {
    const int value = tile - 1000;
    put_png(folder.file("paint." + std::to_string(tile) + ".png"), 4, 4, Bytes{10 * value, 20, 0});
  }
  const auto texture = TextureFile::open(folder.file("paint.<UDIM>.png"), ColorSpace::linear);
  EXPECT_FALSE(texture->constant());
  EXPECT_TRUE(texture->has_tile(1, 0) && texture->has_tile(0, 1));
  EXPECT_FALSE(texture->has_tile(1, 1) || texture->has_tile(-1, 0) || texture->has_tile(10, 0));
  const auto red = [&](double u, double v_up) { return double(texture->at(at(u, 1 - v_up))[0]) * 255; };
  EXPECT_NEAR(red(.999, .5), 10, .05);
  EXPECT_NEAR(red(1.001, .5), 20, .05);
  EXPECT_NEAR(red(.5, 1.5), 110, .1);
  EXPECT_NE(message_of(folder.file("none.<UDIM>.png")).find("has no tiles"), std::string::npos);
}

// Claim: tiles of one colour are no constant: where there is no tile the set has no colour. Tolerance: none. Fails if: the
// texture of such a set is replaced by its colour, which fills missing tiles.
TEST(TextureFile, TilesOfOneColourAreNoConstant) {
  const ScratchFolder folder;
  for (const char* name : {"one.1001.png", "two.1001.png", "two.1012.png"})
    put_png(folder.file(name), 8, 8, Bytes{200, 100, 50});
  for (const char* name : {"one.<UDIM>.png", "two.<UDIM>.png"}) {
    const auto texture = TextureFile::open(folder.file(name), ColorSpace::srgb);
    EXPECT_FALSE(texture->constant()) << name;
    EXPECT_FALSE(texture->has_tile(1, 0)) << name;
  }
}

// Claim: an unchanged file is the same object, a changed one is read again and has another hash. Fails if old texels come
// from a cache under the file's name.
TEST(TextureFile, IsReadAgainWhenItChanges) {
  const ScratchFolder folder;
  const std::string path = folder.file("paint.png");
  const auto put = [&](int value) {
    put_png(path, 8, 8, [&](int x, int) { return Bytes{value, x, 0}; });
    std::filesystem::last_write_time(path, std::filesystem::file_time_type() + std::chrono::hours(value));
  };
  put(100);
  const auto first = TextureFile::open(path, ColorSpace::linear);
  EXPECT_EQ(first, TextureFile::open(path, ColorSpace::linear));
  EXPECT_NE(first->hash(), TextureFile::open(path, ColorSpace::srgb)->hash());
  put(200);
  const auto second = TextureFile::open(path, ColorSpace::linear);
  EXPECT_NE(first->hash(), second->hash());
  EXPECT_NEAR(double(second->at(at(.5, .5))[0]) * 255, 200, .1);
}

}  // namespace
}  // namespace opaline::test
