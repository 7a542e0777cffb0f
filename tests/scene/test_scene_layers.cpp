// SPDX-License-Identifier: GPL-3.0-or-later
// Layers of a medium in a scene file.
#include <gtest/gtest.h>

#include <cmath>

#include "scene/scene_test.h"

namespace opaline {
namespace {

std::string media(const std::string& layers) {
  return R"({"mm_per_unit": 10, "media": {"skin": {"layers": )" + layers + R"(},
    "top": {"sigma_a": 1, "sigma_s_prime": 2, "specular_ior": 1.4}, "bottom": {"preset": "marble"},
    "artist": {"subsurface_color": 0.5, "subsurface_radius": 2}, "nested": {"layers": [{"medium": "top"}]}}})";
}

// Claim: layers are named in any order, have the lengths of the scene and the coefficients of their media; the index of
// refraction is the first one's or the medium's own; one layer alone is its medium. Source: scenes/README.md. Tolerance: 1e-6. Fails if:
// the thickness stays in scene units, or a medium below is not yet read.
TEST(SceneLayers, Values) {
  const Scene scene = parse(media(
      R"([{"medium": "top", "thickness": 0.2}, {"medium": "artist", "thickness": 0}, {"medium": "bottom"}])"));
  const Medium& skin = scene.media[0];
  ASSERT_EQ(skin.layers.size(), 3);
  EXPECT_EQ(skin.layers[0].medium, "top");
  EXPECT_EQ(skin.layers[0].thickness, 2);
  EXPECT_EQ(skin.layers[0].coefficients, (PhysicalMedium{Rgb(1), Rgb(2)}));
  EXPECT_EQ(skin.layers[1].thickness, 0);
  EXPECT_NEAR(skin.layers[1].coefficients.sigma_a.x + skin.layers[1].coefficients.sigma_s_prime.x, .5, 1e-12);
  EXPECT_FALSE(std::isfinite(skin.layers[2].thickness));
  EXPECT_EQ(skin.layers[2].coefficients.sigma_s_prime.y, 2.62);
  EXPECT_EQ(skin.eta, 1.4);
  const auto& nested = std::get<PhysicalMedium>(scene.media[4].coefficients);
  for (std::size_t c = 0; c < 3; ++c) {
    EXPECT_NEAR(nested.sigma_a[c], 1, 1e-6);
    EXPECT_NEAR(nested.sigma_s_prime[c], 2, 1e-6);
  }
}

// Claim: mistakes in layers are named at their place. Source: by hand. Fails if: one is accepted.
TEST(SceneLayers, Errors) {
  const std::pair<const char*, const char*> mistakes[]{
      {"[]", "'media.skin.layers' has no layer"},
      {R"([{"medium": "tpo"}])", "names no medium of this scene"},
      {R"([{"medium": "skin"}])", "is the medium itself"},
      {R"([{"medium": "top"}, {"medium": "bottom"}])", "lacks the key 'thickness'"},
      {R"([{"medium": "top", "thickness": 1}])",
       "'media.skin.layers.0.thickness' has no effect: the last layer fills the rest"},
      {R"([{"medium": "top", "thickness": -1}, {"medium": "bottom"}])", "'media.skin.layers.0.thickness'"},
      {R"([{"medium": "top", "thickness": "nan"}, {"medium": "bottom"}])", "is not a finite number"},
      {R"([{"medium": "top", "thickness": 1, "name": "a"}, {"medium": "bottom"}])", "unknown key 'name'"},
      {R"([{"thickness": 1}])", "lacks the key 'medium'"},
      {R"({"medium": "top"})", "'media.skin.layers'"}};
  for (const auto& [layers, message] : mistakes) {
    SCOPED_TRACE(layers);
    expect_fragments(error_of(media(layers)), {message});
  }
  expect_fragments(
      error_of(R"({"media": {"a": {"layers": [{"medium": "b"}]}, "b": {"layers": [{"medium": "c"}]},
                                "c": {"preset": "marble"}}})"),
      {"'media.a.layers.0.medium' is not homogeneous"});
  expect_fragments(error_of(R"({"media": {"a": {"preset": "marble", "layers": [{"medium": "b"}]}}})"),
                   {"cannot be combined with"});
}

// Claim: what a layer's medium has beside its coefficients is reported. Fails if: a texture or fuzz of a layer is left out silently.
TEST(SceneLayers, KeysWithoutEffect) {
  const Scene scene = parse(R"({"media": {"a": {"layers": [{"medium": "b", "thickness": 1}, {"medium": "c"}]},
      "b": {"sigma_a": 1, "sigma_s_prime": 2, "tint": 0.5, "fuzz_weight": 0.2}, "c": {"preset": "marble"}}})");
  ASSERT_EQ(scene.warnings.size(), 1);
  for (const char* part : {"'media.a.layers.0.medium'", "count in a layer, not 'tint', 'fuzz_weight'"})
    EXPECT_NE(scene.warnings[0].find(part), std::string::npos) << scene.warnings[0];
}

}  // namespace
}  // namespace opaline
