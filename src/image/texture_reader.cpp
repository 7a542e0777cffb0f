// SPDX-License-Identifier: GPL-3.0-or-later
// Textures with OpenImageIO's texture cache, which computes smaller sizes on demand. Part of the reader
// module (picture_reader.h).
#include <OpenImageIO/imagecache.h>
#include <OpenImageIO/strutil.h>
#include <OpenImageIO/texture.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstring>
#include <map>
#include <mutex>
#include <utility>

#include "core/machine_memory.h"
#include "image/cached_picture.h"
#include "image/exr_chunks.h"
#include "image/linear_input.h"
#include "image/picture_file.h"
#include "image/slope_pyramid.h"
#include "image/texel_colors.h"
#include "image/texel_layout.h"
#include "opaline/error.h"

namespace opaline {
namespace {

constexpr int kRows = 64;            // rows of an image, read at once
constexpr float kOfFilters = 1e-4f;  // excess of colours left by filters, times white

/// A quarter of the machine, but at least 256 MB and at most 4 GB.
std::size_t cache_limit() {
  static const std::size_t limit =
      std::clamp(available_memory() / 4, std::size_t(256) << 20, std::size_t(4096) << 20);
  return limit;
}

/// Shared by all textures. Never destroyed: threads may still use it.
OIIO::TextureSystem& texture_system() {
  static OIIO::TextureSystem* const system = [] {
    OIIO::TextureSystem* made = OIIO::TextureSystem::create(false);
    made->attribute("max_memory_MB", float(cache_limit() >> 20));
    made->attribute("automip", 1);
    made->attribute("autotile", kRows);
    return made;
  }();
  return *system;
}

/// Rows of the data window; for tiled files, rows of whole tiles.
void read_rows(OIIO::ImageInput& input, const TexelLayout& layout, int begin, int end, OIIO::TypeDesc type,
               void* values, const std::string& path) {
  const OIIO::ImageSpec& spec = input.spec();
  const bool good =
      spec.tile_width > 0
          ? input.read_tiles(0, 0, spec.x, spec.x + spec.width, begin, end, spec.z, spec.z + 1, layout.begin,
                             layout.end, type, values)
          : input.read_scanlines(0, 0, begin, end, spec.z, layout.begin, layout.end, type, values);
  if (!good) throw bad_file(path, "the image is damaged: " + complaint_of(&input));
}

int rows_at_once(const OIIO::ImageSpec& spec) {
  return spec.tile_height > 0 ? spec.tile_height : kRows;
}

/// True if all pixels of the data window have the same bytes.
bool is_even(const PictureSource& source) {
  const OpenPicture opened = open_picture(source, kTextureFormats);
  const OIIO::ImageSpec spec = opened.input->spec();
  const TexelLayout layout(spec, source.path);
  const std::size_t pixel = std::size_t(layout.end - layout.begin) * spec.format.size();
  const int rows = rows_at_once(spec);
  std::vector<unsigned char> values(pixel * std::size_t(spec.width) * std::size_t(rows)), first;
  for (int y = spec.y; y < spec.y + spec.height; y += rows) {
    const int end = std::min(y + rows, spec.y + spec.height);
    read_rows(*opened.input, layout, y, end, spec.format, values.data(), source.path);
    if (first.empty()) first.assign(values.begin(), values.begin() + std::ptrdiff_t(pixel));
    const std::size_t others = pixel * (std::size_t(spec.width) * std::size_t(end - y) - 1);
    if (std::memcmp(values.data(), first.data(), pixel) != 0 ||
        std::memcmp(values.data(), values.data() + pixel, others) != 0)
      return false;
  }
  return true;
}

/// Calls visit(texel, count) for all texels, with converted colours, while it returns true.
template <class Visit>
void for_each_texel(const PictureSource& source, const TexelColors& colors, const Visit& visit) {
  const OpenPicture opened = open_picture(source, kTextureFormats);
  OIIO::ImageInput& input = *opened.input;
  const OIIO::ImageSpec spec = input.spec();
  const TexelLayout layout(spec, source.path);
  const auto channels = std::size_t(layout.end - layout.begin), width = std::size_t(spec.width);
  const bool is_bytes = spec.format == OIIO::TypeUInt8;
  const int rows = rows_at_once(spec);
  std::vector<float> values(width * std::size_t(rows) * channels);
  const auto value = [&](std::size_t i, std::size_t c, double otherwise) {
    if (layout.places[c] < 0) return otherwise;
    double v = double(values[i * channels + std::size_t(layout.places[c] - layout.begin)]);
    return is_bytes ? std::round(v * 255) / 255 : v;  // exactly equal to colours in a scene file
  };
  const int x_begin = std::max(spec.x, spec.full_x),
            x_end = std::min(spec.x + spec.width, spec.full_x + spec.full_width);
  std::size_t visited = 0;
  for (int y = spec.y; y < spec.y + spec.height; y += rows) {
    const int end = std::min(y + rows, spec.y + spec.height);
    read_rows(input, layout, y, end, OIIO::TypeFloat, values.data(), source.path);
    for (int row = std::max(y, spec.full_y); row < std::min(end, spec.full_y + spec.full_height); ++row)
      for (int x = x_begin; x < x_end; ++x, ++visited) {
        const std::size_t i = std::size_t(row - y) * width + std::size_t(x - spec.x);
        Texel texel{value(i, 0, 0), value(i, 1, 0), value(i, 2, 0), value(i, 3, 1)};
        colors.apply(texel);
        for (const double v : texel)
          if (!(std::abs(v) <= kLargestTexel))
            throw bad_file(source.path, std::string("a texel ") + kTexelOutOfRange);
        if (!visit(texel, std::size_t(1))) return;
      }
  }
  const std::size_t outside = std::size_t(spec.full_width) * std::size_t(spec.full_height) - visited;
  if (outside > 0) visit(Texel{0, 0, 0, layout.places[3] < 0 ? 1. : 0.}, outside);
}

/// Extremes of a float image's colours.
struct FloatRange {
  std::size_t negative = 0;  ///< texels with a colour below 0
  double lowest = 0, highest = 0;
};

/// error Error{bad_input} naming the file, pixel and value: not finite, or above kLargestTexel
FloatRange float_range(const PictureSource& source) {
  const OpenPicture opened = open_picture(source, kTextureFormats);
  const OIIO::ImageSpec spec = opened.input->spec();
  const TexelLayout layout(spec, source.path);
  const auto channels = std::size_t(layout.end - layout.begin), width = std::size_t(spec.width);
  const int rows = rows_at_once(spec);
  const auto x_begin = std::size_t(std::max(0, spec.full_x - spec.x)),
             x_end = std::size_t(std::min(spec.width, spec.full_x + spec.full_width - spec.x));
  std::vector<float> values(width * std::size_t(rows) * channels), lowest(width);
  FloatRange range;
  for (int y = spec.y; y < spec.y + spec.height; y += rows) {
    const int end = std::min(y + rows, spec.y + spec.height);
    read_rows(*opened.input, layout, y, end, OIIO::TypeFloat, values.data(), source.path);
    for (int row = std::max(y, spec.full_y); row < std::min(end, spec.full_y + spec.full_height); ++row) {
      std::ranges::fill(lowest, 0.0f);
      float highest = 0;
      for (std::size_t c = 0; c < 4; ++c) {
        const bool is_grey_again = (c == 1 || c == 2) && layout.places[c] == layout.places[0];
        if (layout.places[c] < 0 || is_grey_again) continue;
        const float* const first =
            &values[std::size_t(row - y) * width * channels] + std::size_t(layout.places[c] - layout.begin);
        for (std::size_t x = x_begin; x < x_end; ++x) {
          const float value = first[x * channels];
          if (!(std::abs(value) <= float(kLargestTexel)))
            throw bad_file(source.path, OIIO::Strutil::fmt::format(
                                            "pixel ({}, {}) {}: {:g}", int(x) + spec.x - spec.full_x,
                                            row - spec.full_y, kTexelOutOfRange, value));
          if (c == 3) continue;
          lowest[x] = std::min(lowest[x], value);
          highest = std::max(highest, value);
        }
      }
      range.highest = std::max(range.highest, double(highest));
      for (const float value : lowest) {
        range.negative += value < -kOfFilters ? 1 : 0;
        range.lowest = std::min(range.lowest, double(value));
      }
    }
  }
  return range;
}

class OiioPicture : public CachedPicture {
 public:
  OiioPicture(PictureSource source, TextureEncoding encoding)
      : source_(std::make_shared<const PictureSource>(std::move(source))) {
    static std::atomic<std::uint64_t> count{0};
    check_is_whole(*source_);
    const OpenPicture opened = open_picture(*source_, kTextureFormats);
    if (opened.format == "exr") check_exr_chunks(source_->path);
    const TexelLayout layout(opened.input->spec(), source_->path);
    const OIIO::ImageSpec spec = layout.spec(opened.input->spec());
    colors_ = TexelColors(opened.input->spec(), opened.format, layout, encoding, source_->path);
    if (spec.format.is_floating_point()) range_ = float_range(*source_);
    add_warnings(layout, spec, encoding.content == TextureContent::colors);
    channels_ = layout.channels;
    is_windowed_ = layout.is_windowed;
    for (std::size_t c = 0; c < 4; ++c) has_channel_[c] = layout.places[c] >= 0;
    resolution_ = {spec.full_width, spec.full_height};
    const auto values = std::size_t(spec.image_pixels()) * std::size_t(spec.nchannels);
    const std::size_t full_size = values * colors_.type_for(spec.format).size();
    memory_ = {values * spec.format.size(), full_size * 4 / 3};
    if (LinearInput::is_held(opened, layout)) memory_.decoded += full_size / 3;  // the smaller sizes
    name_ = "opaline " + std::to_string(count++) + ": " + source_->path;
    LinearInput::register_source(name_, source_, colors_, failure_);
    const OIIO::ustring name(name_);
    texture_system().imagecache()->add_file(name, LinearInput::create);
    handle_ = texture_system().get_texture_handle(name);
    if (handle_ == nullptr || !texture_system().good(handle_)) fail();
    const auto wrap = source_->repeats ? OIIO::TextureOpt::WrapPeriodic : OIIO::TextureOpt::WrapClamp;
    options_.swrap = options_.twrap = wrap;
    options_.interpmode = OIIO::TextureOpt::InterpBilinear;
  }
  ~OiioPicture() override {
    texture_system().invalidate(OIIO::ustring(name_));
    LinearInput::forget_source(name_);
  }

