// SPDX-License-Identifier: GPL-3.0-or-later
// Pictures of `direct`.
#include "input/load_scene.h"
#include "render/direct_test.h"
#include "support/lighting.h"

namespace opaline::test {
namespace {

Scene lit_ball(int pixels) {
  Scene scene = single_shape(SphereShape{{}, 10}, grey_medium(1, .01, 1.3), 1);
  scene.lights = {point_light({20, 30, 40}, {1e4, 2e4, 3e4})};
  scene.camera.position = {0, 0, 50};
  scene.film.resolution = {pixels, pixels};
  return scene;
}

/// Twelve triangles, of which three faces show, one of them in the dark: where pictures are many, no time
/// goes into trees of triangles.
Scene lit_box(int pixels) {
  Scene scene = lit_ball(pixels);
  scene.shapes[0].source = BoxShape{Vec3d(-7), Vec3d(7)};
  scene.shapes[0].normals = NormalMode::faceted;
  scene.camera.position = {-25, 20, 35};
  return scene;
}

double sum_of(const Image& image, const std::string& name) {
  double sum = 0;
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < image.width; ++x) sum += double(channel(image, x, y, name));
  return sum;
}

// Claim: without absorption under uniform radiance 1 a sphere sends back CDF(2R) Ft + F: the whole way from
// camera to light, for both profiles and strategies. Source: WhiteFurnace of the hierarchical picture.
// Tolerance: 4 standard errors of the picture's mean by its own variance layer, and .3 % for the polyhedron.
// Fails if: Ft is taken twice or the samples of a pixel are not averaged.
TEST(Direct, WhiteFurnace) {
  for (const ProfileKind kind : {ProfileKind::dipole, ProfileKind::normalized_diffusion})
    for (const EntryStrategy strategy : kStrategies) {
      Scene scene = single_shape(SphereShape{{}, 25}, grey_medium(.5, 0, 1.4, kind), 1);
      scene.lights = {unit_surroundings()};
      scene.film.resolution = {16, 16};
      scene.film.samples_per_pixel = 2;
      scene.camera.field_of_view = 25;
      scene.settings.laboratory.entry_strategy = strategy;
      DirectScene ball(scene);
      const Image image = ball.picture(16);
      const double returned = diffuse_reflectance_within(ball.profile().channels[1], 50);
      double sum = 0, expected = 0, variance = 0;
      for (int y = 0; y < 16; ++y)
        for (int x = 0; x < 16; ++x) {
          if (channel(image, x, y, "A") < 1) continue;
          sum += double(channel(image, x, y, "G"));
          variance += double(channel(image, x, y, "variance.G"));
          // Energy is what the mirror does not send back, times what was returned.
          const double reflected = double(channel(image, x, y, "specular.G"));
          expected += returned * (1 - reflected) + reflected;
        }
      report(name_of(kind, strategy) + ", over expected", sum / expected);
      report("standard error %", 100 * std::sqrt(variance) / expected);
      EXPECT_NEAR(sum, expected, 4 * std::sqrt(variance) + .003 * expected) << name_of(kind, strategy);
    }
}

// Claim: both strategies make the same picture of the bunny, in every block of 8 x 8 pixels. Source: both are
// unbiased. Tolerance: 64 blocks at 1 % together (Sidak: 3.95 standard errors of a normal distribution, 4.5
// taken for its tails), the picture at 4. Fails if: one strategy's density is 5 % off, or one misses surfaces
// that fold.
TEST(Direct, StrategiesAgreeOnTheBunny) {
  std::vector<Image> pictures;
  for (const EntryStrategy strategy : kStrategies) {
    Scene scene = single_shape(bunny_file(), marble(), 1);
    scene.lights = {point_light({60, 100, 80}, Rgb(1e4)), {"back", DirectionalLight{{0, 0, 1}, Rgb(1)}}};
    scene.camera.position = {0, 30, 90};
    scene.camera.look_at = {0, 24, 0};
    scene.film.resolution = {64, 64};
    scene.settings.laboratory.entry_strategy = strategy;
    pictures.push_back(DirectScene(scene).picture(8));
  }
  double all = 0, all_variance = 0, largest = 0;
  int lit = 0;
  for (int block = 0; block < 64; ++block) {
    double difference = 0, variance = 0;
    for (int i = 0; i < 64; ++i) {
      const int x = block % 8 * 8 + i % 8, y = block / 8 * 8 + i / 8;
      difference += double(channel(pictures[0], x, y, "diffuse.G") - channel(pictures[1], x, y, "diffuse.G"));
      for (const Image& image : pictures) variance += double(channel(image, x, y, "variance.G"));
    }
    all += difference;
    all_variance += variance;
    if (variance > 0) ++lit, largest = std::max(largest, std::abs(difference) / std::sqrt(variance));
  }
  report("largest block's difference in standard errors", largest);
  report("the picture's difference in standard errors", all / std::sqrt(all_variance));
  report("its standard error %", 100 * std::sqrt(all_variance) / sum_of(pictures[0], "diffuse.G"));
  EXPECT_GT(lit, 20);
  EXPECT_LT(largest, 4.5);
  EXPECT_LT(std::abs(all), 4 * std::sqrt(all_variance));
  EXPECT_LT(std::sqrt(all_variance), .01 * sum_of(pictures[0], "diffuse.G"));
}

// Claim: `direct` and the hierarchical picture agree. Source: the one is the other's reference. Tolerance:
// over the whole picture 4 standard errors and 1 % for 40,000 samples; layers without noise 1e-5. Fails if:
// either has another factor in its radiance.
TEST(Direct, AgreesWithTheHierarchicalPicture) {
  Scene scene = lit_ball(24);
  const Image direct = DirectScene(scene).picture(16);
  scene.settings.samples = 40000;
  const Image hierarchical = Prepared(scene).picture();
  for (const std::string name : {"R", "G", "B"}) {
    const double expected = sum_of(hierarchical, name), error = std::sqrt(sum_of(direct, "variance." + name));
    report(name + " over the hierarchical picture", sum_of(direct, name) / expected);
    report("standard error %", 100 * error / expected);
    EXPECT_NEAR(sum_of(direct, name), expected, 4 * error + .01 * expected) << name;
    EXPECT_LT(error, .01 * expected);
  }
  for (const char* name : {"A", "albedo.R", "N.X", "P.Z", "Z"})
    EXPECT_NEAR(sum_of(direct, name), sum_of(hierarchical, name), 1e-5 * std::abs(sum_of(hierarchical, name)))
        << name;
}

// Claim: translucent objects do not bleed into each other unless grouped. Source:
// Groups.NoBleedUnlessGrouped: two spheres with a gap, of which light reaches the left one alone. Tolerance:
// none. Fails if: lines ask all meshes.
TEST(Direct, NoBleedUnlessGrouped) {
  for (const EntryStrategy strategy : kStrategies)
    for (const bool grouped : {false, true}) {
      Scene scene = single_shape(SphereShape{{-5.05, 0, 0}, 5}, grey_medium(1, .01, 1.3), 1);
      scene.shapes.push_back(translucent("right", SphereShape{{5.05, 0, 0}, 5}));
      scene.shapes[0].group = scene.shapes[1].group = grouped ? "pair" : "";
      scene.lights = {point_light({-200, 0, 0}, Rgb(1e5))};
      scene.camera.position = {0, 0, 60};
      scene.camera.field_of_view = 25;
      scene.settings.laboratory.entry_strategy = strategy;
      scene.settings.bounces = 0;
      const Image image = DirectScene(scene).picture(4);
      double right = 0;
      for (int y = 0; y < image.height; ++y)
        for (int x = image.width / 2; x < image.width; ++x)
          right += double(channel(image, x, y, "diffuse.G"));
      EXPECT_EQ(right > 0, grouped);
    }
}

// Claim: a metal mirrors what the other methods see there, translucent things and the light between them. Source: the same
// BSSRDF. Tolerance: 3 % of the mean. Fails if entries are drawn for what the camera sees alone (the ball is black in the
// mirror then).
TEST(Direct, SeesBodiesInMirrors) {
  const Scene scene = parse_scene(
      R"({"media": {"stone": {"preset": "marble", "specular_ior": 1, "profile": "dipole"}},
      "shapes": [{"sphere": {"radius": 10}, "medium": "stone"},
        {"quad": {"corner": [-30, -30, -20], "u": [60, 0, 0], "v": [0, 60, 0]}, "reflectance": 1, "metalness": 1,
          "specular_roughness": 0}],
      "lights": [{"type": "point", "position": [60, 30, 0], "intensity": 3000}],
      "camera": {"position": [60, 0, 40], "look_at": [20, 0, -20], "field_of_view": 4},
      "film": {"resolution": [16, 16], "samples_per_pixel": 4, "pixel_type": "float"}})",
      "text.json");
  const double mirrored = sum_of(Prepared(scene).picture(), "specular.G");
  EXPECT_GT(mirrored, 10);
  EXPECT_NEAR(sum_of(DirectScene(scene).picture(64), "specular.G") / mirrored, 1, .03);
}

