// SPDX-License-Identifier: GPL-3.0-or-later
// Statements of MTL files: read as other programs read them, or reported by file and line.
#include <filesystem>

#include "asset_test.h"
#include "image/texture_file.h"
#include "support/pictures.h"

namespace opaline::asset_test {
namespace {

/// An OBJ file of one triangle of the material `red` beside its library.
struct MtlFolder : ScratchFolder {
  explicit MtlFolder(const std::string& library) {
    put_bytes(file("a.obj"),
              "mtllib a.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nvt 1 0\nvt 0 1\nusemtl red\nf 1/1 2/2 3/3\n");
    put_bytes(file("a.mtl"), library);
  }

  ImportedAsset import() const { return import_asset(file("a.obj"), "a.obj"); }
  Rgb color() const { return load_scene(file("a.obj")).shapes.at(0).reflectance; }
};

/// The warnings of a library, each on a line, without the folder.
std::string warnings_of(const std::string& library) {
  const MtlFolder folder(library);
  std::string text;
  for (const std::string& warning : folder.import().warnings)
    text += warning.substr(folder.path.string().size() + 1) + '\n';
  return text;
}

// Claim: Kd of one number is grey, as the format has it, and keywords in other cases are read. Source: Wavefront, MTL material
// format 4.2. Tolerance: none. Fails if: such a material is the default grey.
TEST(MtlMaterials, ColorsAreReadAsTheFormatHasThem) {
  for (const auto& [library, color] :
       {std::pair("newmtl red\nKd 0.8\n", Rgb(.8)),
        std::pair("newmtl red\nkd 0.8 0.1 0.2\n", Rgb(.8, .1, .2)),
        std::pair("NEWMTL red\nKD .8 +0.1 2e-1 # note\n", Rgb(.8, .1, .2)),
        std::pair("newmtl red\nKd 0.1 0.1 0.1\nKd 0.8 0.1 0.2\n", Rgb(.8, .1, .2))}) {
    EXPECT_EQ(MtlFolder(library).color(), color) << library;
    EXPECT_EQ(warnings_of(library), "") << library;
  }
}

// Claim: colours that the format does not allow are reported by file, line, value and material, with what is taken instead.
// Source: by hand. Tolerance: none. Fails if: they are clamped, or replaced by grey, in silence.
TEST(MtlMaterials, ColorsOutOfRangeAreReported) {
  const auto check = [](const std::string& value, const Rgb& color, const std::string& complaint) {
    const std::string library = "newmtl red\nKd " + value + '\n';
    EXPECT_EQ(MtlFolder(library).color(), color) << value;
    EXPECT_EQ(warnings_of(library), "a.mtl:2: Kd '" + value + "' of material 'red' " + complaint + '\n');
  };
  check(
      "204 25 25", Rgb(1),
      "is above 1 and is clamped to [1, 1, 1]; the values seem to range to 255: for a range of 0 to 1, write "
      "[0.8, 0.098, 0.098]");
  check("1.5 0.2 0.2", {1, .2, .2}, "is above 1 and is clamped to [1, 0.2, 0.2]");
  check("-1", Rgb(0), "is below 0 and is clamped to [0, 0, 0]");
  check("-3 1 5", {0, 1, 1}, "is below 0 and above 1 and is clamped to [0, 1, 1]");
  check("0.3 0.2", Rgb(.5), "has 2 numbers instead of one or three and is ignored");
  check("red", Rgb(.5), "is not a colour of one or three numbers from 0 to 1 and is ignored");
  check("nan 0 0", Rgb(.5), "is not a colour of one or three numbers from 0 to 1 and is ignored");
  check("spectral a.rfl", Rgb(.5), "is not a colour of one or three numbers from 0 to 1 and is ignored");
}

// Claim: of materials with one name the last is taken, and the warning names both. Source: by hand. Tolerance:
// none. Fails if: statements of both are mixed, or nothing is reported.
TEST(MtlMaterials, LastDefinitionReplacesEarlierOnes) {
  const std::string library =
      "newmtl red\nKd 0.9 0.1 0.1\nmap_Kd p.png\nnewmtl blue\nKd 0 0 1\nnewmtl red\nKd 0.3 0.2 0.1\n";
  const MtlFolder folder(library);
  EXPECT_EQ(folder.color(), Rgb(.3, .2, .1));
  const ImportedAsset import = folder.import();
  ASSERT_EQ(import.warnings.size(), 1u);
  const std::string file = folder.file("a.mtl");
  EXPECT_EQ(import.warnings[0],
            file + ":6: the material 'red' is defined again and replaces the one of " + file + ":1");
}

// Claim: an unknown statement is reported by file, line and material, with the one it resembles; one before the first newmtl,
// too. Source: by hand. Tolerance: none. Fails if: a statement vanishes.
TEST(MtlMaterials, UnknownStatementsAreReported) {
  EXPECT_EQ(
      warnings_of("Kd 1 0 0\nnewmtl red\nKd 0.2 0.2 0.2\nmap_Kdd p.png\nxyzzy 3\n"),
      "a.mtl:1: the statement 'Kd' precedes the first newmtl and is ignored\n"
      "a.mtl:4: the statement 'map_Kdd' of material 'red' is unknown and ignored (did you mean 'map_Kd'?)\n"
      "a.mtl:5: the statement 'xyzzy' of material 'red' is unknown and ignored\n");
  EXPECT_EQ(warnings_of("newmtl red\nmap_kd p.png\n"),
            "a.mtl:2: map_kd 'p.png' of material 'red': there is no such file\n");
}

// Claim: an unknown option before an image's name is reported by file and line, and the image is read. Source: by hand. Tolerance:
// none. Fails if: the option becomes part of the name.
TEST(MtlMaterials, UnknownTextureOptionsAreReported) {
  for (const auto& [statement, option] : {std::pair("map_Kd -foo 1 p.png", "-foo 1"),
                                          std::pair("map_Kd -s 1 1 1 -foo on 2 -mm 0 1 p.png", "-foo on 2"),
                                          std::pair("map_Kd -foo p.png", "-foo")}) {
    const MtlFolder folder(std::string("newmtl red\n") + statement + '\n');
    test::put_png(folder.file("p.png"), 4, 4, [](int x, int) { return test::Bytes{40 * x, 100, 50}; });
    const ImportedAsset import = folder.import();
    ASSERT_EQ(import.warnings.size(), 1u);
    EXPECT_EQ(import.warnings[0], folder.file("a.mtl") +
                                      ":2: map_Kd 'p.png' of material 'red': the option '" + option +
                                      "' is ignored");
    EXPECT_TRUE(load_scene(folder.file("a.obj")).shapes.at(0).reflectance_texture) << statement;
  }
}

// Claim: what a matte surface has no analogue for is reported once per material, in the order of the file; values without
// effect are not. Source: the formats' defaults. Tolerance: none. Fails if: a statement is left out of the list.
TEST(MtlMaterials, StatementsWithoutAnalogueAreReportedTogether) {
  const MtlFolder folder(
      "newmtl red\nKd 0.2 0.2 0.2\nKa 1 1 1\nNs 10\nNi 1.45\nillum 2\nKs 0.5 0.5 0.5\nKe 0 0 0\nPr 0.3\nPm "
      "1\n"
      "Ps 0.2\nPc 0\nTf 0.5 0.5 0.5\naniso 0.5\nanisor 0.1\nd 0.5\nTr 0\nKm 0\nKs 0.4 0.5 "
      "0.5\n");
  const ImportedAsset import = folder.import();
  ASSERT_EQ(import.not_carried.size(), 2u);
  EXPECT_EQ(import.not_carried[1], "material 'red': Ks, Pr, Pm, Ps and aniso are ignored");
  EXPECT_TRUE(MtlFolder("newmtl red\nKd 0.2\nPr 1\nPm 0.0\nTf 1 1 1\nd 1.0\nKs 0\naniso 0\n")
                  .import()
                  .not_carried.empty());
}

// Claim: transparency and unsupported textures are one warning each for a material, at their first statement, in any case.
// Source: by hand. Tolerance: none. Fails if: they are only listed among unused statements, or once per statement.
TEST(MtlMaterials, TransparencyAndOtherTexturesAreWarnings) {
  EXPECT_EQ(
      warnings_of("newmtl red\nKd 0.2\nd 0.4\nTf 0.9 1 1\nd 0.4\n"),
      "a.mtl:3: d and Tf of material 'red' are ignored: transparency is not supported; the surface renders "
      "opaque\n");
  EXPECT_EQ(
      warnings_of("newmtl red\nmap_Pr p.png\nmap_Ks q.png\n"),
      "a.mtl:2: map_Pr and map_Ks of material 'red' are ignored: the supported textures are map_Kd, map_Ke, "
      "map_d, bump and norm\n");
  EXPECT_EQ(warnings_of("newmtl red\nTr 0.5\n"),
            "a.mtl:2: Tr of material 'red' is ignored: transparency is not supported; the surface renders "
            "opaque\n");
  EXPECT_EQ(warnings_of("newmtl red\nKe 0 0 0\nd 1\nTr 0\nTf 1 1 1\nnewmtl unused\nKe 1\nd 0.5\n"), "");
}

// Claim: map_d is the opacity of the shape, by the alpha of its image, or red where it has none; beside Ke it is not.
// Source: Wavefront, MTL material format 4.2. Fails if: it is a warning.
TEST(MtlMaterials, MapDIsOpacity) {
  const auto shape_of = [](const std::string& statements) {
    const MtlFolder folder("newmtl red\nKd 0.2\n" + statements);
    test::put_png(folder.file("p.png"), 4, 4, test::Bytes{255, 255, 255});
    return nlohmann::json::parse(folder.import().text, nullptr, true, true).at("shapes").at(0);
  };
  EXPECT_EQ(shape_of("map_d p.png\n").at("opacity").at("texture"), "p.png");
  EXPECT_FALSE(shape_of("map_d p.png\n").at("opacity").contains("channel"));
  EXPECT_FALSE(shape_of("map_d p.png\nKe 1\n").contains("opacity"));
}

// Claim: Ke is the emission of the shape, above 1 too, one number for all three; map_Ke is its texture times Ke, alone where Ke
// is black; a file that is not there leaves Ke. Source: scenes/README.md. Tolerance: 1e-6. Fails if: Ke is clamped, black
// beside an image makes it dark, or the texture is read as data.
TEST(MtlMaterials, EmissionIsALightOfTheShape) {
  const auto radiance = [](const std::string& statements) -> Rgb {
    const MtlFolder folder("newmtl red\nKd 0.2\n" + statements);
    test::put_png(folder.file("p.png"), 4, 4, [](int x, int) {
      return test::Bytes{x < 2 ? 255 : 0, 255, 0};
    });
    for (const Light& light : load_scene(folder.file("a.obj")).lights)
      if (const auto* emitted = std::get_if<ShapeLight>(&light.source))
        if (!emitted->channel || *emitted->channel == 0) return emitted->radiance;
    return {};
  };
  const auto expect = [&](const std::string& statements, const Rgb& wanted) {
    const Rgb found = radiance(statements);
    for (std::size_t c = 0; c < 3; ++c) EXPECT_NEAR(found[c], wanted[c], 1e-6) << statements;
  };
  expect("", {0, 0, 0});
  expect("Ke 3 0.5 0\n", {3, .5, 0});
  expect("ke 2\n", {2, 2, 2});
  expect("Ke 0 0 0\nmap_Ke p.png\n", {.5, 1, 0});
  expect("map_Ke p.png\nKe 4 2 1\n", {2, 2, 0});
  expect("Ke 4 2 1\nmap_Ke gone.png\n", {4, 2, 1});
}

// Claim: materials that are in no library are one warning at the first usemtl, which names some of them. Source: by hand.
// Tolerance: none. Fails if: they are grey in silence, or each is a line of its own.
TEST(MtlMaterials, MissingMaterialsAreOneWarning) {
  const MtlFolder folder("newmtl red\nKd 0.2\n");
  const auto warnings = [&](const std::string& names) {
    std::string text = "mtllib a.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";
    for (const char name : names) text += std::string("usemtl ") + name + "\nf 1 2 3\n";
    put_bytes(folder.file("a.obj"), text + "usemtl red\nf 1 2 3\n");
    return folder.import().warnings;
  };
  const std::string place = folder.file("a.obj") + ":6: ";
  EXPECT_EQ(warnings(""), std::vector<std::string>{});
  EXPECT_EQ(warnings("x"), std::vector{place + "material 'x': not found in any library; uses grey"});
  EXPECT_EQ(warnings("xyx"),
            std::vector{place + "materials 'x' and 'y': not found in any library; uses grey"});
  EXPECT_EQ(warnings("abcde"),
            std::vector{place + "materials 'a', 'b', 'c' and 2 more: not found in any library; uses grey"});
}

// Claim: a damaged image is a warning by the library's line, the material and the image, as a missing one is, and Kd remains.
// Source: by hand. Tolerance: none. Fails if: it is an error, or a place in the text that the asset becomes is named.
TEST(MtlMaterials, BrokenTexturesAreNamed) {
  for (const std::string statement : {"map_Kd", "bump", "norm"}) {
    const MtlFolder folder("newmtl red\nKd 0.2\n" + statement + " p.png\n");
    test::put_png(folder.file("p.png"), 64, 64, [](int x, int y) { return test::Bytes{4 * x, 4 * y, 0}; });
    std::string bytes = bytes_of(folder.file("p.png"));
    bytes.resize(bytes.size() / 2);
    put_bytes(folder.file("p.png"), bytes);
    const Scene scene = load_scene(folder.file("a.obj"));
    EXPECT_EQ(scene.warnings, std::vector{folder.file("a.mtl") + ":3: " + statement +
                                          " 'p.png' of material 'red': the image is truncated"});
    EXPECT_EQ(scene.shapes.at(0).reflectance, Rgb(.2));
    EXPECT_FALSE(scene.shapes[0].reflectance_texture);
  }
}

// Claim: so is an image with a texel above 1e30, by pixel and value. Source: docs/assets.md. Fails if: it is an error of the
// asset.
TEST(MtlMaterials, TexelsOutOfRangeAreNamed) {
  for (const std::string statement : {"map_Kd", "bump"}) {
    const MtlFolder folder("newmtl red\nKd 0.2\n" + statement + " p.exr\n");
    test::put_exr(folder.file("p.exr"), 4, 4, [](int x, int y) {
      return std::array<double, 3>{x == 2 && y == 1 ? 2e30 : .5, .1 * x, .5};
    });
    const Scene scene = load_scene(folder.file("a.obj"));
    EXPECT_EQ(scene.warnings, std::vector{folder.file("a.mtl") + ":3: " + statement +
                                          " 'p.exr' of material 'red': pixel (2, 1) is not finite or above "
                                          "1e30: 2e+30"});
    EXPECT_EQ(scene.shapes.at(0).reflectance, Rgb(.2));
  }
}

// Claim: of -mm the gain applies, and the warning says that the base does not. Source: by hand. Fails if: it says that the option is
// ignored.
TEST(MtlMaterials, OnlyTheBaseOfMmIsIgnored) {
  const MtlFolder folder("newmtl red\nmap_Kd -mm 0.5 0.25 p.png\n");
  test::put_png(folder.file("p.png"), 4, 4, [](int x, int) { return test::Bytes{40 * x, 100, 50}; });
  const Scene scene = load_scene(folder.file("a.obj"));
  EXPECT_EQ(scene.warnings,
            std::vector{folder.file("a.mtl") + ":2: map_Kd 'p.png' of material 'red': the base 0.5 of -mm is "
                                               "ignored; the gain 0.25 applies"});
  EXPECT_EQ(scene.shapes.at(0).reflectance_texture.value().scale, Rgb(.25));
}

// Claim: a comment after a file's name is no part of it, unless a file has this name; a backslash at the end of a line continues it,
// in both files, and later lines keep their numbers. Source: Wavefront's formats. Fails if: the file is not found.
TEST(MtlMaterials, CommentsAndContinuedLinesAreRead) {
  const MtlFolder folder("newmtl red\nmap_Kd \\\r\n p.png # t\nxyzzy 3\n");
  const auto color = [](int x, int) { return test::Bytes{40 * x, 100, 50}; };
  test::put_png(folder.file("p.png"), 4, 4, color);
  put_bytes(folder.file("a.obj"),
            "mtllib \\\n a.mtl # library\nv 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nvt 1 0\nvt 0 1\nusemtl \\\nred\n"
            "f 1/1 2/2 \\\n3/3\n");
  const auto texture_name = [&] {
    const Scene scene = load_scene(folder.file("a.obj"));
    EXPECT_EQ(scene.warnings,
              std::vector{folder.file("a.mtl") +
                          ":4: the statement 'xyzzy' of material 'red' is unknown and ignored"});
    return scene.shapes.at(0).reflectance_texture.value().source->path();
  };
  EXPECT_EQ(texture_name(), folder.file("p.png"));
  test::put_png(folder.file("q.png"), 4, 4, color);
  std::filesystem::rename(folder.file("q.png"), folder.file("p.png # t"));
  EXPECT_EQ(texture_name(), folder.file("p.png # t"));
}

}  // namespace
}  // namespace opaline::asset_test
