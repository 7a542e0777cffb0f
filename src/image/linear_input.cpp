// SPDX-License-Identifier: GPL-3.0-or-later
#include "image/linear_input.h"

#include <Imath/half.h>
#include <OpenImageIO/color.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstring>
#include <map>
#include <mutex>

#include "opaline/error.h"

namespace opaline {
namespace {

struct Registered {
  std::shared_ptr<const PictureSource> source;
  TexelColors colors;
  std::shared_ptr<ReadFailure> failure;
};

struct Registry {
  std::mutex mutex;
  std::map<std::string, Registered> sources;
};

Registry& registry() {
  static Registry known;
  return known;
}

/// Linear light of the 256 bytes in sRGB.
const std::array<float, 256>& linear_bytes() {
  static const std::array<float, 256> table = [] {
    std::array<float, 256> values{};
    for (std::size_t i = 0; i < values.size(); ++i) values[i] = OIIO::sRGB_to_linear(float(i) / 255);
    return values;
  }();
  return table;
}

template <class Value>
bool all_within_range(const void* values, std::size_t count) {
  return std::all_of(static_cast<const Value*>(values), static_cast<const Value*>(values) + count,
                     [](Value value) { return std::abs(double(value)) <= kLargestTexel; });
}

bool all_within_range(const void* values, std::size_t count, OIIO::TypeDesc type) {
  if (type == OIIO::TypeFloat) return all_within_range<float>(values, count);
  if (type == OIIO::TypeHalf) return all_within_range<half>(values, count);
  return type != OIIO::TypeDesc::DOUBLE || all_within_range<double>(values, count);
}

}  // namespace

void LinearInput::register_source(const std::string& name, std::shared_ptr<const PictureSource> source,
                                  const TexelColors& colors, std::shared_ptr<ReadFailure> failure) {
  const std::lock_guard lock(registry().mutex);
  registry().sources[name] = {std::move(source), colors, std::move(failure)};
}

void LinearInput::forget_source(const std::string& name) {
  const std::lock_guard lock(registry().mutex);
  registry().sources.erase(name);
}

bool LinearInput::is_held(const OpenPicture& picture, const TexelLayout& layout) {
  return layout.is_windowed || picture.format == "png" || picture.format == "jpeg" ||
         picture.format == "hdr" || picture.format == "webp";
}

bool LinearInput::open(const std::string& name, OIIO::ImageSpec& spec) {
  {
    const std::lock_guard lock(registry().mutex);
    const auto found = registry().sources.find(name);
    if (found == registry().sources.end()) return false;
    source_ = found->second.source;
    colors_ = found->second.colors;
    failure_ = found->second.failure;
  }
  if (!reopen()) return false;
  is_held_ = is_held(opened_, *layout_);
  take_spec();
  top_ = m_spec;
  level_ = 0;
  sizes_.clear();
  if (is_held_) sizes_.resize(std::size_t(std::bit_width(unsigned(std::max(top_.width, top_.height)))));
  spec = m_spec;
  return true;
}

void LinearInput::take_spec() {
  m_spec = layout_->spec(opened_.input->spec());
  native_ = m_spec.format;
  if (!colors_.are_plain()) m_spec.set_format(colors_.type_for(native_));
}

bool LinearInput::close() {
  const bool closed = opened_.input == nullptr || opened_.input->close();
  opened_ = {};
  sizes_.assign(sizes_.size(), {});
  return closed;
}

bool LinearInput::seek_subimage(int subimage, int miplevel) {
  if (subimage != 0) return false;
  if (is_held_) {
    if (miplevel < 0 || std::size_t(miplevel) >= sizes_.size()) return false;
    level_ = miplevel;
    m_spec.width = m_spec.full_width = width_of(level_);
    m_spec.height = m_spec.full_height = height_of(level_);
    return true;
  }
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
    opened_ = open_picture(*source_, kTextureFormats);
    layout_.emplace(opened_.input->spec(), source_->path);
    return true;
  } catch (const Error& failure) {
    errorfmt("{}", failure.what());
    return false;
  }
}

