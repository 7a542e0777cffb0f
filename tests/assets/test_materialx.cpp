// SPDX-License-Identifier: GPL-3.0-or-later
#include "asset_test.h"
#include "transport/rough_boundary.h"

namespace opaline::asset_test {
namespace {

constexpr const char* kOpenPbr = R"(<?xml version="1.0"?>
<materialx version="1.39" colorspace="lin_rec709">
  <open_pbr_surface name="SR_skin" type="surfaceshader">
    <input name="subsurface_weight" type="float" value="1" />
    <input name="subsurface_color" type="color3" value="0.8, 0.5, 0.3" />
    <input name="subsurface_radius" type="float" value="2.5" />
    <input name="subsurface_scatter_anisotropy" type="float" value="0.25" />
    <input name="specular_ior" type="float" value="1.4" />
    <input name="coat_weight" type="float" value="0.5" />
  </open_pbr_surface>
  <standard_surface name="SR_wax" type="surfaceshader">
    <input name="subsurface" type="float" value="0.5" />
    <input name="subsurface_radius" type="color3" value="3, 2, 1" />
    <input name="subsurface_scale" type="float" value="0.1" />
    <input name="subsurface_color" type="color3" nodegraph="NG_wax" output="out" />
  </standard_surface>
  <standard_surface name="SR_paint" type="surfaceshader">
    <input name="base" type="float" value="0.5" />
    <input name="base_color" type="color3" value="0.5, 0.2, 1" colorspace="srgb_texture" />
  </standard_surface>
  <surfacematerial name="wax" type="material">
    <input name="surfaceshader" type="surfaceshader" nodename="SR_wax" />
  </surfacematerial>
</materialx>
)";

struct MaterialFolder : ScratchFolder {
  explicit MaterialFolder(const std::string& material = kOpenPbr) {
    put_bytes(file("cube.glb"), cube_asset().glb());
    put_bytes(file("tetrahedron.obj"),
              "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nusemtl a\nf 1 2 4\nf 2 3 4\nf 3 1 4\n");
    put_bytes(file("a.mtlx"), material);
  }

  ImportedAsset import(const std::string& asset, const std::string& name = "") const {
    return import_asset(file(asset), file(asset), file("a.mtlx") + name);
  }

  std::string error(const std::string& name = "") const {
    try {
      import("cube.glb", name);
    } catch (const Error& failure) {
      EXPECT_EQ(failure.kind, ErrorKind::bad_input);
      return std::string(failure.what()).substr(path.string().size() + 1);
    }
    return {};
  }
};

void expect_artist(const Medium& medium, const Rgb& color, const Vec3d& radius, double g, double eta) {
  const auto& artist = std::get<ArtistMedium>(medium.coefficients);
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_NEAR(artist.subsurface_color[i], color[i], 1e-12);
    EXPECT_NEAR(artist.subsurface_radius[i], radius[i], 1e-9 * radius[i]);
  }
  EXPECT_EQ(artist.anisotropy, g);
  EXPECT_EQ(medium.eta, eta);
}

// Claim: OpenPBR's subsurface colour and radius times scale are the artist's medium, lengths in the asset's unit, and
// what is not given has OpenPBR's defaults; other inputs are said to be left out. Source: OpenPBR 1.1. Fails if the
// colour is inverted as glTF's, the scale's default is 1, or the unit does not count.
TEST(MaterialX, OpenPbrIsTheArtistsMedium) {
  const MaterialFolder folder;
  for (const auto& [asset, unit] : {std::pair{"tetrahedron.obj", 1.}, {"cube.glb", 1000.}}) {
    const ImportedAsset import = folder.import(asset);
    const Scene scene = parse_scene(import.text, "a.json");
    ASSERT_EQ(scene.media.size(), 1u);
    expect_artist(scene.media[0], {.8, .5, .3}, Vec3d(2.5, 1.25, .625) * unit, .25, 1.4);
    for (const Shape& shape : scene.shapes) EXPECT_EQ(shape.medium, 0u);
    EXPECT_TRUE(has(import.not_carried, "material 'SR_skin': coat_weight"));
  }
}

// Claim: a body's coat mirrors the weight's share of what its index does. Source: OpenPBR 1.1, specular_weight. Fails if
// the weight is passed over.
TEST(MaterialX, BodiesHaveASpecularWeight) {
  const MaterialFolder folder(
      R"(<materialx><open_pbr_surface name="s"><input name="subsurface_weight" value="1"/>
    <input name="specular_weight" value="0.25"/></open_pbr_surface></materialx>)");
  const ImportedAsset import = folder.import("tetrahedron.obj");
  EXPECT_FALSE(has(import.not_carried, "specular_weight"));
  const double eta = parse_scene(import.text, "a.json").media.at(0).eta;
  EXPECT_NEAR((eta - 1) / (eta + 1), std::sqrt(.25 * .04), 1e-9);
}

