// SPDX-License-Identifier: GPL-3.0-or-later
// Time as the knob: what a CPU time is spent on.
#include <gtest/gtest.h>

#include "core/scratch_folder.h"
#include "core/stopwatch.h"
#include "quality/one_body.h"
#include "quality/probe.h"
#include "quality/time_budget.h"

namespace opaline::test {
namespace {

constexpr int kPictureSide = 160;

/// The torus shadows itself, the box has edges, the balls an opaque floor under an area light.
std::vector<Scene> budget_scenes() {
  Scene balls = two_balls();
  balls.settings.method = Method::hierarchical;
  balls.film.resolution = {96, 64};
  return {marble_torus(kPictureSide),
          one_body(BoxShape{{-9, -9, -9}, {9, 9, 9}}, grey_medium(.4, .01, 1.3),
                   {"sun", DirectionalLight{{-.6, -.8, 0}, Rgb(1)}}, kPictureSide),
          balls};
}

struct Spent {
  TimeBudget chosen;
  double seconds = 0;
  double tolerance = 0;
};

Spent spend(const Scene& scene, double seconds) {
  const ScratchFolder folder;
  const auto write = [&](const Image& picture) { write_exr(folder.file("a.exr"), picture, true); };
  Session session;
  const Stopwatch watch;
  Spent spent{fit_budget(session, scene, seconds, write)};
  write(session.render().image);
  spent.seconds = watch.cost({}).cpu_seconds;
  spent.tolerance = session.scene().settings.tolerance;
  return spent;
}

TimeBudget fit(Session& session, const Scene& scene, double seconds) {
  return fit_budget(session, scene, seconds, [](const Image&) {});
}

/// What the cheapest picture takes on this machine, s: budgets are told in it.
double least(const Scene& scene) {
  Session session;
  return fit(session, scene, 1e-3).planned;
}

// Claim: choosing, the picture and its file end within 110 % of the time, and use a good part of it. Source:
// time_budget.h. The clock is the kernel's account of CPU; a case that is disturbed may be tried again,
// twice. Tolerance: none; a third of the time at the least. Fails if: more than the time is planned
// (kPlannedShare of 1.6), the cost of sampling is left out, or samples stay at the fewest.
TEST(TimeBudget, IsKeptAndUsed) {
  for (const Scene& scene : budget_scenes())
    for (const double leasts : {4., 10.}) {
      const double seconds = leasts * least(scene);
      Spent spent;
      for (int attempt = 0; attempt < 3; ++attempt) {
        spent = spend(scene, seconds);
        if (spent.seconds <= 1.1 * seconds) break;
      }
      SCOPED_TRACE(scene.shapes[0].name + ", " + std::to_string(seconds) + " s, spent " +
                   std::to_string(spent.seconds) + ", samples " + std::to_string(spent.chosen.samples));
      EXPECT_TRUE(spent.chosen.fits && spent.chosen.sees_translucent);
      EXPECT_LE(spent.seconds, 1.1 * seconds);
      EXPECT_GE(spent.seconds, seconds / 3);
      EXPECT_LE(spent.chosen.planned, seconds);
    }
}

// Claim: what is done with the picture afterwards is planned for, as large as it is: here half of the time.
// Tolerance: as above. Fails if: it is left out of the plan, or taken for that of a small picture.
TEST(TimeBudget, PlansForWhatFollows) {
  const Scene scene = marble_torus(kPictureSide);
  const double half = 5 * least(scene), pixels = kPictureSide * kPictureSide;
  const auto finish = [&](const Image& picture) {
    const Stopwatch watch;
    while (watch.cost({}).cpu_seconds < half * double(picture.width) * double(picture.height) / pixels)
      continue;
  };
  double spent = 0;
  for (int attempt = 0; attempt < 3; ++attempt) {
    Session session;
    const Stopwatch watch;
    EXPECT_TRUE(fit_budget(session, scene, 2.6 * half, finish).fits);
    finish(session.render().image);
    spent = watch.cost({}).cpu_seconds;
    if (spent <= 1.1 * 2.6 * half) break;
  }
  EXPECT_LE(spent, 1.1 * 2.6 * half);
  EXPECT_GE(spent, 1.5 * half);
}

// Claim: of budgets each three times the one before, none chooses fewer samples or a coarser tolerance.
// Fails if: samples are those of the first small picture, or the tolerance is.
TEST(TimeBudget, MoreTimeIsNoCoarser) {
  const Scene scene = marble_torus(kPictureSide);
  const double unit = least(scene);
  double samples = 0, tolerance = 1;
  for (const double leasts : {2., 6., 18., 54.}) {
    Session session;
    const TimeBudget chosen = fit(session, scene, leasts * unit);
    EXPECT_GE(double(chosen.samples), samples) << leasts;
    EXPECT_LE(session.scene().settings.tolerance, tolerance) << leasts;
    samples = double(chosen.samples);
    tolerance = session.scene().settings.tolerance;
  }
  EXPECT_GT(samples, 20000);
  EXPECT_LT(tolerance, .005);
}

// Claim: too little time is said, with what the cheapest takes, within a factor of two; that has few samples,
// and makes a picture. Fails if: `fits` is always true, or what was spent on choosing is left out.
TEST(TimeBudget, SaysWhatTheLeastIs) {
  Scene scene = marble_torus(kPictureSide);
  scene.film.samples_per_pixel = 16;
  const Spent spent = spend(scene, .01);
  EXPECT_FALSE(spent.chosen.fits);
  EXPECT_LT(spent.chosen.samples, 11000u);
  EXPECT_GT(spent.chosen.planned, .5 * spent.seconds);
  EXPECT_LT(spent.chosen.planned, 2 * spent.seconds);
}

// Claim: the error that is predicted is the one against the truth, within a factor of two and a half. The
// truth has 400k samples of another seed. Fails if: the prediction is that of the last small picture, which
// has an eighth of the samples.
TEST(TimeBudget, PredictsTheError) {
  Scene scene = marble_torus(kPictureSide), truth = scene;
  truth.settings.samples = 400000;
  truth.settings.seed = 77;
  truth.settings.tolerance = 5e-4;
  truth.settings.evaluator = EvaluatorKind::dual_tree;
  Session session;
  const TimeBudget chosen = fit(session, scene, 8 * least(scene));
  ASSERT_TRUE(chosen.predicted);
  const double measured = probe_difference(session.render().image, cold_picture(truth));
  EXPECT_LT(std::abs(std::log(*chosen.predicted / measured)), std::log(2.5))
      << *chosen.predicted << " against " << measured << ", samples " << chosen.samples;
}

// Claim: samples end at settings.max_samples, which is said. Fails if: the cap is ignored.
TEST(TimeBudget, EndsAtTheMostSamples) {
  Scene scene = marble_torus(kPictureSide);
  scene.settings.max_samples = 6000;
  Session session;
  const double seconds = 50 * least(scene);
  const TimeBudget chosen = fit(session, scene, seconds);
  EXPECT_TRUE(chosen.at_most && chosen.fits);
  EXPECT_EQ(chosen.samples, 6000u);
  EXPECT_LT(chosen.planned, .8 * seconds);
  EXPECT_TRUE(session.plan().warnings.empty());
}

// Claim: where nothing translucent is in the scene or in sight, that is said and the scene stays as it was.
TEST(TimeBudget, NothingTranslucentSeen) {
  Scene opaque = two_balls(), away = two_balls();
  for (Shape& shape : opaque.shapes) shape.medium.reset();
  away.camera.look_at = {0, -1, 55};  // the floor alone
  away.camera.field_of_view = 10;
  for (const Scene& scene : {opaque, away}) {
    Session session;
    EXPECT_FALSE(fit(session, scene, 1).sees_translucent);
    EXPECT_EQ(session.scene().settings.samples, scene.settings.samples);
    EXPECT_EQ(session.scene().settings.evaluator, EvaluatorKind::automatic);
  }
}

// Claim: large pictures of a smooth surface get the surface cache where the scene leaves that open, and keep
// its evaluator where it does not. Fails if: the cache is never tried, or tried where another is asked for.
TEST(TimeBudget, ChoosesTheEvaluatorWhereItIsOpen) {
  Scene scene = marble_torus(kPictureSide);
  scene.film.resolution = {1600, 1600};
  const double seconds = 1.5 * least(scene);
  Session session;
  fit(session, scene, seconds);
  EXPECT_EQ(session.scene().settings.evaluator, EvaluatorKind::automatic);
  scene.settings.evaluator = EvaluatorKind::dual_tree;
  fit(session, scene, seconds);
  EXPECT_EQ(session.scene().settings.evaluator, EvaluatorKind::dual_tree);
}

// Claim: cells become smaller with the time, within 110 % of it (tried thrice), until the error of the model hides theirs; too
// little time is said. Source: time_budget.h. Fails if: the cells of a trial are kept, or its cost is left out.
TEST(TimeBudget, CellsFitIntoTheTime) {
  Scene scene = marble_torus(kPictureSide);
  scene.settings.method = Method::volume_diffusion;
  const auto fitted = [&](double seconds, double& spent) {
    Session session;
    const Stopwatch watch;
    const TimeBudget chosen = fit(session, scene, seconds);
    session.render();
    spent = watch.cost({}).cpu_seconds;
    EXPECT_TRUE(chosen.sees_translucent && chosen.predicted);
    return std::pair(chosen, session.scene().settings.cell_size);
  };
  double spent = 0, size = INFINITY, error = 1;
  const double unit = fitted(1e-3, spent).first.planned;
  EXPECT_FALSE(fitted(1e-3, spent).first.fits);
  for (const double units : {2., 5.}) {
    std::pair<TimeBudget, double> chosen;
    for (int attempt = 0; attempt < 3; ++attempt) {
      chosen = fitted(units * unit, spent);
      if (spent <= 1.1 * units * unit) break;
    }
    EXPECT_LE(spent, 1.1 * units * unit);
    EXPECT_LT(chosen.second, size) << units;
    EXPECT_LT(*chosen.first.predicted, error) << units;
    size = chosen.second, error = *chosen.first.predicted;
  }
  EXPECT_TRUE(fitted(1000 * unit, spent).first.at_most);
}

// Claim: direct ends within 110 % of the time too (tried thrice), uses a good part of it, and its picture is
// that of as many entry samples without a clock. Fails if: a pass is given twice, or the last passes are not
// counted.
TEST(TimeBudget, DirectEndsInTime) {
  Scene scene = marble_torus(kPictureSide);
  scene.settings.method = Method::direct;
  Session session;
  session.edit(scene);
  session.prepare();
  DirectState one;
  const Stopwatch watch;
  scene.settings.entry_samples = 16;
  render_direct({scene, session.world(), session.rays(), session.plan()}, one);
  const double seconds = 12 * watch.cost({}).cpu_seconds;
  DirectResult result;
  double spent = 0;
  for (int attempt = 0; attempt < 3; ++attempt) {
    const Stopwatch own;
    result = direct_within({session.scene(), session.world(), session.rays(), session.plan()}, seconds,
                           [](const Image&) {});
    spent = own.cost({}).cpu_seconds;
    if (spent <= 1.1 * seconds) break;
  }
  EXPECT_LE(spent, 1.1 * seconds);
  EXPECT_GE(spent, .4 * seconds);
  scene.settings.entry_samples = result.entry_samples;
  DirectState state;
  const DirectResult again = render_direct({scene, session.world(), session.rays(), session.plan()}, state);
  EXPECT_TRUE(same_pixels(result.picture.image, again.picture.image));
  EXPECT_EQ(again.entry_samples, result.entry_samples);
}

// Claim: the scene's own bounds on direct hold in less time. Fails if: they are replaced.
TEST(TimeBudget, DirectKeepsItsOwnBounds) {
  Scene scene = marble_torus(kPictureSide);
  scene.film.resolution = {32, 32};
  scene.settings.method = Method::direct;
  Session session;
  session.edit(scene);
  session.prepare();
  const auto run = [&] {
    return direct_within({scene, session.world(), session.rays(), session.plan()}, 20, [](const Image&) {});
  };
  scene.settings.entry_samples = 64;
  EXPECT_EQ(run().entry_samples, 64u);
  scene.settings.entry_samples.reset();
  scene.settings.until_error = .2;
  EXPECT_LE(run().relative_error, .2);
}

}  // namespace
}  // namespace opaline::test
