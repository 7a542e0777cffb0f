// SPDX-License-Identifier: GPL-3.0-or-later
// A cache stays as small as it was told to, and loses what was used longest ago.
#include <numeric>

#include "cache_test.h"

namespace opaline {
namespace {

using namespace test;

struct BoundedCache : ScratchFolder {
  std::uint64_t one = 0;  // bytes of an entry

  /// Entries 0 to count - 1 of one size, used in that order, minutes ago.
  explicit BoundedCache(std::uint64_t count) {
    StageCache cache(path.string());
    for (std::uint64_t i = 0; i < count; ++i) cache.keep_light({0, i}, some_light(1000));
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

// Claim: a new entry makes room for itself; what was read last stays, though written first. Source: the issue
// ("bounded in size, least recently used"). Fails if: reading does not count as use, or the oldest go last.
TEST(CacheBound, LeastRecentlyUsedGo) {
  const BoundedCache folder(4);
  StageCache cache(folder.path.string(), 3 * folder.one);
  ASSERT_TRUE(cache.find_light({0, 0}));
  cache.keep_light({0, 4}, some_light(1000));
  EXPECT_EQ(folder.there(5), (std::vector<bool>{true, false, false, true, true}));
  EXPECT_EQ(cache.warning(), "");
}

// Claim: an entry larger than the bound is not kept, which is said. Fails if: it stays as the only one.
TEST(CacheBound, LargerThanAll) {
  const BoundedCache folder(1);
  StageCache cache(folder.path.string(), folder.one / 2);
  cache.keep_light({0, 1}, some_light(1000));
  EXPECT_EQ(folder.there(2), (std::vector<bool>{false, false}));
  EXPECT_NE(cache.warning().find("larger than the whole cache"), std::string::npos);
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