bool LinearInput::hold(int level) {
  if (!sizes_[std::size_t(level)].texels.empty()) return true;
  const bool is_decoded = !sizes_[0].texels.empty();
  if (!is_decoded && !decode()) return false;
  if (level == 0) return true;
  const bool is_good = make_smaller_sizes();
  if (!is_decoded) sizes_[0] = {};
  return is_good;
}

bool LinearInput::decode() {
  if (opened_.input == nullptr && !reopen()) return false;
  const OIIO::ImageSpec& file = opened_.input->spec();
  const bool is_direct = !layout_->is_windowed && layout_->is_plain();
  std::vector<unsigned char> values(std::size_t(file.image_pixels()) *
                                    std::size_t(layout_->end - layout_->begin) * native_.size());
  if (!opened_.input->read_image(0, 0, layout_->begin, layout_->end, native_, values.data()))
    return complain();
  sizes_[0].is_given.assign(std::size_t(top_.height), false);
  if (is_direct)
    sizes_[0].texels = std::move(values);
  else
    place(values);
  opened_ = {};
  return true;
}

template <class RowOf>
bool LinearInput::halve(int level, const RowOf& row_of) {
  const int width = width_of(level - 1), height = height_of(level - 1), to_width = width_of(level),
            to_height = height_of(level);
  const auto channels = std::size_t(top_.nchannels);
  const std::size_t row = std::size_t(to_width) * channels;
  const auto larger = [](int i, int to, int from) {
    return (float(i) + .5f) / float(to) * float(from) - .5f;
  };
  std::vector<std::size_t> left(std::size_t(to_width), 0), right = left;
  std::vector<float> shares(std::size_t(to_width), 0), upper(std::size_t(width) * channels), mean(row);
  for (int x = 0; x < to_width; ++x) {
    const float at = larger(x, to_width, width);
    const auto i = std::size_t(x), first = std::size_t(at);
    left[i] = first * channels;
    right[i] = std::min(first + 1, std::size_t(width - 1)) * channels;
    shares[i] = at - float(first);
  }
  HeldSize& size = sizes_[std::size_t(level)];
  size.texels.resize(row * std::size_t(to_height) * top_.format.size());
  size.is_given.assign(std::size_t(to_height), false);
  for (int y = 0; y < to_height; ++y) {
    const float at = larger(y, to_height, height);
    const int first = int(at), second = std::min(first + 1, height - 1);
    const float share = at - float(first);
    const float* values = row_of(first);
    if (values == nullptr) return false;
    for (std::size_t i = 0; i < upper.size(); ++i) upper[i] = (1 - share) * values[i];
    values = row_of(second);
    if (values == nullptr) return false;
    for (std::size_t i = 0; i < upper.size(); ++i) upper[i] += share * values[i];
    for (std::size_t x = 0; x < left.size(); ++x)
      for (std::size_t c = 0; c < channels; ++c)
        mean[x * channels + c] = (1 - shares[x]) * upper[left[x] + c] + shares[x] * upper[right[x] + c];
    OIIO::convert_pixel_values(OIIO::TypeFloat, mean.data(), top_.format,
                               &size.texels[std::size_t(y) * row * top_.format.size()], int(row));
  }
  return true;
}

bool LinearInput::make_smaller_sizes() {
  const auto of_top = [&](int y) { return convert_top_rows(y, y + 1) ? values_.data() : nullptr; };
  if (!halve(1, of_top)) return false;
  for (int level = 2; level < int(sizes_.size()); ++level) {
    const auto row = std::size_t(width_of(level - 1)) * std::size_t(top_.nchannels);
    const unsigned char* const texels = sizes_[std::size_t(level - 1)].texels.data();
    const auto of_last = [&](int y) {
      values_.resize(row);
      OIIO::convert_pixel_values(top_.format, texels + std::size_t(y) * row * top_.format.size(),
                                 OIIO::TypeFloat, values_.data(), int(row));
      return values_.data();
    };
    if (!halve(level, of_last)) return false;
  }
  return true;
}

