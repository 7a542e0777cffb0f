// SPDX-License-Identifier: GPL-3.0-or-later
#include "image/picture_file.h"

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>

#include "opaline/core/error.h"

namespace opaline {
namespace {

/// Floats in memory over bytes in the file, at most: a constant picture of 8192 x 8192 halves packs 29330 : 1
/// as DWA, 1945 : 1 as ZIP, less as others (measured); a PNG of one-bit palette entries 99072 : 1 (deflate's
/// 1032); a JPEG or TIFF 10240 : 1 at most (progressive JPEG of empty blocks).
double densest(const OIIO::ImageSpec& spec, std::string_view format) {
  if (format == "png") return 131072;
  if (format == "jpeg" || format == "tiff") return 16384;
  return spec.get_string_attribute("compression").substr(0, 3) == "dwa" ? 32768 : 2048;
}

std::string one_line(std::string message) {
  while (!message.empty() && message.back() == '\n') message.pop_back();
  std::replace(message.begin(), message.end(), '\n', ' ');
  return message;
}

}  // namespace

std::string first_bytes(const std::string& path) {
  std::error_code failure;
  const std::filesystem::file_status status = std::filesystem::status(path, failure);
  if (!std::filesystem::exists(status)) throw bad_file(path, "cannot read: " + failure.message());
  if (!std::filesystem::is_regular_file(status)) throw bad_file(path, "cannot read: not a regular file");
  std::ifstream file(path, std::ios::binary);
  if (!file) throw bad_file(path, std::string("cannot read: ") + std::strerror(errno));
  char bytes[8] = {};
  file.read(bytes, sizeof bytes);
  return {bytes, static_cast<std::size_t>(file.gcount())};
}

const char* picture_format(std::string_view start) {
  start = start.substr(0, 8);
  if (start.starts_with("\x76\x2f\x31\x01")) return "exr";
  if (start == "\x89PNG\r\n\x1a\n") return "png";
  if (start.starts_with("#?RADIAN") || start.starts_with("#?RGBE")) return "hdr";
  if (start.starts_with("\xff\xd8\xff")) return "jpeg";
  const std::string_view tiffs[] = {{"II*\0", 4}, {"MM\0*", 4}, {"II+\0", 4}, {"MM\0+", 4}};
  return std::ranges::any_of(tiffs, [&](std::string_view tiff) { return start.starts_with(tiff); }) ? "tiff"
                                                                                                    : nullptr;
}

std::string complaint_of(const OIIO::ImageInput* input) {
  const std::string complaint = input ? input->geterror() : OIIO::geterror();
  return one_line(complaint.empty() ? "no reason given" : complaint);
}

// Beside the picture the libraries hold rows: OpenImageIO 256, however few there are, OpenEXR 32 a thread (traced on a
// picture of 55555 x 2: 850 MB for 2.6).
void check_picture_size(const std::string& path, const OIIO::ImageSpec& spec, std::string_view format,
                        std::uintmax_t file_size) {
  constexpr double always_allowed = 512 << 20, rows_beside = 1024;
  const double claimed =
      sizeof(float) * static_cast<double>(spec.width) * (spec.height + rows_beside) * spec.nchannels;
  if (claimed > densest(spec, format) * static_cast<double>(file_size) + always_allowed)
    throw bad_file(path, "the file is too short for the size it claims", {},
                   std::to_string(spec.width) + " x " + std::to_string(spec.height) + " pixels");
}

}  // namespace opaline