// Claim: an opaque floor under a translucent ball is what the hierarchical picture shows, and without any
// translucent shape the pictures are the same to the last bit. Source: it is not sampled at random,
// but for light that bounces.
// Tolerance: 1e-5 relative where the opaque surface is seen (passes are summed in floats). Fails if: opaque
// light is left out of the passes, or added to them twice.
TEST(Direct, OpaqueSurfacesAreAsEver) {
  Scene scene = lit_ball(24);
  Shape floor;
  floor.name = "floor";
  floor.source = QuadShape{{-30, -12, 30}, {60, 0, 0}, {0, 0, -60}};
  scene.shapes.push_back(floor);
  scene.settings.samples = 2000;
  scene.settings.bounces = 0;
  const Image hierarchical = Prepared(scene).picture(), direct = DirectScene(scene).picture(5);
  int opaque = 0;
  for (int y = 0; y < 24; ++y)
    for (int x = 0; x < 24; ++x) {
      if (channel(direct, x, y, "albedo.R") != .5f) continue;
      ++opaque;
      const float expected = channel(hierarchical, x, y, "R");
      EXPECT_NEAR(channel(direct, x, y, "R"), expected, 1e-5f * expected) << x << ' ' << y;
    }
  EXPECT_GT(opaque, 50);
  EXPECT_GT(sum_of(direct, "R"), 0);
}

