// SPDX-License-Identifier: GPL-3.0-or-later
#include "asset_files/gltf_file.h"

#include <algorithm>
#include <charconv>
#include <cstdint>

#include "asset_files/asset_file.h"
#include "opaline/error.h"

namespace opaline {
namespace {

constexpr std::size_t kVersionAt = 4, kLengthAt = 8, kFirstChunk = 12, kChunkHeader = 8, kAlignment = 4;
constexpr std::size_t kShown = 40;  // first characters of another file
constexpr std::string_view kJson = "JSON", kBinary{"BIN\0", 4};

std::size_t number_at(std::string_view file, std::size_t at) {
  std::size_t value = 0;
  for (std::size_t i = 4; i-- > 0;) value = value << 8 | std::uint8_t(file[at + i]);
  return value;
}

bool is_chunk(std::string_view file, std::size_t at, std::string_view type) {
  return at + kChunkHeader <= file.size() && file.substr(at + 4, 4) == type;
}

/// Bytes after a chunk's header.
std::string_view chunk_at(const std::string& path, std::string_view file, std::size_t at, const char* name) {
  const std::size_t length = number_at(file, at), rest = file.size() - at - kChunkHeader;
  if (length > rest)
    throw bad_file(path, std::string("its ") + name + " chunk is cut off", std::to_string(length) + " bytes",
                   std::to_string(rest));
  return file.substr(at + kChunkHeader, length);
}

/// error unless the first character is that of an object or a list
void check_begins_as_json(const std::string& path, std::string_view file) {
  const std::size_t first = file.find_first_not_of(" \t\r\n\xef\xbb\xbf");
  if (first == file.npos || file[first] == '{' || file[first] == '[') return;
  const std::string_view start = file.substr(first, kShown);
  const bool is_text = std::ranges::all_of(
      start, [](char c) { return (c >= ' ' && c != 0x7f) || c == '\n' || c == '\r' || c == '\t'; });
  throw bad_file(path, "is not a glTF file", "a file that begins with glTF (binary) or { (JSON)",
                 is_text ? "text that begins " + in_quotes(start.substr(0, start.find_first_of("\r\n")))
                         : "binary data");
}

int value_of_letter(char c) {
  constexpr std::string_view letters = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  return int(letters.find(c));  // -1: none
}

std::optional<std::string> decoded_base64(std::string_view text) {
  while (!text.empty() && text.back() == '=') text.remove_suffix(1);
  std::string bytes;
  bytes.reserve(text.size() / 4 * 3 + 3);
  std::uint32_t bits = 0;
  int count = 0;
  for (const char c : text) {
    const int value = value_of_letter(c);
    if (value < 0) return std::nullopt;
    bits = bits << 6 | std::uint32_t(value);
    count += 6;
    if (count < 8) continue;
    count -= 8;
    bytes += char(bits >> count & 0xff);
  }
  return bytes;
}

}  // namespace

GltfChunks gltf_chunks(const std::string& path, std::string_view file) {
  if (!file.starts_with("glTF")) {
    check_begins_as_json(path, file);
    return {file, {}};
  }
  if (file.size() < kFirstChunk + kChunkHeader) throw bad_file(path, "its header is cut off");
  if (const std::size_t version = number_at(file, kVersionAt); version != 2)
    throw bad_file(path, "has an unsupported version", "binary glTF 2", std::to_string(version));
  if (const std::size_t length = number_at(file, kLengthAt); length > file.size())
    throw bad_file(path, "the file is truncated", std::to_string(length) + " bytes by its header",
                   std::to_string(file.size()));
  if (!is_chunk(file, kFirstChunk, kJson)) throw bad_file(path, "does not begin with JSON", "a GLB file");
  GltfChunks chunks;
  chunks.json = chunk_at(path, file, kFirstChunk, "JSON");
  const std::size_t end = kFirstChunk + kChunkHeader + chunks.json.size(),
                    aligned = (end + kAlignment - 1) / kAlignment * kAlignment;
  chunks.is_aligned = end == aligned;
  const std::size_t next = is_chunk(file, end, kBinary) ? end : aligned;
  if (is_chunk(file, next, kBinary)) chunks.binary = chunk_at(path, file, next, "binary");
  while (chunks.json.ends_with('\0')) chunks.json.remove_suffix(1);
  return chunks;
}

bool is_data_uri(const std::string& uri) {
  return uri.starts_with("data:");
}

std::optional<std::string> data_of_uri(const std::string& uri) {
  const std::size_t comma = uri.find(',');
  if (comma == uri.npos) return std::nullopt;
  const std::string_view data = std::string_view(uri).substr(comma + 1);
  if (std::string_view(uri).substr(0, comma).ends_with(";base64")) return decoded_base64(data);
  return decoded_uri(data);
}

std::string decoded_uri(std::string_view uri) {
  std::string text;
  for (std::size_t i = 0; i < uri.size(); ++i) {
    unsigned byte = 0;
    const char* const digits = uri.data() + i + 1;
    if (uri[i] == '%' && i + 2 < uri.size() &&
        std::from_chars(digits, digits + 2, byte, 16).ptr == digits + 2) {
      text += char(byte);
      i += 2;
    } else {
      text += uri[i];
    }
  }
  return text;
}

}  // namespace opaline
