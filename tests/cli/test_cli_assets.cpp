// SPDX-License-Identifier: GPL-3.0-or-later
// Assets of other programs, as the program's commands meet them.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>

#include "../assets/asset_test.h"
#include "input/load_scene.h"
#include "opaline/image.h"
#include "run_program.h"

namespace opaline {
namespace {

using asset_test::Asset;

/// A translucent cube of 4 cm and a white opaque one, one of them mirrored.
std::string two_cubes() {
  Asset asset = asset_test::cube_mesh();
  asset.material(
      {{"name", "wax"},
       {"extensions",
        {{"KHR_materials_volume", {{"attenuationColor", {.5, .3, .1}}, {"attenuationDistance", .002}}},
         {"KHR_materials_volume_scatter", {{"multiscatterColor", {.9, .7, .4}}}}}}});
  asset.json["meshes"].push_back(asset.json["meshes"][0]);
  asset.json["meshes"][0]["primitives"][0]["material"] = 0;
  asset.root(asset.node({{"mesh", 0}, {"scale", {.02, .02, .02}}}));
  asset.root(asset.node({{"mesh", 1}, {"scale", {-.02, .02, .02}}, {"translation", {.05, 0, 0}}}));
  return asset.glb();
}

/// The cube seen by its own camera, from below and behind, at (-3, -4, -6).
Asset cube_with_camera() {
  Asset asset = asset_test::cube_asset();
  asset.json["cameras"] = asset_test::Json::array(
      {{{"type", "perspective"}, {"perspective", {{"yfov", 1.2}, {"znear", .001}, {"aspectRatio", 1}}}}});
  // A matrix of columns right, up and backwards.
  asset.root(asset.node(
      {{"camera", 0},
       {"matrix",
        {-.8944, 0, .4472, 0, -.2290, .8589, -.4581, 0, -.3841, -.5121, -.7682, 0, -3, -4, -6, 1}}}));
  return asset;
}

struct AssetFolder : ScratchFolder {
  AssetFolder() {
    put_bytes(file("cubes.glb"), two_cubes());
    std::filesystem::create_directory(file("scenes"));
  }
};

// Claim: `opaline render asset.glb -o a.png` is enough, and the scene file that `import` writes into another folder
// makes the same bytes, and is not written over once it is edited; `info` and `bench`'s hash of a scene take the asset too. Fails if the two go different ways.
TEST(CliAssets, ImportedScenesMakeTheSamePicture) {
  const AssetFolder folder;
  const Outcome direct = run_program({"render", "cubes.glb", "-o", "a.png"}, folder.path);
  ASSERT_EQ(direct.exit_code, 0) << direct.err;
  EXPECT_TRUE(
      contains(direct.out,
               "asset       1 translucent medium, default camera, default lights; not imported: material "
               "'wax': thicknessFactor 0"))
      << direct.out;
  const Outcome import = run_program({"import", "cubes.glb", "-o", "scenes/cubes.json"}, folder.path);
  ASSERT_EQ(import.exit_code, 0) << import.err;
  EXPECT_TRUE(contains(import.err, "material 'wax': attenuationColor [0.5, 0.3, 0.1] over 2 mm"))
      << import.err;
  EXPECT_TRUE(contains(import.err, "not imported: material 'wax': thicknessFactor 0")) << import.err;
  const Outcome edited = run_program({"render", "scenes/cubes.json", "-o", "b.png"}, folder.path);
  ASSERT_EQ(edited.exit_code, 0) << edited.err;
  EXPECT_TRUE(read_image(folder.file("a.png")).pixels == read_image(folder.file("b.png")).pixels);
  const Outcome again = run_program({"import", "cubes.glb", "-o", "scenes/cubes.json"}, folder.path);
  EXPECT_EQ(again.exit_code, 0) << again.err;
  put_bytes(folder.file("scenes/cubes.json"), bytes_of(folder.file("scenes/cubes.json")) + "// edited");
  const Outcome refused = run_program({"import", "cubes.glb", "-o", "scenes/cubes.json"}, folder.path);
  EXPECT_EQ(refused.exit_code, 2);
  EXPECT_TRUE(contains(refused.err, "exists with different content")) << refused.err;
  EXPECT_TRUE(bytes_of(folder.file("scenes/cubes.json")).ends_with("// edited"));
  const Outcome over =
      run_program({"import", "cubes.glb", "-o", "scenes/cubes.json", "--overwrite"}, folder.path);
  EXPECT_EQ(over.exit_code, 0) << over.err;
  EXPECT_FALSE(bytes_of(folder.file("scenes/cubes.json")).ends_with("// edited"));
  const Outcome info = run_program({"info", "cubes.glb", "--set", "media.wax.specular_ior=1.4"}, folder.path);
  EXPECT_EQ(info.exit_code, 0) << info.err;
  EXPECT_TRUE(contains(info.out, "1 translucent medium")) << info.out;
}

// Claim: the default lights show white matte paint between .6 and 1 of the PNG's range, and not above. Fails if their
// brightness does not follow from their size and distance.
TEST(CliAssets, DefaultLightsShowWhiteAsWhite) {
  const ScratchFolder folder;
  put_bytes(folder.file("white.glb"), asset_test::cube_asset().glb());
  const Outcome outcome = run_program({"render", "white.glb", "-o", "a.png"}, folder.path);
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  const Image image = read_image(folder.file("a.png"));
  float brightest = 0;
  for (std::size_t i = 0; i < image.pixels.size(); ++i)
    if (i % image.channels.size() < 3) brightest = std::max(brightest, image.pixels[i]);
  EXPECT_GT(brightest, .32);  // .6 in sRGB
  EXPECT_LT(brightest, .99);
}

// Claim: the gallery's asset is rendered as it comes, with nothing to warn of: three translucent apples, their medium's flesh
// and painted skin, by its own camera. Source: scenes/README.md.
TEST(CliAssets, TheApplesOfTheGallery) {
  const ScratchFolder folder;
  const std::string apples = std::string(OPALINE_SCENES_DIR) + "/apples.glb";
  const Outcome outcome = run_program({"render", apples, "-o", "a.exr", "--layers", "albedo", "--resolution",
                                       "40x30", "--set", "settings.samples=300"},
                                      folder.path);
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_EQ(outcome.err, "");
  EXPECT_TRUE(contains(outcome.out, "sampling: 3 translucent bodies")) << outcome.out;
  EXPECT_TRUE(contains(outcome.out, "mean free path 0.7 mm")) << outcome.out;
  EXPECT_TRUE(contains(outcome.out, "1 translucent medium, its camera, default lights")) << outcome.out;
}

// Claim: the plan of an opaque asset says how to make it translucent: by options that run, at a size that an OBJ has not,
// and what of its surface is then lost. Fails if: marble of 2 mm is made, or a texture goes without a word.
TEST(CliAssets, HowToMakeMarbleOfIt) {
  const ScratchFolder folder;
  put_bytes(folder.file("a.obj"),
            "mtllib a.mtl\nusemtl wood\nv 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nvt 0 0\n"
            "f 1/1 3/1 2/1\nf 1/1 2/1 4/1\nf 2/1 3/1 4/1\nf 1/1 4/1 3/1\n");
  put_bytes(folder.file("a.mtl"), "newmtl wood\nmap_Kd wood.exr\n");
  std::filesystem::copy(OPALINE_SCENES_DIR "/../tests/cli/goldens/room.exr", folder.file("wood.exr"));
  const Outcome info = run_program({"info", "a.obj"}, folder.path.string());
  EXPECT_TRUE(contains(info.out,
                       "; --medium marble --size 50mm gives it the medium marble, 50 mm across, without its "
                       "texture"))
      << info.out;
  const std::vector<std::string> line{"info", "a.obj", "--medium", "marble", "--size", "50mm"};
  const Outcome marble = run_program(line, folder.path.string());
  // Three right triangles with sides of 50 mm, and one with their diagonals.
  EXPECT_TRUE(contains(marble.out, "translucent wood of marble: 5915 mm^2")) << marble.out << marble.err;
  const Outcome misspelt = run_program({"info", "a.obj", "--medium", "marbel"}, folder.path.string());
  EXPECT_TRUE(contains(misspelt.err, "(did you mean 'marble'?): use --medium marble")) << misspelt.err;
}

// Claim: --medium SHAPE=NAME names one shape and a medium of the scene, --size scales a scene file, too, and cannot stand beside a unit; a medium of
// the scene has precedence over a preset of its name. By hand: a
// ball of 20 units across at 50 mm has 2.5 mm a unit, 7,854 mm^2. Fails if: lengths are taken for the radius.
TEST(CliAssets, MediumAndSizeOfAScene) {
  const SceneFolder folder;
  const Outcome sized =
      run_program({"info", folder.scene, "--size", "5cm", "--medium", "ball=skin1", "--set",
                   R"(shapes.ball={"name": "ball", "sphere": {"radius": 10}, "medium": "skin1"})"});
  EXPECT_TRUE(contains(sized.out, "translucent ball of skin1: 785")) << sized.out << sized.err;
  const Outcome both = run_program({"info", folder.scene, "--size", "5cm", "--set", "mm_per_unit=1"});
  EXPECT_EQ(both.exit_code, 2);
  EXPECT_TRUE(contains(both.err, "--size sets mm_per_unit")) << both.err;
  std::string scene = bytes_of(folder.scene);
  scene.replace(scene.find(R"({"preset": "marble"})"), 20, R"({"sigma_a": 1, "sigma_s_prime": 9})");
  put_bytes(folder.file("own.json"), scene);
  const Outcome own = run_program({"info", folder.file("own.json"), "--medium", "marble", "--size", "5cm",
                                   "--set", "media.marble.specular_ior=1.4"});
  EXPECT_TRUE(contains(own.out, "mean free path 0.1 mm")) << own.out << own.err;
  const Outcome unknown = run_program({"info", folder.scene, "--medium", "marbel"});
  EXPECT_EQ(unknown.exit_code, 2);
  EXPECT_TRUE(contains(unknown.err, "marble")) << unknown.err;
}

// Claim: a measured preset named by --medium has a satin boundary, a look its own. Source: presets.h. Fails if: the default lights
// are reflected as hard discs.
TEST(CliAssets, AMeasuredMediumIsSatin) {
  const ScratchFolder folder;
  put_bytes(folder.file("a.glb"), asset_test::cube_asset().glb());
  for (const auto& [name, roughness] : {std::pair{"skin1", .3}, {"honey", 0.}, {"grape", .15}}) {
    const std::string path = std::string(name) + ".json";
    run_program({"import", "a.glb", "-o", path, "--medium", name}, folder.path.string());
    EXPECT_EQ(load_scene(folder.file(path)).media.at(0).specular_roughness, roughness) << name;
  }
}

// Claim: an asset in metres, made translucent without a size, costs at most 200,000 samples, and the warning names --size; a
// number of samples, a size, or the asset's own media in its unit remove the limit. Source: load_scene.h. Fails if: the plan
// has 2 million samples.
TEST(CliAssets, AnUnknownSizeCostsNoMinutes) {
  const ScratchFolder folder;
  put_bytes(folder.file("a.glb"), asset_test::cube_asset().glb());
  const auto info = [&](std::vector<std::string> more) {
    more.insert(more.begin(), {"info", "a.glb", "--medium", "wax"});
    const Outcome outcome = run_program(more, folder.path.string());
    return outcome.out + outcome.err;
  };
  const std::string unsized = info({});
  EXPECT_TRUE(contains(unsized,
                       "but uses 200000 (settings.max_samples, fewer without a size); check mm_per_unit, "
                       "or give a size such as --size 50mm"))
      << unsized;
  EXPECT_TRUE(contains(info({"--set", "settings.samples=300000"}), "300,000 samples"));
  EXPECT_FALSE(contains(info({"--size", "50mm"}), "settings.max_samples"));
  EXPECT_TRUE(contains(info({"--size", "2m"}), "but uses 2000000 (settings.max_samples); check"));
  put_bytes(folder.file("own.glb"), two_cubes());
  EXPECT_EQ(load_scene(folder.file("own.glb"), std::vector<std::string>{"media.wax.specular_ior=1.4"})
                .settings.max_samples,
            Settings{}.max_samples);
}

// Claim: import writes the medium and the size that render takes, and the asset is sized without a floor added beside it. By
// hand: a cube of 2 m at 5 cm has 25 mm a unit. Fails if: the options are unknown, or the floor counts.
TEST(CliAssets, ImportedWithMediumAndSize) {
  const ScratchFolder folder;
  put_bytes(folder.file("a.glb"), asset_test::cube_asset().glb());
  const std::vector<std::string> options{"--medium", "marble", "--size", "5cm"};
  std::vector<std::string> line{"import", "a.glb", "-o", "a.json"};
  line.insert(line.end(), options.begin(), options.end());
  const Outcome import = run_program(line, folder.path.string());
  ASSERT_EQ(import.exit_code, 0) << import.err;
  const Scene scene = load_scene(folder.file("a.json"));
  EXPECT_DOUBLE_EQ(scene.mm_per_unit, 25);
  EXPECT_EQ(scene.media.at(0).specular_roughness, .3);
  EXPECT_TRUE(scene.shapes.at(0).medium.has_value());
  const std::string floor =
      R"(shapes.+={"name": "floor", "quad": {"corner": [-9, -1, 9], "u": [18, 0, 0], "v": [0, 0, -18]}})";
  line = {"info", "a.glb", "--set", floor};
  line.insert(line.end(), options.begin(), options.end());
  const Outcome info = run_program(line, folder.path.string());
  EXPECT_TRUE(contains(info.out, "of marble: 1.5e+04 mm^2")) << info.out << info.err;
}

// Claim: a warning of import is a warning, not a part without import. Fails if: an unaligned GLB, which is read, is reported as
// not imported.
TEST(CliAssets, WarningsOfImport) {
  const ScratchFolder folder;
  const Outcome import =
      run_program({"import", OPALINE_TEST_INPUTS "/unal.glb", "-o", "a.json"}, folder.path.string());
  EXPECT_TRUE(contains(import.err, "unal.glb: its chunks are not aligned to 4 bytes")) << import.err;
  EXPECT_FALSE(contains(import.err, "not imported: its chunks")) << import.err;
  EXPECT_TRUE(contains(bytes_of(folder.file("a.json")), "// Warning: its chunks are not aligned"));
}

// Claim: `--environment` lights a scene by a picture in place of all its lights, wherever the program is started: what is
// seen beside the asset is the picture, and its white cube is as bright as an even room.
TEST(CliAssets, EnvironmentInPlaceOfLights) {
  const AssetFolder folder;
  Image room;
  room.width = room.full_width = 32;
  room.height = room.full_height = 16;
  room.channels = {"R", "G", "B"};
  room.pixels.resize(32 * 16 * 3);
  for (std::size_t i = 0; i < room.pixels.size(); ++i) room.pixels[i] = i % 3 == 0 ? .5f : .25f;
  write_exr(folder.file("scenes/room.exr"), room, false);
  const Outcome outcome = run_program(
      {"render", "cubes.glb", "-o", "a.exr", "--environment", "scenes/room.exr", "--resolution", "32x32"},
      folder.path);
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  const Image image = read_image(folder.file("a.exr"));
  EXPECT_NEAR(image.pixels[0], .5, 1e-3);
  EXPECT_NEAR(image.pixels[1], .25, 1e-3);
  const std::size_t middle = (16 * 32 + 16) * image.channels.size();
  const auto alpha = std::size_t(std::ranges::find(image.channels, "A") - image.channels.begin());
  ASSERT_LT(alpha, image.channels.size());
  EXPECT_EQ(image.pixels[alpha], 0);
  EXPECT_EQ(image.pixels[middle + alpha], 1);
  EXPECT_NEAR(image.pixels[middle], .5, .005);
  const Outcome gone =
      run_program({"render", "cubes.glb", "-o", "a.exr", "--environment", "gone.exr"}, folder.path);
  EXPECT_EQ(gone.exit_code, 2);
  EXPECT_TRUE(contains(gone.err, "gone.exr: no such image file")) << gone.err;
}

// Claim: images of an asset that are missing, damaged, empty or none are a warning each, with file and line or record, and the
// image is rendered with the factors of the material; the line about the asset does not repeat them. Source: by hand. Fails if:
// one kind is an error, as damaged images were, or libpng prints a line.
TEST(CliAssets, UnusableImagesAreWarnings) {
  const ScratchFolder folder;
  put_bytes(folder.file("damaged.png"), "\x89PNG\r\n\x1a\n and no more");
  put_bytes(folder.file("empty.png"), "");
  put_bytes(folder.file("notes.png"), "no image");
  put_bytes(folder.file("a.obj"),
            "mtllib a.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nusemtl red\nf 1/1 2/1 3/1\n");
  Asset asset = asset_test::cube_asset();
  const std::vector<float> uvs(48, .5f);
  asset.json["meshes"][0]["primitives"][0]["attributes"]["TEXCOORD_0"] =
      asset.accessor("VEC2", asset_test::kFloat, uvs);
  asset.json["meshes"][0]["primitives"][0]["material"] =
      asset.material({{"pbrMetallicRoughness", {{"baseColorTexture", {{"index", 0}}}}}});
  asset.json["textures"] = asset_test::Json::array({{{"source", 0}}});
  const auto expect = [&](const char* name, const std::string& warning) {
    const Outcome outcome = run_program({"render", name, "-o", "a.png", "--resolution", "8x8"}, folder.path);
    EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
    EXPECT_EQ(outcome.err, "opaline: warning: " + warning + '\n');
    EXPECT_FALSE(contains(outcome.out, "not imported") || contains(outcome.out, "lists all")) << outcome.out;
  };
  for (const auto& [image, why] :
       {std::pair("gone.png", "there is no such file"), std::pair("damaged.png", "the image is truncated"),
        std::pair("empty.png", "the file is empty"), std::pair("notes.png", "not a readable image"),
        std::pair("", "it names no file")}) {
    for (const std::string statement : {"map_Kd", "bump", "norm"}) {
      put_bytes(folder.file("a.mtl"), "newmtl red\nKd .7 .2 .1\n" + statement + ' ' + image + '\n');
      expect("a.obj", "a.mtl:3: " + statement + " '" + image + "' of material 'red': " + why);
    }
  }
  for (const auto& [image, why] :
       {std::pair("gone.png", "images[0].uri refers to a missing file: 'gone.png'"),
        std::pair("damaged.png", "images[0] 'damaged.png' cannot be used: the image is truncated"),
        std::pair("empty.png", "images[0] 'empty.png' cannot be used: not a PNG, JPEG or WebP"),
        std::pair("notes.png", "images[0] 'notes.png' cannot be used: not a PNG, JPEG or WebP")}) {
    asset.json["images"] = asset_test::Json::array({{{"uri", image}}});
    put_bytes(folder.file("a.glb"), asset.glb());
    expect("a.glb", std::string("a.glb: materials[0]: baseColorTexture: ") + why);
  }
}

// Claim: what an asset names and has not is a warning with file and line, and the picture is made. Fails if it is only
// counted among what is not carried over.
TEST(CliAssets, MissingFilesAreWarnings) {
  const AssetFolder folder;
  put_bytes(folder.file("a.obj"),
            "mtllib gone.mtl\nmtllib a.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nusemtl red\n"
            "f 1/1 2/1 3/1\n");
  put_bytes(folder.file("a.mtl"), "newmtl red\nmap_Kd gone.png\n");
  const Outcome outcome = run_program({"render", "a.obj", "-o", "a.png", "--resolution", "8x8"}, folder.path);
  EXPECT_EQ(outcome.exit_code, 0);
  for (const char* said : {"warning: a.obj:1: mtllib 'gone.mtl': there is no such file",
                           "warning: a.mtl:2: map_Kd 'gone.png' of material 'red': there is no such file"})
    EXPECT_TRUE(contains(outcome.err, said)) << outcome.err;
}

// Claim: default lights are placed for the camera in use and never seen by it: a camera that looks up from below, past where
// they stand, sees the asset lit from its side, before an even grey backdrop of alpha 0. Fails if they stand around a default view, or in the image.
TEST(CliAssets, DefaultLightsAreUnseen) {
  const ScratchFolder folder;
  put_bytes(folder.file("a.glb"), cube_with_camera().glb());
  const Outcome outcome = run_program(
      {"render", "a.glb", "-o", "a.exr", "--resolution", "64x64", "--layers", "none"}, folder.path);
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  const Image image = read_image(folder.file("a.exr"));
  ASSERT_EQ(image.channels, (std::vector<std::string>{"R", "G", "B", "A"}));
  double covered = 0, light = 0;
  for (std::size_t i = 0; i < image.pixels.size(); i += 4) {
    if (image.pixels[i + 3] == 0) {
      EXPECT_EQ(image.pixels[i], image.pixels[0]) << i;
    }
    covered += double(image.pixels[i + 3]);
    light += double(image.pixels[i]) - double((1 - image.pixels[i + 3]) * image.pixels[0]);
  }
  EXPECT_EQ(image.pixels[3], 0);
  EXPECT_GT(image.pixels[0], .05);
  EXPECT_LT(image.pixels[0], .3);
  EXPECT_GT(covered, 150);
  EXPECT_GT(light / covered, .15);
}

using Words = std::vector<std::string>;

std::vector<SphereLight> lights_of(const std::string& file, const Words& overrides, int frame = 1) {
  std::vector<SphereLight> lights;
  for (const Light& light : load_scene(file, overrides, frame).lights)
    lights.push_back(std::get<SphereLight>(light.source));
  return lights;
}

// Claim: the default camera and lights follow fit_size, to the same view of the cube, 30 times as large and standing on y = 0;
// values of one's own stay, and an asset's own camera, which does not follow, is reported with the remedy. Source: load_scene.h.
// Tolerance: rounding. Fails if: the camera or the lights stay.
TEST(CliAssets, FitSizeMovesTheDefaultCamera) {
  const ScratchFolder folder;
  const std::string file = folder.file("a.glb"), own = folder.file("b.glb");
  put_bytes(file, asset_test::cube_asset().glb());
  put_bytes(own, cube_with_camera().glb());
  const Words fit{"shapes.0.fit_size=60"};
  const Vec3d middle{0, 30000, 0};  // mm
  const Scene before = load_scene(file), now = load_scene(file, fit);
  EXPECT_LT(length(now.camera.position - middle - before.camera.position * 30.), 1e-3);
  EXPECT_LT(length(now.camera.look_at - middle), 1e-3);
  const std::vector<SphereLight> were = lights_of(file, {}), are = lights_of(file, fit);
  ASSERT_EQ(are.size(), 3u);
  for (std::size_t i = 0; i < are.size(); ++i) {
    EXPECT_LT(length(are[i].center - middle - were[i].center * 30.), 1e-3);
    EXPECT_NEAR(are[i].radius, were[i].radius * 30, 1e-3);
    EXPECT_EQ(are[i].radiance, were[i].radiance);
  }
  const Scene set = load_scene(file, Words{fit[0], "camera.position=[0, 30, 200]", "lights.rim.radius=7"});
  EXPECT_EQ(set.camera.position, (Vec3d{0, 30000, 200000}));
  EXPECT_LT(length(set.camera.look_at - middle), 1e-3);
  EXPECT_EQ(std::get<SphereLight>(set.lights[2].source).radius, 7000);
  const std::string remedy = "--set mm_per_unit=... scales all of them";
  EXPECT_FALSE(contains(run_program({"info", file, "--set", fit[0]}).err, remedy));
  EXPECT_TRUE(
      contains(run_program({"info", own, "--set", fit[0]}).err, "the camera of the asset stays; " + remedy));
  EXPECT_FALSE(contains(
      run_program({"info", own, "--set", fit[0], "--set", "camera.position=[0, 30, 200]"}).err, remedy));
}

// Claim: default lights are placed for a camera given on the command line as for the same camera of the asset, at its first
// key in all frames; overrides of a light still apply, and other overrides move none. Source: load_scene.h. Tolerance: rounding.
// Fails if: lights stay where the camera of the import would need them.
TEST(CliAssets, DefaultLightsFollowAGivenCamera) {
  const ScratchFolder folder;
  const std::string file = folder.file("a.glb"), own = folder.file("b.glb");
  put_bytes(file, asset_test::cube_asset().glb());
  put_bytes(own, cube_with_camera().glb());
  const std::vector<SphereLight> expected = lights_of(own, {});
  const std::string keys = R"(camera.position={"keyed": {"5": [-3, -4, -6], "9": [4, 2, 5]}})";
  for (const auto& [words, frame] : {std::pair{Words{"camera.position=[-3, -4, -6]"}, 1},
                                     std::pair{Words{keys}, 1}, std::pair{Words{keys}, 9}}) {
    const std::vector<SphereLight> lights = lights_of(file, words, frame);
    ASSERT_EQ(lights.size(), 3u);
    for (std::size_t i = 0; i < 3; ++i)
      EXPECT_LT(length(lights[i].center - expected[i].center), 1e-2) << words[0];
  }
  EXPECT_EQ(lights_of(file, {"camera.position=[-3, -4, -6]", "lights.key.center=[9, 8, 7]"})[0].center,
            (Vec3d{9000, 8000, 7000}));
  EXPECT_EQ(lights_of(file, {"film.exposure=1"}), lights_of(file, {}));
  EXPECT_EQ(lights_of(own, {"film.exposure=1"}), expected);
}

// Claim: --allow-outside lets assets name files outside of their folders, with every command that reads them; without it
// they are refused. Fails if a command lacks the option.
TEST(CliAssets, FilesOutsideAreAllowedOnDemand) {
  const ScratchFolder folder;
  std::filesystem::create_directory(folder.file("asset"));
  const Asset cube = asset_test::cube_asset();
  put_bytes(folder.file("outside.bin"), cube.buffer);
  put_bytes(folder.file("asset/a.gltf"), cube.gltf("../outside.bin"));
  for (const std::vector<std::string>& words :
       {std::vector<std::string>{"info", "asset/a.gltf"},
        {"render", "asset/a.gltf", "-o", "a.png", "--resolution", "8x8"},
        {"import", "asset/a.gltf", "-o", "a.json"}}) {
    const Outcome refused = run_program(words, folder.path);
    EXPECT_EQ(refused.exit_code, 2);
    EXPECT_TRUE(contains(refused.err, "'../outside.bin' lies outside of the asset's folder")) << refused.err;
    std::vector<std::string> allowed = words;
    allowed.push_back("--allow-outside");
    EXPECT_EQ(run_program(allowed, folder.path).exit_code, 0) << words[0];
  }
  for (const char* command : {"view", "precompute", "bench"})
    EXPECT_TRUE(contains(run_program({command, "--help"}, folder.path).out, "--allow-outside")) << command;
}

// Claim: `import --animation` writes a scene with the animation of that name, and refuses others with the known names.
// Source: docs/assets.md. Fails if: the option is not passed on.
TEST(CliAssets, ImportTakesAnAnimation) {
  const ScratchFolder folder;
  Asset asset = asset_test::cube_asset();
  const int times = asset.accessor<float>("SCALAR", asset_test::kFloat, {0, 1}),
            places = asset.accessor<float>("VEC3", asset_test::kFloat, {0, 0, 0, 1, 0, 0});
  for (const char* name : {"walk", "run"})
    asset.json["animations"].push_back(
        {{"name", name},
         {"channels", {{{"sampler", 0}, {"target", {{"node", 0}, {"path", "translation"}}}}}},
         {"samplers", {{{"input", times}, {"output", places}}}}});
  put_bytes(folder.file("a.glb"), asset.glb());
  const auto import = [&](const std::string& name) {
    return run_program({"import", "a.glb", "--animation", name, "-o", "a.json", "--overwrite"}, folder.path);
  };
  EXPECT_EQ(import("run").exit_code, 0);
  EXPECT_TRUE(contains(bytes_of(folder.file("a.json")), R"("animation": "1")"));
  const Outcome unknown = import("swim");
  EXPECT_EQ(unknown.exit_code, 2);
  EXPECT_TRUE(contains(unknown.err, "has no such animation")) << unknown.err;
}

// Claim: what of a glTF is not drawn as it says, and changes the image, is a warning of `render`; a skin and an alpha mask,
// which are drawn, are none. Fails if it is only counted among what is not carried over.
TEST(CliAssets, WhatChangesTheImageIsAWarning) {
  const ScratchFolder folder;
  std::filesystem::copy(OPALINE_TEST_INPUTS "/mask.glb", folder.file("mask.glb"));
  const Outcome mask = run_program({"render", "mask.glb", "-o", "a.png", "--resolution", "8x8"}, folder.path);
  EXPECT_EQ(mask.exit_code, 0);
  EXPECT_FALSE(contains(mask.err, "warning")) << mask.err;
  Asset asset = asset_test::cube_asset();
  asset.material({{"pbrMetallicRoughness", {{"roughnessFactor", 3}}}});
  asset.json["meshes"][0]["primitives"][0]["material"] = 0;
  put_bytes(folder.file("rough.glb"), asset.glb());
  const Outcome rough =
      run_program({"render", "rough.glb", "-o", "a.png", "--resolution", "8x8"}, folder.path);
  EXPECT_EQ(rough.exit_code, 0);
  EXPECT_TRUE(contains(rough.err,
                       "warning: rough.glb: materials[0].pbrMetallicRoughness.roughnessFactor is out of "
                       "range (expected 0 to 1, got 3): uses 1.0"))
      << rough.err;
}

// Claim: textures that do not exist and glass are warnings, once each for all meshes, and not repeated in the line about
// the asset. Source: by hand. Fails if: they are on that line alone, or a material is reported for each of its meshes.
TEST(CliAssets, LossesOfMaterialsAreWarnings) {
  const ScratchFolder folder;
  Asset asset = asset_test::cube_asset();
  const std::vector<float> uvs(48, .5f);
  asset.json["meshes"][0]["primitives"].push_back(asset.json["meshes"][0]["primitives"][0]);
  asset.json["meshes"][0]["primitives"][1]["attributes"]["TEXCOORD_0"] =
      asset.accessor("VEC2", asset_test::kFloat, uvs);
  const int material =
      asset.material({{"name", "lens"},
                      {"pbrMetallicRoughness", {{"baseColorTexture", {{"index", 5}}}}},
                      {"occlusionTexture", {{"index", 6}}},
                      {"extensions", {{"KHR_materials_transmission", {{"transmissionFactor", 1}}}}}});
  for (auto& primitive : asset.json["meshes"][0]["primitives"]) primitive["material"] = material;
  put_bytes(folder.file("a.glb"), asset.glb());
  for (const std::vector<std::string>& words : {std::vector<std::string>{"info", "a.glb"},
                                                {"render", "a.glb", "-o", "a.png", "--resolution", "8x8"}}) {
    const Outcome outcome = run_program(words, folder.path);
    EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
    for (const char* loss :
         {"baseColorTexture: textures[5] is not there", "occlusionTexture: textures[6] is not there",
          "KHR_materials_transmission: a clear, non-scattering body is not supported; treated as "
          "opaque"}) {
      const std::string warning = std::string("warning: a.glb: material 'lens': ") + loss;
      const std::size_t at = outcome.err.find(warning);
      ASSERT_NE(at, outcome.err.npos) << loss << outcome.err;
      EXPECT_EQ(outcome.err.find(warning, at + 1), outcome.err.npos) << outcome.err;
      EXPECT_FALSE(contains(outcome.out, loss)) << outcome.out;
    }
  }
}

// Claim: glass of an MTL and a material in no library are warnings of `render` and `info`, not repeated in the line
// about the asset; faces without a material are called so. Source: by hand. Fails if: a loss is on that line alone.
TEST(CliAssets, LossesOfMtlMaterialsAreWarnings) {
  const ScratchFolder folder;
  put_bytes(folder.file("a.mtl"), "newmtl lens\nKd 0.8\nd 0.2\nTf 0.5 0.5 0.5\n");
  put_bytes(folder.file("a.obj"),
            "mtllib a.mtl\nv 0 0 0\nv 9 0 0\nv 0 9 0\nv 0 0 9\nf 1 2 3\nf 4 2 3\nf 1 2 3\nusemtl lens\n"
            "f 1 2 4\nusemtl gone\nf 2 3 4\n");
  for (const std::vector<std::string>& words : {std::vector<std::string>{"info", "a.obj"},
                                                {"render", "a.obj", "-o", "a.png", "--resolution", "8x8"}}) {
    const Outcome outcome = run_program(words, folder.path);
    EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
    for (const char* loss : {"a.mtl:3: d and Tf of material 'lens' are ignored: transparency is not "
                             "supported; the surface renders "
                             "opaque",
                             "a.obj:11: material 'gone': not found in any library; uses grey",
                             "a.obj, faces without a material: 1 duplicate triangles"}) {
      EXPECT_TRUE(contains(outcome.err, std::string("warning: ") + loss)) << outcome.err;
      EXPECT_FALSE(contains(outcome.out, loss)) << outcome.out;
    }
    EXPECT_FALSE(contains(outcome.out, "not imported")) << outcome.out;
    EXPECT_FALSE(contains(outcome.err, "(none)")) << outcome.err;
  }
}

// Claim: one opaque open mesh as OBJ and as PLY has no warning. Source: by hand. Fails if: a format warns of light that leaks.
TEST(CliAssets, OpaqueOpenMeshesHaveNoWarning) {
  const ScratchFolder folder;
  put_bytes(folder.file("a.obj"), "v 0 0 0\nv 9 0 0\nv 0 9 0\nf 1 2 3\n");
  put_bytes(
      folder.file("a.ply"),
      "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n"
      "element face 1\nproperty list uchar int vertex_indices\nend_header\n0 0 0\n9 0 0\n0 9 0\n3 0 1 2\n");
  for (const char* name : {"a.obj", "a.ply"}) {
    const Outcome info = run_program({"info", name}, folder.path);
    EXPECT_EQ(info.exit_code, 0);
    EXPECT_EQ(info.err, "") << name;
  }
}

// Claim: the plan of a figure of metres says a size at which marble lets light through. Fails if 2,000,000 samples are
// what the hint leads to.
TEST(CliAssets, MarbleOfAFigureInMetresHasASize) {
  const ScratchFolder folder;
  put_bytes(folder.file("a.glb"), asset_test::cube_asset().glb());  // 2 m
  const Outcome info = run_program({"info", "a.glb"}, folder.path);
  EXPECT_TRUE(contains(info.out, "; --medium marble --size 50mm gives it the medium marble, 50 mm across"))
      << info.out;
  const Outcome marble = run_program({"info", "a.glb", "--medium", "marble", "--size", "50mm"}, folder.path);
  EXPECT_TRUE(contains(marble.out, "cube of marble: 1.5e+04 mm^2")) << marble.out << marble.err;
}

// Claim: the command that the plan suggests for a shape whose name has a point works as it stands. Source: Blender calls copies
// "Cube.001". Fails if the name is taken for a path of keys.
TEST(CliAssets, SuggestedCommandsWork) {
  const ScratchFolder folder;
  put_bytes(folder.file("a.obj"),
            "o Cube.001\nv 0 0 0\nv 9 0 0\nv 0 9 0\nv 0 0 9\nf 1 3 2\nf 1 2 4\nf 2 3 4\nf 3 1 4\n"
            "o Cube.002\nv 20 0 0\nv 29 0 0\nv 20 9 0\nv 20 0 9\nf 5 7 6\nf 5 6 8\nf 6 7 8\nf 7 5 8\n");
  const std::string out = run_program({"info", "a.obj"}, folder.path).out, begin = "--medium ";
  const std::size_t at = out.find(begin);
  ASSERT_NE(at, out.npos) << out;
  const std::size_t from = at + begin.size();
  const Outcome marble =
      run_program({"info", "a.obj", "--medium", out.substr(from, out.find(' ', from) - from)}, folder.path);
  EXPECT_EQ(marble.exit_code, 0) << marble.err;
  EXPECT_TRUE(contains(marble.out, "of marble: ")) << marble.out;
  EXPECT_FALSE(contains(marble.out, "Cube.002 of marble")) << marble.out;
}

// Claim: an asset that is broken, or is none, ends with code 2, its name, and without a scene file. Fails if the file
// is written before it is checked.
TEST(CliAssets, BrokenAssetsAreNamed) {
  const AssetFolder folder;
  put_bytes(folder.file("bad.gltf"), "{}");
  put_bytes(folder.file("wax.txt"), "wax");
  put_bytes(folder.file("wax.glb"), "wax of bees, for candles\nof all kinds");
  put_bytes(folder.file("zeros.gltf"), std::string(9, '\0'));
  put_bytes(folder.file("empty.obj"), "");
  put_bytes(folder.file("points.obj"), "v 0 0 0\n");
  for (const char* name : {"b.fbx", "b.USDZ", "b.x3d", "b.STEP", "ball.blend"})
    put_bytes(folder.file(name), "Kaydara FBX Binary");
  put_bytes(folder.file("ball.json"), R"({"shapes": [{"file": "ball.blend"}]})");
  put_bytes(folder.file("dusk.json"),
            "{\n\"lights\": [{\"type\": \"environment\",\n\"file\": \"gone.exr\"}]}");
  const struct {
    std::vector<std::string> words;
    const char* said;
  } cases[] = {
      {{"import", "bad.gltf", "-o", "a.json"}, "bad.gltf: cannot be read as glTF 2.0"},
      {{"render", "bad.gltf", "-o", "a.png"}, "bad.gltf: cannot be read as glTF 2.0"},
      {{"render", "wax.glb", "-o", "a.png"},
       "wax.glb: is not a glTF file (expected a file that begins with glTF (binary) or { (JSON), got text "
       "that "
       "begins 'wax of bees, for candles')"},
      {{"info", "zeros.gltf"}, "or { (JSON), got binary data)"},
      {{"info", "empty.obj"}, "empty.obj: the file is empty"},
      {{"info", "points.obj"},
       "points.obj: contains no faces (expected an OBJ mesh: lines with v x y z and f 1 2 3, got 1 "
       "vertices)"},
      {{"render", "wax.txt", "-o", "a.png"}, "wax.txt: is not a scene file"},
      {{"render", "dusk.json", "-o", "a.png"}, "dusk.json:3:9: gone.exr: no such image file"},
      {{"import", "gone.glb", "-o", "a.json"}, "gone.glb: no such file"},
      {{"render", "b.fbx", "-o", "a.png"}, "b.fbx: FBX is not supported; export GLB"},
      {{"import", "b.USDZ", "-o", "a.json"},
       "b.USDZ: USD is not supported; export GLB, or convert it with opaline-usd"},
      {{"render", "b.x3d", "-o", "a.png"}, "b.x3d: X3D is not supported; export GLB"},
      {{"render", "b.STEP", "-o", "a.png"}, "b.STEP: STEP is not supported; export STL"},
      {{"info", "ball.json"}, "ball.blend: Blender's .blend is not supported; export GLB"},
      {{"import", "cubes.glb", "--material", "gone.mtlx", "-o", "a.json"}, "gone.mtlx: no such file"},
      {{"import", "wax.txt", "-o", "a.json"}, "wax.txt: is not a supported asset format"},
      {{"import", "cubes.glb", "-o", "a.gltf"}, "a name that ends in .json"},
      {{"render", "cubes.glb", "-o", "a.png", "--set", "media.wix.g=0"}, "did you mean 'wax'"}};
  for (const auto& c : cases) {
    const Outcome outcome = run_program(c.words, folder.path);
    EXPECT_EQ(outcome.exit_code, 2) << outcome.err;
    EXPECT_TRUE(contains(outcome.err, c.said)) << outcome.err;
  }
  EXPECT_FALSE(std::filesystem::exists(folder.file("a.json")));
}

// Claim: the image of docs/assets.md, Cycles' on the left and ours on the right, is the same twice. Tolerance: 1 % of white in the
// mean (measured .1 %: edges of 64 rays). Fails if: the two are not of one camera, light or paint.
TEST(LongCliAssets, SideBySideWithBlender) {
  if (!std::filesystem::exists(OPALINE_SCENES_DIR "/../build-blender/bin/python3"))
    GTEST_SKIP() << "Blender is not there; tests/run --long fetches it";
  const ScratchFolder folder;
  const std::string picture = folder.file("both.png");
  ASSERT_EQ(std::system(("OPALINE='" OPALINE_PROGRAM "' '" OPALINE_SCENES_DIR
                         "/../tests/assets/blender/side_by_side' '" +
                         picture + "'")
                            .c_str()),
            0);
  const Image both = read_image(picture);
  const int gap = 8, width = (both.width - gap) / 2;
  const std::size_t channels = both.channels.size();
  double differs = 0, sum = 0;
  for (int y = 0; y < both.height; ++y)
    for (std::size_t i = 0; i < std::size_t(width) * channels; ++i) {
      const float* const row = both.pixels.data() + std::size_t(y) * std::size_t(both.width) * channels;
      differs += std::abs(double(row[i]) - double(row[i + std::size_t(width + gap) * channels]));
      sum += double(row[i]);
    }
  const double count = double(width) * both.height * double(channels);
  EXPECT_GT(sum / count, .05);
  EXPECT_LT(differs / count, .01);
}

}  // namespace
}  // namespace opaline
