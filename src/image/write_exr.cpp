// SPDX-License-Identifier: GPL-3.0-or-later
#include <Imath/half.h>
#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfFrameBuffer.h>
#include <OpenEXR/ImfHeader.h>
#include <OpenEXR/ImfIO.h>
#include <OpenEXR/ImfOutputFile.h>
#include <OpenEXR/ImfStandardAttributes.h>
#include <OpenEXR/ImfStringAttribute.h>
#include <OpenEXR/ImfThreading.h>
#include <tbb/global_control.h>

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <new>
#include <system_error>
#include <utility>

#include "core/atomic_file.h"
#include "core/parallel.h"
#include "image/color_channels.h"
#include "image/picture_layers.h"
#include "opaline/error.h"

namespace opaline {
namespace {

constexpr float half_max = 65504.0f;

/// ZIP compresses 16 rows together. A strip has several blocks, for all threads, within a small memory limit.
constexpr int block_rows = 16, most_blocks = 32;
constexpr std::size_t strip_bytes = std::size_t(8) << 20;

/// Output stream for OpenEXR's writer. Records the first failure, because the writer's destructor, with the
/// final write, does not report it.
class CheckedFile final : public Imf::OStream {
 public:
  explicit CheckedFile(const std::string& path)
      : OStream(path.c_str()), file_(std::fopen(path.c_str(), "wb")) {
    if (file_ == nullptr) remember();
  }
  ~CheckedFile() override {
    if (file_ != nullptr) std::fclose(file_);
  }
  CheckedFile(const CheckedFile&) = delete;
  CheckedFile& operator=(const CheckedFile&) = delete;

  void write(const char* bytes, int size) override {
    const auto wanted = static_cast<std::size_t>(size);
    if (file_ == nullptr || std::fwrite(bytes, 1, wanted, file_) < wanted) fail();
  }
  std::uint64_t tellp() override {
    const ::off_t at = file_ != nullptr ? ::ftello(file_) : -1;
    if (at < 0) fail();
    return static_cast<std::uint64_t>(at);
  }
  void seekp(std::uint64_t place) override {
    if (file_ == nullptr || ::fseeko(file_, static_cast<::off_t>(place), SEEK_SET) != 0) fail();
  }

  /// Closes the file; returns 0, or the errno of the first failure.
  int finish() {
    if (file_ != nullptr && std::fclose(std::exchange(file_, nullptr)) != 0) remember();
    return failure_;
  }

 private:
  void remember() {
    if (failure_ == 0) failure_ = errno != 0 ? errno : EIO;
  }
  [[noreturn]] void fail() {
    remember();
    throw std::system_error(failure_, std::generic_category());
  }

  std::FILE* file_;
  int failure_ = 0;
};

/// Positions, depths, irradiance and variances exceed a half's 11 bits or its range; Cryptomatte's names are
/// bits of a float.
bool always_float(const std::string& channel) {
  return channel == "Z" || channel.starts_with("P.") || channel.starts_with("irradiance.") ||
         channel.starts_with("variance.") || is_matte_channel(channel);
}

Imath::Box2i data_window(const Image& image) {
  const Imath::V2i corner(image.crop_x, image.crop_y);
  return {corner, corner + Imath::V2i(image.width - 1, image.height - 1)};
}

/// Channel of an image in the file.
struct FileChannel {
  std::size_t place = 0;  // index among the image's channels
  bool half = false;
  std::size_t bytes() const { return half ? sizeof(::half) : sizeof(float); }
  Imf::PixelType type() const { return half ? Imf::HALF : Imf::FLOAT; }
};

Imf::Chromaticities chromaticities_of(FilmColorSpace space) {
  const RgbPrimaries& primaries = space == FilmColorSpace::acescg ? kAp1Primaries : kRec709Primaries;
  const auto xy = [](const std::array<double, 2>& at) { return Imath::V2f(float(at[0]), float(at[1])); };
  return {xy(primaries.red), xy(primaries.green), xy(primaries.blue), xy(primaries.white)};
}

Imf::Header make_header(const Image& image, const std::vector<FileChannel>& channels, FilmColorSpace space) {
  const int width = image.full_width > 0 ? image.full_width : image.width,
            height = image.full_height > 0 ? image.full_height : image.height;
  Imf::Header header({{0, 0}, {width - 1, height - 1}}, data_window(image));
  header.pixelAspectRatio() = float(image.pixel_aspect);
  header.compression() = Imf::ZIP_COMPRESSION;
  header.zipCompressionLevel() = 1;  // slightly larger files than at the default level 4, but faster
  for (const FileChannel& channel : channels)
    header.channels().insert(image.channels[channel.place], Imf::Channel(channel.type()));
  header.insert("Software", Imf::StringAttribute("opaline"));
  Imf::addChromaticities(header, chromaticities_of(space));
  // OpenEXR's and the Color Interop Forum's name of the space.
  header.insert("colorInteropID",
                Imf::StringAttribute(space == FilmColorSpace::acescg ? "lin_ap1_scene" : "lin_rec709_scene"));
  for (const auto& [name, value] : image.metadata) header.insert(name, Imf::StringAttribute(value));
  return header;
}

float storable(float value, bool half, WriteReport& report) {
  if (!std::isfinite(value)) {
    ++report.non_finite;
    return 0.0f;
  }
  if (half && std::abs(value) > half_max) {
    ++report.half_overflow;
    return std::copysign(half_max, value);
  }
  return value;
}

/// One channel of a row, in the file's type.
template <class Stored>
void store_row(const float* value, std::size_t step, std::size_t count, char* to, WriteReport& report) {
  constexpr bool half = sizeof(Stored) < sizeof(float);
  for (std::size_t i = 0; i < count; ++i, value += step, to += sizeof(Stored)) {
    const Stored stored(storable(*value, half, report));
    std::memcpy(to, &stored, sizeof stored);
  }
}

/// Rows of an image in the file's types, channel by channel.
class Strip {
 public:
  Strip(const Image& image, const std::vector<FileChannel>& channels, FilmColorSpace space)
      : image_(image), channels_(channels), planes_(channels.size()) {
    if (space == FilmColorSpace::acescg) colors_ = color_channels(image.channels);
  }

