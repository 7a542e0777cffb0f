// SPDX-License-Identifier: GPL-3.0-or-later
// The parts of the error are settings that a scene takes, one a part.
#include <gtest/gtest.h>

#include <set>

#include "benchmark/error_budget.h"
#include "input/load_scene.h"

namespace opaline {
namespace {

Settings settings_with(const std::vector<std::string>& overrides) {
  return parse_scene("{}", "empty.json", overrides).settings;
}

// Claim: the six parts of the error (the table in bench/README.md); the two pictures of a part differ in what it
// names and in nothing else: samples 16 times as many (and the cap with them; light samples so that as many
// rays are traced), light samples, the exact sum, the near field, the cache, the method. By hand. Fails if: a part's own
// setting is misspelt (a scene refuses it), or a second one slips in.
TEST(ErrorBudget, OneSettingApart) {
  const std::vector<BudgetPart> parts = error_budget(1000, {});
  std::set<std::string> names;
  for (const BudgetPart& part : parts) {
    names.insert(part.name);
    const Settings a = settings_with(part.here), b = settings_with(part.converged);
    EXPECT_EQ(a.samples != b.samples, part.name == "sampling") << part.name;
    EXPECT_EQ(a.light_samples != b.light_samples, part.name == "irradiance" || part.name == "sampling")
        << part.name;
    EXPECT_EQ(b.evaluator == EvaluatorKind::brute_force, part.name == "hierarchy") << part.name;
    EXPECT_EQ(a.laboratory.near_field != b.laboratory.near_field, part.name == "near field") << part.name;
    EXPECT_EQ(a.evaluator == EvaluatorKind::surface_cache, part.name == "interpolation") << part.name;
    EXPECT_EQ(a.method != b.method, part.name == "model") << part.name;
    EXPECT_EQ(a.tolerance, b.tolerance) << part.name;
    EXPECT_EQ(a.laboratory.near_irradiance, b.laboratory.near_irradiance) << part.name;
  }
  EXPECT_EQ(names, (std::set<std::string>{"sampling", "irradiance", "hierarchy", "near field",
                                          "interpolation", "model"}));
  EXPECT_EQ(settings_with(parts[0].converged).samples, 16000u);
  EXPECT_EQ(settings_with(parts[0].here).light_samples, 1024);
  EXPECT_EQ(settings_with(parts[0].converged).light_samples, 64);
  EXPECT_EQ(settings_with(parts[1].converged).light_samples, 1024);
  EXPECT_EQ(settings_with(parts[4].here).light_samples, 1024);
  EXPECT_EQ(settings_with(parts[4].converged).light_samples, 1024);
  EXPECT_EQ(settings_with(parts[5].converged).method, Method::volume_diffusion);
  EXPECT_EQ(parts[5].converged[0], "settings.bounces=0");
}

// Claim: an opaque scene has no parts; a huge cloud is not multiplied beyond memory, but still at least
// doubled; a scene's classic traversal is what its hierarchy is measured on; light samples stay in range.
// Source: error_budget.h. Fails if: 16 times 2 million samples are asked for.
TEST(ErrorBudget, Limits) {
  EXPECT_TRUE(error_budget(0, {}).empty());
  EXPECT_EQ(settings_with(error_budget(2'000'000, {})[0].converged).samples, 4'000'000u);
  EXPECT_EQ(settings_with(error_budget(3'000'000, {})[0].converged).samples, 6'000'000u);
  Settings settings;
  settings.evaluator = EvaluatorKind::classic;
  settings.light_samples = 60000;
  const std::vector<BudgetPart> parts = error_budget(1000, settings);
  EXPECT_EQ(settings_with(parts[2].here).evaluator, EvaluatorKind::classic);
  EXPECT_EQ(settings_with(parts[1].converged).light_samples, 65536);
}

}  // namespace
}  // namespace opaline