// Claim: a channel that does not scatter has a diffuse part of exactly 0 and changes no bit of the others
// that would draw the same numbers; a medium that scatters nowhere is black and not an error. Source:
// definition. Tolerance: none. Fails if: 0 / 0 of the kernel over the density reaches the picture.
TEST(Direct, ChannelsThatDoNotScatterAreBlack) {
  for (const EntryStrategy strategy : kStrategies)
    for (const Rgb& sigma_s_prime : {Rgb{1, 0, 2}, Rgb{0, 0, 3}, Rgb{0, 0, 0}})
      for (const double sigma_a : {0., .1}) {
        Scene scene = lit_box(12);
        scene.media[0].coefficients = PhysicalMedium{Rgb(sigma_a), sigma_s_prime};
        scene.settings.laboratory.entry_strategy = strategy;
        DirectScene box(scene);
        DirectState state;
        const DirectResult result = box.run(state, 2);
        EXPECT_EQ(result.picture.non_finite, 0u);
        const char* names[] = {"diffuse.R", "diffuse.G", "diffuse.B"};
        for (std::size_t c = 0; c < 3; ++c)
          EXPECT_EQ(sum_of(result.picture.image, names[c]) > 0, sigma_s_prime[c] > 0) << names[c];
      }
}

// Claim: without light the picture is exactly black, its noise none, and until_error ends after 8 passes.
// Source: linearity. Tolerance: none. Fails if: 0 / 0 of the noise is not told.
TEST(Direct, NoLightIsBlack) {
  Scene scene = lit_box(16);
  scene.lights.clear();
  scene.settings.until_error = .01;
  scene.settings.entry_samples = 16 * 50;
  DirectScene box(scene);
  DirectState state;
  const DirectResult result = render_direct({box.scene, box.world, box.rays, box.plan}, state);
  EXPECT_EQ(state.passes, 8u);
  EXPECT_EQ(result.relative_error, 0);
  for (const char* name : {"R", "G", "B", "variance.R"}) EXPECT_EQ(sum_of(result.picture.image, name), 0);
  EXPECT_GT(sum_of(result.picture.image, "A"), 0);
}

