// SPDX-License-Identifier: GPL-3.0-or-later
// Media at the ends of their ranges, and input beyond them.
#include <chrono>
#include <functional>
#include <limits>

#include "opaline/error.h"
#include "support/point_source_walks.h"
#include "transport/point_source.h"
#include "volume_test.h"

namespace opaline {
namespace {

using test::expect_walked;
using test::medium_of_albedo;
using test::walks_of_seed;

void expect_finite(const WalkedValue& value, const std::string& what) {
  EXPECT_TRUE(std::isfinite(value.value) && std::isfinite(value.error)) << what;
}

void expect_finite(const SlabWalks& walked, const std::string& what) {
  for (const WalkedValue& value : {walked.absorbed, walked.unfinished, walked.energy})
    expect_finite(value, what);
  for (const WalkedFace& face : {walked.back, walked.through}) {
    for (const WalkedValue& value : {face.total, face.uncollided, face.beyond}) expect_finite(value, what);
    for (const WalkedRing& ring : face.rings)
      for (const WalkedValue& value : {ring.share, ring.within, ring.profile}) expect_finite(value, what);
    for (const WalkedCosine& bin : face.angular_exit) expect_finite(bin.value, what);
  }
  for (const WalkedCosine& bin : walked.albedo_by_entry) expect_finite(bin.value, what);
}

// Claim: no value is NaN or infinite, and energy is kept, for every combination of no absorption, no scattering and
// neither, scattering far forward or backward, boundaries from .75 to 3, half spaces and slabs. Source: conservation of
// energy. Tolerance: five standard errors, for 120 combinations. Fails if: an exponential of the controls overflows, or
// an empty medium's distances become 0 times infinity.
TEST(LaboratoryExtremes, FiniteAndWhole) {
  for (const double sigma_a : {0., .1, 30.})
    for (const double sigma_s : {0., 2.})
      for (const double g : {-.95, 0., .95})
        for (const double eta : {.75, 1., 3.})
          for (const double thickness : {.01, 50., std::numeric_limits<double>::infinity()}) {
            LaboratorySettings settings = walks_of_seed(1024, 3);
            settings.most_collisions = 4000;
            const SlabWalks walked =
                walk_slab({sigma_a, sigma_s, g, eta}, {thickness}, kDiffuseEntry, settings);
            const std::string what = testing::PrintToString(std::array{sigma_a, sigma_s, g, eta, thickness});
            expect_finite(walked, what);
            EXPECT_NEAR(walked.energy.value, 1, 5 * walked.energy.error + 1e-9) << what;
            if (sigma_s == 0 && std::isinf(thickness)) {
              EXPECT_EQ(walked.back.total.value, 0) << what;
            }
          }
}

// Claim: a half space that absorbs nothing sends everything back; walks in it have no mean length, yet end, and what
// they leave inside is told: the share falls as one over the root of the collisions allowed. Source: conservation of
// energy; the survival of a walk in a half space (Sparre Andersen 1953). Tolerance: four standard errors; a factor of
// 1.25 for the ratio of two such shares, which is 2. Fails if: a walk that is given up counts as returned, or a bound
// on the collisions is missing (it then hangs).
TEST(LaboratoryExtremes, WhiteHalfSpace) {
  double before = 0;
  for (const std::uint64_t most : {4000, 16000}) {
    LaboratorySettings settings = walks_of_seed(10000, 4);
    settings.most_collisions = most;
    const SlabWalks walked = walk_slab(medium_of_albedo(1, 1.5), {}, kDiffuseEntry, settings);
    EXPECT_EQ(walked.absorbed.value, 0);
    expect_walked(walked.energy, 1, 1e-6, "energy");
    EXPECT_GT(walked.unfinished.value, 0);
    if (before > 0) {
      EXPECT_NEAR(before / walked.unfinished.value, 2, .5);
    }
    before = walked.unfinished.value;
  }
  const SlabWalks whole = walk_slab(medium_of_albedo(1, 1.5), {}, kDiffuseEntry, walks_of_seed(2048, 4));
  EXPECT_NEAR(whole.back.total.value, 1, .002);  // as things are by default
}

// Claim: at grazing incidence below the critical angle of eta .75 nothing enters, which a table of angles has as 0 and
// a beam is refused for. Source: Snell's law: cosine .661. Fails if: it divides by the flux that did not enter.
TEST(LaboratoryExtremes, TotalReflectionOutside) {
  const SlabWalks walked = walk_slab(medium_of_albedo(.9, .75), {}, kDiffuseEntry, walks_of_seed(20000, 5));
  for (const WalkedCosine& bin : walked.albedo_by_entry) {
    if (bin.high < .66) {
      EXPECT_EQ(bin.value.value, 0) << bin.high;
    }
    if (bin.low > .67) {
      EXPECT_GT(bin.value.value, .3) << bin.high;
    }
  }
}

// Claim: what is out of range is refused by its name. Source: laboratory.h, point_source.h. Fails if: a check is
// missing, or NaN passes it.
TEST(LaboratoryExtremes, BadInput) {
  const double nan = std::numeric_limits<double>::quiet_NaN(),
               infinite = std::numeric_limits<double>::infinity();
  const HomogeneousMedium good{.1, 1, 0, 1.3};
  const auto slab = [](const HomogeneousMedium& m, double thickness = 1, double cosine = 1) {
    walk_slab(m, {thickness}, {false, cosine}, walks_of_seed(1, 1));
  };
  const auto with = [&](const auto& change) {
    LaboratorySettings settings = walks_of_seed(1, 1);
    change(settings);
    walk_slab(good, {1}, kNormalEntry, settings);
  };
  const std::pair<std::string, std::function<void()>> cases[] = {
      {"sigma_a",
       [&] {
         slab({-1, 1, 0, 1});
       }},
      {"sigma_a",
       [&] {
         slab({nan, 1, 0, 1});
       }},
      {"sigma_s",
       [&] {
         slab({0, infinite, 0, 1});
       }},
      {"g",
       [&] {
         slab({0, 1, 1, 1});
       }},
      {"g",
       [&] {
         slab({0, 1, nan, 1});
       }},
      {"eta",
       [&] {
         slab({0, 1, 0, 0});
       }},
      {"eta",
       [&] {
         slab({0, 1, 0, nan});
       }},
      {"thickness", [&] { slab(good, 0); }},
      {"thickness", [&] { slab(good, nan); }},
      {"cosine", [&] { slab(good, 1, 0); }},
      {"cosine", [&] { slab(good, 1, 1.01); }},
      {"cosine",
       [&] {
         slab({.1, 1, 0, .75}, 1, .5);
       }},
      {"walks", [&] { with([](LaboratorySettings& s) { s.walks = 0; }); }},
      {"most_collisions", [&] { with([](LaboratorySettings& s) { s.most_collisions = 0; }); }},
      {"cosine_bins", [&] { with([](LaboratorySettings& s) { s.cosine_bins = 0; }); }},
      {"radii", [&] { with([](LaboratorySettings& s) {
                        s.radii = {2, 1};
                      }); }},
      {"radii", [&] { with([](LaboratorySettings& s) {
                        s.radii = {0, 1};
                      }); }},
      {"radii", [&] { test::walk_point_source(good, walks_of_seed(1, 1)); }},
      {"sigma_a",
       [&] {
         test::walk_point_source({0, 1, 0, 1}, walks_of_seed(1, 1));
       }},
  };
  for (const auto& [name, call] : cases) try {
      call();
      ADD_FAILURE() << name << " was accepted";
    } catch (const Error& error) {
      EXPECT_EQ(error.kind, ErrorKind::bad_input);
      EXPECT_NE(std::string(error.what()).find("'" + name + "'"), std::string::npos) << error.what();
      EXPECT_FALSE(error.expected.empty()) << name;
    }
}

}  // namespace
}  // namespace opaline
