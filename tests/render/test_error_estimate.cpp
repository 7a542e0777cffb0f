// SPDX-License-Identifier: GPL-3.0-or-later
// The error that a picture states, against the error that it has.
#include <gtest/gtest.h>

#include <cmath>
#include <map>

#include "input/load_scene.h"
#include "opaline/compare.h"
#include "render/render.h"
#include "session/session_records.h"

namespace opaline {
namespace {

RenderResult estimated(Session& session, const std::string& name, const std::vector<std::string>& more) {
  std::vector<std::string> overrides{"settings.method=hierarchical", "film.resolution=[32,32]",
                                     "film.samples_per_pixel=1", "film.filter=box"};
  overrides.insert(overrides.end(), more.begin(), more.end());
  session.edit(load_scene(std::string(OPALINE_SCENES_DIR) + "/" + name + ".json", overrides));
  return session.render();
}

/// Mean relative error of the diffuse light where translucent surfaces are seen, worst channel.
double measured_error(const RenderResult& result, const Image& truth) {
  double worst = 0;
  const RelativeErrors errors = relative_errors(extract_layer(result.image, "diffuse"),
                                                extract_layer(truth, "diffuse"), result.translucent);
  for (const std::vector<double>& channel : errors.channels)
    worst = std::max(worst, error_statistics(channel).mean);
  return worst;
}

void expect_estimate(const RenderResult& result, const Image& truth, const std::string& name) {
  const double measured = measured_error(result, truth),
               estimated = estimated_relative_error(result.image, result.translucent);
  SCOPED_TRACE(name + ": measured " + std::to_string(measured) + ", estimated " + std::to_string(estimated));
  EXPECT_LT(estimated, 2 * measured);
  EXPECT_GT(estimated, measured / 2);
}

const std::vector<std::string> kTruth{"settings.samples=80000", "settings.tolerance=0.002",
                                      "settings.light_samples=128", "settings.seed=5"};

std::vector<std::string> joined(std::vector<std::string> a, const std::vector<std::string>& b) {
  a.insert(a.end(), b.begin(), b.end());
  return a;
}

// Claim: the estimated error of a picture (layer `error`, the closing line) is within a factor 2 of the
// measured mean relative error, on every scene of the repository at its default settings, with few samples
// and with very few. Source: the statement in render.h. The reference has 80k samples of another seed: off
// by less than a third of the errors here. The slab has the dipole with few samples, because the estimate knows nothing
// of a multipole's far side. Tolerance: the factor stated. Fails if: the roughness of the
// irradiance or the wider near field's difference is left out (two to five times too low with few samples).
TEST(ErrorEstimate, IsWithinAFactorOfTwo) {
  for (const std::string name : {"bunny-marble", "bunny-skin1", "sphere", "backlit-slab"}) {
    const std::vector<std::string> profile = name == "backlit-slab"
                                                 ? std::vector<std::string>{"media.jade.profile=dipole"}
                                                 : std::vector<std::string>{};
    Session session;
    const Image truth = estimated(session, name, joined(profile, kTruth)).image;
    for (const std::string samples : {"", "5000", "500"}) {
      const std::vector<std::string> few{"settings.samples=" + samples};
      expect_estimate(estimated(session, name, samples.empty() ? profile : joined(profile, few)), truth,
                      name + ", samples " + samples);
    }
  }
  Session session;
  const Image truth = estimated(session, "backlit-slab", kTruth).image;
  expect_estimate(estimated(session, "backlit-slab", {}), truth, "multipole");
}

// Claim: the same with any number of camera rays a pixel and of shadow rays, in the light of a panel and the
// surroundings: a pixel's camera rays share the shadow rays, and their noise is not shared. Source: the
// variance of a mean. Tolerance: the factor stated. Fails if: standard errors are added up over a pixel's
// rays (five times too high at 16), a single shadow ray counts as free of noise (three times too low at 64),
// or the floor's noise counts (three times too high at 1).
TEST(ErrorEstimate, HoldsForAnyNumberOfRaysAPixel) {
  const std::vector<std::string> skin{"media.skin.sigma_s_prime=[20,20,20]", "settings.samples=4000"};
  Session references;
  std::map<int, Session> sessions;  // by the number of shadow rays, to reuse samples
  for (const int rays : {1, 16, 64}) {
    const std::vector<std::string> pixel{"film.samples_per_pixel=" + std::to_string(rays)};
    const Image truth =
        estimated(references, "sphere",
                  joined(joined(skin, pixel),
                         {"settings.samples=30000", "settings.light_samples=128", "settings.seed=5"}))
            .image;
    for (const int light : {4, 16})
      expect_estimate(
          estimated(sessions[light], "sphere",
                    joined(joined(skin, pixel), {"settings.light_samples=" + std::to_string(light)})),
          truth, std::to_string(rays) + " rays, " + std::to_string(light) + " to a light");
  }
}

}  // namespace
}  // namespace opaline
