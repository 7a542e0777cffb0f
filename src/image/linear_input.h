// SPDX-License-Identifier: GPL-3.0-or-later
// A picture as the texture cache is to see it: from a file or from memory, its texels linear colours. Of the module
// (picture_reader.h).
#pragma once

#include <OpenImageIO/imageio.h>

#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "image/cached_picture.h"
#include "image/picture_file.h"
#include "image/texel_colors.h"
#include "image/texel_layout.h"

namespace opaline {

/// The formats of textures.
inline constexpr std::string_view kTextureFormats[] = {"exr", "hdr", "png", "jpeg", "tiff"};

/// Decodes another input, its first part alone. Texels become linear colours, see TexelColors; of sRGB they are halves,
/// whose rounding is below that of 8 bits. Formats that are read from their beginning alone are decoded at once and held until each row was asked
/// for: the cache asks for rows in any order, and OpenImageIO 2.4 goes back by opening the file anew, which a picture in
/// memory does not survive. So are pictures whose data window is not their display window: OpenImageIO 2.4 puts the
/// texture's tiles in the wrong places if it lies within.
class LinearInput : public OIIO::ImageInput {
 public:
  /// Registers the source of inputs with this name.
  static void register_source(const std::string& name, std::shared_ptr<const PictureSource> source,
                              const TexelColors& colors);
  static void forget_source(const std::string& name);
  static OIIO::ImageInput* create() { return new LinearInput; }

  /// True if an opened picture is held.
  static bool is_held(const OpenPicture& picture, const TexelLayout& layout);

  const char* format_name() const override { return "opaline linear"; }
  int supports(OIIO::string_view feature) const override {
    return opened_.input != nullptr ? opened_.input->supports(feature) : 0;
  }
  bool open(const std::string& name, OIIO::ImageSpec& spec) override;
  bool close() override;
  int current_subimage() const override { return is_held_ ? 0 : opened_.input->current_subimage(); }
  int current_miplevel() const override { return is_held_ ? 0 : opened_.input->current_miplevel(); }
  bool seek_subimage(int subimage, int miplevel) override;
  bool read_native_scanline(int subimage, int miplevel, int y, int z, void* data) override;
  bool read_native_scanlines(int subimage, int miplevel, int y_begin, int y_end, int z, void* data) override;
  bool read_native_tile(int subimage, int miplevel, int x, int y, int z, void* data) override;

 private:
  void take_spec();
  bool reopen();
  bool decode();
  /// From the file's values to texels, in the display window.
  void place(const std::vector<unsigned char>& values);
  /// Where to read into what shall become texels at `texels`, and make them of it.
  void* buffer_for(void* texels, std::size_t pixels, OIIO::TypeDesc type);
  void finish(void* texels, std::size_t pixels, OIIO::TypeDesc type);
  bool complain();
  /// Returns whether the values of texels are finite and at most kLargestTexel; else sets the error.
  bool check_range(const void* values, std::size_t count, OIIO::TypeDesc type);
  /// Changes the colours of values_ and gives them to the cache.
  bool change_colors(std::size_t pixels, void* data);
  void change_each(std::size_t pixels);

  std::shared_ptr<const PictureSource> source_;
  TexelColors colors_;
  bool is_held_ = false;
  OpenPicture opened_;
  std::optional<TexelLayout> layout_;
  OIIO::TypeDesc native_;  // type of the values in the file
  std::mutex mutex_;       // guards all members below
  std::vector<unsigned char> whole_, read_;
  std::vector<bool> is_given_;  // each row of it
  std::vector<float> values_;
};

}  // namespace opaline
