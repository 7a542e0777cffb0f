// SPDX-License-Identifier: GPL-3.0-or-later
// The dual tree takes queries in groups: whom a query is grouped with changes its exitance by no more than
// the tolerance.
#include <limits>

#include "exitance/accuracy.h"

namespace opaline {
namespace {

using namespace test;

constexpr double kTolerance = .005;

/// The bunny under a coloured light with a hard shadow.
struct LitBunny {
  Cloud cloud{bunny_file(), 20000};
  std::vector<Query> queries = Cloud(bunny_file(), 600, 3).queries();
  Octree octree = cloud.tree(coloured_light);
  SplitKernel kernel = cloud.kernel(make_diffuse_profile(marble()));
  std::vector<Exitance> exact = brute_force(octree, kernel, queries);

  std::vector<Exitance> run(const std::vector<Query>& places) const {
    return dual_tree(octree, kernel, places, kTolerance);
  }
};

const LitBunny& bunny() {
  static const LitBunny setup;
  return setup;
}

// Claim: shuffled, every query keeps its exitance within the tolerance. Source: evaluate.h. Tolerance: the
// promise, against each other and against brute force. Fails if: results are stored in the order of the
// packets.
TEST(DualTreeCompany, OrderDoesNotMatter) {
  const std::vector<Query>& queries = bunny().queries;
  const std::vector<Exitance> reference = bunny().run(queries);
  for (const std::uint64_t seed : {1u, 2u}) {
    std::vector<std::size_t> order(queries.size());
    std::iota(order.begin(), order.end(), std::size_t(0));
    for (std::size_t i = order.size(); i > 1; --i) std::swap(order[i - 1], order[hash_bits(seed, i) % i]);
    std::vector<Query> shuffled;
    for (const std::size_t i : order) shuffled.push_back(queries[i]);
    const std::vector<Exitance> mixed = bunny().run(shuffled);
    std::vector<Exitance> values(queries.size());
    for (std::size_t i = 0; i < order.size(); ++i) values[order[i]] = mixed[i];
    EXPECT_LE(worst_accuracy(values, reference).p99, kTolerance);
    EXPECT_LE(worst_accuracy(values, bunny().exact).p99, kTolerance);
  }
}

// Claim: a query alone, seventeen (one packet and one lane) and the crowd agree within the tolerance. Source:
// evaluate.h. Tolerance: the promise. Fails if: the lanes of a packet that is not full all repeat its first
// query.
TEST(DualTreeCompany, AloneAndInACrowd) {
  const std::vector<Query>& queries = bunny().queries;
  const std::vector<Exitance> crowd = bunny().run(queries);
  for (const std::size_t together : {1u, 17u}) {
    std::vector<Exitance> values;
    for (std::size_t i = 0; i < queries.size(); i += together) {
      const std::size_t end = std::min(queries.size(), i + together);
      const std::vector<Exitance> part =
          bunny().run({queries.begin() + std::ptrdiff_t(i), queries.begin() + std::ptrdiff_t(end)});
      values.insert(values.end(), part.begin(), part.end());
    }
    const Accuracy apart = worst_accuracy(values, crowd);
    report("in groups of " + std::to_string(together) + ", p99 %", 100 * apart.p99);
    EXPECT_LE(apart.p99, kTolerance) << together;
    EXPECT_LE(worst_accuracy(values, bunny().exact).p99, kTolerance) << together;
  }
}

// Claim: queries at NaN of either sign, at infinity and up to 3e38 mm away give 0 (as brute force does), and
// leave the others within the tolerance. Source: the contract; a NaN with its sign bit set finds no place in
// the far kernel's table. Tolerance: none for the zeros; the promise for the others. Fails if: queries that
// are not finite are not set apart.
TEST(DualTreeCompany, QueriesFromNowhere) {
  constexpr float kInfinity = std::numeric_limits<float>::infinity(),
                  kNan = std::numeric_limits<float>::quiet_NaN();
  const std::vector<Vec3f> nowhere = {
      {kNan, 0, 0},           {0, -kNan, 0},      {-kNan, -kNan, -kNan},
      {kInfinity, 0, 0},      {0, -kInfinity, 0}, {-kInfinity, kInfinity, kNan},
      {1e6f, 0, 0},           {-1e15f, 1e15f, 0}, {0, 0, 3e38f},
      {-3e38f, 3e38f, 3e38f}, {1e25f, 1e-30f, 0}};
  for (const bool all_at_once : {false, true})
    for (std::size_t kind = 0; kind < (all_at_once ? 1 : nowhere.size()); ++kind) {
      std::vector<Query> places;
      std::vector<std::size_t> odd;
      for (std::size_t i = 0; i < bunny().queries.size(); ++i) {
        if (i % 50 == 7) {
          odd.push_back(places.size());
          places.push_back({nowhere[all_at_once ? odd.size() % nowhere.size() : kind], {0, 1, 0}});
        }
        places.push_back(bunny().queries[i]);
      }
      std::vector<Exitance> values = bunny().run(places);
      for (std::size_t i = odd.size(); i-- > 0;) {
        const Vec3f& p = places[odd[i]].position;
        ASSERT_EQ(values[odd[i]].exitance, RgbF(0)) << p.x << " " << p.y << " " << p.z;
        ASSERT_EQ(values[odd[i]].irradiance, RgbF(0)) << p.x << " " << p.y << " " << p.z;
        values.erase(values.begin() + std::ptrdiff_t(odd[i]));
      }
      EXPECT_LE(worst_accuracy(values, bunny().exact).p99, kTolerance) << (all_at_once ? -1 : int(kind));
    }
  const std::vector<Query> none_at_home(40, Query{{kNan, kNan, kNan}, {0, 1, 0}});
  for (const Exitance& e : bunny().run(none_at_home)) EXPECT_EQ(e.exitance, RgbF(0));
}

// Claim: queries from the surface out to a hundred times its size, a few at a time, are brute force's.
// Source: the contract. Tolerance: the promise. Fails if: results are stored in the order of the packets.
TEST(DualTreeCompany, QueriesFartherAndFarther) {
  std::vector<Query> places = bunny().queries;
  for (std::size_t i = 0; i < places.size(); ++i) places[i].position *= std::exp2(float(i % 8));
  const std::vector<Exitance> exact = brute_force(bunny().octree, bunny().kernel, places);
  EXPECT_LE(worst_accuracy(bunny().run(places), exact).p99, kTolerance);
}

}  // namespace
}  // namespace opaline