// Claim: shapes of an OBJ that share the medium are one body. Fails if the tetrahedron falls into two open ones.
TEST(MaterialX, PartsOfAnObjAreOneBody) {
  const Scene scene = parse_scene(MaterialFolder().import("tetrahedron.obj").text, "a.json");
  ASSERT_EQ(scene.shapes.size(), 2u);
  EXPECT_FALSE(scene.shapes[0].group.empty());
  EXPECT_EQ(scene.shapes[0].group, scene.shapes[1].group);
}

// Claim: a standard surface, found by its material's name, has a radius of a colour times a scale; a weight between 0
// and 1 leaves the rest to the base colour; what is connected to an input is said. Source: Autodesk Standard Surface 1.0.1. Fails if a name leads to
// the first surface.
TEST(MaterialX, StandardSurfaceIsFoundByName) {
  const MaterialFolder folder;
  for (const char* name : {"#wax", "#SR_wax"}) {
    const ImportedAsset import = folder.import("tetrahedron.obj", name);
    expect_artist(parse_scene(import.text, "a.json").media.at(0), {1, 1, 1}, {.3, .2, .1}, 0, 1.5);
    EXPECT_TRUE(has(import.not_carried, "connection of subsurface_color: ignored, uses the default"));
    EXPECT_TRUE(has(import.translated, "subsurface 0.5 -> subsurface_weight; base colour -> base_color 0.8"));
    const Medium medium = parse_scene(import.text, "a.json").media.at(0);
    EXPECT_EQ(medium.subsurface_weight, .5);
    EXPECT_EQ(medium.base_color, Rgb(.8));
  }
}

// Claim: the first of several surfaces is taken with a warning that names the others, a surface given by name without. Fails if:
// a look is chosen in silence.
TEST(MaterialX, TheFirstOfSeveralIsNamed) {
  const MaterialFolder folder;
  EXPECT_TRUE(
      has(folder.import("tetrahedron.obj").warnings,
          "a.mtlx: 'SR_skin' is the material of all shapes; others of the file, by FILE#NAME: 'SR_wax', "
          "'SR_paint'"));
  EXPECT_FALSE(has(folder.import("tetrahedron.obj", "#wax").warnings, "SR_"));
}

constexpr const char* kTwoMaterials = R"(<materialx>
  <image name="skin" type="color3"><input name="file" type="filename" value="skin.png" colorspace="srgb_texture"/></image>
  <tiledimage name="dull" type="float"><input name="file" type="filename" value="dull.png"/></tiledimage>
  <open_pbr_surface name="SR_a"><input name="base_color" type="color3" nodename="skin"/>
    <input name="base_weight" value="0.5"/><input name="specular_roughness" type="float" nodename="dull"/></open_pbr_surface>
  <standard_surface name="SR_b"><input name="subsurface" value="1"/>
    <input name="subsurface_color" type="color3" nodename="skin"/></standard_surface>
  <surfacematerial name="a"><input name="surfaceshader" nodename="SR_a"/></surfacematerial>
  <surfacematerial name="b"><input name="surfaceshader" nodename="SR_b"/></surfacematerial></materialx>)";

// Claim: each shape has the MaterialX material of the name of its own, one without such a name keeps its own; images are
// textures. Fails if: all shapes have the first material, or an image is ignored.
TEST(MaterialX, MaterialsByName) {
  const MaterialFolder folder(kTwoMaterials);
  put_bytes(folder.file("c.obj"),
            "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nusemtl b\nf 1 3 2\nusemtl a\nf 1 2 4\nf 2 3 4\n"
            "usemtl c\nf 3 1 4\n");
  const ImportedAsset import = folder.import("c.obj");
  const Json json = Json::parse(import.text, nullptr, true, true);
  const Json& shapes = json["shapes"];
  const std::string skin = folder.file("skin.png");
  EXPECT_EQ(shapes[0]["medium"], "b");
  EXPECT_EQ(json["media"]["b"]["subsurface_color"]["texture"], skin);
  EXPECT_EQ(shapes[1]["reflectance"], (Json{{"texture", skin}, {"color_space", "srgb"}, {"scale", .5}}));
  EXPECT_EQ(shapes[1]["specular_roughness"]["texture"], folder.file("dull.png"));
  EXPECT_FALSE(shapes[2].contains("medium") || shapes[2]["reflectance"].is_object());
  EXPECT_TRUE(has(import.warnings, "has no material 'c': it stays as in the asset"));
  EXPECT_FALSE(has(import.not_carried, "connect"));
  const ImportedAsset one = folder.import("c.obj", "#a");
  EXPECT_TRUE(Json::parse(one.text, nullptr, true, true)["shapes"][2]["reflectance"].is_object());
}

