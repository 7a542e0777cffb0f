// SPDX-License-Identifier: GPL-3.0-or-later
// Queries in chunks and packets of neighbours.
#include <numeric>

#include "exitance/query_order.h"
#include "exitance/simd/lanes.h"
#include "support/clouds.h"

namespace opaline {
namespace {

using namespace test;

/// Cuts the first `count` queries; every one must be in one packet.
PacketCut cut_whole(std::vector<Query> queries, std::vector<std::uint32_t>& order, float reach) {
  order.resize(queries.size());
  std::iota(order.begin(), order.end(), 0u);
  const PacketCut cut = sort_into_packets(order, queries, reach);
  std::vector<std::uint32_t> sorted = order;
  std::ranges::sort(sorted);
  for (std::uint32_t i = 0; i < sorted.size(); ++i) EXPECT_EQ(sorted[i], i);
  std::size_t sum = 0;
  for (std::size_t p = 0; p < cut.packets; ++p) {
    EXPECT_GT(cut.counts[p], 0);
    EXPECT_LE(cut.counts[p], kLanes);
    sum += cut.counts[p];
  }
  EXPECT_EQ(sum, queries.size());
  return cut;
}

// Claim: every query of a chunk stands in exactly one packet, 1 to 16 in each, 32 packets at most:
// neighbours, all at one point, far apart, one to 256 of them. Source: query_order.h. Tolerance: none. Fails
// if: a packet is cut after the last of the 32.
TEST(QueryOrder, PacketsHoldEveryQueryOnce) {
  const std::vector<Query> near = Cloud(SphereShape{{}, 5}, 3000).queries();
  for (const std::size_t n : {1u, 2u, 15u, 16u, 17u, 100u, 255u, 256u})
    for (const float reach : {1e-6f, .1f, 100.f}) {
      std::vector<std::uint32_t> order;
      cut_whole({near.begin(), near.begin() + std::ptrdiff_t(n)}, order, reach);
      cut_whole(std::vector<Query>(n, near[0]), order, reach);
      std::vector<Query> apart;
      for (std::size_t i = 0; i < n; ++i)
        apart.push_back(
            {Vec3f{float(i * 7919 % 256), float(i * 104729 % 251), float(i % 3)} * 1e30f, {0, 1, 0}});
      EXPECT_LE(cut_whole(apart, order, reach).packets, PacketCut::kMost);
    }
}

// Claim: eight queries here and eight far away make two packets; sixteen within reach of each other make one.
// Source: query_order.h. Tolerance: none. Fails if: packets are cut at the middle alone.
TEST(QueryOrder, ScatteredPacketsAreCut) {
  std::vector<Query> queries;
  for (int i = 0; i < 16; ++i)
    queries.push_back({{.1f * float(i % 8) + (i % 2 == 0 ? 50.f : 0.f), 0, 0}, {0, 1, 0}});
  std::vector<std::uint32_t> order;
  const PacketCut cut = cut_whole(queries, order, 1);
  ASSERT_EQ(cut.packets, 2u);
  EXPECT_EQ(cut.counts[0], 8);
  for (int i = 0; i < 8; ++i) EXPECT_LT(queries[order[std::size_t(i)]].position.x, 10);
  EXPECT_EQ(cut_whole(queries, order, 100).packets, 1u);
}

// Claim: chunks of 256 neighbours: on a sphere of 20,000 queries the mean radius of a chunk's box is at
// most 1.8 times that of a square of its share of the area. Source: a space-filling curve. Tolerance: as
// measured (1.46) and a quarter. Fails if: the keys are of the first two coordinates alone.
TEST(QueryOrder, ChunksAreCompact) {
  std::vector<Query> queries = Cloud(SphereShape{{}, 10}, 20000).queries();
  for (std::size_t i = queries.size(); i > 1; --i) std::swap(queries[i - 1], queries[hash_bits(1, i) % i]);
  queries[7].position.x = std::nanf("");
  const std::vector<std::uint32_t> order = chunk_order(queries);
  ASSERT_EQ(order.size(), queries.size() - 1);
  double mean = 0;
  const std::size_t chunks = order.size() / kChunk;
  for (std::size_t c = 0; c < chunks; ++c) {
    Vec3f low = queries[order[c * kChunk]].position, high = low;
    for (std::size_t i = 0; i < kChunk; ++i) {
      low = component_min(low, queries[order[c * kChunk + i]].position);
      high = component_max(high, queries[order[c * kChunk + i]].position);
    }
    mean += double(length(high - low)) / 2 / double(chunks);
  }
  const double side = std::sqrt(4 * kPi * 100 * kChunk / double(order.size()));
  report("radius of chunks over a square's", mean / (side * std::sqrt(.5)));
  EXPECT_LT(mean, 1.8 * side * std::sqrt(.5));
}

// Claim: an order in which chunks are compact already, tile by tile as a picture has them, is kept. Source:
// query_order.cpp: it is as good, and the queries are read in the order of memory. Tolerance: none. Fails if:
// every order is sorted.
TEST(QueryOrder, TilesStayAsTheyAre) {
  std::vector<Query> queries;
  for (int tile = 0; tile < 64; ++tile)
    for (int i = 0; i < int(kChunk); ++i)
      queries.push_back({{float(tile % 8 * 16 + i % 16), 0, float(tile / 8 * 16 + i / 16)}, {0, 1, 0}});
  const std::vector<std::uint32_t> order = chunk_order(queries);
  for (std::uint32_t i = 0; i < order.size(); ++i) ASSERT_EQ(order[i], i);
}

}  // namespace
}  // namespace opaline
