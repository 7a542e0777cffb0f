// SPDX-License-Identifier: GPL-3.0-or-later
// Entries that are whole, with the right name and hash, and hold what their key cannot stand for: made by
// hand, or by a program at fault.
#include <functional>
#include <limits>

#include "cache/content_hash.h"
#include "cache/entry_header.h"
#include "support/cache_test.h"

namespace opaline {
namespace {

using namespace test;

constexpr std::size_t kCount = 600;
constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
const StageKey kForgedKey{1, 2};

/// Whether it is found after it was kept.
bool is_believed(const SurfaceSamples& samples) {
  const ScratchFolder folder;
  StageCache cache(folder.path.string());
  cache.keep(kForgedKey, samples, SamplesCodec{surface_of(0)});
  return cache.find(kForgedKey, SamplesCodec{surface_of(kCount)}).has_value();
}
bool is_believed(const LightTransfer& light) {
  const ScratchFolder folder;
  StageCache cache(folder.path.string());
  cache.keep(kForgedKey, light, LightCodec{0});
  return cache.find(kForgedKey, LightCodec{kCount}).has_value();
}
bool is_believed(const Octree& tree) {
  const ScratchFolder folder;
  StageCache cache(folder.path.string());
  cache.keep(kForgedKey, tree, OctreeCodec{some_samples(0)});
  return cache.find(kForgedKey, OctreeCodec{some_samples(kCount)}).has_value();
}
bool is_believed(const SurfaceCache& exitance) {
  const ScratchFolder folder;
  StageCache cache(folder.path.string());
  cache.keep(kForgedKey, exitance, SurfaceCacheCodec{some_world(), kMeshes});
  return cache.find(kForgedKey, SurfaceCacheCodec{some_world(), kMeshes}).has_value();
}

/// None of the changes to a result that is believed is.
template <class Result>
void expect_refused(const Result& result, const std::vector<std::function<void(Result&)>>& changes) {
  EXPECT_TRUE(is_believed(result));
  for (std::size_t i = 0; i < changes.size(); ++i) {
    Result changed = result;
    changes[i](changed);
    EXPECT_FALSE(is_believed(changed)) << "change " << i;
  }
}

// Claim: samples that lie elsewhere than their triangles say, are too many, or do not share the surface's
// area are not used. Fails if: a line of are_samples_of goes.
TEST(CacheForged, Samples) {
  using S = SurfaceSamples;
  expect_refused<S>(some_samples(kCount), {
                                              [](S& s) { s.samples.clear(); },
                                              [](S& s) { s.samples.resize(kCount / 2); },
                                              [](S& s) { s = some_samples(20 * kCount); },
                                              [](S& s) { s.samples[3].mesh = 11; },
                                              [](S& s) { s.samples[3].triangle = kTriangles; },
                                              [](S& s) { s.samples[3].triangle += 1; },
                                              [](S& s) { s.samples[3].u = 2; },
                                              [](S& s) { s.samples[3].v = kNan; },
                                              [](S& s) { s.samples[3].position.x += 1; },
                                              [](S& s) { s.samples[3].normal = -s.samples[3].normal; },
                                              [](S& s) { s.samples[3].area = -1; },
                                              [](S& s) { s.samples[3].area *= 100; },
                                              [](S& s) { s.samples[3].centroid.y = kNan; },
                                              [](S& s) { s.area *= 2; },
                                              [](S& s) { s.area = double(kNan); },
                                              [](S& s) { s.radius = 0; },
                                          });
}

// Claim: light for another number of samples, or of no amount, is not used. Fails if: a line of is_light_of
// goes.
TEST(CacheForged, Light) {
  using L = LightTransfer;
  expect_refused<L>(some_light(kCount), {
                                            [](L& l) { l.weights.pop_back(); },
                                            [](L& l) { l.weights.push_back(1); },
                                            [](L& l) { l.weights.clear(); },
                                            [](L& l) { l.weights[7] = -1; },
                                            [](L& l) { l.weights[7] = kNan; },
                                            [](L& l) { l.relative_error = -1; },
                                            [](L& l) { l.relative_error = double(kNan); },
                                        });
}

// Claim: trees whose nodes are none, which would end the walk outside of them, in a ring or never, are not
// used. Fails if: a line of is_tree_of goes.
TEST(CacheForged, Octree) {
  using T = Octree;
  const auto chain = [](T& t) {  // each node the only child of the one before
    OctreeNode node = t.nodes[0];
    t.nodes.assign(kCount, node);
    for (OctreeNode& n : t.nodes) n.skip = kCount;
    t.nodes.back().leaf = true;
  };
  expect_refused<T>(some_octree(kCount),
                    {
                        chain,
                        [](T& t) { t = Octree{}; },
                        [](T& t) { t.nodes.clear(); },
                        [](T& t) { t.nodes.pop_back(); },
                        [](T& t) { t.nodes.insert(t.nodes.end(), 5000, t.nodes.back()); },
                        [](T& t) { t.samples.pop_back(); },
                        [](T& t) { t.normals.pop_back(); },
                        [](T& t) { t.nodes[0].skip = 1; },
                        [](T& t) { t.nodes[1].skip = 1; },
                        [](T& t) { t.nodes[1].skip = 0; },
                        [](T& t) { t.nodes[1].skip = ~0u; },
                        [](T& t) { t.nodes[1].first = 5; },
                        [](T& t) { t.nodes[1].count += 1; },
                        [](T& t) { t.nodes[0].count = ~0u; },
                        [](T& t) { t.nodes[0].leaf = true; },
                        [](T& t) { t.nodes.back().leaf = false; },
                        [](T& t) { std::memset(&t.nodes[2].leaf, 2, 1); },
                        [](T& t) { t.nodes[2].x[1] = kNan; },
                        [](T& t) { t.nodes[2].half.x = -1; },
                        [](T& t) { t.nodes[2].flux[0] = -1; },
                        [](T& t) { t.nodes[0].flux[3] *= 3; },
                        [](T& t) { t.samples[2].flux[0] = kNan; },
                        [](T& t) { t.normals[2].x = kNan; },
                        [](T& t) { t.flux_unit = 0; },
                        [](T& t) { t.flux_unit = kNan; },
                    });
}

// Claim: exitance with places or nodes that are not there is not used. Fails if: a line of is_exitance_of
// goes.
TEST(CacheForged, Exitance) {
  using E = SurfaceCache;
  expect_refused<E>(some_exitance(50),
                    {
                        [](E& e) { e.splits[4].pop_back(); },
                        [](E& e) {
                          e.splits[2].push_back({0, 1});
                        },
                        [](E& e) { e.splits[4].back().first += 1; },
                        [](E& e) { e.splits[4][3].segments = 65537; },
                        [](E& e) { e.patches.pop_back(); },
                        [](E& e) { e.patches[2].vertices[1] = 50; },
                        [](E& e) { e.patches[2].lattice = std::uint32_t(e.lattices.size()); },
                        [](E& e) { e.vertices.clear(); },
                        [](E& e) { e.lattices.back().first += 1; },
                        [](E& e) { e.lattices[0].segments = 3; },
                        [](E& e) { e.lattices[0].segments = 0; },
                        [](E& e) { e.lattices[0].segments = 65538; },
                        [](E& e) { e.lattice_nodes[4] = 50; },
                        [](E& e) { e.nodes.pop_back(); },
                        [](E& e) { e.nodes[4].near.y = kNan; },
                        [](E& e) { e.vertices[4].slope[1].x = kNan; },
                        [](E& e) { e.own_irradiance[1] = kNan; },
                    });
}

/// Bytes with this listing in front, under the name and with the hash that make them whole.
std::string entry_of(const EntryName& name, const std::string& listing, const std::string& payload) {
  ContentHash hash;
  hash.add(listing.data(), listing.size());
  hash.add(payload.data(), payload.size());
  std::string header = header_text(name, listing, payload.size(), hash.value());
  header.resize(std::max<std::size_t>(header.size(), kUserBlock));
  return header + payload;
}

// Claim: whatever a header says of its data sets, none is read from outside the file, and their numbers have
// no memory taken. Fails if: an offset or a product of count and size is not compared with the file's length,
// or wraps.
TEST(CacheForged, Listing) {
  const EntryName name{"light", kForgedKey};
  const std::string bytes(4 * kCount + 16, '\0'),
      error = "relative_error 1 x 8 at 3424\nedge_shift 1 x 8 at 3432\n";
  const ScratchFolder folder;
  const auto is_found = [&](const std::string& listing) {
    put_bytes(folder.file(file_name(name)), entry_of(name, listing, bytes));
    StageCache cache(folder.path.string());
    return cache.find(kForgedKey, LightCodec{kCount}).has_value();
  };
  EXPECT_TRUE(is_found("weights 600 x 4 at 1024\n" + error));
  for (const char* weights : {
           "weights 600 x 4 at 1048\n",
           "weights 600 x 4 at 0\n",
           "weights 600 x 4 at 18446744073709551615\n",
           "weights 600 x 4 at 18446744073709550616\n",
           "weights 4611686018427388504 x 4 at 1024\n",
           "weights 600 x 8 at 1024\n",
           "weights 600 x 0 at 1024\n",
           "weights 601 x 4 at 1024\n",
           "weights 18446744073709551616 x 4 at 1024\n",
           "weights -600 x 4 at 1024\n",
           "weights 600 x 4\n",
           "weights\n",
           " 600 x 4 at 1024\n",
           "",
       })
    EXPECT_FALSE(is_found(weights + error)) << weights;
  EXPECT_FALSE(is_found("weights 600 x 4 at 1024\nrelative_error 0 x 8 at 0\n"));
  EXPECT_FALSE(is_found("weights 600 x 4 at 1024\nrelative_error 300 x 8 at 1024\n"));
  EXPECT_FALSE(is_found(std::string(850, 'a') + "\n"));  // with its hash longer than the header
}

// Claim: an entry of 30 GB that takes no room on the disk is not read. Tolerance: .5 s; reading it takes more
// than 3 s on any machine, and its memory. Fails if: its length is not looked at first.
TEST(CacheForged, SparseEntry) {
  const ScratchFolder folder;
  constexpr std::uint64_t bytes = std::uint64_t(30) << 30;
  for (const char* stage : {"samples", "light", "octree", "exitance"}) {
    const EntryName name{stage, kForgedKey};
    std::string header = header_text(name, "weights 600 x 4 at 1024\n", bytes - kUserBlock, {});
    header.resize(kUserBlock);
    put_bytes(folder.file(file_name(name)), header);
    std::filesystem::resize_file(folder.file(file_name(name)), bytes);
  }
  StageCache cache(folder.path.string());
  const auto start = std::chrono::steady_clock::now();
  EXPECT_FALSE(cache.find(kForgedKey, SamplesCodec{surface_of(kCount)}));
  EXPECT_FALSE(cache.find(kForgedKey, LightCodec{kCount}));
  EXPECT_FALSE(cache.find(kForgedKey, OctreeCodec{some_samples(kCount)}));
  EXPECT_LT(std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count(), .5);
  EXPECT_NE(cache.warning().find("is larger than its result"), std::string::npos) << cache.warning();
}

}  // namespace
}  // namespace opaline