// Claim: without scattering below the surface it is opaque, of base times base colour, sRGB made linear, ACEScg made
// Rec.709. Source: MaterialX's colour spaces; ACEScg white is Rec.709 white. Fails if colours are taken as they stand.
TEST(MaterialX, OthersAreOpaque) {
  const Scene scene = parse_scene(MaterialFolder().import("tetrahedron.obj", "#SR_paint").text, "a.json");
  EXPECT_TRUE(scene.media.empty());
  const Rgb color = scene.shapes.at(0).reflectance;
  EXPECT_NEAR(color.x, .5 * .21404, 1e-5);
  EXPECT_NEAR(color.y, .5 * .033105, 1e-5);
  EXPECT_NEAR(color.z, .5, 1e-12);
  const auto gray = [](const char* value) {
    const MaterialFolder folder(
        R"(<materialx colorspace="acescg"><standard_surface name="s" type="surfaceshader">
      <input name="base_color" type="color3" value=")" +
        std::string(value) + R"("/></standard_surface></materialx>)");
    return parse_scene(folder.import("tetrahedron.obj").text, "a.json").shapes.at(0).reflectance;
  };
  for (std::size_t i = 0; i < 3; ++i) EXPECT_NEAR(gray("0.5, 0.5, 0.5")[i], .5, 1e-4);
  EXPECT_GT(gray("0.5, 0.25, 0.25").x, .6);  // Rec.709's red is less saturated
}

// Claim: an opaque surface has the metalness, roughness and coat of its model, by either model's names and defaults; the
// coat mirrors the weight's share of .04. Source: OpenPBR 1.1, Standard Surface 1.0.1. Fails if a name is of the other
// model, or the weight is passed over.
TEST(MaterialX, OpaqueSurfacesAreGlossy) {
  const auto gloss = [](const std::string& text) {
    const MaterialFolder folder("<materialx>" + text + "</materialx>");
    const ImportedAsset import = folder.import("tetrahedron.obj");
    EXPECT_FALSE(has(import.not_carried, "material 's'"));
    return parse_scene(import.text, "a.json").shapes.at(0).gloss.value();
  };
  const Gloss pbr = gloss(R"(<open_pbr_surface name="s"><input name="base_metalness" value="0.5"/>
    <input name="specular_weight" value="0.25"/></open_pbr_surface>)");
  EXPECT_EQ(pbr.metalness, .5);
  EXPECT_EQ(pbr.roughness, .3);
  EXPECT_NEAR((pbr.eta - 1) / (pbr.eta + 1), std::sqrt(.25 * .04), 1e-9);
  const Gloss standard = gloss(R"(<standard_surface name="s"><input name="metalness" value="1"/>
    <input name="specular_roughness" value="0.6"/><input name="specular_IOR" value="1.4"/></standard_surface>)");
  EXPECT_EQ(standard.metalness, 1);
  EXPECT_EQ(standard.roughness, .6);
  EXPECT_NEAR(standard.eta, 1.4, 1e-12);
}

// Claim: anisotropy is OpenPBR's as it stands; of a standard surface, alpha over and times the root of the alphas' ratio,
// turned by a part of a full turn. Source: OpenPBR 1.1; MaterialX 1.38, roughness_anisotropy. Fails if one is taken for the
// other.
TEST(MaterialX, AnisotropyIsThatOfTheModel) {
  const auto gloss = [](const std::string& text) {
    const MaterialFolder folder("<materialx>" + text + "</materialx>");
    const ImportedAsset import = folder.import("tetrahedron.obj");
    EXPECT_FALSE(has(import.not_carried, "material 's'"));
    return parse_scene(import.text, "a.json").shapes.at(0).gloss.value();
  };
  const Gloss pbr = gloss(R"(<open_pbr_surface name="s"><input name="specular_roughness" value="0.4"/>
    <input name="specular_roughness_anisotropy" value="0.5"/></open_pbr_surface>)");
  EXPECT_EQ(pbr.grain, (Grain{.5, 0}));
  EXPECT_EQ(pbr.roughness, .4);
  const Gloss standard = gloss(R"(<standard_surface name="s"><input name="specular_roughness" value="0.4"/>
    <input name="specular_anisotropy" value="0.5"/><input name="specular_rotation" value="0.25"/></standard_surface>)");
  const FacetAlphas alphas = facet_alphas(float(standard.roughness), float(standard.grain.anisotropy));
  EXPECT_NEAR(alphas.along, .16 / std::sqrt(.5), 1e-6);
  EXPECT_NEAR(alphas.across, .16 * std::sqrt(.5), 1e-6);
  EXPECT_EQ(standard.grain.rotation, 90);
}

