// SPDX-License-Identifier: GPL-3.0-or-later
#include <cmath>

#include "scene_test.h"

namespace opaline {
namespace {

void expect_near(const Vec3d& a, const Vec3d& b, double tolerance = 1e-12) {
  for (std::size_t i = 0; i < 3; ++i) EXPECT_NEAR(a[i], b[i], tolerance) << "component " << i;
}

PhysicalMedium physical(const std::string& inside) {
  return std::get<PhysicalMedium>(parse(with_medium("{" + inside + "}")).media.at(0).coefficients);
}

ArtistMedium artist(const std::string& inside) {
  return std::get<ArtistMedium>(parse(with_medium("{" + inside + "}")).media.at(0).coefficients);
}

// Claim: an empty scene is a scene, with the defaults of scene.h. Fails if a top-level key becomes required.
TEST(SceneValues, EmptySceneHasDefaults) {
  const Scene scene = parse("\xef\xbb\xbf/* nothing */ {}");
  EXPECT_TRUE(scene.media.empty() && scene.shapes.empty() && scene.lights.empty());
  EXPECT_EQ(scene.camera.position, Vec3d(0, 0, 5));
  EXPECT_EQ(scene.film.resolution, (std::array<int, 2>{512, 512}));
  EXPECT_EQ(scene.settings.max_samples, 2000000u);
  EXPECT_EQ(scene.file, "test.json");
}

// Claim: an f-number is the focal length of a film of 24 mm height over the diameter of the lens; a point of focus counts along the
// view; lengths are scene units; a value of the command line replaces the other key of the file. By hand: 12 mm / tan(20 degrees) / 2.8 = 11.775 mm;
// the point (3, 0, 1) is 4 units in front of a camera at z = 5 that looks along -z. Fails if: millimetres and units change places.
TEST(SceneValues, Lenses) {
  const auto camera = [](const std::string& inside, const std::vector<std::string>& overrides = {}) {
    return parse(R"({"mm_per_unit": 10, "camera": {)" + inside + "}}", overrides).camera;
  };
  EXPECT_NEAR(camera(R"("f_number": 2.8)").aperture, 11.775, .001);
  EXPECT_EQ(camera(R"("aperture": 3)").aperture, 30);
  EXPECT_FALSE(camera("").focus_distance);
  EXPECT_EQ(camera(R"("focus_distance": 7)").focus_distance, 70);
  EXPECT_NEAR(*camera(R"("focus_point": [3, 0, 1])").focus_distance, 40, 1e-12);
  EXPECT_FALSE(camera(R"("focus_point": [0, 0, 6])").focus_distance);  // behind
  EXPECT_EQ(camera(R"("f_number": 2)", {"camera.orthographic_height=2"}).aperture, 0);
  EXPECT_EQ(camera(R"("orthographic_height": 2)").orthographic_height, 20);
  const Camera replaced =
      camera(R"("field_of_view": 30, "aperture": 1, "focus_distance": 2)",
             {"camera.orthographic_height=4", "camera.aperture=2", "camera.focus_point=[0, 0, 0]"});
  EXPECT_EQ(replaced.orthographic_height, 40);
  EXPECT_EQ(replaced.aperture, 20);
  EXPECT_EQ(replaced.focus_distance, 50);
}

// Claim: more than six built-in curved shapes are less fine, and all take at most 8 million triangles together, until each
// has the fewest. Fails if each of 300 balls is as fine as a lone one (4.5 GB), or a seventh changes nothing.
TEST(SceneValues, ManyBallsAreCoarserThanFew) {
  const auto fineness_of = [](int balls) {
    std::string shapes;
    for (int i = 0; i < balls; ++i) shapes += R"({"sphere": {"radius": 1}}, )";
    const Scene scene =
        parse(R"({"shapes": [)" + shapes + R"({"torus": {"major_radius": 2, "minor_radius": 1}}]})");
    const int of_torus = std::get<TorusShape>(scene.shapes.back().source).fineness;
    EXPECT_EQ(std::get<SphereShape>(scene.shapes.front().source).fineness, of_torus);
    return of_torus;
  };
  EXPECT_EQ(fineness_of(5), kMostFineness);
  EXPECT_EQ(fineness_of(6), kMostFineness - 1);
  EXPECT_EQ(fineness_of(299), kMostFineness - 1);
  EXPECT_EQ(fineness_of(2000), kLeastFineness);
}

// Claim: the presets hold the numbers of Jensen et al. 2001. Source: their figure 5; two whole rows and a sum
// over all of them, typed anew from the table in channel order. Fails if sigma_a and sigma_s_prime change
// places.
TEST(SceneValues, Presets) {
  const PhysicalMedium marble = physical(R"("preset": "marble")");
  EXPECT_EQ(marble.sigma_s_prime, Rgb(2.19, 2.62, 3.00));
  EXPECT_EQ(marble.sigma_a, Rgb(0.0021, 0.0041, 0.0071));
  EXPECT_EQ(physical(R"("preset": "spectralon")").sigma_a, Rgb());
  EXPECT_EQ(physical(R"("preset": "ketchup")").sigma_a, Rgb(0.061, 0.97, 1.45));
  Rgb scattering, absorption;
  for (const char* name : {"apple", "chicken1", "chicken2", "cream", "ketchup", "marble", "potato",
                           "skimmilk", "skin1", "skin2", "spectralon", "wholemilk"}) {
    const PhysicalMedium medium = physical(R"("preset": ")" + std::string(name) + '"');
    scattering += medium.sigma_s_prime;
    absorption += medium.sigma_a;
    const double eta = parse(with_medium(R"({"preset": ")" + std::string(name) + "\"}")).media[0].eta;
    EXPECT_EQ(eta, std::string(name) == "marble" ? 1.5 : 1.3) << name;
  }
  expect_near(scattering, {2.29 + .15 + .19 + 7.38 + .18 + 2.19 + .68 + .70 + .74 + 1.09 + 11.6 + 2.55,
                           2.39 + .21 + .25 + 5.47 + .07 + 2.62 + .70 + 1.22 + .88 + 1.59 + 20.4 + 3.21,
                           1.97 + .38 + .32 + 3.15 + .03 + 3.00 + .55 + 1.90 + 1.01 + 1.79 + 14.9 + 3.77});
  expect_near(absorption,
              {.0030 + .015 + .018 + .0002 + .061 + .0021 + .0024 + .0014 + .032 + .013 + 0 + .0011,
               .0034 + .077 + .088 + .0028 + .97 + .0041 + .0090 + .0025 + .17 + .070 + 0 + .0024,
               .046 + .19 + .20 + .0163 + 1.45 + .0071 + .12 + .0142 + .48 + .145 + 0 + .014});
}

// Claim: the four ways to describe a medium give these coefficients, whatever mm_per_unit says; the ends of
// every range are accepted. Source: scenes/README.md; sigma_s' = (1 - g) sigma_s. Fails if a coefficient is
// scaled by mm_per_unit, if g is taken as -g, or if a zero is refused.
TEST(SceneValues, Media) {
  EXPECT_EQ(physical(R"("sigma_a": 2, "sigma_s_prime": [1, 2, 3])").sigma_a, Rgb(2, 2, 2));
  EXPECT_EQ(physical(R"("sigma_a": 0, "sigma_s": [4, 8, 12], "g": 0.75)").sigma_s_prime, Rgb(1, 2, 3));
  EXPECT_EQ(physical(R"("sigma_a": 0, "sigma_s": 4, "g": -0.5)").sigma_s_prime, Rgb(6, 6, 6));
  EXPECT_EQ(physical(R"("sigma_a": 0, "sigma_s": 4)").sigma_s_prime, Rgb(4, 4, 4));
  EXPECT_EQ(physical(R"("sigma_a": 0, "sigma_s_prime": 0)").sigma_s_prime, Rgb());
  EXPECT_NEAR(physical(R"("sigma_a": 0, "sigma_s": 1, "g": 0.999)").sigma_s_prime.x, 0.001, 1e-15);
  EXPECT_NEAR(physical(R"("sigma_a": 0, "sigma_s": 1, "g": -0.999)").sigma_s_prime.x, 1.999, 1e-15);
  const Scene anisotropic = parse(R"({"media": {"a": {"preset": "marble", "scatter_anisotropy": 0.95},
      "b": {"sigma_a": 0, "sigma_s_prime": 2, "scatter_anisotropy": -0.95}, "c": {"sigma_a": 0, "sigma_s": 4, "g": 0.5},
      "d": {"preset": "marble"}}})");
  const std::vector<double> anisotropies{.95, -.95, .5, 0};
  for (std::size_t m = 0; m < anisotropies.size(); ++m)
    EXPECT_EQ(anisotropic.media[m].scatter_anisotropy, anisotropies[m]);
  EXPECT_EQ(std::get<PhysicalMedium>(anisotropic.media[0].coefficients),
            std::get<PhysicalMedium>(anisotropic.media[3].coefficients));
  for (const char* albedo : {"0", "0.999", "1", "[0, 0.5, 1]"})
    EXPECT_NO_THROW(artist(R"("subsurface_radius": 0, "subsurface_color": )" + std::string(albedo)))
        << albedo;
  const ArtistMedium jade = artist(R"("subsurface_color": "#ff8000", "subsurface_radius": [1, 2, 3],
      "subsurface_radius_scale": [2, 0.5, 1], "subsurface_scatter_anisotropy": -0.999)");
  EXPECT_EQ(jade.subsurface_radius, Rgb(2, 1, 3));
  EXPECT_EQ(jade.anisotropy, -0.999);
  expect_near(jade.subsurface_color, {1, std::pow((128 / 255.0 + 0.055) / 1.055, 2.4), 0});
  const Scene metres =
      parse(R"({"mm_per_unit": 1000, "media": {"b": {"sigma_a": 1, "sigma_s_prime": 2, "eta": 1.1,
      "profile": "normalized_diffusion"}, "a": {"subsurface_color": 1, "subsurface_radius": 3}}})");
  EXPECT_EQ(metres.media[0].name, "b");
  EXPECT_EQ(metres.media[0].eta, 1.1);
  EXPECT_EQ(metres.media[0].profile, ProfileKind::normalized_diffusion);
  EXPECT_FALSE(metres.media[1].profile);
  EXPECT_EQ(metres.media[1].eta, 1.3);
  EXPECT_EQ(std::get<PhysicalMedium>(metres.media[0].coefficients).sigma_s_prime, Rgb(2, 2, 2));
  EXPECT_EQ(std::get<ArtistMedium>(metres.media[1].coefficients).subsurface_radius, Rgb(3, 3, 3));
}

