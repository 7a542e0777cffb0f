// SPDX-License-Identifier: GPL-3.0-or-later
#include <Imath/half.h>
#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfFrameBuffer.h>
#include <OpenEXR/ImfHeader.h>
#include <OpenEXR/ImfIO.h>
#include <OpenEXR/ImfOutputFile.h>
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

#include "opaline/core/atomic_file.h"
#include "opaline/core/error.h"
#include "opaline/image/image.h"

namespace opaline {
namespace {

constexpr float half_max = 65504.0f;

/// A multiple of the 16 rows that ZIP compresses together.
constexpr int strip_rows = 64;

/// The file under OpenEXR's writer. It remembers the first failure, since the writer's destructor, which
/// writes last, does not tell.
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

  /// Closes; 0, or the errno of the first thing that failed since the start.
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

/// Positions, depths, irradiance and variances need more than a half's 11 bits or its range.
bool always_float(const std::string& channel) {
  return channel == "Z" || channel.starts_with("P.") || channel.starts_with("irradiance.") ||
         channel.starts_with("variance.");
}

Imath::Box2i data_window(const Image& image) {
  const Imath::V2i corner(image.crop_x, image.crop_y);
  return {corner, corner + Imath::V2i(image.width - 1, image.height - 1)};
}

Imf::Header make_header(const Image& image, const std::vector<bool>& is_half) {
  const int width = image.full_width > 0 ? image.full_width : image.width,
            height = image.full_height > 0 ? image.full_height : image.height;
  Imf::Header header({{0, 0}, {width - 1, height - 1}}, data_window(image));
  header.compression() = Imf::ZIP_COMPRESSION;
  header.zipCompressionLevel() = 1;  // 3 % larger than at the usual level 4, in three quarters of its time
  for (std::size_t c = 0; c < image.channels.size(); ++c)
    header.channels().insert(image.channels[c], Imf::Channel(is_half[c] ? Imf::HALF : Imf::FLOAT));
  header.insert("Software", Imf::StringAttribute("opaline"));
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

// Appends the value's bytes; the place after them.
char* store(float value, bool half, char* to) {
  if (!half) {
    std::memcpy(to, &value, sizeof value);
    return to + sizeof value;
  }
  const ::half rounded(value);
  std::memcpy(to, &rounded, sizeof rounded);
  return to + sizeof rounded;
}

/// Rows of a picture in the file's own types, pixel by pixel.
class Strip {
 public:
  Strip(const Image& image, const std::vector<bool>& is_half) : image_(image), is_half_(is_half) {
    for (const bool half : is_half) pixel_bytes_ += half ? sizeof(::half) : sizeof(float);
  }

  void fill(int first, int count, WriteReport& report) {
    const std::size_t pixels = static_cast<std::size_t>(count) * static_cast<std::size_t>(image_.width);
    const std::size_t row = static_cast<std::size_t>(image_.width) * is_half_.size();
    const float* value = image_.pixels.data() + static_cast<std::size_t>(first) * row;
    bytes_.resize(pixels * pixel_bytes_);
    char* to = bytes_.data();
    for (std::size_t i = 0; i < pixels; ++i)
      for (const bool half : is_half_) to = store(storable(*value++, half, report), half, to);
    first_ = first;
  }

  Imf::FrameBuffer frame_buffer() const {
    Imath::Box2i window = data_window(image_);
    window.min.y += first_;
    Imf::FrameBuffer buffer;
    const char* at = bytes_.data();
    for (std::size_t c = 0; c < is_half_.size(); ++c) {
      buffer.insert(image_.channels[c],
                    Imf::Slice::Make(is_half_[c] ? Imf::HALF : Imf::FLOAT, at, window, pixel_bytes_,
                                     pixel_bytes_ * static_cast<std::size_t>(image_.width)));
      at += is_half_[c] ? sizeof(::half) : sizeof(float);
    }
    return buffer;
  }

 private:
  const Image& image_;
  const std::vector<bool>& is_half_;
  std::size_t pixel_bytes_ = 0;
  std::vector<char> bytes_;
  int first_ = 0;
};

}  // namespace

WriteReport write_exr(const std::string& path, const Image& image, bool half) {
  const std::size_t row = static_cast<std::size_t>(image.width) * image.channels.size();
  require(image.width > 0 && image.height > 0 && row > 0, "a picture has pixels and channels");
  require(image.pixels.size() == row * static_cast<std::size_t>(image.height),
          "a value per pixel and channel");
  std::vector<bool> is_half;
  for (const std::string& channel : image.channels) is_half.push_back(half && !always_float(channel));

  const auto threads =
      static_cast<int>(tbb::global_control::active_value(tbb::global_control::max_allowed_parallelism));
  Imf::setGlobalThreadCount(threads > 1 ? threads : 0);
  WriteReport report;
  Strip strip(image, is_half);
  AtomicFile file(path);
  CheckedFile sink(file.temporary());
  std::string complaint;
  try {
    Imf::OutputFile output(sink, make_header(image, is_half));
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