  std::array<float, 4> at(const TexturePlace& place) const override {
    OIIO::TextureOpt options = options_at(place);
    std::array<float, 4> texel{};
    if (!texture_system().texture(handle_, texture_system().get_perthread_info(), options, place.u, place.v,
                                  place.side_x[0], place.side_x[1], place.side_y[0], place.side_y[1],
                                  channels_, texel.data()) ||
        failure_->is_set())
      fail();
    if (channels_ < 3) return {texel[0], texel[0], texel[0], channels_ == 2 ? texel[1] : 1};
    return {texel[0], texel[1], texel[2], channels_ == 4 ? texel[3] : 1};
  }

  // Cubic splines between the texels of every size, for continuous slopes.
  std::array<float, 2> slope(const TexturePlace& place, std::size_t channel) const override {
    OIIO::TextureOpt options = options_at(place);
    options.interpmode = OIIO::TextureOpt::InterpBicubic;
    std::array<float, 4> texel{}, along_u{}, along_v{};
    if (!texture_system().texture(handle_, texture_system().get_perthread_info(), options, place.u, place.v,
                                  place.side_x[0], place.side_x[1], place.side_y[0], place.side_y[1],
                                  channels_, texel.data(), along_u.data(), along_v.data()) ||
        failure_->is_set())
      fail();
    const std::size_t at = channels_ > 2 ? channel : channel == 3 ? 1 : 0;
    return {along_u[at], along_v[at]};
  }