  void fill(int first, int count, WriteReport& report) {
    const auto width = static_cast<std::size_t>(image_.width), rows = static_cast<std::size_t>(count),
               step = image_.channels.size();
    for (std::size_t c = 0; c < channels_.size(); ++c) planes_[c].resize(rows * width * channels_[c].bytes());
    std::vector<WriteReport> reports(chunk_count(rows, block_rows));
    parallel_chunks(rows, block_rows, [&](std::size_t begin, std::size_t end, std::size_t chunk) {
      std::vector<float> converted;
      for (std::size_t y = begin; y < end; ++y) {
        const float* row = image_.pixels.data() + (static_cast<std::size_t>(first) + y) * width * step;
        if (!colors_.empty()) {
          converted.assign(row, row + width * step);
          convert_colors(converted, step, colors_, to_acescg());
          row = converted.data();
        }
        for (std::size_t c = 0; c < channels_.size(); ++c) {
          char* to = planes_[c].data() + y * width * channels_[c].bytes();
          const auto store = channels_[c].half ? store_row<::half> : store_row<float>;
          store(row + channels_[c].place, step, width, to, reports[chunk]);
        }
      }
    });
    for (const WriteReport& part : reports) {
      report.non_finite += part.non_finite;
      report.half_overflow += part.half_overflow;
    }
    first_ = first;
  }

  Imf::FrameBuffer frame_buffer() const {
    Imath::Box2i window = data_window(image_);
    window.min.y += first_;
    Imf::FrameBuffer buffer;
    for (std::size_t c = 0; c < channels_.size(); ++c)
      buffer.insert(image_.channels[channels_[c].place],
                    Imf::Slice::Make(channels_[c].type(), planes_[c].data(), window, channels_[c].bytes(),
                                     channels_[c].bytes() * static_cast<std::size_t>(image_.width)));
    return buffer;
  }

 private:
  const Image& image_;
  const std::vector<FileChannel>& channels_;
  std::vector<ColorChannels> colors_;  // to be converted
  std::vector<std::vector<char>> planes_;
  int first_ = 0;
};

int strip_rows_of(const Image& image, const std::vector<FileChannel>& channels) {
  std::size_t row = 0;
  for (const FileChannel& channel : channels) row += channel.bytes() * static_cast<std::size_t>(image.width);
  const std::size_t blocks = strip_bytes / (row * block_rows);
  return block_rows * static_cast<int>(std::clamp<std::size_t>(blocks, 4, most_blocks));
}

}  // namespace

bool is_named(const LayerChoice& layers, std::string_view name) {
  return std::ranges::find(layers.names, name) != layers.names.end();
}

bool has_channel(const LayerChoice& layers, const std::string& channel) {
  if (layers.all || (channel.size() == 1 && channel != "Z")) return true;
  const std::string layer = channel.substr(0, channel.find('.'));
  return is_named(layers, layer) || (is_matte_channel(channel) && is_named(layers, kCryptomatte)) ||
         (is_light_group(layer) && is_named(layers, kLightGroups)) ||
         (layer == "S0" && is_named(layers, kWavelengths));
}

WriteReport write_exr(const std::string& path, const Image& image, bool half) {
  return write_exr(path, image, half, LayerChoice{});
}

WriteReport write_exr(const std::string& path, const Image& image, bool half, const LayerChoice& layers,
                      FilmColorSpace space) {
  const std::size_t row = static_cast<std::size_t>(image.width) * image.channels.size();
  require(image.width > 0 && image.height > 0 && row > 0, "a picture has pixels and channels");
  require(image.pixels.size() == row * static_cast<std::size_t>(image.height),
          "a value per pixel and channel");
  std::vector<FileChannel> channels;
  for (std::size_t c = 0; c < image.channels.size(); ++c)
    if (has_channel(layers, image.channels[c]))
      channels.push_back({c, half && !always_float(image.channels[c])});

  const auto threads =
      static_cast<int>(tbb::global_control::active_value(tbb::global_control::max_allowed_parallelism));
  Imf::setGlobalThreadCount(threads > 1 ? threads : 0);
  WriteReport report;
  Strip strip(image, channels, space);
  AtomicFile file(path);
  CheckedFile sink(file.temporary());
  std::string complaint;
  try {
    Imf::OutputFile output(sink, make_header(image, channels, space));
    const int strip_rows = strip_rows_of(image, channels);
    for (int first = 0; first < image.height; first += strip_rows) {
      const int count = std::min(strip_rows, image.height - first);
      strip.fill(first, count, report);
      output.setFrameBuffer(strip.frame_buffer());
      output.writePixels(count);
    }
  } catch (const std::bad_alloc&) {
    throw;
  } catch (const std::exception& error) {
    complaint = error.what();
  }
  if (const int failure = sink.finish())
    throw run_failed(path, std::string("cannot write: ") + std::strerror(failure));
  if (!complaint.empty()) throw run_failed(path, "cannot write: " + complaint);
  file.commit();
  return report;
}

}  // namespace opaline
