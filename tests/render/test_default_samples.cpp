// SPDX-License-Identifier: GPL-3.0-or-later
// How many samples are enough, and that no more are taken unasked.
#include <gtest/gtest.h>

#include "input/load_scene.h"
#include "opaline/compare.h"
#include "plan/make_plan.h"
#include "render/render.h"
#include "support/scenes.h"

namespace opaline {
namespace {

using namespace test;

std::string scene_file(const std::string& name) {
  return std::string(OPALINE_SCENES_DIR) + "/" + name + ".json";
}

Image picture_of_file(Session& session, const std::string& name, const std::vector<std::string>& more) {
  std::vector<std::string> overrides{"settings.method=hierarchical", "film.resolution=[96,96]",
                                     "film.samples_per_pixel=1",     "film.filter=box",
                                     "film.pixel_type=float",        "settings.tolerance=0.001"};
  overrides.insert(overrides.end(), more.begin(), more.end());
  session.edit(load_scene(scene_file(name), overrides));
  session.prepare();
  return opaline::render({session.scene(), session.world(), session.rays(), session.bodies()}).image;
}

ErrorStatistics sampling_error(const Image& image, const Image& reference) {
  return error_statistics(relative_errors(extract_layer(image, "diffuse"),
                                          extract_layer(reference, "diffuse"), object_pixels(reference)));
}

// Claim: at its default number of samples every scene of the repository has a sampling error of at most 1 %
// (mean over the object's pixels and channels, p99 10 %), and bunny-marble has it at 15,000. Source: the
// project's targets: 50,000 and, at best, 15,000. Measured: .29 (bunny-marble, 24k), .65 (bunny-skin1, 13k),
// .29 (sphere), .61 % (backlit-slab); bunny-marble at 15k .44 %; p99 at most 8.7 %. Tolerance: as stated; the
// reference has 150k samples, and one of 300k moves no mean by more than .02 %. Fails if: the shares are equal
// (means of 1.8 to 3.5 %).
TEST(DefaultSamples, KeepWithinOnePercent) {
  for (const std::string name : {"bunny-marble", "bunny-skin1", "sphere", "backlit-slab"}) {
    Session session;
    const Image reference = picture_of_file(session, name, {"settings.samples=150000"});
    const auto expect_one_percent = [&](const std::string& what, const std::vector<std::string>& more) {
      SCOPED_TRACE(name + what);
      const ErrorStatistics error = sampling_error(picture_of_file(session, name, more), reference);
      RecordProperty(name + what + "_mean", std::to_string(error.mean));
      RecordProperty(name + what + "_p99", std::to_string(error.p99));
      EXPECT_LT(error.mean, 0.01);
      EXPECT_LT(error.p99, 0.10);
    };
    expect_one_percent("", {});
    if (name == "bunny-marble") expect_one_percent("_15k", {"settings.samples=15000"});
  }
}

// Claim: the default spacing is the diffuse mean free path where that lies between one and one and a half
// mean free paths, else the nearer of these, in the channel where it is least. Source: plan.h. Expected:
// spacings worked out by hand from mean free path l = 1 mm and 1 - alpha', diffuse mean free path l / sqrt(3
// (1 - alpha')). Tolerance: 1e-3, for the count is whole. Fails if: another channel rules, or a bound is left
// out.
TEST(DefaultSamples, FollowTheMedium) {
  const auto spacing = [](const Rgb& absorbed) {
    Scene scene = single_shape(SphereShape{{}, 60}, grey_medium(1, 0.5, 1.3), 1);
    scene.media[0].coefficients = PhysicalMedium{absorbed, Rgb(1) - absorbed};
    scene.settings.samples.reset();
    return make_plan(scene, make_world(scene)).groups[0].spacing;
  };
  EXPECT_NEAR(spacing(Rgb(0)), 1.5, 1.5e-3);                 // without absorption: infinite
  EXPECT_NEAR(spacing(Rgb(0.01)), 1.5, 1.5e-3);              // 5.77
  EXPECT_NEAR(spacing(Rgb(0.25)), 1.1547, 1.2e-3);           // 1.1547
  EXPECT_NEAR(spacing(Rgb(0.8)), 1, 1e-3);                   // .645
  EXPECT_NEAR(spacing(Rgb{0.01, 0.25, 0}), 1.1547, 1.2e-3);  // green rules
}

}  // namespace
}  // namespace opaline