  std::array<float, 3> squared_slopes(const TexturePlace& place, std::size_t channel,
                                      float texels) const override {
    if (is_windowed_) return {};
    std::call_once(has_slopes_[channel], [&] {
      SlopePyramid made(resolution_[0], resolution_[1]);
      std::vector<float> row;
      for_each_texel(*source_, colors_, [&](const Texel& texel, std::size_t) {
        row.push_back(float(texel[channel]));
        if (int(row.size()) == resolution_[0]) made.add_row(std::exchange(row, {}));
        return true;
      });
      slopes_[channel].emplace(std::move(made));
    });
    return slopes_[channel]->at(place.u, place.v, texels);
  }

  std::optional<Texel> constant() const override {
    // Comparing bytes is far faster than comparing texels, but does not support windows.
    if (!is_windowed_ && !is_even(*source_)) return {};
    std::optional<Texel> first;
    bool is_constant = true;
    for_each_texel(*source_, colors_, [&](const Texel& texel, std::size_t) {
      if (!first) first = texel;
      is_constant = texel == *first;
      return is_constant && is_windowed_;
    });
    return is_constant ? first : std::nullopt;
  }

  Texel mean() const override {
    Texel sum{};
    double count = 0;
    for_each_texel(*source_, colors_, [&](const Texel& texel, std::size_t times) {
      for (std::size_t c = 0; c < 4; ++c) sum[c] += texel[c] * double(times);
      count += double(times);
      return true;
    });
    for (double& value : sum) value /= count;
    return sum;
  }

