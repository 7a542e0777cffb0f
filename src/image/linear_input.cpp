// SPDX-License-Identifier: GPL-3.0-or-later
#include "image/linear_input.h"

#include <OpenImageIO/color.h>

#include <algorithm>
#include <filesystem>
#include <map>
#include <mutex>
#include <string_view>

#include "image/picture_file.h"
#include "opaline/core/error.h"

namespace opaline {
namespace {

struct Registered {
  std::shared_ptr<const PictureSource> source;
  bool to_linear;
};

struct Registry {
  std::mutex mutex;
  std::map<std::string, Registered> sources;
};

Registry& registry() {
  static Registry known;
  return known;
}

}  // namespace

void LinearInput::register_source(const std::string& name, std::shared_ptr<const PictureSource> source,
                                  bool to_linear) {
  const std::lock_guard lock(registry().mutex);
  registry().sources[name] = {std::move(source), to_linear};
}

void LinearInput::forget_source(const std::string& name) {
  const std::lock_guard lock(registry().mutex);
  registry().sources.erase(name);
}

LinearInput::Opened LinearInput::open_source(const PictureSource& source) {
  const std::string start = source.bytes.empty() ? first_bytes(source.path) : source.bytes.substr(0, 8);
  constexpr const char* readable = "an EXR, HDR, PNG, JPEG or TIFF picture";
  if (start.empty()) throw bad_file(source.path, "the file is empty", readable);
  const char* const format = picture_format(start);
  if (format == nullptr) throw bad_file(source.path, "not a picture that can be read", readable);
  Opened opened;
  opened.input = OIIO::ImageInput::create(format);
  OIIO::ImageSpec spec, config;
  config.attribute("oiio:UnassociatedAlpha", 1);
  if (!source.bytes.empty() && opened.input) {
    opened.memory = std::make_unique<OIIO::Filesystem::IOMemReader>(source.bytes.data(), source.bytes.size());
    if (!opened.input->set_ioproxy(opened.memory.get()))
      throw bad_file(source.path, "cannot be read from within an asset", "a PNG or JPEG picture", format);
  }
  if (!opened.input || !opened.input->open(source.path, spec, config))
    throw bad_file(source.path, "not a picture that can be read: " + complaint_of(opened.input.get()));
  if (spec.deep) throw bad_file(source.path, "deep pictures are not supported");
  check_picture_size(source.path, spec, format,
                     source.bytes.empty() ? std::filesystem::file_size(source.path) : source.bytes.size());
  return opened;
}

bool LinearInput::open(const std::string& name, OIIO::ImageSpec& spec) {
  {
    const std::lock_guard lock(registry().mutex);
    const auto found = registry().sources.find(name);
    if (found == registry().sources.end()) return false;
    source_ = found->second.source;
    to_linear_ = found->second.to_linear;
  }
  if (!reopen()) return false;
  take_spec();
  const std::string_view format = opened_.input->format_name();
  is_sequential_ = format == "png" || format == "jpeg" || format == "hdr";
  spec = m_spec;
  return true;
}

void LinearInput::take_spec() {
  m_spec = opened_.input->spec();
  native_ = m_spec.format;
  m_spec.channelformats.clear();
  if (to_linear_) m_spec.set_format(OIIO::TypeHalf);
}

bool LinearInput::close() {
  const bool closed = opened_.input == nullptr || opened_.input->close();
  opened_ = {};
  whole_ = {};
  return closed;
}

bool LinearInput::seek_subimage(int subimage, int miplevel) {
  if (is_sequential_) return subimage == 0 && miplevel == 0;
  if (!opened_.input->seek_subimage(subimage, miplevel)) return false;
  take_spec();
  return true;
}

bool LinearInput::complain() {
  errorfmt("{}", complaint_of(opened_.input.get()));
  return false;
}

bool LinearInput::reopen() {
  try {
    opened_ = open_source(*source_);
    return true;
  } catch (const Error& failure) {
    errorfmt("{}", failure.what());
    return false;
  }
}

bool LinearInput::decode() {
  if (opened_.input == nullptr && !reopen()) return false;
  whole_.resize(std::size_t(m_spec.image_pixels()) * std::size_t(m_spec.nchannels) * native_.size());
  if (!opened_.input->read_image(0, 0, 0, m_spec.nchannels, native_, whole_.data())) {
    whole_ = {};
    return complain();
  }
  opened_ = {};
  is_given_.assign(std::size_t(m_spec.height), false);
  return true;
}

bool LinearInput::make_linear(std::size_t pixels, void* data) {
  const auto channels = std::size_t(m_spec.nchannels);
  for (std::size_t i = 0; i < pixels * channels; ++i)
    if (int(i % channels) != m_spec.alpha_channel) values_[i] = OIIO::sRGB_to_linear(values_[i]);
  return OIIO::convert_pixel_values(OIIO::TypeFloat, values_.data(), OIIO::TypeHalf, data,
                                    int(pixels * channels));
}

bool LinearInput::read_native_scanline(int subimage, int miplevel, int y, int z, void* data) {
  return read_native_scanlines(subimage, miplevel, y, y + 1, z, data);
}

bool LinearInput::read_native_scanlines(int subimage, int miplevel, int y_begin, int y_end, int z,
                                        void* data) {
  const std::lock_guard lock(mutex_);
  const std::size_t row = std::size_t(m_spec.width) * std::size_t(m_spec.nchannels);
  const std::size_t pixels = std::size_t(m_spec.width) * std::size_t(y_end - y_begin);
  const auto values = pixels * std::size_t(m_spec.nchannels);
  if (to_linear_) values_.resize(values);
  void* const target = to_linear_ ? static_cast<void*>(values_.data()) : data;
  const OIIO::TypeDesc type = to_linear_ ? OIIO::TypeFloat : m_spec.format;
  if (is_sequential_) {
    if (whole_.empty() && !decode()) return false;
    const unsigned char* const first = whole_.data() + std::size_t(y_begin - m_spec.y) * row * native_.size();
    OIIO::convert_pixel_values(native_, first, type, target, int(values));
    std::fill(is_given_.begin() + (y_begin - m_spec.y), is_given_.begin() + (y_end - m_spec.y), true);
    if (std::ranges::find(is_given_, false) == is_given_.end()) whole_ = {};
  } else if (!opened_.input->read_scanlines(subimage, miplevel, y_begin, y_end, z, 0, m_spec.nchannels, type,
                                            target)) {
    return complain();
  }
  return !to_linear_ || make_linear(pixels, data);
}

bool LinearInput::read_native_tile(int subimage, int miplevel, int x, int y, int z, void* data) {
  const std::lock_guard lock(mutex_);
  const auto pixels = std::size_t(m_spec.tile_pixels());
  if (to_linear_) values_.resize(pixels * std::size_t(m_spec.nchannels));
  if (!opened_.input->read_tiles(subimage, miplevel, x, x + m_spec.tile_width, y, y + m_spec.tile_height, z,
                                 z + std::max(1, m_spec.tile_depth), 0, m_spec.nchannels,
                                 to_linear_ ? OIIO::TypeFloat : m_spec.format,
                                 to_linear_ ? static_cast<void*>(values_.data()) : data))
    return complain();
  return !to_linear_ || make_linear(pixels, data);
}

}  // namespace opaline
