// SPDX-License-Identifier: GPL-3.0-or-later
#include "view/view_frame.h"

#include <Imath/half.h>
#include <turbojpeg.h>
#include <zlib.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstring>
#include <span>
#include <utility>

#include "opaline/core/error.h"
#include "opaline/core/parallel.h"

namespace opaline {
namespace {

static_assert(std::endian::native == std::endian::little, "frames are sent as they lie in memory");

constexpr std::size_t kShown = 4, kHeader = 8 * sizeof(std::uint32_t);
constexpr float kLargestHalf = 65504;
constexpr float kLogSlope = 16;  // at 0, of the values in a JPEG
constexpr int kJpegQuality = 85, kLargestJpeg = 65500;
constexpr std::size_t kBandBytes = 1 << 18;

/// As an EXR of halves holds it.
half stored(float value) {
  return std::isfinite(value) ? half(std::clamp(value, -kLargestHalf, kLargestHalf)) : half(0.0f);
}

std::vector<std::size_t> channels_of(const Image& image, const std::string& layer) {
  std::vector<std::size_t> channels;
  for (std::size_t c = 0; c < image.channels.size() && !layer.empty(); ++c)
    if (image.channels[c] == layer || image.channels[c].starts_with(layer + '.')) channels.push_back(c);
  return channels;
}

std::size_t pixels_of(const Image& image) {
  return std::size_t(image.width) * std::size_t(image.height);
}

std::size_t bytes_of_pixel(std::size_t layer_channels) {
  return kShown * sizeof(half) + layer_channels * sizeof(float);
}

template <class Value>
void append(std::string& bytes, const Value& value) {
  bytes.append(reinterpret_cast<const char*>(&value), sizeof value);
}

std::string header_of(std::uint32_t mark, const ViewPicture& picture, PictureStep step, std::uint32_t number,
                      std::size_t layer_channels) {
  std::string bytes;
  append(bytes, std::array<std::uint32_t, 8>{
                    mark, number, picture.revision, std::uint32_t(step), std::uint32_t(picture.image.width),
                    std::uint32_t(picture.image.height), std::uint32_t(layer_channels),
                    std::uint32_t(std::min(picture.seconds * 1e6, 4e9))});
  return bytes;
}

/// The bytes of a value, each to a plane of its own.
template <class Value>
void put_planes(Value value, std::string& bytes, std::size_t first, std::size_t plane_bytes) {
  std::array<char, sizeof value> parts;
  std::memcpy(parts.data(), &value, sizeof value);
  for (std::size_t i = 0; i < parts.size(); ++i) bytes[first + i * plane_bytes] = parts[i];
}

std::string planes_of(const Image& image, std::span<const std::size_t> channels, int row, int rows) {
  const std::size_t all = image.channels.size(), width = std::size_t(image.width),
                    pixels = width * std::size_t(rows);
  std::string bytes(pixels * bytes_of_pixel(channels.size()), '\0');
  const float* pixel = image.pixels.data() + std::size_t(row) * width * all;
  for (std::size_t p = 0; p < pixels; ++p, pixel += all) {
    std::size_t plane = 0;
    for (std::size_t c = 0; c < kShown; ++c, plane += sizeof(half))
      put_planes(stored(pixel[c]).bits(), bytes, plane * pixels + p, pixels);
    for (const std::size_t c : channels) {
      put_planes(pixel[c], bytes, plane * pixels + p, pixels);
      plane += sizeof(float);
    }
  }
  return bytes;
}

/// Quickly rather than well.
std::string deflated(const std::string& bytes) {
  uLongf size = compressBound(uLong(bytes.size()));
  std::string packed(size, '\0');
  require(compress2(reinterpret_cast<Bytef*>(packed.data()), &size,
                    reinterpret_cast<const Bytef*>(bytes.data()), uLong(bytes.size()), Z_BEST_SPEED) == Z_OK,
          "zlib has room for what it compresses");
  packed.resize(size);
  return packed;
}

float largest_of(const Image& image) {
  float largest = 0;
  for (std::size_t p = 0; p < pixels_of(image); ++p)
    for (std::size_t c = 0; c < 3; ++c)
      largest = std::max(largest, float(stored(image.pixels[p * image.channels.size() + c])));
  return largest > 0 ? largest : 1;
}

std::vector<unsigned char> logarithms(const Image& image, float largest) {
  const float scale = 255 / std::log2(1 + kLogSlope * largest);
  std::vector<unsigned char> bytes(3 * pixels_of(image));
  parallel_chunks(pixels_of(image), 1 << 14, [&](std::size_t begin, std::size_t end, std::size_t) {
    for (std::size_t p = begin; p < end; ++p)
      for (std::size_t c = 0; c < 3; ++c) {
        const float value = std::max(0.0f, float(stored(image.pixels[p * image.channels.size() + c])));
        bytes[3 * p + c] = static_cast<unsigned char>(std::lround(scale * std::log2(1 + kLogSlope * value)));
      }
  });
  return bytes;
}

/// libjpeg-turbo's, and let go of.
struct JpegEncoder {
  tjhandle handle = tjInitCompress();
  unsigned char* bytes = nullptr;
  unsigned long size = 0;