  TexelsAboveOne above_one(const Vec3d& scale) const override {
    if (!range_ || (colors_.are_plain() && range_->highest * max_component(scale) <= 1)) return {};
    const std::lock_guard lock(above_one_mutex_);
    const std::array<double, 3> key{scale.x, scale.y, scale.z};
    if (const auto known = above_one_.find(key); known != above_one_.end()) return known->second;
    TexelsAboveOne above;
    for_each_texel(*source_, colors_, [&](const Texel& texel, std::size_t times) {
      const double highest = std::max({texel[0] * scale.x, texel[1] * scale.y, texel[2] * scale.z});
      above.texels += times;
      above.count += highest > 1 + double(kOfFilters) ? times : 0;
      above.largest = std::max(above.largest, highest);
      return true;
    });
    above_one_[key] = above;
    return above;
  }

  std::array<int, 2> resolution() const override { return resolution_; }
  std::array<bool, 4> channels() const override { return has_channel_; }
  TextureMemory memory() const override { return memory_; }
  std::string warning() const override { return warning_; }

 private:
  void add_warnings(const TexelLayout& layout, const OIIO::ImageSpec& spec, bool is_color) {
    const auto add = [this](const std::string& text) {
      warning_ += (warning_.empty() ? source_->path + ": " : "; ") + text;
    };
    if (layout.ignored > 0)
      add(std::string("the file does not define the meaning of ") +
          (layout.ignored == 1 ? "a channel besides grey, which is" : "channels besides grey, which are") +
          " not used");
    if (is_color && range_ && range_->negative > 0)
      add(OIIO::Strutil::fmt::format(
          "{} of {} texels have a negative colour, rendered as 0; the lowest is {:.3g}", range_->negative,
          spec.image_pixels(), range_->lowest));
  }

  OIIO::TextureOpt options_at(const TexturePlace& place) const {
    OIIO::TextureOpt options = options_;
    if (place.ends_at_edges) options.swrap = options.twrap = OIIO::TextureOpt::WrapClamp;
    return options;
  }

  [[noreturn]] void fail() const {
    std::string complaint = failure_->is_set() ? failure_->text() : texture_system().geterror();
    complaint = complaint.substr(0, complaint.find('\n'));
    throw bad_file(source_->path, "the image is damaged: " + complaint);
  }

  std::shared_ptr<const PictureSource> source_;
  std::shared_ptr<ReadFailure> failure_ = std::make_shared<ReadFailure>();
  TexelColors colors_;
  std::optional<FloatRange> range_;  // none: integers
  mutable std::mutex above_one_mutex_;
  mutable std::map<std::array<double, 3>, TexelsAboveOne> above_one_;  // by scale
  mutable std::array<std::once_flag, 4> has_slopes_;
  mutable std::array<std::optional<SlopePyramid>, 4> slopes_;  // by channel
  std::string warning_;
  int channels_ = 0;  // channels of a texel
  std::array<bool, 4> has_channel_{};
  std::array<int, 2> resolution_{};
  bool is_windowed_ = false;
  TextureMemory memory_;
  std::string name_;
  OIIO::TextureSystem::TextureHandle* handle_ = nullptr;
  OIIO::TextureOpt options_;
};

std::unique_ptr<CachedPicture> open_cached(PictureSource source, TextureEncoding encoding) {
  return std::make_unique<OiioPicture>(std::move(source), encoding);
}

bool holds_floats(const PictureSource& source) {
  check_is_whole(source);  // libpng prints a line of its own on opening a damaged header
  return open_picture(source, kTextureFormats).input->spec().format.is_floating_point();
}

}  // namespace
}  // namespace opaline

opaline::TextureReader opaline_texture_reader() {
  return {opaline::open_cached, opaline::holds_floats, opaline::cache_limit};
}
