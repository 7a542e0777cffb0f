// SPDX-License-Identifier: GPL-3.0-or-later
// The whole program, killed, and on a disk that is full.
#include <gtest/gtest.h>
#include <sched.h>
#include <sys/mount.h>

#include <cerrno>
#include <cstring>

#include "run_program.h"

namespace opaline {
namespace {

/// Runs the command to its end once for its time, then kills it as often at moments spread over it; `check`
/// after each.
template <class Check>
void kill_program(const std::vector<std::string>& command, int times, const Check& check) {
  const auto start = std::chrono::steady_clock::now();
  ASSERT_EQ(run_program(command).exit_code, 0);
  const double whole = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  check();
  for (int i = 0; i < times; ++i) {
    Child child(command);
    std::this_thread::sleep_for(std::chrono::duration<double>(1.1 * whole * (i + 1) / times));
    child.send(SIGKILL);
    child.wait();
    check();
  }
}

void expect_nothing_lost(int times) {
  const SceneFolder folder;
  const std::string out = folder.file("a.exr"), sums = folder.file("sums.exr"), cache = folder.file("cache");
  const std::vector<std::string> direct{"render",   folder.scene, "-o",     folder.file("direct.exr"),
                                        "--method", "direct",     "--set",  "settings.entry_samples=64",
                                        "--resume", sums,         "--quiet"};
  const std::vector<std::string> cached{"render", folder.scene, "-o", out, "--cache", cache, "--quiet"};
  std::string picture, direct_picture;
  kill_program(direct, times, [&] {
    if (direct_picture.empty()) direct_picture = bytes_of(folder.file("direct.exr"));
    EXPECT_TRUE(bytes_of(folder.file("direct.exr")) == direct_picture);
    std::filesystem::remove(sums);
  });
  kill_program(cached, times, [&] {
    if (picture.empty()) picture = bytes_of(out);
    EXPECT_TRUE(bytes_of(out) == picture);
    EXPECT_EQ(run_program({"cache", "verify", cache}).exit_code, 0);
    if (times % 2 == 0) std::filesystem::remove_all(cache);
    std::filesystem::create_directories(cache);
  });
}

// Claim: a render that is killed at any moment leaves the picture, the sums and the cache whole, as they were
// or new, and the next one makes the same bytes. Tolerance: none. Fails if: anything is written under its own
// name.
TEST(CliKills, NothingIsLost) {
  expect_nothing_lost(12);
}
TEST(LongCliKills, NothingIsLost) {
  expect_nothing_lost(500);
}

/// In a child process with a disk of 128 KiB at this folder, which ends with what work() returns; -1: no such
/// disk may be made here.
template <class Work>
int with_small_disk(const std::string& folder, const Work& work) {
  const pid_t child = ::fork();
  if (child == 0) {
    const bool made = ::unshare(CLONE_NEWNS) == 0 &&
                      ::mount(nullptr, "/", nullptr, MS_REC | MS_PRIVATE, nullptr) == 0 &&
                      ::mount("tmpfs", folder.c_str(), "tmpfs", 0, "size=128k") == 0;
    ::_exit(made ? work() : 77);
  }
  int status = 0;
  ::waitpid(child, &status, 0);
  if (WIFEXITED(status) && WEXITSTATUS(status) == 77) return -1;
  return WIFEXITED(status) ? WEXITSTATUS(status) : -2;
}

// Claim: on a real disk that fills up the old picture stays, nothing lies beside it, and it is said with exit
// 3; a full cache costs no picture. Only root may make such a disk, of 128 KiB: where that is not allowed,
// this says so, and CliFailures.FullDiskKeepsTheOldFile and CliCache.FullDiskCostsNoPicture alone check it,
// by a limit on the files' size. Fails if: a failed write or flush is not looked at.
TEST(CliFullDisk, KeepsTheOldFile) {
  const SceneFolder folder;
  const std::string disk = folder.file("disk"), out = disk + "/a.exr", cache = disk + "/cache";
  std::filesystem::create_directory(disk);
  const int result = with_small_disk(disk, [&] {
    put_bytes(out, "old");
    const Outcome full = run_program({"render", folder.scene, "-o", out, "--quiet", "--method", "lambert",
                                      "--resolution", "256x256", "--set", "film.pixel_type=float"});
    if (full.exit_code != 3 || !contains(full.err, "No space left")) return 1;
    if (bytes_of(out) != "old") return 2;
    if (std::distance(std::filesystem::directory_iterator(disk), {}) != 1) return 3;
    const Outcome cached = run_program({"render", folder.scene, "-o", folder.file("b.exr"), "--set",
                                        "settings.samples=9000", "--cache", cache});
    if (cached.exit_code != 0 || !contains(cached.err, "not all results were stored")) return 4;
    return run_program({"cache", "verify", cache}).exit_code == 0 ? 0 : 5;
  });
  if (result == -1) {
    std::fprintf(stderr, "no disk may be mounted here (%s): not checked on one\n", std::strerror(EPERM));
    return;
  }
  EXPECT_EQ(result, 0);
}

}  // namespace
}  // namespace opaline
