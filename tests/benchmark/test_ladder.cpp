// SPDX-License-Identifier: GPL-3.0-or-later
// The rungs of a scene.
#include <gtest/gtest.h>

#include <algorithm>
#include <set>

#include "benchmark/ladder.h"
#include "opaline/scene/load_scene.h"

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

// Claim: a scene takes every rung's settings, and they are what the rung says. Source: scenes/README.md.
// Fails if: a knob or evaluator of the ladder is misspelt, or overrides lose one of them.
TEST(Ladder, SettingsAreTheScenes) {
  for (const Rung& rung : ladder({.planned_samples = 1000, .quick = false})) {
    Scene scene;
    ASSERT_NO_THROW(scene = parse_scene("{}", "empty.json", overrides_of(rung))) << name_of(rung);
    EXPECT_EQ(scene.settings.method == Method::hierarchical, rung.method == "hierarchical");
    EXPECT_EQ(scene.settings.evaluator == EvaluatorKind::brute_force, rung.evaluator == "brute_force");
    if (rung.knob == "max_solid_angle") {
      EXPECT_EQ(scene.settings.max_solid_angle, std::stod(rung.value));
    }
    if (rung.knob == "samples") {
      EXPECT_EQ(scene.settings.samples, std::stoul(rung.value));
    }
    if (rung.knob == "entry_samples") {
      EXPECT_EQ(scene.settings.entry_samples, std::stoul(rung.value));
    }
  }
}

}  // namespace
}  // namespace opaline
