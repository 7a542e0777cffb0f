// SPDX-License-Identifier: GPL-3.0-or-later
#include "image/exr_chunks.h"

#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfCompression.h>
#include <OpenEXR/ImfHeader.h>
#include <OpenEXR/ImfInputPart.h>
#include <OpenEXR/ImfMultiPartInputFile.h>
#include <OpenEXR/ImfPartType.h>
#include <OpenEXR/ImfTiledInputPart.h>
#include <zlib.h>

#include <algorithm>
#include <exception>
#include <vector>

#include "opaline/error.h"

namespace opaline {
namespace {

namespace imf = OPENEXR_IMF_NAMESPACE;

/// Decoded size of run-length encoded bytes: n >= 0 repeats the next byte n + 1 times, -n precedes n literal
/// bytes.
std::size_t bytes_of_runs(const char* runs, std::size_t size) {
  std::size_t bytes = 0;
  for (std::size_t at = 0; at < size;) {
    const int count = static_cast<signed char>(runs[at]);
    bytes += std::size_t(count < 0 ? -count : count + 1);
    at += count < 0 ? std::size_t(1 - count) : 2;
  }
  return bytes;
}

/// True if a zlib stream decodes to this number of bytes.
bool inflates_to(std::size_t bytes, const char* data, std::size_t size) {
  std::vector<Bytef> decoded(bytes);
  uLongf length = bytes;
  return ::uncompress(decoded.data(), &length, reinterpret_cast<const Bytef*>(data), size) == Z_OK &&
         length == bytes;
}

/// Bytes of a pixel; 0: subsampled channels, unsupported by OpenImageIO.
std::size_t pixel_bytes(const imf::ChannelList& channels) {
  std::size_t bytes = 0;
  for (auto at = channels.begin(); at != channels.end(); ++at) {
    const imf::Channel& channel = at.channel();
    if (channel.xSampling != 1 || channel.ySampling != 1) return 0;
    bytes += channel.type == imf::HALF ? 2 : 4;
  }
  return bytes;
}

int rows_of_chunk(imf::Compression compression) {
  switch (compression) {
    case imf::ZIP_COMPRESSION:
    case imf::PXR24_COMPRESSION:
      return 16;
    case imf::PIZ_COMPRESSION:
    case imf::B44_COMPRESSION:
    case imf::B44A_COMPRESSION:
    case imf::DWAA_COMPRESSION:
      return 32;
    case imf::DWAB_COMPRESSION:
      return 256;
    default:
      return 1;
  }
}

class ChunkCheck {
 public:
  ChunkCheck(imf::MultiPartInputFile& file, const std::string& path)
      : file_(file),
        path_(path),
        compression_(file.header(0).compression()),
        pixel_(pixel_bytes(file.header(0).channels())) {}

  void check() {
    if (pixel_ == 0) return;
    if (file_.header(0).hasTileDescription())
      check_tiles();
    else
      check_rows();
  }

 private:
  void check_rows() {
    imf::InputPart part(file_, 0);
    const auto window = part.header().dataWindow();
    const int rows = rows_of_chunk(compression_);
    for (long long y = window.min.y; y <= window.max.y; y += rows) {
      const long long height = std::min<long long>(rows, window.max.y - y + 1);
      const char* data = nullptr;
      int size = 0;
      part.rawPixelData(int(y), data, size);
      check_chunk(window.size().x + 1LL, height, data, size, y == window.min.y || y + rows > window.max.y);
    }
  }

  void check_tiles() {
    imf::TiledInputPart part(file_, 0);
    for (int level_y = 0; level_y < part.numYLevels(); ++level_y)
      for (int level_x = 0; level_x < part.numXLevels(); ++level_x)
        if (part.isValidLevel(level_x, level_y)) check_level(part, level_x, level_y);
  }

  void check_level(imf::TiledInputPart& part, int level_x, int level_y) {
    const int last_x = part.numXTiles(level_x) - 1, last_y = part.numYTiles(level_y) - 1;
    for (int y = 0; y <= last_y; ++y)
      for (int x = 0; x <= last_x; ++x) {
        const auto window = part.dataWindowForTile(x, y, level_x, level_y);
        const char* data = nullptr;
        int size = 0, tile[4] = {x, y, level_x, level_y};
        part.rawTileData(tile[0], tile[1], tile[2], tile[3], data, size);
        check_chunk(window.size().x + 1LL, window.size().y + 1LL, data, size,
                    (x == 0 && y == 0) || (x == last_x && y == last_y));
      }
  }

  /// Incompressible chunks are stored uncompressed.
  void check_chunk(long long width, long long height, const char* data, int stored, bool is_at_end) {
    const std::size_t bytes = std::size_t(width) * std::size_t(height) * pixel_, size = std::size_t(stored);
    bool is_whole = size > 0;
    if (size < bytes && compression_ == imf::NO_COMPRESSION) is_whole = false;
    if (size < bytes && compression_ == imf::RLE_COMPRESSION) is_whole = bytes_of_runs(data, size) == bytes;
    const bool is_zip = compression_ == imf::ZIP_COMPRESSION || compression_ == imf::ZIPS_COMPRESSION;
    if (is_whole && size < bytes && is_zip && is_at_end) is_whole = inflates_to(bytes, data, size);
    if (!is_whole) throw bad_file(path_, "the image is damaged: incomplete chunk");
  }

  imf::MultiPartInputFile& file_;
  const std::string& path_;
  imf::Compression compression_;
  std::size_t pixel_;
};

}  // namespace

std::string without_name(std::string complaint, const std::string& path) {
  for (const char* const sentence : {"Cannot read image file", "Error reading pixel data from image file"}) {
    const std::string named = std::string(sentence) + " \"" + path + "\". ";
    for (std::size_t at; (at = complaint.find(named)) != std::string::npos;)
      complaint.erase(at, named.size());
  }
  return complaint;
}

void check_exr_chunks(const std::string& path) try {
  imf::MultiPartInputFile file(path.c_str(), 0, false);
  const imf::Header& header = file.header(0);
  if (header.hasType() && imf::isDeepData(header.type())) return;  // refused on opening
  ChunkCheck(file, path).check();
} catch (const Error&) {
  throw;
} catch (const std::exception& failure) {
  throw bad_file(path, "the image is damaged: " + without_name(failure.what(), path));
}

}  // namespace opaline
