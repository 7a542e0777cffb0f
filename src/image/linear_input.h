// SPDX-License-Identifier: GPL-3.0-or-later
// Source of the texture cache: an image from a file or from memory, with linear texels. Part of the reader
// module (picture_reader.h).
#pragma once

#include <OpenImageIO/imageio.h>

#include <algorithm>
#include <atomic>
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
inline constexpr std::string_view kTextureFormats[] = {"exr", "hdr", "png", "jpeg", "tiff", "webp"};

/// First failure to read a source. OpenImageIO 2.5 aborts if a thread looks up an image after reading it has failed, so inputs
/// return zeros, and the texture reports the failure.
class ReadFailure {
 public:
  void set(const std::string& text) {
    const std::lock_guard lock(mutex_);
    if (!is_set_) text_ = text;
    is_set_ = true;
  }
  bool is_set() const { return is_set_; }
  /// After is_set.
  std::string text() const {
    const std::lock_guard lock(mutex_);
    return text_;
  }

 private:
  mutable std::mutex mutex_;
  std::string text_;
  std::atomic<bool> is_set_ = false;
};

/// Decodes the first part of another input. Texels become linear colours, see TexelColors; those of sRGB are
/// halves, with rounding below that of 8 bits. Formats without random access are decoded as a whole and
/// held until each row was read: the cache reads rows in any order, and OpenImageIO 2.4 rewinds by
/// reopening the file, impossible for an image in memory. The same applies to images with a data window
/// inside the display window, as OpenImageIO 2.4 misplaces their tiles. Held images offer their smaller
/// sizes, all made at once: the cache looks up four texels of the larger size for each texel.
class LinearInput : public OIIO::ImageInput {
 public:
  /// Registers the source of inputs with this name.
  static void register_source(const std::string& name, std::shared_ptr<const PictureSource> source,
                              const TexelColors& colors, std::shared_ptr<ReadFailure> failure);
  static void forget_source(const std::string& name);
  static OIIO::ImageInput* create() { return new LinearInput; }

  /// True if an opened image is decoded as a whole.
  static bool is_held(const OpenPicture& picture, const TexelLayout& layout);

  const char* format_name() const override { return "opaline linear"; }
  int supports(OIIO::string_view feature) const override {
    return opened_.input != nullptr ? opened_.input->supports(feature) : 0;
  }
  bool open(const std::string& name, OIIO::ImageSpec& spec) override;
  bool close() override;
  int current_subimage() const override { return is_held_ ? 0 : opened_.input->current_subimage(); }
  int current_miplevel() const override { return is_held_ ? level_ : opened_.input->current_miplevel(); }
  bool seek_subimage(int subimage, int miplevel) override;
  bool read_native_scanline(int subimage, int miplevel, int y, int z, void* data) override;
  bool read_native_scanlines(int subimage, int miplevel, int y_begin, int y_end, int z, void* data) override;
  bool read_native_tile(int subimage, int miplevel, int x, int y, int z, void* data) override;

 private:
  /// Texels of a size of a held image, until each row was read.
  struct HeldSize {
    std::vector<unsigned char> texels;  ///< the largest: before the conversion of colours
    std::vector<bool> is_given;         ///< per row
  };

  bool read_held_rows(int level, int y_begin, int y_end, void* data);
  bool read_texel_rows(int subimage, int miplevel, int y_begin, int y_end, int z, void* data);
  bool read_texel_tile(int subimage, int miplevel, int x, int y, int z, void* data);
  /// Returns true; after a failure, with zeros in place of the texels.
  bool deliver(bool is_good, std::size_t bytes, void* data);
  void take_spec();
  bool reopen();
  int width_of(int level) const { return is_held_ ? std::max(1, top_.width >> level) : m_spec.width; }
  int height_of(int level) const { return std::max(1, top_.height >> level); }
  /// Decodes or computes a size, unless it is held.
  bool hold(int level);
  bool decode();
  bool make_smaller_sizes();
  /// Bilinear samples at half the size, as by the cache. row_of(y): values of a row of the larger size; null
  /// after an error.
  template <class RowOf>
  bool halve(int level, const RowOf& row_of);
  /// Converts rows of the largest held size to values_, with linear colours.
  bool convert_top_rows(int y_begin, int y_end);
  /// Converts the file's values to texels, in the display window.
  void place(const std::vector<unsigned char>& values);
  /// Buffer for reading values to be converted into `texels`, and the conversion.
  void* buffer_for(void* texels, std::size_t pixels, OIIO::TypeDesc type);
  void finish(void* texels, std::size_t pixels, OIIO::TypeDesc type);
  bool complain();
  /// True if all texels are finite and at most kLargestTexel; otherwise sets the error.
  bool check_range(const void* values, std::size_t count, OIIO::TypeDesc type);
  /// Converts the colours of values_.
  bool change_colors(std::size_t pixels);
  bool pass_on(std::size_t pixels, void* data);
  void change_each(std::size_t pixels);

  std::shared_ptr<const PictureSource> source_;
  TexelColors colors_;
  std::shared_ptr<ReadFailure> failure_;
  bool is_held_ = false;
  OpenPicture opened_;
  std::optional<TexelLayout> layout_;
  OIIO::TypeDesc native_;  // type of the values in the file
  OIIO::ImageSpec top_;    // specification of the largest size of a held image
  int level_ = 0;          // current size of a held image
  std::mutex mutex_;       // guards all members below
  std::vector<HeldSize> sizes_;
  std::vector<unsigned char> read_;
  std::vector<float> values_;
};

}  // namespace opaline
