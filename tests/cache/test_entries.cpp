// SPDX-License-Identifier: GPL-3.0-or-later
// What comes back from the disk is what went there, or nothing.
#include <hdf5.h>

#include "support/cache_test.h"

namespace opaline {
namespace {

using namespace test;

const StageKey kKey{0x0123456789abcdef, 0xfedcba9876543210};
const std::vector<std::uint32_t> kOthers{0, 9};
const std::string kName = "samples-0123456789abcdeffedcba9876543210.h5";

// Claim: every stage's result comes back bit for bit, by another object and under other mesh
// numbers. Source: stage_cache.h. Tolerance: none. Fails if: a member is left out of its HDF5 type, or the
// meshes are kept by their numbers in the world.
TEST(CacheEntries, RoundTrip) {
  const ScratchFolder folder;
  for (const std::uint32_t count : {1u, 5000u, 50000u}) {
    const SurfaceSamples samples = some_samples(count);
    const LightTransfer light = some_light(count);
    const Octree octree = some_octree(count);
    StageCache writer(folder.path.string()), reader(folder.path.string());
    writer.keep(kKey, samples, SamplesCodec{surface_of(0)});
    writer.keep(kKey, light, LightCodec{0});
    writer.keep(kKey, octree, OctreeCodec{samples});
    const auto same = reader.find(kKey, SamplesCodec{surface_of(count)});
    ASSERT_TRUE(same) << reader.warning();
    EXPECT_TRUE(same_bytes(samples.samples, same->samples));
    EXPECT_EQ(samples.area, same->area);
    EXPECT_EQ(samples.radius, same->radius);
    const auto renumbered = reader.find(kKey, SamplesCodec{surface_of(count, kOthers)});
    ASSERT_TRUE(renumbered);
    for (std::size_t i = 0; i < count; ++i) ASSERT_EQ(renumbered->samples[i].mesh, i % 3 == 0 ? 0u : 9u);
    const auto same_light = reader.find(kKey, LightCodec{count});
    ASSERT_TRUE(same_light);
    EXPECT_TRUE(same_bytes(light.weights, same_light->weights));
    EXPECT_EQ(light.relative_error, same_light->relative_error);
    const auto tree = reader.find(kKey, OctreeCodec{samples});
    ASSERT_TRUE(tree);
    EXPECT_TRUE(same_bytes(octree.nodes, tree->nodes));
    EXPECT_TRUE(same_bytes(octree.samples, tree->samples));
    EXPECT_TRUE(same_bytes(octree.normals, tree->normals));
    EXPECT_EQ(octree.flux_unit, tree->flux_unit);
    const SurfaceCache exitance = some_exitance(count);
    writer.keep(kKey, exitance, SurfaceCacheCodec{some_world(), kMeshes});
    const auto cache = reader.find(kKey, SurfaceCacheCodec{some_world(), kOthers});
    ASSERT_TRUE(cache);
    ASSERT_EQ(cache->splits.size(), 12u);
    EXPECT_TRUE(same_bytes(exitance.splits[4], cache->splits[0]));
    EXPECT_TRUE(same_bytes(exitance.splits[2], cache->splits[9]));
    EXPECT_EQ(exitance.own_irradiance, cache->own_irradiance);
    EXPECT_TRUE(same_bytes(exitance.patches, cache->patches));
    EXPECT_TRUE(same_bytes(exitance.vertices, cache->vertices));
    EXPECT_TRUE(same_bytes(exitance.lattices, cache->lattices));
    EXPECT_TRUE(same_bytes(exitance.lattice_nodes, cache->lattice_nodes));
    EXPECT_TRUE(same_bytes(exitance.nodes, cache->nodes));
    EXPECT_EQ(writer.warning() + reader.warning(), "");
    EXPECT_EQ(folder.entries(), 5u);  // and the lock
  }
}

// Claim: the same result makes the same file. Source: the design ("Bits do not move"). Fails if: HDF5 stamps
// the time into its data sets.
TEST(CacheEntries, SameBytes) {
  const ScratchFolder one, two;
  StageCache(one.path.string()).keep(kKey, some_samples(1000), SamplesCodec{surface_of(0)});
  std::this_thread::sleep_for(std::chrono::milliseconds(1100));  // HDF5's clock has seconds
  StageCache(two.path.string()).keep(kKey, some_samples(1000), SamplesCodec{surface_of(0)});
  EXPECT_FALSE(bytes_of(one.file(kName)).empty());
  EXPECT_TRUE(bytes_of(one.file(kName)) == bytes_of(two.file(kName)));
}

// Claim: an entry is an HDF5 file that other tools open. Source: HDF5's user block. Fails if: the header
// stands where HDF5 does not look past it.
TEST(CacheEntries, IsPlainHdf5) {
  const ScratchFolder folder;
  StageCache(folder.path.string()).keep(kKey, some_samples(10), SamplesCodec{surface_of(0)});
  const std::string path = folder.file(kName);
  ASSERT_GT(H5Fis_hdf5(path.c_str()), 0);
  const hid_t file = H5Fopen(path.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT),
              set = H5Dopen2(file, "area", H5P_DEFAULT);
  double area = 0;
  EXPECT_GE(H5Dread(set, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, &area), 0);
  EXPECT_EQ(area, some_samples(10).area);
  H5Dclose(set);
  H5Fclose(file);
}

/// An entry of 12k samples, .7 MB, and ways to spoil it.
struct Spoiled : ScratchFolder {
  std::string entry = file(kName), whole;
  Spoiled() {
    StageCache(path.string()).keep(kKey, some_samples(12000), SamplesCodec{surface_of(0)});
    whole = bytes_of(entry);
  }
  /// What is said of these bytes; "" if they are taken for samples.
  std::string said_of(const std::string& bytes) const {
    put_bytes(entry, bytes);
    StageCache cache(path.string());
    return cache.find(kKey, SamplesCodec{surface_of(12000)}) ? "" : cache.warning();
  }
};

// Claim: one bit flipped anywhere is noticed before the file is parsed, and the warning names the file.
// Source: stage_cache.h; here also every byte of the header. Tolerance: none.
// Fails if: the hash leaves something out; the header's zeros are not compared.
TEST(CacheEntries, FlippedBits) {
  const Spoiled spoiled;
  ASSERT_EQ(spoiled.said_of(spoiled.whole), "");
  std::size_t checked = 0;
  const auto expect_noticed = [&](std::size_t at) {
    std::string bytes = spoiled.whole;
    bytes[at] = char(bytes[at] ^ (1 << (at % 8)));
    const std::string said = spoiled.said_of(bytes);
    ASSERT_NE(said.find(kName + ' '), std::string::npos) << "byte " << at << ": " << said;
    ++checked;
  };
  for (std::size_t at = 0; at < 1024; ++at) expect_noticed(at);
  for (std::size_t at = 1024; at < spoiled.whole.size(); at += 4096) expect_noticed(at);
  expect_noticed(spoiled.whole.size() - 1);
  EXPECT_GT(checked, 1180u);
}

// Claim: what is not this entry is said by name and reason and not parsed. Source: stage_cache.h. Fails if: a
// reason is lost, or HDF5 is asked first (its own file without a header is foreign).
TEST(CacheEntries, NotThisEntry) {
  const Spoiled spoiled;
  const std::string& whole = spoiled.whole;
  const auto with = [&](const std::string& from, const std::string& to) {
    std::string bytes = whole;
    return bytes.replace(bytes.find(from), from.size(), to);
  };
  const struct {
    std::string bytes, reason;
  } lines[] = {
      {"", "is truncated"},
      {whole.substr(0, 1023), "is truncated"},
      {whole.substr(0, 1024), "is truncated"},
      {whole.substr(0, whole.size() / 2), "is truncated"},
      {whole.substr(0, whole.size() - 1), "is truncated"},
      {whole + 'x', "is damaged"},
      {whole.substr(1024), "is not a cache entry"},
      {std::string(5000, '\0'), "is not a cache entry"},
      {"PNG" + whole, "is not a cache entry"},
      {with("format 4", "format 3"), "does not have this program's version"},
      {with("stage samples", "stage light  "), "is damaged"},
      {with("0123456789abcdef", "0000000000000000"), "is damaged"},
  };
  for (const auto& line : lines) {
    const std::string said = spoiled.said_of(line.bytes);
    EXPECT_NE(said.find(kName + ' ' + line.reason), std::string::npos) << line.reason << ": " << said;
  }
  std::filesystem::remove(spoiled.entry);
  std::filesystem::create_directory(spoiled.entry);
  StageCache cache(spoiled.path.string());
  EXPECT_FALSE(cache.find(kKey, SamplesCodec{surface_of(12000)}));
  EXPECT_NE(cache.warning().find("is not a regular file"), std::string::npos) << cache.warning();
}

// Claim: several bad entries are one warning, and each is replaced by the next result. Source: stage_cache.h.
// Fails if: keep leaves an entry that exists.
TEST(CacheEntries, BadOnesAreReplaced) {
  const Spoiled spoiled;
  put_bytes(spoiled.entry, "x");
  put_bytes(spoiled.file("light" + kName.substr(7)), "y");
  StageCache cache(spoiled.path.string());
  EXPECT_FALSE(cache.find(kKey, SamplesCodec{surface_of(12000)}));
  EXPECT_FALSE(cache.find(kKey, LightCodec{1}));
  EXPECT_FALSE(cache.find(kKey, OctreeCodec{{}}));  // there is none: nothing to say
  EXPECT_EQ(cache.warning(), "cache " + spoiled.path.string() + ": " + kName + " is truncated, light" +
                                 kName.substr(7) + " is truncated; computed again");
  cache.keep(kKey, some_samples(12000), SamplesCodec{surface_of(0)});
  EXPECT_TRUE(bytes_of(spoiled.entry) == spoiled.whole);
}

}  // namespace
}  // namespace opaline