// Claim: images of anisotropy and rotation are its textures. Fails if they are lost.
TEST(MaterialX, AnisotropyHasTextures) {
  const MaterialFolder folder(R"(<materialx>
    <image name="i" type="float"><input name="file" type="filename" value="i.png"/></image>
    <standard_surface name="s"><input name="specular_anisotropy" nodename="i"/>
      <input name="specular_rotation" nodename="i"/></standard_surface></materialx>)");
  const Json shape = Json::parse(folder.import("tetrahedron.obj").text, nullptr, true, true)["shapes"][0];
  EXPECT_TRUE(shape["specular_anisotropy"]["texture"].get<std::string>().ends_with("i.png"));
  EXPECT_TRUE(shape["specular_rotation"]["texture"].get<std::string>().ends_with("i.png"));
}

// Claim: the fuzz of OpenPBR and the sheen of Standard Surface are fuzz, of opaque surfaces and media. Source: OpenPBR
// 1.1; Standard Surface 1.0.1, its default roughness. Fails if: they are reported as lost, or a medium has none.
TEST(MaterialX, FuzzAndSheenAreFuzz) {
  const auto scene = [](const std::string& text) {
    const MaterialFolder folder("<materialx>" + text + "</materialx>");
    const ImportedAsset import = folder.import("tetrahedron.obj");
    EXPECT_FALSE(has(import.not_carried, "material 's'"));
    return parse_scene(import.text, "a.json");
  };
  EXPECT_EQ(scene(R"(<open_pbr_surface name="s"><input name="fuzz_weight" value="0.4"/>
    <input name="fuzz_color" value="0.5, 0.25, 1"/></open_pbr_surface>)")
                .shapes.at(0)
                .fuzz,
            (Fuzz{.4, {.5, .25, 1}, .5}));
  EXPECT_EQ(scene(R"(<standard_surface name="s"><input name="subsurface" value="1"/>
    <input name="sheen" value="0.7"/></standard_surface>)")
                .media.at(0)
                .fuzz,
            (Fuzz{.7, {1, 1, 1}, .3}));
  EXPECT_EQ(scene(R"(<open_pbr_surface name="s"><input name="fuzz_color" value="0.5"/></open_pbr_surface>)")
                .shapes.at(0)
                .fuzz,
            Fuzz());
}

// Claim: images connected to the inputs of fuzz are its textures, with their tiling and colour space; other connections are reported.
// Source: MaterialX 1.39. Fails if: an input loses its image, the weight is lost with it, or a colour space of the document's is ignored.
TEST(MaterialX, ImagesOfFuzzAreTextures) {
  const auto import = [](const std::string& inputs) {
    const MaterialFolder folder(R"(<materialx colorspace="lin_rec709">
      <nodegraph name="NG"><tiledimage name="w" type="float"><input name="file" type="filename" value="w.png"/>
        <input name="uvtiling" type="vector2" value="2, 3"/></tiledimage><output name="out" type="float" nodename="w"/></nodegraph>
      <image name="c" type="color3"><input name="file" type="filename" value="c.png" colorspace="srgb_texture"/></image>
      <open_pbr_surface name="s">)" +
                                inputs + "</open_pbr_surface></materialx>");
    put_bytes(folder.file("w.png"), "");
    put_bytes(folder.file("c.png"), "");
    return folder.import("cube.glb");
  };
  const ImportedAsset all = import(R"(<input name="fuzz_weight" type="float" nodegraph="NG" output="out"/>
    <input name="fuzz_color" type="color3" nodename="c"/><input name="fuzz_roughness" type="float" nodegraph="NG" output="out"/>)");
  const Json keys = Json::parse(all.text, nullptr, true, true).at("shapes").at(0);
  EXPECT_TRUE(keys.at("fuzz_weight").at("texture").get<std::string>().ends_with("w.png")) << all.text;
  EXPECT_EQ(keys.at("fuzz_weight").at("uv_scale"), Json({2, 3}));
  EXPECT_EQ(keys.at("fuzz_color").at("color_space"), "srgb");
  EXPECT_TRUE(keys.at("fuzz_roughness").contains("texture"));
  EXPECT_FALSE(has(all.not_carried, "fuzz")) << all.text;
  const ImportedAsset lost = import(
      R"(<input name="fuzz_weight" value="0.5"/><input name="fuzz_color" type="color3" nodename="x"/>)");
  EXPECT_TRUE(has(lost.not_carried, "fuzz_color: it is connected to no image"));
  EXPECT_EQ(Json::parse(lost.text, nullptr, true, true).at("shapes").at(0).at("fuzz_weight"), .5);
}

