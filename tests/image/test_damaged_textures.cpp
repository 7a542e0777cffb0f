// SPDX-License-Identifier: GPL-3.0-or-later
// Textures with missing, damaged or extreme contents.
#include <cmath>
#include <cstring>
#include <filesystem>

#include "../core/scratch_folder.h"
#include "texture_test.h"

namespace opaline::test {
namespace {

// Claim: a header cannot ask for more empty pixels than 4096 x 4096, or 64 times those that the file has. Source: by hand.
// Fails if a file of a kilobyte is padded to gigabytes.
TEST(DamagedTextures, BoundsEmptyPixels) {
  const ScratchFolder folder;
  const auto message_of_height = [&](int height) {
    OIIO::ImageSpec spec(8, 8, 1, OIIO::TypeFloat);
    spec.full_width = 4096;
    spec.full_height = height;
    put_channels(folder.file("tall.exr"), spec, {"Y"}, {std::vector<float>{1}, std::vector<float>{1}});
    return message_of(folder.file("tall.exr"));
  };
  EXPECT_EQ(message_of_height(4096).find("display window"), std::string::npos);
  EXPECT_NE(message_of_height(4097).find("its display window is too large for its data window"),
            std::string::npos);
}

// Claim: an EXR whose chunks do not hold all of its pixels is refused, by rows and by tiles: halves that the header calls floats
// (twice the bytes), an empty chunk. Source: the OpenEXR file layout. Fails if pixels that the file does not have are taken from
// what memory held before.
TEST(DamagedTextures, RefusesChunksWithoutTheirPixels) {
  const ScratchFolder folder;
  const std::string path = folder.file("chunks.exr");
  const auto put_and_change = [&](const std::string& compression, int tile, const auto& change) {
    OIIO::ImageSpec spec(64, 16, 1, OIIO::TypeHalf);
    spec.tile_width = spec.tile_height = tile;
    spec.attribute("compression", compression);
    put_channels(path, spec, {"Y"}, {std::vector<float>{1}, std::vector<float>{.5f}});
    EXPECT_NO_THROW(TextureFile::open(path, ColorSpace::linear)) << compression << tile;
    std::string bytes = bytes_of(path);
    change(bytes);
    put_bytes(path, bytes);
    EXPECT_NE(message_of(path).find("the image is damaged: "), std::string::npos) << compression << tile;
  };
  const std::string half("Y\0\1\0\0\0", 6);
  for (const char* const compression :
       {"none", "rle", "zip", "zips", "piz", "pxr24", "b44", "b44a", "dwaa", "dwab"})
    for (const int tile : {0, 16})
      put_and_change(compression, tile, [&](std::string& bytes) { bytes[bytes.find(half) + 2] = 2; });
  put_and_change("zip", 0, [](std::string& bytes) {
    // Behind the offset table, whose only entry is its place.
    std::uint64_t chunk = 8, entry = 0;
    while (std::memcpy(&entry, &bytes[chunk - 8], 8), entry != chunk) ++chunk;
    std::memset(&bytes[chunk + 4], 0, 4);  // its size, after its row
  });
}

// Claim: a file with a texel that is NaN, infinite or above 1e30 (slopes between such texels overflow) is refused, by pixel and
// value. Source: by hand. Fails if a lookup returns the texel.
TEST(DamagedTextures, RefusesTexelsOutOfRange) {
  const ScratchFolder folder;
  const auto message_of_value = [&](OIIO::TypeDesc type, int tile, float value) -> std::string {
    OIIO::ImageSpec spec(64, 64, 1, type);
    spec.tile_width = spec.tile_height = tile;
    const std::string path = folder.file(std::to_string(value) + std::to_string(tile) + ".exr");
    put_channels(path, spec, {"Y"}, {std::vector<float>{1}, std::vector<float>{value}});
    try {
      TextureFile::open(path, ColorSpace::linear);
    } catch (const Error& error) {
      return error.message;
    }
    return {};
  };
  const std::string refused = "pixel (32, 0) is not finite or above 1e30: ";
  for (const int tile : {0, 32}) {
    EXPECT_EQ(message_of_value(OIIO::TypeFloat, tile, 9e29f), "");
    for (const auto& [value, text] :
         {std::pair(NAN, "nan"), std::pair(INFINITY, "inf"), std::pair(-1.1e30f, "-1.1e+30")})
      EXPECT_EQ(message_of_value(OIIO::TypeFloat, tile, value), refused + text);
    EXPECT_EQ(message_of_value(OIIO::TypeHalf, tile, NAN), refused + "nan");
  }
}

/// An uncompressed grey TIFF of 16 x 16 bytes whose directory precedes its pixels.
std::string tiff_of_bytes() {
  constexpr int kSide = 16, kEntries = 8, kPixels = 8 + 2 + 12 * kEntries + 4;
  std::string bytes("II*\0\x08\0\0\0", 8);
  const auto add = [&](int number, int size) {
    for (int i = 0; i < size; ++i) bytes += char(number >> 8 * i & 255);
  };
  add(kEntries, 2);
  // Width, height, bits, no compression, black is zero, place of the only strip, its rows, its bytes.
  for (const auto& [tag, value] :
       {std::pair(256, kSide), std::pair(257, kSide), std::pair(258, 8), std::pair(259, 1), std::pair(262, 1),
        std::pair(273, kPixels), std::pair(278, kSide), std::pair(279, kSide * kSide)})
    for (const auto& [number, size] :
         {std::pair(tag, 2), std::pair(4, 2), std::pair(1, 4), std::pair(value, 4)})
      add(number, size);
  add(0, 4);
  return bytes + std::string(kSide * kSide, char(200));
}

// Claim: an uncompressed TIFF that lacks any of its bytes is refused. Source: TIFF 6.0. Fails if OpenImageIO alone judges, which
// reads the missing pixels as black.
TEST(DamagedTextures, RefusesShortTiffs) {
  const ScratchFolder folder;
  const std::string path = folder.file("a.tif"), whole = tiff_of_bytes();
  put_bytes(path, whole);
  EXPECT_EQ(message_of(path), "");
  for (const std::size_t length : {whole.size() - 1, whole.size() - 128, std::size_t(111), std::size_t(50)}) {
    put_bytes(path, whole.substr(0, length));
    EXPECT_NE(message_of(path).find("the image is truncated"), std::string::npos) << length;
  }
}

// Claim: the message of a file cut off names it once. Fails if: each level of OpenEXR adds its sentence.
TEST(DamagedTextures, AreNamedOnce) {
  const ScratchFolder folder;
  const std::string path = folder.file("cut.exr");
  put_channels(path, OIIO::ImageSpec(64, 64, 1, OIIO::TypeHalf), {"Y"}, {std::vector<float>{1}});
  const std::string whole = bytes_of(path);
  for (const std::size_t size : {whole.size() / 2, whole.size() - 8}) {  // in the header, in the last chunk
    put_bytes(path, whole.substr(0, size));
    const std::string message = message_of(path);
    EXPECT_NE(message.find(path), std::string::npos) << message;
    EXPECT_EQ(message.find(path), message.rfind(path)) << message;
  }
}

// Claim: what cannot be read is an error that names the file, when it is opened. Fails if a damaged file waits until it is
// looked up, or is shown as grey.
TEST(DamagedTextures, RefusesBrokenFiles) {
  const ScratchFolder folder;
  put_png(folder.file("good.png"), 64, 64, checker);
  const std::string good = bytes_of(folder.file("good.png"));
  put_bytes(folder.file("short.png"), good.substr(0, good.size() / 2));
  std::string changed = good;
  changed[good.size() / 2] = char(changed[good.size() / 2] ^ 1);
  put_bytes(folder.file("changed.png"), changed);
  put_bytes(folder.file("empty.png"), "");
  put_bytes(folder.file("text.png"), "a text, and no picture");
  put_bytes(folder.file("short.jpg"), std::string("\xff\xd8\xff\xe0\0\x10JFIF\0\1\1\0\0\1\0\1\0\0", 20));
  std::filesystem::create_directory(folder.file("folder.png"));
  std::filesystem::create_symlink("/dev/zero", folder.file("endless.png"));
  const std::pair<const char*, const char*> broken[] = {{"short.png", "truncated"},
                                                        {"changed.png", "damaged"},
                                                        {"empty.png", "empty"},
                                                        {"text.png", "EXR, HDR"},
                                                        {"absent.png", "no such image file"},
                                                        {"folder.png", "is a folder"},
                                                        {"endless.png", "is a device"},
                                                        {"short.jpg", "truncated"}};
  for (const auto& [name, what] : broken) {
    const std::string message = message_of(folder.file(name));
    EXPECT_NE(message.find(folder.file(name)), std::string::npos) << message;
    EXPECT_NE(message.find(what), std::string::npos) << message;
  }
}

}  // namespace
}  // namespace opaline::test