// Claim: steps of a transform act in the order of the list; rotation is counter-clockwise about its axis; a
// matrix is given by rows. Source: scenes/README.md, worked by hand. Fails if compose swaps its arguments,
// the sine its sign, or read_matrix rows and columns.
TEST(SceneValues, Transforms) {
  const auto moved = [](const std::string& steps, const Vec3d& p, const std::string& unit = "1") {
    const Scene scene = parse(R"({"mm_per_unit": )" + unit +
                              R"(, "shapes": [{"sphere": {"radius": 1}, "transform": [)" + steps + "]}]}");
    return transform_point(scene.shapes.at(0).to_world, p);
  };
  expect_near(moved(R"({"translate": [1, 2, 3]}, {"scale": 2})", {1, 1, 1}), {4, 6, 8});
  expect_near(moved(R"({"scale": [2, 3, 4]}, {"translate": [1, 2, 3]})", {1, 1, 1}), {3, 5, 7});
  expect_near(moved(R"({"rotate": {"axis": [0, 0, 2], "degrees": 90}})", {1, 0, 5}), {0, 1, 5});
  expect_near(moved(R"({"rotate": {"axis": [1, 1, 1], "degrees": 120}})", {1, 2, 3}), {3, 1, 2});
  const std::string matrix = R"({"matrix": [[1, 2, 0, 10], [0, 1, 0, 20], [0, 0, 1, 30]]})";
  expect_near(moved(matrix, {1, 1, 1}), {13, 21, 31});
  expect_near(moved(matrix, {1, 1, 1}, "1000"), {10003, 20001, 30001});
  expect_near(moved(R"({"translate": [1, 2, 3]}, {"scale": 2})", {1, 1, 1}, "1000"), {2002, 4002, 6002});
}