// Claim: a picture of one pixel, and one of nothing, are pictures. Source: none needed. Fails if: a tile is
// taken for full.
TEST(Direct, OnePixelAndNothing) {
  Scene scene = lit_box(1);
  const Image one = DirectScene(scene).picture(3);
  ASSERT_EQ(one.width * one.height, 1);
  EXPECT_GT(channel(one, 0, 0, "G"), 0);
  scene = lit_box(4);
  scene.shapes.clear();
  EXPECT_EQ(sum_of(DirectScene(scene).picture(2), "R"), 0);
}

// Claim: the variance layer is the variance of the pixel's mean: over 256 seeds it agrees with the scatter.
// Source: definition. Tolerance: 8 % over the lit pixels together (some 50 x 255, of tails heavier than the
// normal distribution's: 2 % of scatter; with 2,048 seeds .3 % were measured), and no pixel's ratio outside
// [.6, 1.5]. Fails if: n - 1 is n, or the variance is a pass's and not the mean's (8 times as much).
TEST(Direct, VarianceIsTheScatterOfSeeds) {
  Scene scene = lit_box(10);
  scene.lights.push_back(unit_sphere_light({-20, 10, 30}, 5));
  DirectScene box(scene);
  std::vector<Mean> means(100), stated(100);
  for (std::uint64_t seed = 0; seed < 256; ++seed) {
    box.scene.settings.seed = seed;
    const Image image = box.picture(8);
    for (std::size_t p = 0; p < 100; ++p) {
      means[p].add(double(channel(image, int(p % 10), int(p / 10), "diffuse.G")));
      stated[p].add(double(channel(image, int(p % 10), int(p / 10), "variance.G")));
    }
  }
  double scatter_sum = 0, stated_sum = 0, lowest = INFINITY, highest = 0;
  for (std::size_t p = 0; p < 100; ++p) {
    if (means[p].mean() == 0) continue;
    // Each pixel alike, however bright.
    const double square = means[p].mean() * means[p].mean(), ratio = means[p].variance() / stated[p].mean();
    scatter_sum += means[p].variance() / square;
    stated_sum += stated[p].mean() / square;
    lowest = std::min(lowest, ratio);
    highest = std::max(highest, ratio);
  }
  report("scatter over stated variance", scatter_sum / stated_sum);
  report("lowest of a pixel", lowest);
  report("highest of a pixel", highest);
  EXPECT_NEAR(scatter_sum / stated_sum, 1, .08);
  EXPECT_GT(lowest, .6);
  EXPECT_LT(highest, 1.5);
}

// Claim: the same bytes for 1 and 2 threads, another seed other ones. Source: the design. Tolerance: none.
// Fails if: random numbers are counted by thread; or the seed is ignored.
TEST(Direct, SameBytesForOneAndTwoThreads) {
  Scene scene = lit_box(40);
  scene.film.samples_per_pixel = 2;
  scene.lights.push_back(unit_surroundings());
  const auto picture = [&](std::size_t threads) {
    return with_threads(threads, [&] { return DirectScene(scene).picture(3); });
  };
  const Image one = picture(1);
  EXPECT_TRUE(std::ranges::equal(one.pixels, picture(2).pixels));
  scene.settings.seed = 1;
  EXPECT_FALSE(std::ranges::equal(one.pixels, picture(2).pixels));
}

// Claim: a crop's pixels are the whole picture's. Source: keys are by place in the whole. Tolerance: none.
// Fails if: they are by place in the crop.
TEST(Direct, CropIsPartOfTheWhole) {
  Scene scene = lit_box(32);
  const Image whole = DirectScene(scene).picture(2);
  scene.film.crop = {{5, 3, 27, 29}};
  const Image part = DirectScene(scene).picture(2);
  ASSERT_EQ(part.width, 22);
  ASSERT_EQ(part.height, 26);
  const std::size_t n = whole.channels.size();
  for (int y = 0; y < part.height; ++y)
    EXPECT_TRUE(std::equal(part.pixels.data() + std::size_t(y) * 22 * n,
                           part.pixels.data() + std::size_t(y + 1) * 22 * n,
                           whole.pixels.data() + (std::size_t(y + 3) * 32 + 5) * n))
        << "row " << y;
}

}  // namespace
}  // namespace opaline::test
