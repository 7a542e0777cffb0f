// SPDX-License-Identifier: GPL-3.0-or-later
// A texture: opened, looked up near and far, and its mean.
#include <cmath>

#include "fuzz_target.h"
#include "image/texture_file.h"

namespace opaline::fuzz {

std::vector<std::string> seeds() {
  return {};
}

std::vector<std::string> words() {
  return {"IHDR",      "tRNS",         "iCCP",       "IDAT",
          "IEND",      "chlist",       "dataWindow", "displayWindow",
          "box2i",     "tiles",        "tiledesc",   "lineOrder",
          "type",      "deepscanline", "#?RADIANCE", "FORMAT=32-bit_rle_rgbe",
          "EXPOSURE=", "-Y 4 +X 8",    "II*",        "MM",
          "JFIF",      "Exif",         "\xff\xc0",   "\xff\xc2",
          "\xff\xc4",  "\xff\xda",     "ICC_PROFILE"};
}

}  // namespace opaline::fuzz

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace opaline;
  static const fuzz::ScratchFile file("texture");
  file.put({reinterpret_cast<const char*>(data), size});
  fuzz::try_input([&] {
    const auto texture = TextureFile::open(file.path(), TextureFile::space_of_colors(file.path()));
    fuzz::expect(texture->memory().decoded > 0, "memory");
    for (const double value : texture->mean()) fuzz::expect(std::isfinite(value), "a finite mean");
    for (const float side : {0.f, .01f, 3.f})
      for (const float at : {0.f, .49f, -7.3f}) {
        const TexturePlace place{at, 1 - at, {side, 0}, {0, side}};
        for (const float value : texture->at(place)) fuzz::expect(std::isfinite(value), "a finite texel");
        for (const float value : texture->slope(place, 0))
          fuzz::expect(std::isfinite(value), "a finite slope");
      }
  });
  return 0;
}
