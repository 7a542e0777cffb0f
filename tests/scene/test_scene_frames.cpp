// SPDX-License-Identifier: GPL-3.0-or-later
// Values and files that change from frame to frame.
#include "scene_test.h"
#include "values/frame_name.h"

namespace opaline {
namespace {

double degrees_at(int frame, const std::string& value) {
  return parse_scene(R"({"camera": {"field_of_view": )" + value + "}}", "test.json", {}, frame)
      .camera.field_of_view;
}

// Claim: a keyed number is its value at each key, constant outside, a line or a smooth curve between: the
// spline has no corner at a key, and through values on a line it is that line. Source: keyed_values.h.
// Tolerance: rounding. Fails if: slopes leave out that keys are unevenly spaced (the line).
TEST(SceneFrames, NumbersBetweenKeys) {
  const std::string linear = R"({"keyed": {"10": 30, "1": 12, "20": 10}})";
  EXPECT_EQ(degrees_at(-5, linear), 12);
  EXPECT_EQ(degrees_at(1, linear), 12);
  EXPECT_DOUBLE_EQ(degrees_at(4, linear), 18);
  EXPECT_EQ(degrees_at(10, linear), 30);
  EXPECT_DOUBLE_EQ(degrees_at(15, linear), 20);
  EXPECT_EQ(degrees_at(99, linear), 10);
  const std::string spline = R"({"keyed": {"100": 30, "1": 12, "200": 10}, "between": "spline"})";
  EXPECT_EQ(degrees_at(100, spline), 30);
  const double before = degrees_at(100, spline) - degrees_at(99, spline),
               after = degrees_at(101, spline) - degrees_at(100, spline);
  EXPECT_NEAR(before, after, .02);
  EXPECT_NEAR(before, (10 - 12) / 199., .02);
  const std::string line = R"({"keyed": {"0": 10, "1": 11, "7": 17, "40": 50}, "between": "spline"})";
  for (int frame = 0; frame <= 40; ++frame) EXPECT_NEAR(degrees_at(frame, line), 10 + frame, 1e-12);
}

// Claim: everything made of numbers can be keyed: points, colours, matrices, steps of transforms, media; from
// the command line, too; and a medium may be called keyed. Source: scenes/README.md. Fails if: lists are not
// blended, or values are resolved before --set.
TEST(SceneFrames, AnyNumbers) {
  const std::string text = R"({
    "media": {"keyed": {"preset": "marble"},
              "m": {"sigma_a": {"keyed": {"1": 0, "3": [2, 4, 6]}}, "sigma_s_prime": 1}},
    "shapes": [{"sphere": {"radius": 1}, "medium": "m",
                "transform": [{"translate": {"keyed": {"1": [0, 0, 0], "3": [2, 4, 6]}}}]}],
    "lights": [{"type": "point", "name": "p", "position": [0, 0, 0], "intensity": 1}]})";
  const std::vector<std::string> sets{"media.m.sigma_a={\"keyed\": {\"1\": [0, 0, 0], \"3\": [2, 4, 6]}}",
                                      "lights.p.intensity={\"keyed\": {\"1\": 1, \"5\": 5}}"};
  const Scene scene = parse_scene(text, "test.json", sets, 2);
  EXPECT_EQ(scene.media[0].name, "keyed");
  EXPECT_EQ(std::get<PhysicalMedium>(scene.media[1].coefficients).sigma_a, Rgb(1, 2, 3));
  EXPECT_EQ(scene.shapes[0].to_world.translation, Vec3d(1, 2, 3));
  EXPECT_EQ(std::get<PointLight>(scene.lights[0].source).intensity, Rgb(2, 2, 2));
}

// Claim: where only the camera and the film have keys their range is known as that of one light; a key or a
// file by frame elsewhere ends that, a medium called keyed does not. Source: Scene::camera_frames. Fails if:
// keys of shapes, media or file names are overlooked.
TEST(SceneFrames, OfACameraAlone) {
  const auto frames = [](const std::vector<std::string>& sets) {
    return parse_scene(R"({
      "media": {"keyed": {"preset": "marble"}},
      "shapes": [{"name": "ball", "sphere": {"radius": 1}, "medium": "keyed"}],
      "lights": [{"type": "point", "name": "p", "position": [0, 0, 5], "intensity": 1}]})",
                       "test.json", sets, 2)
        .camera_frames;
  };
  const std::string camera = "camera.position={\"keyed\": {\"3\": [0, 0, 9], \"26\": [9, 0, 9]}}",
                    film = "film.exposure={\"keyed\": {\"1\": 0, \"5\": 2}}",
                    light = "lights.p.intensity={\"keyed\": {\"1\": 1, \"5\": 5}}",
                    medium =
                        "media.keyed={\"sigma_a\": {\"keyed\": {\"1\": 0, \"3\": 2}}, \"sigma_s_prime\": 1}",
                    mesh = "shapes.ball={\"name\": \"ball\", \"file\": \"ball.##.obj\"}";
  EXPECT_EQ(frames({}), 1u);
  EXPECT_EQ(frames({camera}), 24u);
  EXPECT_EQ(frames({camera, film}), 26u);
  for (const std::string& other : {light, medium, mesh}) EXPECT_EQ(frames({camera, other}), 1u) << other;
}

// Claim: what is wrong with keyed values is said at its place. Source: the design of messages. Fails if: a
// key is taken for 0.
TEST(SceneFrames, Mistakes) {
  const auto camera = [](const std::string& value) -> std::string {
    try {
      parse_scene("{\"camera\": {\"field_of_view\":\n" + value + "}}", "test.json", {}, 2);
    } catch (const Error& error) {
      return error.what();
    }
    return "";
  };
  EXPECT_NE(camera(R"({"keyed": {}})").find("test.json:2:"), std::string::npos) << camera(R"({"keyed": {}})");
  EXPECT_NE(camera(R"({"keyed": {"one": 1}})").find("'one' is not a frame"), std::string::npos);
  EXPECT_NE(camera(R"({"keyed": {"1": 1}, "betwen": 1})").find("'betwen'"), std::string::npos);
  EXPECT_NE(camera(R"({"keyed": {"1": 1}, "between": "smooth"})").find("\"linear\" or \"spline\""),
            std::string::npos);
  EXPECT_NE(camera(R"({"keyed": {"1": 1, "3": [1]}})").find("cannot be blended"), std::string::npos);
  EXPECT_NE(camera(R"({"keyed": {"2": 1, "4": [1]}})").find("cannot be blended"), std::string::npos);  // of 3
  EXPECT_NE(camera(R"({"keyed": {"1": 20, "3": 30, "01": 40}})").find("'1' and '01' denote the same frame"),
            std::string::npos);
  EXPECT_NE(camera(R"({"keyed": {"1": 20, "3": 400}})").find("camera.field_of_view"), std::string::npos);
}

// Claim: the last run of two or more # in a path is the frame. Source: frame_name.h. Fails if: a single #, as
// names may have, is replaced.
TEST(SceneFrames, Paths) {
  EXPECT_EQ(with_frame("a/bunny.####.obj", 7), "a/bunny.0007.obj");
  EXPECT_EQ(with_frame("##.##.obj", 123), "##.123.obj");
  EXPECT_EQ(with_frame("take#3.obj", 7), "take#3.obj");
  EXPECT_EQ(with_frame("####", -7), "-0007");
  const Scene scene = parse_scene(R"({"shapes": [{"file": "b.###.ply"}]})", "x/test.json", {}, 12);
  EXPECT_EQ(std::get<MeshFile>(scene.shapes[0].source).path, "x/b.012.ply");
}

}  // namespace
}  // namespace opaline