// Claim: every length is converted to mm once: a scene in units of k mm equals the scene in mm with its
// lengths times k, bit for bit for a power of two; brightness is not converted. Source: scenes/README.md.
// Fails if any length() or point() below loses its mm_per_unit.
TEST(SceneValues, LengthsBecomeMillimetres) {
  const Scene scene = parse(R"({"mm_per_unit": 4, "shapes": [
      {"sphere": {"center": [1, 2, 3], "radius": 0.1}}, {"box": {"low": [1, 2, 3], "high": [2, 3, 4]}},
      {"quad": {"corner": [1, 2, 3], "u": [0, 0, 1], "v": [0, 2, 0]}},
      {"slab": {"center": [1, 2, 3], "width": 1, "depth": 2, "thickness": 3}},
      {"torus": {"center": [1, 2, 3], "major_radius": 2, "minor_radius": 1}},
      {"file": "a.obj", "fit_size": 5, "fill_holes": true}, {"file": "a.obj", "transform": [{"translate": [1, 0, 0]}]}],
    "lights": [{"type": "point", "position": [1, 2, 3], "intensity": 7},
      {"type": "directional", "direction": [0, -3, 4], "irradiance": 7},
      {"type": "sphere", "center": [1, 2, 3], "radius": 2, "radiance": 1e30},
      {"type": "quad", "corner": [1, 2, 3], "u": [1, 0, 0], "v": [0, 1, 0], "radiance": [1, 0, 0]}],
    "camera": {"position": [1, 2, 3], "look_at": [1, 2, 0], "up": [0, 1, 1], "field_of_view": 30},
    "settings": {"sample_spacing": 0.5}})");
  const Vec3d at{4, 8, 12};
  const auto source = [&](std::size_t i) { return scene.shapes.at(i).source; };
  EXPECT_EQ(std::get<SphereShape>(source(0)).center, at);
  EXPECT_EQ(std::get<SphereShape>(source(0)).radius, 0.4);
  EXPECT_EQ(std::get<BoxShape>(source(1)).low, at);
  EXPECT_EQ(std::get<BoxShape>(source(1)).high, Vec3d(8, 12, 16));
  EXPECT_EQ(std::get<QuadShape>(source(2)).corner, at);
  EXPECT_EQ(std::get<QuadShape>(source(2)).u, Vec3d(0, 0, 4));
  EXPECT_EQ(std::get<QuadShape>(source(2)).v, Vec3d(0, 8, 0));
  const auto slab = std::get<SlabShape>(source(3));
  EXPECT_EQ(slab.center, at);
  EXPECT_EQ(Vec3d(slab.width, slab.depth, slab.thickness), Vec3d(4, 8, 12));
  const auto torus = std::get<TorusShape>(source(4));
  EXPECT_EQ(torus.center, at);
  EXPECT_EQ(torus.major_radius, 8);
  EXPECT_EQ(torus.minor_radius, 4);
  EXPECT_EQ(std::get<MeshFile>(source(5)).fit_size, 20);
  EXPECT_TRUE(std::get<MeshFile>(source(5)).fill_holes);
  // A fitted mesh is in mm already; any other is still in scene units.
  EXPECT_EQ(transform_point(scene.shapes[5].to_world, {1, 1, 1}), Vec3d(1, 1, 1));
  EXPECT_EQ(transform_point(scene.shapes[6].to_world, {1, 1, 1}), Vec3d(8, 4, 4));
  const auto light = [&](std::size_t i) { return scene.lights.at(i).source; };
  EXPECT_EQ(std::get<PointLight>(light(0)).position, at);
  EXPECT_EQ(std::get<PointLight>(light(0)).intensity, Rgb(7, 7, 7));
  expect_near(std::get<DirectionalLight>(light(1)).direction, {0, -0.6, 0.8});
  EXPECT_EQ(std::get<DirectionalLight>(light(1)).irradiance, Rgb(7, 7, 7));
  EXPECT_EQ(std::get<SphereLight>(light(2)).center, at);
  EXPECT_EQ(std::get<SphereLight>(light(2)).radius, 8);
  EXPECT_EQ(std::get<SphereLight>(light(2)).radiance, Rgb(1e30, 1e30, 1e30));
  EXPECT_EQ(std::get<QuadLight>(light(3)).corner, at);
  EXPECT_EQ(std::get<QuadLight>(light(3)).u, Vec3d(4, 0, 0));
  EXPECT_EQ(std::get<QuadLight>(light(3)).v, Vec3d(0, 4, 0));
  EXPECT_EQ(std::get<QuadLight>(light(3)).radiance, Rgb(1, 0, 0));
  EXPECT_EQ(scene.camera.position, at);
  EXPECT_EQ(scene.camera.look_at, Vec3d(4, 8, 0));
  EXPECT_EQ(scene.camera.up, Vec3d(0, 1, 1));
  EXPECT_EQ(scene.camera.field_of_view, 30);
  EXPECT_EQ(scene.settings.sample_spacing, 2);
  EXPECT_EQ(parse(R"({"mm_per_unit": 1000})").camera.position, Vec3d(0, 0, 5000));
}

