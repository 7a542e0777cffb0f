// SPDX-License-Identifier: GPL-3.0-or-later
// The error that a picture states, against the error that it has.
#include <gtest/gtest.h>

#include <cmath>

#include "opaline/image/metrics.h"
#include "opaline/render/render.h"
#include "opaline/scene/load_scene.h"

namespace opaline {
namespace {

Image picture(const std::string& name, const std::vector<std::string>& more) {
  std::vector<std::string> overrides{"film.resolution=[96,96]", "film.samples_per_pixel=1",
                                     "film.filter=box"};
  overrides.insert(overrides.end(), more.begin(), more.end());
  const Scene scene = load_scene(std::string(OPALINE_SCENES_DIR) + "/" + name + ".json", overrides);
  const World world = make_world(scene);
  const RayScene rays(world);
  const Precompute samples = precompute({scene, world, rays, make_plan(scene, world)});
  return render({scene, world, rays, samples.groups}).image;
}

// Claim: the estimated error of a picture (layer `error`, the closing line) is within a factor 3 of the
// measured mean relative error, on every scene of the repository at its default settings and at a quarter of
// the samples. Source: the statement in render.h. The reference has 300k samples and a tolerance of .2 %:
// less than a third of the errors here. Tolerance: the factor stated. Fails if: the spread is not squared,
// the near field's part is left out (skin), or radiance is divided by irradiance.
TEST(ErrorEstimate, IsWithinAFactorOfThree) {
  for (const std::string name : {"bunny-marble", "bunny-skin1", "sphere", "backlit-slab"}) {
    const Image reference =
        picture(name, {"settings.samples=300000", "settings.tolerance=0.002", "settings.light_samples=256"});
    for (const bool sparse : {false, true}) {
      SCOPED_TRACE(name + (sparse ? ", 10k samples" : ""));
      const Image image = picture(
          name, sparse ? std::vector<std::string>{"settings.samples=10000"} : std::vector<std::string>{});
      double measured = 0;
      const RelativeErrors errors = relative_errors(
          extract_layer(image, "diffuse"), extract_layer(reference, "diffuse"), object_pixels(reference));
      for (const std::vector<double>& channel : errors.channels)
        measured = std::max(measured, error_statistics(channel).mean);
      const double estimated = estimated_relative_error(image);
      RecordProperty(name + (sparse ? "_10k" : "") + "_measured", std::to_string(measured));
      RecordProperty(name + (sparse ? "_10k" : "") + "_estimated", std::to_string(estimated));
      EXPECT_LT(estimated, 3 * measured);
      EXPECT_GT(estimated, measured / 3);
    }
  }
}

}  // namespace
}  // namespace opaline