  JpegEncoder() = default;
  JpegEncoder(const JpegEncoder&) = delete;
  JpegEncoder& operator=(const JpegEncoder&) = delete;
  ~JpegEncoder() {
    tjFree(bytes);
    tjDestroy(handle);
  }
};

}  // namespace

std::size_t frame_size(const ViewPicture& picture, const std::string& layer) {
  return kHeader + pixels_of(picture.image) * bytes_of_pixel(channels_of(picture.image, layer).size());
}

std::string pack_frame(const ViewPicture& picture, std::uint32_t number, const std::string& layer) {
  const Image& image = picture.image;
  const std::size_t pixels = pixels_of(image), all = image.channels.size();
  const std::vector<std::size_t> channels = channels_of(image, layer);
  std::string bytes = header_of(kFrameMark, picture, picture.step, number, channels.size());
  bytes.resize(kHeader + pixels * bytes_of_pixel(channels.size()));
  char* const colours = bytes.data() + kHeader;
  char* const values = colours + pixels * kShown * sizeof(half);
  parallel_chunks(pixels, 1 << 14, [&](std::size_t begin, std::size_t end, std::size_t) {
    for (std::size_t p = begin; p < end; ++p) {
      const float* pixel = image.pixels.data() + p * all;
      for (std::size_t c = 0; c < kShown; ++c) {
        const std::uint16_t bits = stored(pixel[c]).bits();
        std::memcpy(colours + (p * kShown + c) * sizeof bits, &bits, sizeof bits);
      }
      for (std::size_t c = 0; c < channels.size(); ++c)
        std::memcpy(values + (p * channels.size() + c) * sizeof(float), pixel + channels[c], sizeof(float));
    }
  });
  return bytes;
}

bool can_be_jpeg(const ViewPicture& picture) {
  return std::max(picture.image.width, picture.image.height) <= kLargestJpeg;
}

std::string pack_jpeg(const ViewPicture& picture, std::uint32_t number) {
  const PictureStep step = picture.step == PictureStep::final ? PictureStep::sharper : picture.step;
  std::string bytes = header_of(kJpegMark, picture, step, number, 0);
  const float largest = largest_of(picture.image);
  append(bytes, largest);
  const std::vector<unsigned char> rgb = logarithms(picture.image, largest);
  JpegEncoder jpeg;
  require(tjCompress2(jpeg.handle, rgb.data(), picture.image.width, 0, picture.image.height, TJPF_RGB,
                      &jpeg.bytes, &jpeg.size, TJSAMP_420, kJpegQuality, TJFLAG_FASTDCT) == 0,
          "libjpeg-turbo takes what is small enough");
  return bytes.append(reinterpret_cast<const char*>(jpeg.bytes), jpeg.size);
}

void FrameBands::begin(std::shared_ptr<const ViewPicture> picture, std::string layer) {
  const Image& image = picture->image;
  std::vector<std::size_t> channels = channels_of(image, layer);
  const std::size_t bytes_of_row = std::size_t(image.width) * bytes_of_pixel(channels.size());
  if (image.width != width_ || image.height != height_ || layer != layer_ || channels != channels_)
    held_.clear();
  width_ = image.width;
  height_ = image.height;
  rows_ = int(std::max<std::size_t>(1, kBandBytes / bytes_of_row));
  row_ = 0;
  held_.resize(std::size_t((height_ + rows_ - 1) / rows_));
  channels_ = std::move(channels);
  layer_ = std::move(layer);
  picture_ = std::move(picture);
}

std::string FrameBands::next(std::uint32_t number) {
  std::string bytes = header_of(kBandMark, *picture_, picture_->step, number, channels_.size());
  for (; row_ < height_; row_ += rows_) {
    const int rows = std::min(rows_, height_ - row_);
    std::string planes = planes_of(picture_->image, channels_, row_, rows);
    std::string& held = held_[std::size_t(row_ / rows_)];
    if (planes == held) continue;
    held = std::move(planes);
    append(bytes, std::array<std::uint32_t, 2>{std::uint32_t(row_), std::uint32_t(rows)});
    row_ += rows_;
    return bytes + deflated(held);
  }
  picture_.reset();
  append(bytes, std::array<std::uint32_t, 2>{});
  return bytes;
}

}  // namespace opaline
