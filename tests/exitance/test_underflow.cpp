// SPDX-License-Identifier: GPL-3.0-or-later
// Exponentials that underflow.
#include <ctime>

#include "support/clouds.h"

namespace opaline {
namespace {

using namespace test;

// Claim: where sigma_tr r is about 1e4 nothing comes out, and neither there nor where exp(-sigma_tr r) is a
// denormal (r about 90 / sigma_tr) does a query take more than 3 times as long as at moderate distance.
// Source: denormal arithmetic stalls by a hundred cycles. Tolerance: factor 3 on the least of 9 runs' CPU
// time, one thread; 1e-30 of E for "nothing". Fails if: worker threads or the caller's do not flush denormals
// and the kernel is computed by exp.
TEST(Underflow, DoesNotStall) {
  const double radius = 20;
  const Cloud cloud(SphereShape{{}, radius}, 20000);
  const Octree octree = cloud.tree(RgbF(1));
  for (const ProfileKind kind : {ProfileKind::dipole, ProfileKind::normalized_diffusion}) {
    const DiffuseProfile profile = make_diffuse_profile(grey_medium(10, .5, 1.3, kind));
    const double decay = kind == ProfileKind::dipole
                             ? std::sqrt(1.5) / 10
                             : 1 / (3 * std::get<NormalizedDiffusion>(profile.channels[0]).d);
    const SplitKernel kernel = make_split_kernel(profile, cloud.surface.spacing(), 1e4 / decay + 1, true);
    const auto seconds = [&](double distance, EvaluatorKind evaluator, RgbF& out) {
      const std::vector<Query> queries(100, Query{{float(distance), 0, 0}, {1, 0, 0}});
      double best = 1e9;
      for (int run = 0; run < 9; ++run) {
        const std::clock_t start = std::clock();
        out = evaluated_by(evaluator, octree, kernel, queries, 1e-6, 1e-7)[0].exitance;
        best = std::min(best, double(std::clock() - start) / CLOCKS_PER_SEC);
      }
      return best;
    };
    with_threads(1, [&] {
      for (const EvaluatorKind evaluator : kEvaluators) {
        RgbF moderate, denormal, nothing;
        const double usual = seconds(radius + 5 / decay, evaluator, moderate);
        const double slow = seconds(radius + 88 / decay, evaluator, denormal);
        const double far = seconds(1e4 / decay, evaluator, nothing);
        const std::string name = (kind == ProfileKind::dipole ? "dipole, " : "normalized diffusion, ") +
                                 std::string(name_of(evaluator));
        report(name + ": denormal / moderate time", slow / usual);
        report(name + ": underflow / moderate time", far / usual);
        EXPECT_GT(moderate.x, 1e-6f);
        EXPECT_LT(denormal.x, 1e-30f);
        EXPECT_LT(nothing.x, 1e-30f);
        EXPECT_LT(slow, 3 * usual);
        EXPECT_LT(far, 3 * usual);
      }
      return 0;
    });
  }
}

}  // namespace
}  // namespace opaline
