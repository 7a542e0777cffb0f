// SPDX-License-Identifier: GPL-3.0-or-later
// Pictures that cannot be read or written: one clear error each, bounded memory, the old file intact.
#include <OpenImageIO/imageio.h>
#include <gtest/gtest.h>

#include <cstdint>
#include <cstring>
#include <filesystem>
#include <optional>
#include <string>

#include "../core/scratch_folder.h"
#include "opaline/error.h"
#include "opaline/image.h"

namespace opaline {
namespace {

/// Noise, which no codec makes smaller.
Image noise(int width, int height) {
  Image image;
  image.width = width;
  image.height = height;
  image.channels = {"R", "G", "B"};
  std::uint32_t state = 1;
  for (int i = 0; i < width * height * 3; ++i) {
    state = state * 1664525u + 1013904223u;
    image.pixels.push_back(static_cast<float>(state >> 8) * 0x1p-24f);
  }
  return image;
}

template <typename Action>
std::optional<Error> error_of(Action action) {
  try {
    action();
  } catch (const Error& error) {
    return error;
  }
  return {};
}

/// Nothing is left in OpenImageIO that its later versions print at exit.
void expect_nothing_pending() {
  EXPECT_EQ(OIIO::geterror(), "");
}

std::string picture_bytes(const ScratchFolder& folder, const std::string& extension) {
  const std::string path = folder.file("whole." + extension);
  if (extension == "exr") write_exr(path, noise(64, 70), false);
  if (extension == "png") write_png(path, noise(64, 70), 0);
  return bytes_of(path);
}

void expect_bad_input(const std::string& path, const std::string& label) {
  const std::optional<Error> error = error_of([&] { read_image(path); });
  ASSERT_TRUE(error) << label << " was read";
  EXPECT_EQ(error->kind, ErrorKind::bad_input) << label;
  EXPECT_EQ(error->file, path) << label;
  EXPECT_EQ(std::string(error->what()).find('\n'), std::string::npos) << error->what();
  expect_nothing_pending();
}

// Claim: missing, a folder, empty, text, noise, and a picture of another format are bad input, by the file's
// name. Source: image.h. Fails if: OpenImageIO guesses the format (it takes noise for a Targa), or a message
// stays pending.
TEST(BadPictures, NotAPicture) {
  const ScratchFolder folder;
  expect_bad_input(folder.file("missing.exr"), "missing");
  expect_bad_input(folder.path.string(), "folder");
  std::string garbage(4096, '\0');
  for (std::size_t i = 0; i < garbage.size(); ++i) garbage[i] = static_cast<char>(i * i * 31 + i / 7);
  const std::string contents[] = {"",
                                  "v 0 0 0\n",
                                  garbage,
                                  "\x76\x2f\x31\x01",
                                  "\x76\x2f\x31\x01" + garbage,
                                  "\x89PNG\r\n\x1a\n",
                                  "\x89PNG\r\n\x1a\n" + garbage,
                                  "P6 1 1 255 rgb"};
  for (const std::string& content : contents)
    for (const char* extension : {"exr", "png"}) {
      const std::string path = folder.file(std::string("a.") + extension);
      put_bytes(path, content);
      expect_bad_input(path, content.substr(0, 8));
    }
}

// Claim: a picture cut off anywhere is bad input, never a picture with black rows. A truncated EXR opens.
// Source: image.h. Fails if: read_image's result is not looked at, or libpng judges (it needs no end).
TEST(BadPictures, Truncated) {
  const ScratchFolder folder;
  for (const char* extension : {"exr", "png"}) {
    const std::string whole = picture_bytes(folder, extension);
    const std::string path = folder.file(std::string("cut.") + extension);
    for (std::size_t length = 0; length < whole.size(); length += whole.size() / 41) {
      put_bytes(path, whole.substr(0, length));
      expect_bad_input(path, extension + std::to_string(length));
    }
    put_bytes(path, whole.substr(0, whole.size() - 1));
    expect_bad_input(path, std::string(extension) + " less one byte");
  }
}

// Claim: a header that claims 1e9 x 1e9 or 30000 x 30000 pixels in 100 kB is bad input, at once and in
// bounded memory. Source: image.h. Fails if: memory is reserved by the header
// alone.
TEST(BadPictures, HugeClaim) {
  const ScratchFolder folder;
  for (const std::int32_t side : {1000000000, 30000}) {
    std::string bytes = picture_bytes(folder, "exr");
    for (const char* window : {"dataWindow", "displayWindow"}) {
      // Name, type "box2i", length, each int32 of 4 bytes: x and y of the first pixel, then of the last.
      const std::size_t corner = bytes.find(window) + std::strlen(window) + 1 + sizeof "box2i" + 4 + 8;
      const std::int32_t last[2] = {side - 1, side - 1};
      ASSERT_EQ(bytes[corner], 63) << "the corner (63, 69) of a 64 x 70 picture";
      std::memcpy(bytes.data() + corner, last, sizeof last);
    }
    put_bytes(folder.file("huge.exr"), bytes);
    expect_bad_input(folder.file("huge.exr"), std::to_string(side));
    const std::optional<Error> error = error_of([&] { read_image(folder.file("huge.exr")); });
    EXPECT_TRUE(side > 30000 || error->message.find("the size it claims") != std::string::npos)
        << error->what();
  }
}

// Claim: no damaged byte in an EXR's header crashes the reader: it reads, or says bad input. In a PNG every
// damaged byte is found. Source: image.h; PNG specification, annex D. Two damages. Fails if: an exception of
// another type leaves read_image, or the PNG's CRC is not checked.
TEST(BadPictures, DamagedBytes) {
  const ScratchFolder folder;
  for (const char* extension : {"exr", "png"}) {
    const std::string whole = picture_bytes(folder, extension);
    const std::string path = folder.file(std::string("bad.") + extension);
    std::size_t refused = 0;
    for (std::size_t i = 0; i < 400; ++i) {
      std::string bytes = whole;
      bytes[i] = static_cast<char>(bytes[i] ^ (i % 2 ? 0x80 : 0x11));
      put_bytes(path, bytes);
      const std::optional<Error> error = error_of([&] { read_image(path); });
      EXPECT_TRUE(!error || error->kind == ErrorKind::bad_input);
      refused += error.has_value();
      expect_nothing_pending();
    }
    EXPECT_GE(refused, std::string(extension) == "exr" ? 50u : 400u) << extension;
  }
}

// Claim: a place that cannot be written is run_failed by name, before a pixel is encoded, and nothing is
// made. Root ignores permission bits, so the folder is missing or a plain file. Source: image.h. Fails if:
// OpenImageIO opens the final name itself, or its error stays pending.
TEST(BadPictures, Unwritable) {
  const ScratchFolder folder;
  put_bytes(folder.file("plain"), "old");
  for (const std::string& path :
       {folder.file("plain/a.exr"), folder.file("missing/a.exr"), folder.path.string()}) {
    const std::optional<Error> errors[] = {error_of([&] { write_exr(path, noise(4, 4), true); }),
                                           error_of([&] { write_png(path, noise(4, 4), 0); })};
    for (const std::optional<Error>& error : errors) {
      ASSERT_TRUE(error) << path;
      EXPECT_EQ(error->kind, ErrorKind::run_failed);
      EXPECT_EQ(error->file, path);
    }
    expect_nothing_pending();
  }
  EXPECT_EQ(bytes_of(folder.file("plain")), "old");
  EXPECT_EQ(folder.entries(), 1u);
}

// Claim: a disk that is full at any byte, the last one too, raises run_failed with the system's reason; the
// old file is intact and nothing lies beside it. Source: image.h. Fails if: OpenImageIO writes by itself (it
// then loses a failure in the last kilobytes of an EXR and in all of a small PNG).
TEST(BadPictures, FullDisk) {
  const ScratchFolder folder;
  for (const char* extension : {"exr", "png"}) {
    const std::size_t size = picture_bytes(folder, extension).size(), entries = folder.entries();
    const std::string path = folder.file(std::string("whole.") + extension);
    put_bytes(path, "old");
    for (const std::size_t room : {std::size_t{0}, std::size_t{100}, size / 2, size - 5000, size - 1}) {
      std::optional<Error> error;
      {
        const FullDisk disk(room);
        error = error_of([&] { picture_bytes(folder, extension); });
      }
      ASSERT_TRUE(error) << extension << ' ' << room;
      EXPECT_EQ(error->kind, ErrorKind::run_failed);
      EXPECT_EQ(error->file, path);
      EXPECT_NE(std::string(error->what()).find("File too large"), std::string::npos) << error->what();
      EXPECT_EQ(bytes_of(path), "old");
      EXPECT_EQ(folder.entries(), entries);
      expect_nothing_pending();
    }
    const FullDisk disk(size);
    EXPECT_EQ(picture_bytes(folder, extension).size(), size) << "the room is just enough";
  }
}

}  // namespace
}  // namespace opaline
