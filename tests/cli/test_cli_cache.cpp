// SPDX-License-Identifier: GPL-3.0-or-later
// `opaline render --cache` and `opaline cache`.
#include <gtest/gtest.h>

#include <set>
#include <string>
#include <vector>

#include "run_program.h"

namespace opaline {
namespace {

struct CachedScene : SceneFolder {
  std::string cache = file("cache");
  Outcome render(const std::string& name, const std::vector<std::string>& more = {}) const {
    std::vector<std::string> words{"render", scene, "-o", file(name), "--cache", cache, "--log", "json"};
    words.insert(words.end(), more.begin(), more.end());
    return run_program(words);
  }
  /// Files of the cache of one stage.
  std::vector<std::string> entries(const std::string& stage) const {
    std::vector<std::string> found;
    for (const auto& entry : std::filesystem::directory_iterator(cache))
      if (entry.path().filename().string().starts_with(stage)) found.push_back(entry.path().string());
    return found;
  }
};

bool is_all_from_the_cache(const Outcome& outcome) {
  const nlohmann::json decisions = event_of(events_of(outcome.out), "reuse")["decisions"];
  for (const std::string line : decisions)
    if (!line.ends_with("from the cache")) return false;
  return decisions.size() == 3;
}

// Claim: with a cache, cold or warm, the bytes of the pictures are those without; a warm run takes all from
// it, and says so. Source: the help of cache. Fails if: an entry is not found again by another process, or
// the metadata tells of the cache.
TEST(CliCache, WarmRunIsTheSame) {
  const CachedScene folder;
  ASSERT_EQ(run_program({"render", folder.scene, "-o", folder.file("plain.exr"), "--quiet"}).exit_code, 0);
  const Outcome cold = folder.render("cold.exr"), warm = folder.render("warm.exr");
  ASSERT_EQ(cold.exit_code, 0) << cold.out;
  ASSERT_EQ(warm.exit_code, 0) << warm.out;
  EXPECT_FALSE(is_all_from_the_cache(cold));
  EXPECT_TRUE(is_all_from_the_cache(warm));
  const std::string plain = bytes_of(folder.file("plain.exr"));
  EXPECT_FALSE(plain.empty());
  EXPECT_TRUE(bytes_of(folder.file("cold.exr")) == plain);
  EXPECT_TRUE(bytes_of(folder.file("warm.exr")) == plain);
  EXPECT_TRUE(is_all_from_the_cache(folder.render("camera.exr", {"--set", "camera.position=[0,20,40]"})));
  EXPECT_FALSE(is_all_from_the_cache(folder.render("seed.exr", {"--seed", "1"})));
}

// Claim: precompute keeps a scene's volume_diffusion, and a render of it takes the solution from the cache. Source: docs/frames.md.
// Fails if: precompute solves for another method.
TEST(CliCache, PrecomputeSolvesVolumeDiffusion) {
  const CachedScene folder;
  const std::string method = "settings.method=volume_diffusion";
  ASSERT_EQ(run_program({"precompute", folder.scene, "--cache", folder.cache, "--set", method}).exit_code, 0);
  const std::vector<std::string> decisions =
      event_of(events_of(folder.render("a.exr", {"--set", method}).out), "reuse")["decisions"];
  EXPECT_TRUE(std::ranges::any_of(decisions, [](const std::string& decision) {
    return decision.ends_with("diffusion from the cache");
  })) << testing::PrintToString(decisions);
}

// Claim: a cache folder that cannot be looked at is one line that names it and why. By hand: a name longer than file systems
// have, and a link to itself. Fails if: a question about the folder throws an exception of the library's, in its words.
TEST(CliCache, FolderThatCannotBeLookedAt) {
  const CachedScene folder;
  std::filesystem::create_symlink(folder.file("loop"), folder.file("loop"));
  for (const std::string& cache : {folder.file(std::string(300, 'a')), folder.file("loop/cache")})
    for (const std::vector<std::string>& command : std::vector<std::vector<std::string>>{
             {"render", folder.scene, "-o", folder.file("a.exr"), "--cache", cache},
             {"precompute", folder.scene, "--cache", cache},
             {"cache", "ls", cache},
             {"cache", "prune", cache}}) {
      const Outcome outcome = run_program(command);
      EXPECT_EQ(outcome.exit_code, 3);
      EXPECT_TRUE(outcome.err.starts_with("opaline: error: " + cache + ": cannot ")) << outcome.err;
      EXPECT_EQ(std::ranges::count(outcome.err, '\n'), 1) << outcome.err;
    }
}

// Claim: each decision about reuse is told once. Fails if: the three channels of a room in colour, lights of one name, tell
// theirs each.
TEST(CliCache, ARoomsChannelsAreToldOnce) {
  const CachedScene folder;
  const Outcome outcome =
      folder.render("a.exr", {"--environment", OPALINE_SCENES_DIR "/../tests/cli/goldens/room.exr"});
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  const std::vector<std::string> told = event_of(events_of(outcome.out), "reuse")["decisions"];
  EXPECT_FALSE(told.empty());
  EXPECT_EQ(std::set<std::string>(told.begin(), told.end()).size(), told.size());
}

// Claim: a damaged entry is one warning that names it, exit 0, the same picture, and mended. Source: the
// issue. Fails if: the warning is not printed, or damage fails the run.
TEST(CliCache, DamageIsSaidAndMended) {
  const CachedScene folder;
  folder.render("a.exr");
  const std::string entry = folder.entries("samples").at(0), whole = bytes_of(entry);
  put_bytes(entry, whole.substr(0, whole.size() - 1));
  EXPECT_EQ(run_program({"cache", "verify", folder.cache}).exit_code, 1);
  const Outcome outcome = folder.render("b.exr");
  EXPECT_EQ(outcome.exit_code, 0);
  const std::string warning = event_of(events_of(outcome.out), "warning")["message"];
  EXPECT_TRUE(contains(warning, std::filesystem::path(entry).filename().string() + " is truncated"))
      << warning;
  EXPECT_TRUE(bytes_of(folder.file("a.exr")) == bytes_of(folder.file("b.exr")));
  EXPECT_TRUE(bytes_of(entry) == whole);
  EXPECT_EQ(run_program({"cache", "verify", folder.cache}).exit_code, 0);
}

// Claim: a full disk costs the cache, not the picture: exit 0 and a warning. Source: the help of cache. The
// limit holds the EXR of 32 x 32 pixels but not the samples. Fails if: keep throws.
TEST(CliCache, FullDiskCostsNoPicture) {
  const CachedScene folder;
  const Outcome outcome =
      run_program({"render", folder.scene, "-o", folder.file("a.exr"), "--cache", folder.cache, "--set",
                   "settings.samples=20000", "--resolution", "8x8"},
                  ".", {.file_size = 200000, .address_space = {}});
  EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_TRUE(contains(outcome.err, "not all results were stored")) << outcome.err;
  EXPECT_TRUE(std::filesystem::exists(folder.file("a.exr")));
  EXPECT_TRUE(folder.entries("").empty());
}

// Claim: ls names every entry, prune removes what is asked, --cache-size holds during a run. Source:
// `opaline cache --help`. Fails if: sizes are not read as such.
TEST(CliCache, ListAndPrune) {
  const CachedScene folder;
  folder.render("a.exr");
  const Outcome list = run_program({"cache", "ls", folder.cache, "--json"});
  ASSERT_EQ(list.exit_code, 0) << list.err;
  const nlohmann::json entries = nlohmann::json::parse(list.out)["entries"];
  ASSERT_EQ(entries.size(), 3u);
  for (const auto& entry : entries)
    EXPECT_EQ(std::filesystem::file_size(folder.cache + '/' + std::string(entry["file"])), entry["bytes"]);
  EXPECT_TRUE(contains(run_program({"cache", "ls", folder.cache}).out, "3 entries of "));
  EXPECT_EQ(run_program({"cache", "prune", folder.cache, "--size", "1GB"}).out,
            "0 entries removed of 0.0 MB\n");
  EXPECT_EQ(run_program({"cache", "prune", folder.cache, "--size", "0"}).exit_code, 0);
  EXPECT_EQ(run_program({"cache", "ls", folder.cache}).out, "0 entries of 0.0 MB\n");
  EXPECT_TRUE(
      contains(folder.render("b.exr", {"--cache-size", "10KB"}).out, "larger than the maximum cache size"));
}

// Claim: a folder that cannot be is said before the work, exit 3; a command that is none, exit 2. Source: the
// exit codes. Fails if: the scene is rendered first.
TEST(CliCache, BadFolders) {
  const CachedScene folder;
  put_bytes(folder.file("plain"), "x");
  const Outcome outcome =
      run_program({"render", folder.scene, "-o", folder.file("a.exr"), "--cache", folder.file("plain")});
  EXPECT_EQ(outcome.exit_code, 3);
  EXPECT_TRUE(contains(outcome.err, "cannot create the cache folder")) << outcome.err;
  EXPECT_TRUE(outcome.out.empty());
  EXPECT_EQ(run_program({"cache", "ls", folder.file("none")}).exit_code, 3);
  EXPECT_EQ(run_program({"cache", "list", folder.cache}).exit_code, 2);
  EXPECT_EQ(run_program({"cache", "prune", folder.cache, "--size", "much"}).exit_code, 2);
}

}  // namespace
}  // namespace opaline