// Claim: names, groups, normals, surfaces, surroundings, film and settings arrive. Source: scenes/README.md.
// Fails if any key is known to the schema but never read.
TEST(SceneValues, TheRest) {
  const Scene scene = parse(R"({"media": {"m": {"preset": "cream"}},
    "shapes": [{"file": "a.obj", "normals": "faceted", "medium": "m", "group": "g"},
      {"name": "b", "file": "b.obj", "medium": "m", "group": "g"}, {"file": "c.obj", "reflectance": "#ff0000"},
      {"file": "d.obj"}],
    "lights": [{"type": "point", "position": [0, 0, 0], "intensity": 0}], "surroundings": [0, 0, 2],
    "film": {"resolution": [16384, 16384], "crop": [1, 2, 3, 16384], "samples_per_pixel": 65536, "filter": "gaussian",
      "pixel_type": "float", "exposure": -1.5},
    "settings": {"method": "lambert", "evaluator": "brute_force", "laboratory": {"max_solid_angle": 0.01, "near_field": false},
      "samples": 1e5, "max_samples": 300000, "light_samples": 16, "seed": 9}})");
  EXPECT_EQ(scene.shapes[0].name, "shape0");
  EXPECT_EQ(scene.shapes[1].name, "b");
  EXPECT_EQ(scene.shapes[0].normals, NormalMode::faceted);
  EXPECT_EQ(scene.shapes[1].normals, NormalMode::smooth);
  EXPECT_EQ(scene.shapes[1].group, "g");
  EXPECT_EQ(scene.shapes[1].medium, 0u);
  EXPECT_EQ(scene.shapes[2].reflectance, Rgb(1, 0, 0));
  EXPECT_EQ(scene.shapes[3].reflectance, Rgb(0.5, 0.5, 0.5));
  EXPECT_FALSE(scene.shapes[3].medium.has_value());
  ASSERT_EQ(scene.lights.size(), 2u);
  EXPECT_EQ(scene.lights[0].name, "light0");
  EXPECT_EQ(scene.lights[1].name, "surroundings");
  EXPECT_EQ(std::get<Surroundings>(scene.lights[1].source).radiance, Rgb(0, 0, 2));
  EXPECT_TRUE(parse(R"({"surroundings": 0})").lights.empty());
  EXPECT_EQ(scene.film.crop, (std::array<int, 4>{1, 2, 3, 16384}));
  EXPECT_EQ(scene.film.samples_per_pixel, 65536);
  EXPECT_EQ(scene.film.filter, PixelFilter::gaussian);
  EXPECT_FALSE(scene.film.half);
  EXPECT_EQ(scene.film.exposure, -1.5);
  EXPECT_EQ(scene.settings.method, Method::lambert);
  EXPECT_EQ(scene.settings.evaluator, EvaluatorKind::brute_force);
  EXPECT_EQ(scene.settings.laboratory.max_solid_angle, 0.01);
  EXPECT_FALSE(scene.settings.laboratory.near_field);
  EXPECT_EQ(scene.settings.samples, 100000u);
  EXPECT_EQ(scene.settings.max_samples, 300000u);
  EXPECT_EQ(scene.settings.light_samples, 16);
  EXPECT_EQ(scene.settings.seed, 9u);
}