void LinearInput::place(const std::vector<unsigned char>& values) {
  const OIIO::ImageSpec& file = opened_.input->spec();
  const std::size_t bytes = native_.size(), from = bytes * std::size_t(layout_->end - layout_->begin),
                    to = bytes * std::size_t(layout_->channels);
  const int x_begin = std::max(file.x, file.full_x), y_begin = std::max(file.y, file.full_y);
  const int x_end = std::min(file.x + file.width, file.full_x + file.full_width),
            y_end = std::min(file.y + file.height, file.full_y + file.full_height);
  std::vector<unsigned char>& texels = sizes_[0].texels;
  texels.assign(std::size_t(top_.width) * std::size_t(top_.height) * to, 0);
  for (int y = y_begin; y < y_end; ++y) {
    const std::size_t source =
        std::size_t(y - file.y) * std::size_t(file.width) + std::size_t(x_begin - file.x);
    const std::size_t target =
        std::size_t(y - file.full_y) * std::size_t(top_.width) + std::size_t(x_begin - file.full_x);
    layout_->take(&values[source * from], std::size_t(x_end - x_begin), bytes, &texels[target * to]);
  }
}

void* LinearInput::buffer_for(void* texels, std::size_t pixels, OIIO::TypeDesc type) {
  if (layout_->is_plain()) return texels;
  read_.resize(pixels * std::size_t(layout_->end - layout_->begin) * type.size());
  return read_.data();
}

void LinearInput::finish(void* texels, std::size_t pixels, OIIO::TypeDesc type) {
  if (!layout_->is_plain())
    layout_->take(read_.data(), pixels, type.size(), static_cast<unsigned char*>(texels));
}

bool LinearInput::check_range(const void* values, std::size_t count, OIIO::TypeDesc type) {
  if (all_within_range(values, count, type)) return true;
  errorfmt("a converted texel {}", kTexelOutOfRange);
  return false;
}

bool LinearInput::change_colors(std::size_t pixels) {
  const auto channels = std::size_t(m_spec.nchannels), count = pixels * channels;
  if (colors_.need_texels()) {
    change_each(pixels);
    return check_range(values_.data(), count, OIIO::TypeFloat);
  }
  for (std::size_t i = 0; i < count; ++i)
    if (int(i % channels) != m_spec.alpha_channel) values_[i] = OIIO::sRGB_to_linear(values_[i]);
  return true;
}

bool LinearInput::pass_on(std::size_t pixels, void* data) {
  return change_colors(pixels) &&
         OIIO::convert_pixel_values(OIIO::TypeFloat, values_.data(), m_spec.format, data,
                                    int(pixels * std::size_t(m_spec.nchannels)));
}

void LinearInput::change_each(std::size_t pixels) {
  const auto channels = std::size_t(m_spec.nchannels), of_color = channels < 3 ? std::size_t(1) : 3;
  float* values = values_.data();
  for (std::size_t i = 0; i < pixels; ++i, values += channels) {
    Texel texel{1, 1, 1, channels > of_color ? double(values[of_color]) : 1};
    for (std::size_t c = 0; c < 3; ++c) texel[c] = double(values[std::min(c, of_color - 1)]);
    colors_.apply(texel);
    for (std::size_t c = 0; c < of_color; ++c) values[c] = float(texel[c]);
  }
}

bool LinearInput::read_native_scanline(int subimage, int miplevel, int y, int z, void* data) {
  return read_native_scanlines(subimage, miplevel, y, y + 1, z, data);
}

bool LinearInput::deliver(bool is_good, std::size_t bytes, void* data) {
  if (is_good) return true;
  failure_->set(geterror());
  std::memset(data, 0, bytes);
  return true;
}

bool LinearInput::read_native_scanlines(int subimage, int miplevel, int y_begin, int y_end, int z,
                                        void* data) {
  const std::lock_guard lock(mutex_);
  return deliver(read_texel_rows(subimage, miplevel, y_begin, y_end, z, data),
                 std::size_t(width_of(miplevel)) * m_spec.pixel_bytes() * std::size_t(y_end - y_begin), data);
}

bool LinearInput::read_native_tile(int subimage, int miplevel, int x, int y, int z, void* data) {
  const std::lock_guard lock(mutex_);
  return deliver(read_texel_tile(subimage, miplevel, x, y, z, data), std::size_t(m_spec.tile_bytes()), data);
}

