// SPDX-License-Identifier: GPL-3.0-or-later
#include "image/png_chunks.h"

#include <zlib.h>

#include <cstdint>
#include <string_view>

#include "opaline/error.h"

namespace opaline {
namespace {

std::uint32_t crc_of(std::string_view bytes) {
  return std::uint32_t(::crc32_z(0, reinterpret_cast<const Bytef*>(bytes.data()), bytes.size()));
}

std::uint32_t big_endian(std::string_view bytes) {
  std::uint32_t value = 0;
  for (const char byte : bytes.substr(0, 4)) value = value << 8 | static_cast<unsigned char>(byte);
  return value;
}

void append_big_endian(std::string& bytes, std::uint32_t value) {
  for (int shift = 24; shift >= 0; shift -= 8) bytes.push_back(static_cast<char>(value >> shift & 0xff));
}

}  // namespace

std::string with_png_texts(const std::string& bytes,
                           std::span<const std::pair<std::string, std::string>> texts) {
  constexpr std::size_t header_end = 8 + 12 + 13;  // the signature, and IHDR with its 13 bytes of data
  std::string result = bytes.substr(0, header_end);
  for (const auto& [keyword, text] : texts) {
    // After the keyword: uncompressed, method 0, no language, no translated keyword.
    std::string chunk = "iTXt" + keyword;
    chunk.append(5, '\0');
    chunk += text;
    append_big_endian(result, static_cast<std::uint32_t>(chunk.size() - 4));
    result += chunk;
    append_big_endian(result, crc_of(chunk));
  }
  return result.append(bytes, header_end);
}

void check_png_chunks(const PictureBytes& bytes, const std::string& path) {
  std::uintmax_t at = 8;  // after the signature
  std::string chunk;      // its type and data, then its CRC
  while (!chunk.starts_with("IEND")) {
    const std::uintmax_t data = big_endian(bytes.read(at, 4));
    chunk = bytes.read(at + 4, 4 + data + 4);
    if (chunk.size() < 4 + data + 4) throw bad_file(path, "the image is truncated");
    if (crc_of({chunk.data(), 4 + data}) != big_endian({chunk.data() + 4 + data, 4}))
      throw bad_file(path, "the image is damaged: wrong CRC of the chunk at byte " + std::to_string(at));
    at += 12 + data;
  }
}

}  // namespace opaline