// Claim: a thickness is a length of the scene; a multipole medium without one has that of the built-in plates made of
// it, scaled with them, and a declared one stays; plates that differ are refused with both. Where the profile is left
// open, a declared thickness makes it a multipole. Source: scenes/README.md. Fails if: the plate's thickness is along
// another axis, or other profiles take it.
TEST(SceneValues, Thickness) {
  const auto scene_of = [](const std::string& medium, const std::string& more = "") {
    return parse_scene(R"({"mm_per_unit": 10, "media": {"m": {"preset": "marble", )" + medium + R"(}},
      "shapes": [{"medium": "m", "slab": {"width": 4, "depth": 5, "thickness": 0.2},
                  "transform": [{"scale": 3}, {"rotate": {"axis": [1, 2, 3], "degrees": 40}}]})" +
                           more + "]}",
                       "x.json");
  };
  EXPECT_EQ(scene_of(R"("profile": "dipole", "thickness": 2)").media[0].thickness, 20);
  EXPECT_EQ(scene_of(R"("profile": "dipole")").media[0].thickness, INFINITY);
  EXPECT_EQ(scene_of(R"("profile": "multipole", "thickness": 2)").media[0].thickness, 20);
  EXPECT_NEAR(scene_of(R"("profile": "multipole")").media[0].thickness, 6, 1e-9);
  for (const char* open : {R"("thickness": 2)", R"("profile": "auto", "thickness": 2)"})
    EXPECT_EQ(scene_of(open).media[0].profile, ProfileKind::multipole) << open;
  EXPECT_FALSE(scene_of(R"("profile": "auto")").media[0].profile);
  const std::string other = R"(, {"medium": "m", "slab": {"width": 4, "depth": 5, "thickness": 0.3}})";
  try {
    scene_of(R"("profile": "multipole")", other);
    ADD_FAILURE() << "two thicknesses";
  } catch (const Error& error) {
    EXPECT_NE(std::string(error.what()).find("6 and 3 mm"), std::string::npos) << error.what();
  }
  EXPECT_EQ(scene_of(R"("profile": "multipole", "thickness": 2)", other).media[0].thickness, 20);
}

