// SPDX-License-Identifier: GPL-3.0-or-later
// An environment: its picture read, sampled and looked up.
#include <cmath>

#include "fuzz_target.h"
#include "lights/environment_picture.h"

namespace opaline::fuzz {

std::vector<std::string> seeds() {
  return {};
}

std::vector<std::string> words() {
  return {"chlist",    "dataWindow",     "displayWindow",
          "box2i",     "chromaticities", "lineOrder",
          "envmap",    "#?RADIANCE",     "FORMAT=32-bit_rle_rgbe",
          "EXPOSURE=", "COLORCORR=",     "-Y 4 +X 8",
          "IHDR",      "IDAT",           "IEND"};
}

}  // namespace opaline::fuzz

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace opaline;
  static const fuzz::ScratchFile file("environment");
  file.put({reinterpret_cast<const char*>(data), size});
  const auto expect_radiance = [](const RgbF& radiance) {
    for (const float value : {radiance.x, radiance.y, radiance.z})
      fuzz::expect(std::isfinite(value) && value >= 0, "finite radiance, not below 0");
  };
  fuzz::try_input([&] {
    const auto picture = EnvironmentPicture::read(file.path());
    fuzz::expect(picture->memory() > 0 && picture->block_count() > 0, "memory and blocks");
    for (const Vec3d& normal : {Vec3d{0, 1, 0}, Vec3d{.6, -.8, 0}, Vec3d{0, 0, 1}}) {
      expect_radiance(picture->radiance(normal));
      for (const double u : {0., .3, .999}) {
        const EnvironmentPicture::Sample sample = picture->sample({u, 1 - u - .0005}, normal);
        expect_radiance(sample.weight);
        const float density = picture->density(sample.direction, normal);
        fuzz::expect(std::isfinite(density) && density >= 0, "a finite density");
      }
    }
  });
  return 0;
}
