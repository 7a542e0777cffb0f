// SPDX-License-Identifier: GPL-3.0-or-later
// Cryptomatte: names as numbers, and which of them cover a pixel.
#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <cstdio>
#include <map>
#include <nlohmann/json.hpp>

#include "render/mattes.h"
#include "support/scenes.h"

namespace opaline {
namespace {

using namespace test;

// Claim: names are the numbers of the specification's own tests. Source: Cryptomatte, cryptomatte_utilities_tests.py,
// mm3hash_float_values and its sample files. Tolerance: of the digits given. Fails with another hash, seed or byte
// order.
TEST(Mattes, PublishedNumbers) {
  EXPECT_EQ(matte_id("hello"), 6.0705627102400005616e-17f);
  EXPECT_EQ(matte_id("m\xc3\xa4"
                     "dchen"),
            6.2361298211599995797e+25f);
  const std::pair<const char*, float> rounded[] = {
      {"cube", -4.08461912519e+15f}, {"sphere", 2.79018604383e+15f}, {"plane", 3.66557617593e-11f}};
  for (const auto& [name, number] : rounded) EXPECT_FLOAT_EQ(matte_id(name), number) << name;
}

// Claim: no name is a denormal, infinity or NaN, which compositors lose. Source: uint32_to_float32. Of 20,000 names one
// in 128 has an exponent that must be mended. Fails if it is not.
TEST(Mattes, NumbersAreOrdinary) {
  for (int i = 0; i < 20000; ++i) EXPECT_TRUE(std::isnormal(matte_id("shape" + std::to_string(i)))) << i;
}

/// A ball of marble, one beside it in the same medium, and a matte wall behind; a lamp hides a part.
Scene two_balls_and_wall() {
  Scene scene = single_shape(SphereShape{{-8, 0, 0}, 8}, marble(), 200);
  scene.shapes.push_back(translucent("other", SphereShape{{9, 0, 0}, 8}));
  Shape wall;
  wall.name = "wall";
  wall.source = QuadShape{{-20, -20, -30}, {40, 0, 0}, {0, 40, 0}};
  scene.shapes.push_back(wall);
  scene.lights = {{"lamp", SphereLight{{0, 9, 30}, 4, Rgb(1)}}};
  scene.film.samples_per_pixel = 16;
  return scene;
}

struct MattePicture {
  Scene scene = two_balls_and_wall();
  Prepared prepared{scene};
  Image image = prepared.picture();

  MattePicture() { add_mattes({prepared.scene, prepared.world, prepared.rays}, image); }
  /// The share of a pixel that a name of a layer covers.
  float share(const std::string& layer, const std::string& name, int x, int y) const {
    float sum = 0;
    for (const char* part : {"00", "01", "02"})
      for (const auto& [id, share] : {std::pair{".R", ".G"}, std::pair{".B", ".A"}})
        if (channel(image, x, y, layer + part + id) == matte_id(name))
          sum += channel(image, x, y, layer + part + share);
    return sum;
  }
};

// Claim: the shares of all shapes are the coverage of the pixel, each the share of its rays; materials are media, and
// opaque shapes themselves. The lamp, which hides the wall, belongs to none. Source: mattes.h. Tolerance: float
// rounding. Fails if what a lamp hides is counted, a share is of the rays that met something, or bodies of one medium
// are two materials.
TEST(Mattes, SharesAreCoverage) {
  const MattePicture picture;
  int mixed = 0;
  for (int y = 0; y < 32; ++y)
    for (int x = 0; x < 32; ++x) {
      const float left = picture.share("CryptoObject", "shape", x, y),
                  right = picture.share("CryptoObject", "other", x, y),
                  wall = picture.share("CryptoObject", "wall", x, y);
      EXPECT_NEAR(left + right + wall, channel(picture.image, x, y, "A"), 1e-6f) << x << ' ' << y;
      EXPECT_NEAR(left + right, picture.share("CryptoMaterial", "marble", x, y), 1e-6f);
      EXPECT_EQ(wall, picture.share("CryptoMaterial", "wall", x, y));
      if (left > 0 && wall > 0) ++mixed;
    }
  EXPECT_GT(mixed, 10);
  EXPECT_EQ(picture.share("CryptoObject", "shape", 12, 16), 1);
  EXPECT_EQ(picture.share("CryptoObject", "other", 20, 16), 1);
}

// Claim: the larger share comes first. Source: Cryptomatte specification 1.2.0. Fails if names keep the order in which
// rays met them.
TEST(Mattes, LargestFirst) {
  const MattePicture picture;
  for (int y = 0; y < 32; ++y)
    for (int x = 0; x < 32; ++x)
      EXPECT_GE(channel(picture.image, x, y, "CryptoObject00.G"),
                channel(picture.image, x, y, "CryptoObject00.A"));
}

// Claim: the metadata say how names became numbers, under the first seven digits of the layer's own, and list them:
// each as the bits that the pixels hold. Source: Cryptomatte specification 1.2.0. Fails if a key is missing, or the
// manifest has the hash before its exponent is mended.
TEST(Mattes, Metadata) {
  const MattePicture picture;
  const std::map<std::string, std::string> stated(picture.image.metadata.begin(),
                                                  picture.image.metadata.end());
  const std::pair<const char*, std::vector<std::string>> layers[] = {
      {"CryptoObject", {"shape", "other", "wall"}}, {"CryptoMaterial", {"marble", "wall"}}};
  for (const auto& [layer, names] : layers) {
    char digits[9];
    std::snprintf(digits, sizeof digits, "%08x", unsigned(std::bit_cast<std::uint32_t>(matte_id(layer))));
    const std::string key = "cryptomatte/" + std::string(digits, 7);
    EXPECT_EQ(stated.at(key + "/name"), layer);
    EXPECT_EQ(stated.at(key + "/hash"), "MurmurHash3_32");
    EXPECT_EQ(stated.at(key + "/conversion"), "uint32_to_float32");
    const auto manifest = nlohmann::json::parse(stated.at(key + "/manifest"));
    EXPECT_EQ(manifest.size(), names.size());
    for (const std::string& name : names) {
      const auto bits = std::uint32_t(std::stoul(manifest.at(name).get<std::string>(), nullptr, 16));
      EXPECT_EQ(std::bit_cast<float>(bits), matte_id(name)) << name;
    }
  }
}

}  // namespace
}  // namespace opaline
