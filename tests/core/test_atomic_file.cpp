// SPDX-License-Identifier: GPL-3.0-or-later
// Output files appear whole or not at all: the old file is intact, and nothing is left beside it, whatever
// fails.
#include <gtest/gtest.h>
#include <sys/stat.h>

#include <filesystem>
#include <string>

#include "core/atomic_file.h"
#include "opaline/error.h"
#include "scratch_folder.h"

namespace opaline {
namespace {

/// what() of the Error{run_failed} that `action` throws; "" if it throws none.
template <typename Action>
std::string failure_of(Action action) {
  try {
    action();
  } catch (const Error& error) {
    EXPECT_EQ(error.kind, ErrorKind::run_failed);
    return error.what();
  }
  return {};
}

bool contains(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

// Claim: a committed file has the bytes written, alone in its folder, with the rights that the umask leaves.
// Source: atomic_file.h. Tolerance: none. Fails if: commit copies and leaves the temporary, or it is made by
// mkstemp (0600).
TEST(AtomicFile, ReplacesTheOldFile) {
  const ScratchFolder folder;
  const std::string path = folder.file("a.json");
  put_bytes(path, "old and longer");
  write_file(path, "new");
  EXPECT_EQ(bytes_of(path), "new");
  EXPECT_EQ(folder.entries(), 1u);
  const mode_t mask = ::umask(0);
  ::umask(mask);
  struct stat status {};
  ASSERT_EQ(::stat(path.c_str(), &status), 0);
  EXPECT_EQ(status.st_mode & 0777u, 0666u & ~mask);
}

// Claim: the temporary lies in the final file's folder, hidden, with its extension, and no two are the same.
// Source: atomic_file.h. Fails if: the name has no counter, or a fixed extension, or is in the system's
// folder.
TEST(AtomicFile, TemporaryIsBesideAndUnique) {
  const ScratchFolder folder;
  const AtomicFile first(folder.file("a.exr")), second(folder.file("a.exr"));
  const std::filesystem::path temporary = first.temporary();
  EXPECT_EQ(temporary.parent_path(), folder.path);
  EXPECT_EQ(temporary.extension(), ".exr");
  EXPECT_EQ(temporary.filename().string().front(), '.');
  EXPECT_NE(first.temporary(), second.temporary());
}

// Claim: without commit, by an exception or a return, the old file is as it was and the temporary is gone.
// Source: atomic_file.h. Fails if: the destructor does nothing, or commits.
TEST(AtomicFile, WithoutCommitNothingHappens) {
  const ScratchFolder folder;
  const std::string path = folder.file("a.txt");
  put_bytes(path, "old");
  {
    const AtomicFile file(path);
    put_bytes(file.temporary(), "half of the new");
  }
  EXPECT_EQ(bytes_of(path), "old");
  EXPECT_EQ(folder.entries(), 1u);
}

// Claim: what cannot be written is said at construction, with the file and the reason, and nothing is made or
// changed. Root ignores permission bits, so the folder is missing or a file. A device is refused: a rename
// would replace it. Source: atomic_file.h. Fails if: the temporary is made on commit, or a kind of file is
// not looked at.
TEST(AtomicFile, UnwritableIsSaidAtOnce) {
  const ScratchFolder folder;
  put_bytes(folder.file("plain"), "old");
  const struct {
    std::string path, reason;
  } lines[] = {
      {folder.file("missing/a.exr"), "no such folder"},
      {folder.file("plain/a.exr"), "Not a directory"},
      {folder.path.string(), "is a folder"},
      {folder.path.string() + "/", "no file name"},
      {"", "no file name"},
      {"/dev/null", "not a regular file"},
      {folder.file(std::string(300, 'n')), "File name too long"},
  };
  for (const auto& line : lines) {
    const std::string failure = failure_of([&] { const AtomicFile file(line.path); });
    EXPECT_TRUE(contains(failure, line.reason)) << line.path << ": " << failure;
    EXPECT_TRUE(contains(failure, line.path)) << failure;
  }
  EXPECT_EQ(bytes_of(folder.file("plain")), "old");
  EXPECT_EQ(folder.entries(), 1u);
  EXPECT_TRUE(std::filesystem::is_character_file("/dev/null"));
}

// Claim: a commit that cannot rename fails, removes the temporary and says why; here a folder took the name
// meanwhile. Source: atomic_file.h. Fails if: rename's result is not looked at.
TEST(AtomicFile, FailedCommitLeavesNothing) {
  const ScratchFolder folder;
  const std::string path = folder.file("a.txt");
  AtomicFile file(path);
  std::filesystem::create_directory(path);
  const std::string failure = failure_of([&] { file.commit(); });
  EXPECT_TRUE(contains(failure, "Is a directory")) << failure;
  EXPECT_EQ(folder.entries(), 1u);
}

// Claim: a full disk raises the error and leaves the old file and nothing else.
// Source: atomic_file.h. Fails if: a short write is taken for a
// full one.
TEST(AtomicFile, FullDiskLeavesTheOldFile) {
  const ScratchFolder folder;
  const std::string path = folder.file("a.txt");
  put_bytes(path, "old");
  std::string failure;
  {
    const FullDisk disk(1000);
    failure = failure_of([&] { write_file(path, std::string(1001, 'x')); });
  }
  EXPECT_TRUE(contains(failure, "File too large")) << failure;
  EXPECT_EQ(bytes_of(path), "old");
  EXPECT_EQ(folder.entries(), 1u);
}

// Claim: a link stays a link, and its target in another folder is replaced.
// Source: atomic_file.h ("the final file"). Fails if: the path is renamed over as given.
TEST(AtomicFile, LinkIsFollowed) {
  const ScratchFolder folder, elsewhere;
  put_bytes(elsewhere.file("target"), "old");
  std::filesystem::create_symlink(elsewhere.file("target"), folder.file("link"));
  write_file(folder.file("link"), "new");
  EXPECT_TRUE(std::filesystem::is_symlink(folder.file("link")));
  EXPECT_EQ(bytes_of(elsewhere.file("target")), "new");
}

// Claim: links to what is not there yet, one behind the other and relative to their own folders, are
// followed: the file is made at their end and they stay links; one that leads back to itself is refused.
// Source: what any other program's open() does. Fails if: a link whose end does not exist is renamed over.
TEST(AtomicFile, DanglingLinkIsFollowed) {
  const ScratchFolder folder;
  std::filesystem::create_directory(folder.file("below"));
  std::filesystem::create_symlink("below/second", folder.file("first"));
  std::filesystem::create_symlink("../file", folder.file("below/second"));
  std::filesystem::create_symlink("ring", folder.file("ring"));
  write_file(folder.file("first"), "new");
  EXPECT_TRUE(std::filesystem::is_symlink(folder.file("first")));
  EXPECT_TRUE(std::filesystem::is_symlink(folder.file("below/second")));
  EXPECT_EQ(bytes_of(folder.file("file")), "new");
  const std::string failure = failure_of([&] { write_file(folder.file("ring"), "new"); });
  EXPECT_TRUE(contains(failure, "symbolic links")) << failure;
  EXPECT_EQ(folder.entries(), 4u);
}

}  // namespace
}  // namespace opaline
