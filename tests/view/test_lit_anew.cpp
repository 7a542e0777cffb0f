// SPDX-License-Identifier: GPL-3.0-or-later
// A picture in other light without a ray: how near it is to the one that is rendered, and that the view shows it first.
#include "lights/light.h"
#include "support/scene_picture.h"
#include "view/lit_anew.h"
#include "view_client.h"

namespace opaline {
namespace {

using namespace test;

/// All lights as they emit, times a factor.
Scene in_light(Scene scene, const Rgb& factor) {
  for (Light& light : scene.lights) light = with_emission(light, emission(light) * factor);
  return scene;
}

/// Of all values of a layer (empty: all layers), their difference over the larger of the value and a thousandth of its
/// channel's largest: what a share of them does not exceed.
double difference(const Image& a, const Image& b, const std::string& layer, double share) {
  const std::size_t count = b.channels.size();
  std::vector<double> differences;
  for (std::size_t c = 0; c < count; ++c) {
    if (!b.channels[c].starts_with(layer)) continue;
    double largest = 0;
    for (std::size_t i = c; i < b.pixels.size(); i += count) largest = std::max(largest, double(b.pixels[i]));
    for (std::size_t i = c; i < b.pixels.size() && largest > 0; i += count)
      differences.push_back(std::abs(double(a.pixels[i]) - double(b.pixels[i])) /
                            std::max(std::abs(double(b.pixels[i])), 1e-3 * largest));
  }
  if (differences.empty()) return 0;  // a method without the layer
  std::ranges::sort(differences);
  return differences.at(std::size_t(share * double(differences.size() - 1)));
}

double difference_of_halves(const std::vector<std::uint16_t>& a, const std::vector<std::uint16_t>& b) {
  double worst = 0;
  for (std::size_t i = 0; i < b.size(); ++i) {
    half was, is;
    was.setBits(a.at(i));
    is.setBits(b[i]);
    worst = std::max(worst, std::abs(double(was) - double(is)) / std::max(1e-3, double(is)));
  }
  return worst;
}

// Claim: all layers are those of a picture that is rendered in the other light, to the rounding of floats where all
// channels have one factor; else 99 % of the light to the tolerance that the tree is asked for, and the error layer to a tenth.
// Source: lit_anew.h. Tolerance: 1e-4, for sums of thousands of floats and a solver's steps; settings.tolerance. Fails if: a
// layer with light stays, or one without light is scaled.
TEST(LitAnew, IsWhatIsRendered) {
  const ViewFolder folder;
  for (const char* method : {"hierarchical", "lambert", "volume_diffusion"}) {
    SCOPED_TRACE(method);
    const std::vector<std::string> edits{"settings.method=" + std::string(method), "settings.samples=800",
                                         "settings.cell_size=8"};
    const Scene scene = load_scene(folder.scene, edits);
    const Image before = cold_picture(scene);
    const Scene brighter = in_light(scene, {1.37, 1.37, 1.37}), tinted = in_light(scene, {.3, 1, 2.5});
    const Image in_brighter = cold_picture(brighter), in_tinted = cold_picture(tinted);
    const std::optional<LitAnew> lit = lit_anew(before, scene, brighter),
                                 coloured = lit_anew(before, scene, tinted);
    ASSERT_TRUE(lit && coloured);
    EXPECT_TRUE(lit->has_one_factor && !coloured->has_one_factor);
    EXPECT_EQ(lit->image.channels, in_brighter.channels);
    EXPECT_LE(difference(lit->image, in_brighter, "", 1), 1e-4);
    for (const char* layer : {"R", "G", "B", "diffuse.", "specular.", "irradiance."})
      EXPECT_LE(difference(coloured->image, in_tinted, layer, .99), scene.settings.tolerance) << layer;
    EXPECT_LE(difference(coloured->image, in_tinted, "error.", 1), .1);
    EXPECT_GT(difference(before, in_brighter, "diffuse", .5), .2);
  }
}

// Claim: it is not known where lights differ by different factors or in more than what they emit, or anything else does; nor,
// unless the exposure alone differs, beside a backdrop, which is no light, or a shadow catcher, whose alpha depends on all lights.
TEST(LitAnew, IsOfLightAlone) {
  const ViewFolder folder;
  const Scene scene = load_scene(folder.scene);
  const Image picture = cold_picture(scene);
  for (const char* edit :
       {"lights.key.intensity=1e4", "lights.key.position=[1, 90, 0]", "media.stone.eta=1.4",
        "settings.seed=3", "camera.position=[0, 30, 110]", "film.samples_per_pixel=2"})
    EXPECT_FALSE(lit_anew(picture, scene, load_scene(folder.scene, std::vector<std::string>{edit}))) << edit;
  for (Scene beside :
       {load_scene(folder.scene, std::vector<std::string>{"backdrop=0.5"}),
        load_scene(folder.scene, std::vector<std::string>{"shapes.floor.shadow_catcher=true"})})
    EXPECT_FALSE(lit_anew(picture, beside, in_light(beside, Rgb(2))));
  Scene exposed = load_scene(folder.scene, std::vector<std::string>{"backdrop=0.5"}), before = exposed;
  exposed.film.exposure = 1;
  EXPECT_TRUE(lit_anew(picture, before, exposed));
  const Scene dark = in_light(scene, {});
  EXPECT_FALSE(lit_anew(picture, dark, scene));
  EXPECT_TRUE(lit_anew(picture, scene, dark));
}

// Claim: where the final picture takes its time, the view shows this one first, in all its pixels; brighter by one factor
// it is final. Fails if: it is not asked for, or a coarse one comes before.
TEST(LitAnew, IsShownFirst) {
  const ViewFolder folder;
  const RunningView view(folder.scene);
  ViewClient page(view);
  page.set({{"lights.1.radiance", 0},
            {"lights.2.irradiance", 0},
            {"film.resolution", {256, 192}},
            {"film.samples_per_pixel", 16}});
  ASSERT_TRUE(page.read_final(2));
  page.set({{"lights.key.intensity", {2e4, 2e4, 2e4}}});
  ASSERT_TRUE(page.read_until([&] { return page.frame.revision == 3; }));
  EXPECT_EQ(page.frame.step, PictureStep::sharper);
  EXPECT_EQ(page.frame.width, 256u);
  const std::vector<std::uint16_t> shown = page.frame.colours;
  ASSERT_TRUE(page.read_final(3));
  EXPECT_LE(difference_of_halves(shown, page.frame.colours),
            .005 + 1e-3);  // settings.tolerance, and two halves
  page.set({{"lights.key.intensity", {5e4, 5e4, 5e4}}});
  ASSERT_TRUE(page.read_until([&] { return page.frame.revision == 4; }));
  EXPECT_EQ(page.frame.step, PictureStep::final);
  const auto edits = page.texts.at("scene").at("edits").get<std::vector<std::string>>();
  EXPECT_LE(difference_of_halves(page.frame.colours, rendered(folder.scene, edits)), 1e-3);
}

}  // namespace
}  // namespace opaline