// Claim: a bump of an image that the surface's normal is connected to, directly or through a graph, is a bump map of its
// scale in the asset's unit, laid by its tiling from the lower left; other connections are said. Source: MaterialX 1.39, bump.
// Fails if the scale is in mm, or the prefix of files is dropped.
TEST(MaterialX, BumpsAreBumpMaps) {
  const std::string graph = R"(<nodegraph name="NG" fileprefix="maps/">
      <tiledimage name="h" type="float"><input name="file" type="filename" value="h.png"/>
        <input name="uvtiling" type="vector2" value="2, 2.5"/></tiledimage>
      <bump name="b" type="vector3"><input name="height" type="float" nodename="h"/>
        <input name="scale" type="float" value="0.002"/></bump>
      <output name="out" type="vector3" nodename="b"/></nodegraph>)";
  const auto import = [&](const std::string& normal, const std::string& more = "") {
    const MaterialFolder folder("<materialx>" + graph + more + "<standard_surface name=\"s\">" + normal +
                                "</standard_surface></materialx>");
    std::filesystem::create_directory(folder.path / "maps");
    put_bytes(folder.file("maps/h.png"), "");
    return folder.import("cube.glb");
  };
  const ImportedAsset bumped = import(R"(<input name="normal" nodegraph="NG" output="out"/>)");
  EXPECT_TRUE(has(bumped.translated, "bump of maps/h.png -> bump_map, white 2 mm high"));
  EXPECT_FALSE(has(bumped.not_carried, "normal"));
  EXPECT_NE(bumped.text.find("maps/h.png"), std::string::npos);
  EXPECT_NE(bumped.text.find("\"uv_scale\": [2.0, 2.5]"), std::string::npos) << bumped.text;
  EXPECT_NE(bumped.text.find("\"uv_offset\": [0, -1.5]"), std::string::npos) << bumped.text;
  EXPECT_TRUE(has(import(R"(<input name="normal" nodename="n"/>)", R"(<normalmap name="n"/>)").not_carried,
                  "normal: it is connected to no bump node"));
  EXPECT_TRUE(has(import(R"(<input name="normal" nodename="n"/>)",
                         R"(<bump name="n"><input name="height" value="1"/></bump>)")
                      .not_carried,
                  "normal: its heights are not an image"));
}

// Claim: what is wrong is named by file, surface and input. Fails if a broken value becomes 0.
TEST(MaterialX, MistakesAreNamed) {
  const auto surface = [](const std::string& input) {
    return "<materialx>\n<open_pbr_surface name=\"s\"><input name=\"subsurface_weight\" value=\"1\"/>" +
           input + "</open_pbr_surface></materialx>";
  };
  EXPECT_EQ(MaterialFolder().error("#blood"),
            "a.mtlx: has no such surface (expected one of 'SR_skin', 'SR_wax', 'SR_paint', got 'blood')");
  EXPECT_EQ(MaterialFolder("<materialx>\n<a>").error().substr(0, 20), "a.mtlx:2: is not XML");
  EXPECT_EQ(MaterialFolder("<usd/>").error(),
            "a.mtlx: is not a MaterialX file (expected the element materialx)");
  EXPECT_EQ(MaterialFolder("<materialx/>").error(),
            "a.mtlx: has no such surface (expected a file with an open_pbr_surface or standard_surface)");
  EXPECT_EQ(MaterialFolder(surface("<input name=\"subsurface_color\" value=\"1, x, 1\"/>")).error(),
            "a.mtlx: material 's': bad input 'subsurface_color' (expected one number, or three separated by "
            "commas, got '1, x, 1')");
  EXPECT_EQ(MaterialFolder(surface("<input name=\"specular_ior\" value=\"99\"/>")).error(),
            "a.mtlx: material 's': bad input 'specular_ior' (expected a number from 0.1 to 10, got 99)");
}

}  // namespace
}  // namespace opaline::asset_test
