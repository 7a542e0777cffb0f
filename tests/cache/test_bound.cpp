// SPDX-License-Identifier: GPL-3.0-or-later
// A cache stays as small as it was told to, and loses what was used longest ago.
#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <numeric>

#include "support/cache_test.h"

namespace opaline {
namespace {

using namespace test;

struct BoundedCache : ScratchFolder {
  std::uint64_t one = 0;  // bytes of an entry

  /// Entries 0 to count - 1 of one size, used in that order, minutes ago.
  explicit BoundedCache(std::uint64_t count) {
    StageCache cache(path.string());
    for (std::uint64_t i = 0; i < count; ++i) cache.keep({0, i}, some_light(1000), LightCodec{0});
    const auto now = std::filesystem::file_time_type::clock::now();
    for (std::uint64_t i = 0; i < count; ++i)
      std::filesystem::last_write_time(entry(i), now - std::chrono::minutes(count - i));
    one = std::filesystem::file_size(entry(0));
  }
  std::string entry(std::uint64_t i) const { return file("light-" + hex({0, i}) + ".h5"); }
  std::vector<bool> there(std::uint64_t count) const {
    std::vector<bool> all;
    for (std::uint64_t i = 0; i < count; ++i) all.push_back(std::filesystem::exists(entry(i)));
    return all;
  }
};

// Claim: a new entry makes room for itself; what was read last stays, though written first. Source:
// stage_cache.h ("bounded in size, least recently used"). Fails if: reading does not count as use, or the
// oldest go last.
TEST(CacheBound, LeastRecentlyUsedGo) {
  const BoundedCache folder(4);
  StageCache cache(folder.path.string(), 3 * folder.one);
  ASSERT_TRUE(cache.find({0, 0}, LightCodec{1000}));
  cache.keep({0, 4}, some_light(1000), LightCodec{0});
  EXPECT_EQ(folder.there(5), (std::vector<bool>{true, false, false, true, true}));
  EXPECT_EQ(cache.warning(), "");
}

// Claim: an entry larger than the bound is not kept, which is said; what is there stays, and smaller ones
// still find their way in. Fails if: it is written and all others go for it.
TEST(CacheBound, LargerThanAll) {
  const BoundedCache folder(3);
  StageCache cache(folder.path.string(), 4 * folder.one);
  cache.keep({0, 9}, some_light(100000), LightCodec{0});
  cache.keep({0, 3}, some_light(1000), LightCodec{0});
  EXPECT_EQ(folder.there(4), (std::vector<bool>{true, true, true, true}));
  EXPECT_FALSE(std::filesystem::exists(folder.entry(9)));
  EXPECT_NE(cache.warning().find("larger than the maximum cache size"), std::string::npos);
}

// Claim: what has an entry's name and is a folder, a pipe or a link, dangling or not, is listed as bad and
// not waited for, and a new entry takes the place of a link, not of its target. Fails if: listing asks for
// the size of what a name leads to, or opening follows it.
TEST(CacheBound, NotRegularFiles) {
  const BoundedCache folder(1);
  std::filesystem::create_directory(folder.entry(1));
  ASSERT_EQ(::mkfifo(folder.entry(2).c_str(), 0600), 0);
  std::filesystem::create_symlink("nothing", folder.entry(3));
  std::filesystem::create_symlink(folder.entry(0), folder.entry(4));
  const std::vector<CacheEntry> entries = list_cache(folder.path.string());
  ASSERT_EQ(entries.size(), 5u);
  int bad = 0;
  for (const CacheEntry& entry : entries)
    bad += problem_of(folder.path.string(), entry) == "is not a regular file" ? 1 : 0;
  EXPECT_EQ(bad, 4);
  StageCache cache(folder.path.string());
  for (std::uint64_t i = 1; i < 5; ++i) EXPECT_FALSE(cache.find({0, i}, LightCodec{1000})) << i;
  cache.keep({0, 3}, some_light(10), LightCodec{0});
  EXPECT_TRUE(std::filesystem::is_regular_file(std::filesystem::symlink_status(folder.entry(3))));
  EXPECT_FALSE(std::filesystem::exists(folder.file("nothing")));
  prune_cache(folder.path.string(), 0);
  EXPECT_TRUE(std::filesystem::is_directory(folder.entry(1)));
}

// Claim: where another process keeps the lock, a run waits for a second once, says so, and goes on; pruning
// by itself waits, and asks. Fails if: either waits for the lock without a word.
TEST(CacheBound, HeldLock) {
  const BoundedCache folder(3);
  const int lock = ::open(folder.file(".opaline-lock").c_str(), O_RDWR | O_CREAT, 0600);
  ASSERT_EQ(::flock(lock, LOCK_EX), 0);
  StageCache cache(folder.path.string(), 3 * folder.one);
  cache.keep({0, 3}, some_light(1000), LightCodec{0});
  cache.keep({0, 4}, some_light(1000), LightCodec{0});
  EXPECT_NE(cache.warning().find("locked by another process"), std::string::npos) << cache.warning();
  EXPECT_EQ(folder.there(5), (std::vector<bool>{true, true, true, true, true}));
  int asked = 0;
  EXPECT_TRUE(prune_cache(folder.path.string(), 0, [&] { return ++asked < 3; }).empty());
  EXPECT_EQ(asked, 3);
  ::close(lock);
  EXPECT_EQ(prune_cache(folder.path.string(), 0, [] { return false; }).size(), 5u);
}

// Claim: pruning leaves at most the bytes asked for, the latest used, and other people's files. Source:
// cache_folder.h. Fails if: the sum leaves an entry out, or names are not looked at.
TEST(CacheBound, Prune) {
  const BoundedCache folder(6);
  put_bytes(folder.file("light-notes.h5"), "mine");
  put_bytes(folder.file("holiday.png"), "mine");
  const std::vector<CacheEntry> removed = prune_cache(folder.path.string(), 2 * folder.one + folder.one / 2);
  EXPECT_EQ(removed.size(), 4u);
  EXPECT_EQ(folder.there(6), (std::vector<bool>{false, false, false, false, true, true}));
  EXPECT_EQ(folder.entries(), 2u + 2u + 1u);
  prune_cache(folder.path.string(), 0);
  EXPECT_TRUE(list_cache(folder.path.string()).empty());
  EXPECT_EQ(bytes_of(folder.file("light-notes.h5")), "mine");
}

}  // namespace
}  // namespace opaline
