// SPDX-License-Identifier: GPL-3.0-or-later
// EXRs by other programs: tiles, compressions, parts, layers, and the refused kinds.
#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfDeepScanLineOutputPart.h>
#include <OpenEXR/ImfHeader.h>
#include <OpenEXR/ImfMultiPartOutputFile.h>
#include <OpenEXR/ImfPartType.h>
#include <OpenEXR/ImfRgbaFile.h>
#include <OpenImageIO/imageio.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <vector>

#include "../core/scratch_folder.h"
#include "image/picture_module.h"
#include "opaline/error.h"
#include "opaline/image.h"

namespace opaline {
namespace {

OIIO::ImageSpec spec_of(const std::vector<std::string>& channels) {
  OIIO::ImageSpec spec(37, 21, int(channels.size()), OIIO::TypeFloat);
  spec.channelnames = channels;
  return spec;
}

std::vector<float> values_for(const OIIO::ImageSpec& spec, float factor = 1) {
  std::vector<float> values;
  for (int i = 0; i < spec.width * spec.height * spec.nchannels; ++i)
    values.push_back(factor * .125f * float(i % 97));  // exact in halves
  return values;
}

void write(OIIO::ImageOutput& output, const OIIO::ImageSpec& spec, const std::vector<float>& values) {
  const bool is_written = spec.tile_width > 0 ? output.write_tiles(0, spec.width, 0, spec.height, 0, 1,
                                                                   OIIO::TypeFloat, values.data())
                                              : output.write_image(OIIO::TypeFloat, values.data());
  ASSERT_TRUE(is_written) << output.geterror();
}

std::string message_of(const std::string& path) {
  try {
    read_image(path);
  } catch (const Error& error) {
    return error.what();
  }
  return "";
}

// Claim: rows and tiles of any lossless compression and type have the same values. Source: OpenImageIO, the
// writer. Tolerance: none. Fails if: tiles are misplaced, or OpenImageIO is loaded.
TEST(ReadExr, RowsAndTilesOfAnyCompression) {
  const ScratchFolder folder;
  const std::string path = folder.file("a.exr");
  for (const char* compression : {"none", "rle", "zips", "zip", "piz"})
    for (const int tile : {0, 16}) {
      OIIO::ImageSpec spec = spec_of({"R", "G", "B", "id"});
      spec.channelformats = {OIIO::TypeHalf, OIIO::TypeFloat, OIIO::TypeHalf, OIIO::TypeFloat};
      spec.attribute("compression", compression);
      spec.tile_width = spec.tile_height = tile;
      spec.attribute("note", "kept");
      const std::vector<float> values = values_for(spec);
      const auto output = OIIO::ImageOutput::create(path);
      ASSERT_TRUE(output->open(path, spec)) << output->geterror();
      write(*output, spec, values);
      ASSERT_TRUE(output->close());
      const bool was_loaded = picture_module_is_loaded();
      const Image image = read_image(path);
      EXPECT_EQ(picture_module_is_loaded(), was_loaded) << "250 libraries for an EXR";
      EXPECT_EQ(image.channels, spec.channelnames);
      EXPECT_TRUE(std::ranges::equal(image.pixels, values)) << compression << tile;
      EXPECT_EQ(std::ranges::count(image.metadata, std::pair<std::string, std::string>("note", "kept")), 1);
    }
}

// Claim: the image is the first part, and channels stand layer by layer, R, G, B and A first. Source: read_exr.h.
// Fails if: a later part or the file's alphabetical order is returned.
TEST(ReadExr, FirstPartInTheOrderOfLayers) {
  const ScratchFolder folder;
  const std::string path = folder.file("a.exr");
  const OIIO::ImageSpec specs[] = {spec_of({"A", "B", "G", "R", "Z", "diffuse.B", "diffuse.G", "diffuse.R"}),
                                   spec_of({"R", "G", "B"})};
  const auto output = OIIO::ImageOutput::create(path);
  ASSERT_TRUE(output->open(path, 2, specs)) << output->geterror();
  write(*output, specs[0], values_for(specs[0]));
  ASSERT_TRUE(output->open(path, specs[1], OIIO::ImageOutput::AppendSubimage));
  write(*output, specs[1], values_for(specs[1], 3));
  ASSERT_TRUE(output->close());
  const Image image = read_image(path);
  EXPECT_EQ(image.channels,
            (std::vector<std::string>{"R", "G", "B", "A", "Z", "diffuse.R", "diffuse.G", "diffuse.B"}));
  EXPECT_EQ(image.pixels[0], .125f * 3) << "R, fourth of the first part";
}

// Claim: deep images and subsampled channels are refused by name. Source: image.h. Fails if: missing values are
// taken for 0.
TEST(ReadExr, RefusesDeepAndSubsampled) {
  const ScratchFolder folder;
  const std::string chroma = folder.file("chroma.exr"), deep = folder.file("deep.exr");
  {
    Imf::RgbaOutputFile output(chroma.c_str(), 8, 8, Imf::WRITE_YC);
    const std::vector<Imf::Rgba> row(64, Imf::Rgba(.5f, .5f, .5f));
    output.setFrameBuffer(row.data(), 1, 8);
    output.writePixels(8);
  }
  {
    Imf::Header header(8, 8);
    header.setType(Imf::DEEPSCANLINE);
    header.setName("deep");
    header.compression() = Imf::ZIPS_COMPRESSION;
    header.channels().insert("Z", Imf::Channel(Imf::FLOAT));
    Imf::MultiPartOutputFile output(deep.c_str(), &header, 1);
    Imf::DeepScanLineOutputPart part(output, 0);
  }
  EXPECT_EQ(message_of(chroma),
            chroma + ": the channel BY is subsampled (expected as many values as pixels)");
  EXPECT_EQ(message_of(deep), deep + ": deep images are not supported");
}

}  // namespace
}  // namespace opaline