// Claim: a key for another profile is reported, with its place and the profile using it. Source: scenes/README.md.
// Fails if: the profile is not compared, or keys without a profile of their own are reported.
TEST(SceneValues, KeysOfOtherProfilesAreReported) {
  const auto warnings_of = [](const std::string& keys) {
    return parse_scene(R"({"media": {"m": {"preset": "marble", )" + keys + "}}}", "x.json").warnings;
  };
  for (const char* used :
       {R"("thickness": 2)", R"("fit": "dmfp")", R"("profile": "multipole", "thickness": 2)",
        R"("profile": "normalized_diffusion", "fit": "dmfp")"})
    EXPECT_TRUE(warnings_of(used).empty()) << used;
  const std::vector<std::string> thickness = warnings_of(R"("profile": "dipole", "thickness": 2)"),
                                 fit = warnings_of(R"("profile": "dipole", "fit": "dmfp")");
  ASSERT_EQ(thickness.size(), 1);
  EXPECT_EQ(thickness[0].substr(0, 9), "x.json:1:") << thickness[0];
  EXPECT_NE(thickness[0].find(
                "'media.m.thickness' has no effect with the profile 'dipole'; it applies to 'multipole'"),
            std::string::npos)
      << thickness[0];
  ASSERT_EQ(fit.size(), 1);
  EXPECT_NE(fit[0].find("applies to 'normalized_diffusion'"), std::string::npos) << fit[0];
}

}  // namespace
}  // namespace opaline
