// SPDX-License-Identifier: GPL-3.0-or-later
// The reader of EXR and PNG files: as pictures, layer by layer as they are compared, and as the sums of a direct rendering.
#include "fuzz_target.h"
#include "methods/direct/direct.h"
#include "opaline/compare.h"
#include "opaline/image.h"

namespace opaline::fuzz {
namespace {

constexpr const char* kScene = "a scene's key";

Scene small_scene() {
  Scene scene;
  scene.film.resolution = {3, 2};
  return scene;
}

Image picture(const std::vector<std::string>& channels) {
  Image image;
  image.width = 3, image.height = 2;
  image.channels = channels;
  for (std::size_t i = 0; i < 6 * channels.size(); ++i) image.pixels.push_back(float(i) / 8);
  image.metadata = {{"opaline:seed", "0"}, {"Software", "opaline"}};
  return image;
}

}  // namespace

std::vector<std::string> seeds() {
  std::vector<std::string> all;
  const ScratchFile exr("exr"), png("png");
  const auto keep = [&](const std::string& path) { all.push_back(file_bytes(path)); };
  write_exr(exr.path(), picture({"R", "G", "B", "A", "Z"}), true);
  keep(exr.path());
  Image cropped = picture({"R"});
  cropped.crop_x = 7, cropped.crop_y = 5, cropped.full_width = cropped.full_height = 20;
  write_exr(exr.path(), cropped, false);
  keep(exr.path());
  Image layered = picture({"R", "G", "B", "A", "Z", "diffuse.R", "diffuse.G", "diffuse.B", "N.X", "N.Y",
                           "N.Z", "error.R", "light_key.R", "CryptoObject00.R", "CryptoObject00.G"});
  layered.metadata.emplace_back("cryptomatte/0000000/manifest", R"({"ball":"3f8a6c11"})");
  write_exr(exr.path(), layered, true);
  keep(exr.path());
  DirectState state;
  state.passes = 3;
  state.sums.assign(36, 0.5f);
  write_direct_state(exr.path(), state, small_scene(), kScene);
  keep(exr.path());
  write_png(png.path(), picture({"R", "G", "B"}), 0);
  keep(png.path());
  return all;
}

std::vector<std::string> words() {
  return {"IHDR",
          "PLTE",
          "tRNS",
          "gAMA",
          "sRGB",
          "iCCP",
          "IDAT",
          "IEND",
          "tEXt",
          "channels",
          "chlist",
          "compression",
          "dataWindow",
          "box2i",
          "displayWindow",
          "lineOrder",
          "tiles",
          "tiledesc",
          "opaline:direct_passes",
          "opaline:direct_scene",
          "string",
          "deepscanline",
          "multiView",
          "diffuse.R",
          "diffuse.",
          ".R",
          "A",
          "type"};
}

}  // namespace opaline::fuzz

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace opaline;
  static const fuzz::ScratchFile file("picture");
  static const Scene scene = fuzz::small_scene();
  file.put({reinterpret_cast<const char*>(data), size});
  fuzz::try_input([&] {
    const Image image = read_image(file.path());
    fuzz::expect(image.width > 0 && image.height > 0 && !image.channels.empty(), "pixels and channels");
    fuzz::expect(
        image.pixels.size() == std::size_t(image.width) * std::size_t(image.height) * image.channels.size(),
        "a value a pixel and channel");
    const std::size_t pixels = std::size_t(image.width) * std::size_t(image.height);
    fuzz::expect(object_pixels(image).size() == pixels, "a mark for each pixel");
    for (const char* name : {"", "diffuse", "Z", "N", "error", "CryptoObject00"}) {
      const Layer layer = extract_layer(image, name);
      for (const auto& channel : layer.channels)
        fuzz::expect(channel.size() == pixels, "a value for each pixel");
      fuzz::expect(layer.names.size() == layer.channels.size(), "a name for each channel");
      count_non_finite(layer);
    }
  });
  fuzz::try_input([&] { read_direct_state(file.path(), scene, fuzz::kScene); });
  return 0;
}
