// SPDX-License-Identifier: GPL-3.0-or-later
// The rungs of a scene.
#include <gtest/gtest.h>

#include <algorithm>
#include <set>

#include "benchmark/ladder.h"
#include "input/load_scene.h"

namespace opaline {
namespace {

std::set<std::string> names_of(const std::vector<Rung>& rungs) {
  std::set<std::string> names;
  for (const Rung& rung : rungs)
    EXPECT_TRUE(names.insert(name_of(rung)).second) << "twice: " << name_of(rung);
  return names;
}

// Claim: lambert is first, each evaluator and method is there, and sample counts are a quarter of the plan's,
// the plan's and four times it. Source: ladder.h. Fails if: the counts do not follow the plan, or a series is
// lost.
TEST(Ladder, OfATranslucentScene) {
  const std::vector<Rung> rungs = ladder({.planned_samples = 1000, .quick = false});
  EXPECT_EQ(name_of(rungs.at(0)), "lambert");
  const std::set<std::string> names = names_of(rungs);
  for (const char* name :
       {"hierarchical brute_force", "hierarchical classic max_solid_angle=0.4",
        "hierarchical classic max_solid_angle=0.02", "hierarchical surface_cache tolerance=0.02",
        "hierarchical dual_tree samples=250", "hierarchical dual_tree samples=1000",
        "hierarchical dual_tree samples=4000", "direct entry_samples=64"})
    EXPECT_TRUE(names.contains(name)) << name;
}

// Claim: the quick ladder is a part of the whole one, and shorter; nothing translucent leaves no hierarchical
// rung; of one sample a quarter is one. Source: ladder.h. Fails if: quick values are not among the values, or
// 0 samples are asked for (a scene refuses them).
TEST(Ladder, QuickAndOpaque) {
  const std::vector<Rung> whole = ladder({.planned_samples = 1000, .quick = false}),
                          quick = ladder({.planned_samples = 1000, .quick = true});
  EXPECT_LT(quick.size(), whole.size());
  EXPECT_TRUE(std::ranges::includes(names_of(whole), names_of(quick)));
  for (const Rung& rung : ladder({.planned_samples = 0, .quick = false}))
    EXPECT_NE(rung.method, "hierarchical");
  EXPECT_TRUE(
      names_of(ladder({.planned_samples = 1, .quick = true})).contains("hierarchical dual_tree samples=1"));
}

// Claim: where there is light between things one rung is without it, and only there. Source: ladder.h. Fails if: no rung
// tells what gathering costs and what it is worth, or two rungs of other scenes are the same.
TEST(Ladder, WithoutLightBetweenThings) {
  for (const bool quick : {false, true})
    for (const bool bounces : {false, true})
      EXPECT_EQ(names_of(ladder({.planned_samples = 1000, .quick = quick, .bounces = bounces}))
                    .contains("hierarchical bounces=0"),
                bounces);
}

// Claim: a scene takes every rung's settings, and they are what the rung says. Source: scenes/README.md.
// Fails if: a knob or evaluator of the ladder is misspelt, or overrides lose one of them.
TEST(Ladder, SettingsAreTheScenes) {
  for (const Rung& rung : ladder({.planned_samples = 1000, .quick = false, .bounces = true})) {
    Scene scene;
    ASSERT_NO_THROW(scene = parse_scene("{}", "empty.json", overrides_of(rung))) << name_of(rung);
    EXPECT_EQ(scene.settings.method == Method::hierarchical, rung.method == "hierarchical");
    EXPECT_EQ(scene.settings.evaluator == EvaluatorKind::brute_force, rung.evaluator == "brute_force");
    EXPECT_EQ(scene.settings.bounces.has_value(), rung.knob == "bounces");
    if (rung.knob == "max_solid_angle") {
      EXPECT_EQ(scene.settings.laboratory.max_solid_angle, std::stod(rung.value));
    }
    if (rung.knob == "samples") {
      EXPECT_EQ(scene.settings.samples, std::stoul(rung.value));
    }
    if (rung.knob == "entry_samples") {
      EXPECT_EQ(scene.settings.entry_samples, std::stoul(rung.value));
    }
  }
}

// Claim: against random walks stand lambert, first, the scene as it is, each profile that samples can have, set in every
// medium, and volume_diffusion. Source: ladder.h. Fails if: a profile is lost, or set in one medium alone.
TEST(Ladder, AgainstRandomWalks) {
  const std::vector<std::string> media{"wax", "milk"};
  const std::string file = R"({"media": {"wax": {"preset": "marble"}, "milk": {"preset": "wholemilk"}}})";
  const std::vector<Rung> rungs = truth_ladder(/*quick=*/false);
  EXPECT_EQ(name_of(rungs.at(0)), "lambert");
  std::set<ProfileKind> profiles;
  for (const Rung& rung : rungs) {
    Scene scene;
    ASSERT_NO_THROW(scene = parse_scene(file, "media.json", overrides_of(rung, media))) << name_of(rung);
    EXPECT_EQ(scene.media.at(0).profile, scene.media.at(1).profile) << name_of(rung);
    if (scene.media[0].profile) profiles.insert(*scene.media[0].profile);
  }
  EXPECT_EQ(profiles.size(), kProfileNames.size() - 1);  // directional_dipole is direct's
  const std::set<std::string> all = names_of(rungs);
  EXPECT_TRUE(all.contains("hierarchical"));
  EXPECT_TRUE(all.contains("volume_diffusion cell_size=2"));
  EXPECT_TRUE(std::ranges::includes(all, names_of(truth_ladder(/*quick=*/true))));
}

}  // namespace
}  // namespace opaline
