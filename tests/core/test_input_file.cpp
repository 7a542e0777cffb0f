// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/un.h>
#include <unistd.h>

#include "core/input_file.h"
#include "opaline/error.h"
#include "scratch_folder.h"

namespace opaline {
namespace {

std::string refusal_of(const std::string& path) {
  try {
    InputFile file(path, "mesh file", [](const std::string&) { return std::string(" (hint)"); });
  } catch (const Error& error) {
    EXPECT_EQ(error.kind, ErrorKind::bad_input);
    EXPECT_EQ(error.file, path);
    return error.what();
  }
  return "none";
}

// Claim: what is no regular file is refused at once by its kind, also behind a link; a missing file gets the hint. Source:
// input_file.h. Fails if: the file is opened before it is looked at, which waits for a pipe's writer.
TEST(InputFile, RefusesWhatIsNoRegularFile) {
  const ScratchFolder folder;
  const std::string pipe = folder.file("pipe"), link = folder.file("link"), socket = folder.file("socket");
  ASSERT_EQ(::mkfifo(pipe.c_str(), 0600), 0);
  std::filesystem::create_symlink(pipe, link);
  const int listener = ::socket(AF_UNIX, SOCK_STREAM, 0);
  sockaddr_un address{AF_UNIX, {}};
  socket.copy(address.sun_path, sizeof address.sun_path - 1);
  ASSERT_EQ(::bind(listener, reinterpret_cast<const sockaddr*>(&address), sizeof address), 0);
  const std::string expected = " (expected a regular file)";
  EXPECT_EQ(refusal_of(pipe), pipe + ": is a pipe" + expected);
  EXPECT_EQ(refusal_of(link), link + ": is a pipe" + expected);
  EXPECT_EQ(refusal_of(socket), socket + ": is a socket" + expected);
  EXPECT_EQ(refusal_of("/dev/zero"), "/dev/zero: is a device" + expected);
  EXPECT_EQ(refusal_of(folder.path.string()), folder.path.string() + ": is a folder" + expected);
  EXPECT_EQ(refusal_of(folder.file("none")), folder.file("none") + ": no such mesh file (hint)");
  EXPECT_EQ(refusal_of("/dev/null/none"), "/dev/null/none: no such mesh file (hint)");
  std::filesystem::create_symlink(link + "2", link + "2");
  EXPECT_TRUE(refusal_of(link + "2").starts_with(link + "2: cannot be opened: ")) << refusal_of(link + "2");
  ::close(listener);
}

// Claim: parts and the whole are the file's bytes; beyond its end there are none. Tolerance: none. Fails if: a position is
// added twice, or a part beyond the end is padded.
TEST(InputFile, ReadsParts) {
  const ScratchFolder folder;
  put_bytes(folder.file("a"), "0123456789");
  const InputFile file(folder.file("a"));
  EXPECT_EQ(file.size(), 10u);
  EXPECT_EQ(file.read(3, 4), "3456");
  EXPECT_EQ(file.read(8, 4), "89");
  EXPECT_EQ(file.read(12, 4), "");
  EXPECT_EQ(file.read_all(), "0123456789");
}

}  // namespace
}  // namespace opaline
