// SPDX-License-Identifier: GPL-3.0-or-later
// Old spellings of keys and values.
#include "input/schema.h"
#include "scene_test.h"

namespace opaline {
namespace {

const std::string kOld = R"({"media": {"a": {"preset": "marble", "eta": 1.4},
  "b": {"preset": "skin1", "profile": "normalized_diffusion_searchlight"}},
  "settings": {"laboratory": {"near_field": false}}})";
const std::string kNow = R"({"media": {"a": {"preset": "marble", "specular_ior": 1.4},
  "b": {"preset": "skin1", "profile": "normalized_diffusion", "fit": "searchlight"}},
  "settings": {"laboratory": {"near_field": false}}})";

// Claim: old spellings mean what today's do, and each is a warning with its place that names today's. Source: the
// contract. Fails if: a spelling is dropped, or its value.
TEST(DeprecatedSpellings, AreReadWithAWarning) {
  Scene old = parse(kOld);
  const Scene now = parse(kNow);
  EXPECT_TRUE(now.warnings.empty());
  ASSERT_EQ(old.warnings.size(), 2u);
  EXPECT_EQ(old.warnings[0], "test.json:1:38: 'media.a.eta' is deprecated; use 'media.a.specular_ior'");
  EXPECT_NE(old.warnings[1].find("profile=normalized_diffusion, media.b.fit=searchlight"), std::string::npos);
  old.warnings.clear();
  EXPECT_EQ(old, now);
  EXPECT_EQ(now.media[0].eta, 1.4);
  EXPECT_EQ(now.media[1].fit, NormalizedDiffusionFit::searchlight);
}

// Claim: of two overrides the later one wins, in whatever spelling; one file or one override with both is an error.
// Source: the contract. Fails if: the order of spellings counts.
TEST(DeprecatedSpellings, TheLaterOverrideWins) {
  const std::string old = "media.a.eta=", now = "media.a.specular_ior=";
  EXPECT_EQ(parse(kOld, {now + "1.6"}).media[0].eta, 1.6);
  EXPECT_EQ(parse(kNow, {old + "1.6"}).media[0].eta, 1.6);
  EXPECT_EQ(parse(kNow, {old + "1.6", now + "1.7"}).media[0].eta, 1.7);
  EXPECT_EQ(parse(kNow, {now + "1.6", old + "1.7"}).media[0].eta, 1.7);
  const Scene refit = parse(kOld, {"media.b.profile=normalized_diffusion_refit"});
  EXPECT_EQ(refit.media[1].fit, NormalizedDiffusionFit::refit);
  EXPECT_EQ(parse(kOld, {"media.b.profile=dipole"}).media[1].profile, ProfileKind::dipole);
  expect_fragments(error_of(kNow, {R"(media.a={"preset": "skin1", "eta": 1, "specular_ior": 1})"}),
                   {"'specular_ior' have the same meaning"});
}

// Claim: edits of a file with old spellings keep its text where they can, and give the same scene. Source:
// edited_scene. Fails if: a value that has moved in the tree is looked for at its new place in the text.
TEST(DeprecatedSpellings, EditsKeepTheFileReadable) {
  const std::vector<std::vector<std::string>> all{{"media.a.specular_ior=1.5"},
                                                  {"media.a.profile=dipole"},
                                                  {"media.b.fit=dmfp"},
                                                  {"settings.seed=3"},
                                                  {"settings.laboratory.near_field=true"},
                                                  {"settings.laboratory.entry_strategy=chords"}};
  for (const std::vector<std::string>& edits : all) {
    SCOPED_TRACE(edits[0]);
    Scene edited = parse(edited_scene(kOld, "test.json", edits)), wanted = parse(kOld, edits);
    edited.warnings = wanted.warnings = {};
    EXPECT_EQ(edited, wanted);
  }
  EXPECT_NE(edited_scene(kOld, "test.json", all[0]).find("\"eta\": 1.5}"), std::string::npos);
}

// Claim: a key that is now one of the laboratory's is an error that names its path. Source: the contract. Fails if: the
// laboratory's keys are not among those that are suggested.
TEST(DeprecatedSpellings, KeysOfTheLaboratoryAreNamed) {
  for (const std::string key :
       {"instruction_set", "max_solid_angle", "near_field", "near_irradiance", "entry_strategy"})
    expect_fragments(error_of(R"({"settings": {")" + key + R"(": 1}})"),
                     {"unknown key '" + key + "'", "did you mean 'settings.laboratory." + key + "'?"});
}

// Claim: no table of keys, and so no document, help or JSON Schema, has an old spelling. Source: the contract. Fails if: a
// row of one is left.
TEST(DeprecatedSpellings, AreNotAdvertised) {
  for (const KeyInfo& info : schema()) {
    EXPECT_NE(info.key, "eta") << info.section;
    for (const char* old : {"_searchlight", "_dmfp", "_refit"})
      for (const std::string_view choice : info.choices) EXPECT_FALSE(choice.ends_with(old)) << choice;
    if (info.section == "settings") {
      EXPECT_NE(info.key, "near_field");
    }
  }
}

// Claim: a fit chooses normalized diffusion where no profile is named, and `$schema` is ignored. Source:
// scenes/README.md. Fails if: a fit alone leaves the profile open.
TEST(DeprecatedSpellings, FitNamesTheProfile) {
  const Scene scene = parse(R"({"$schema": "opaline.schema.json", "media": {
    "a": {"preset": "marble", "fit": "dmfp"}, "b": {"preset": "marble", "profile": "dipole", "fit": "dmfp"}}})");
  EXPECT_EQ(scene.media[0].profile, ProfileKind::normalized_diffusion);
  EXPECT_EQ(scene.media[1].profile, ProfileKind::dipole);
  expect_fragments(error_of(R"({"media": {"a": {"preset": "marble", "fit": "dmfp", "thickness": 1}}})"),
                   {"'media.a.fit' cannot be combined with 'thickness'"});
}

}  // namespace
}  // namespace opaline