bool LinearInput::convert_top_rows(int y_begin, int y_end) {
  const std::size_t row = std::size_t(top_.width) * std::size_t(top_.nchannels),
                    pixels = std::size_t(top_.width) * std::size_t(y_end - y_begin),
                    count = pixels * std::size_t(top_.nchannels);
  const unsigned char* const texels = &sizes_[0].texels[std::size_t(y_begin) * row * native_.size()];
  values_.resize(count);
  if (native_ == OIIO::TypeUInt8 && colors_.is_srgb && !colors_.need_texels()) {
    const std::array<float, 256>& table = linear_bytes();
    for (std::size_t i = 0; i < count; ++i) values_[i] = table[texels[i]];
    if (const int alpha = top_.alpha_channel; alpha >= 0)
      for (auto i = std::size_t(alpha); i < count; i += std::size_t(top_.nchannels))
        values_[i] = float(texels[i]) / 255;
    return true;
  }
  OIIO::convert_pixel_values(native_, texels, OIIO::TypeFloat, values_.data(), int(count));
  return check_range(values_.data(), count, OIIO::TypeFloat) &&
         (colors_.are_plain() || change_colors(pixels));
}

bool LinearInput::read_held_rows(int level, int y_begin, int y_end, void* data) {
  if (!hold(level)) return false;
  HeldSize& size = sizes_[std::size_t(level)];
  const std::size_t row = std::size_t(width_of(level)) * std::size_t(top_.nchannels),
                    count = row * std::size_t(y_end - y_begin);
  if (level == 0 && !colors_.are_plain()) {
    if (!convert_top_rows(y_begin, y_end)) return false;
    OIIO::convert_pixel_values(OIIO::TypeFloat, values_.data(), top_.format, data, int(count));
  } else {
    const std::size_t bytes = top_.format.size();
    std::memcpy(data, &size.texels[std::size_t(y_begin) * row * bytes], count * bytes);
    if (!check_range(data, count, top_.format)) return false;
  }
  std::fill(size.is_given.begin() + y_begin, size.is_given.begin() + y_end, true);
  if (std::ranges::find(size.is_given, false) == size.is_given.end()) size = {};
  return true;
}

bool LinearInput::read_texel_rows(int subimage, int miplevel, int y_begin, int y_end, int z, void* data) {
  if (is_held_) return read_held_rows(miplevel, y_begin, y_end, data);
  const bool is_changed = !colors_.are_plain();
  const std::size_t pixels = std::size_t(m_spec.width) * std::size_t(y_end - y_begin);
  const auto values = pixels * std::size_t(m_spec.nchannels);
  if (is_changed) values_.resize(values);
  void* const target = is_changed ? static_cast<void*>(values_.data()) : data;
  const OIIO::TypeDesc type = is_changed ? OIIO::TypeFloat : m_spec.format;
  if (!opened_.input->read_scanlines(subimage, miplevel, y_begin, y_end, z, layout_->begin, layout_->end,
                                     type, buffer_for(target, pixels, type)))
    return complain();
  finish(target, pixels, type);
  if (!check_range(target, values, type)) return false;
  return !is_changed || pass_on(pixels, data);
}

bool LinearInput::read_texel_tile(int subimage, int miplevel, int x, int y, int z, void* data) {
  const bool is_changed = !colors_.are_plain();
  const auto pixels = std::size_t(m_spec.tile_pixels());
  if (is_changed) values_.resize(pixels * std::size_t(m_spec.nchannels));
  void* const target = is_changed ? static_cast<void*>(values_.data()) : data;
  const OIIO::TypeDesc type = is_changed ? OIIO::TypeFloat : m_spec.format;
  if (!opened_.input->read_tiles(subimage, miplevel, x, x + m_spec.tile_width, y, y + m_spec.tile_height, z,
                                 z + std::max(1, m_spec.tile_depth), layout_->begin, layout_->end, type,
                                 buffer_for(target, pixels, type)))
    return complain();
  finish(target, pixels, type);
  if (!check_range(target, pixels * std::size_t(m_spec.nchannels), type)) return false;
  return !is_changed || pass_on(pixels, data);
}

}  // namespace opaline
