// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <cmath>

#include "asset_test.h"
#include "transport/rough_boundary.h"

namespace opaline::asset_test {
namespace {

/// The scene of a cube of this material.
Asset cube_of(Json material) {
  Asset asset = cube_asset();
  asset.material(std::move(material));
  asset.json["meshes"][0]["primitives"][0]["material"] = 0;
  return asset;
}

const Json kVolume{
    {"attenuationColor", {.9, .5, .2}}, {"attenuationDistance", .004}, {"thicknessFactor", .02}};

/// 1/mm of the volume above, in each channel.
Vec3d sigma_t() {
  return {-std::log(.9) / 4, -std::log(.5) / 4, -std::log(.2) / 4};
}

/// The albedo whose half space of an index-matched boundary reflects rho, by the formula that the draft gives.
double albedo(double rho, double g) {
  const double s = 4.09712 + 4.20863 * rho - std::sqrt(9.59217 + 41.6808 * rho + 17.7126 * rho * rho);
  return (1 - s * s) / (1 - g * s * s);
}

void expect_medium(const Medium& medium, const Vec3d& rho, double g, double eta) {
  const auto& physical = std::get<PhysicalMedium>(medium.coefficients);
  for (std::size_t i = 0; i < 3; ++i) {
    const double sigma_s = albedo(rho[i], g) * sigma_t()[i];
    EXPECT_NEAR(physical.sigma_s_prime[i], (1 - g) * sigma_s, 1e-9 * sigma_t()[i]) << i;
    EXPECT_NEAR(physical.sigma_a[i], sigma_t()[i] - sigma_s, 1e-9 * sigma_t()[i]) << i;
  }
  EXPECT_EQ(medium.scatter_anisotropy, g);
  EXPECT_EQ(medium.eta, eta);
}

// Claim: a volume that scatters becomes sigma_a and sigma_s in 1/mm by the draft's inversion, in either of its two
// spellings; a metre is 1000 mm. Source: KHR_materials_volume, KHR_materials_volume_scatter,
// KHR_materials_scatter; Kulla & Conty 2017. Fails if: metres are taken for mm, or (1 - g) counts twice.
TEST(GltfMaterials, ScatteringVolumesAreMedia) {
  const Json draft = {
      {"name", "wax"},
      {"extensions",
       {{"KHR_materials_volume", kVolume},
        {"KHR_materials_transmission", {{"transmissionFactor", 1}}},
        {"KHR_materials_ior", {{"ior", 1.4}}},
        {"KHR_materials_volume_scatter", {{"multiscatterColor", {.8, .6, .1}}, {"scatterAnisotropy", .3}}}}}};
  const Scene scene = scene_of(cube_of(draft).glb(), "a.glb");
  ASSERT_EQ(scene.media.size(), 1u);
  EXPECT_EQ(scene.media[0].name, "wax");
  EXPECT_EQ(scene.shapes.at(0).medium, 0u);
  expect_medium(scene.media[0], {.8, .6, .1}, .3, 1.4);
  EXPECT_TRUE(imported(cube_of(draft)).not_carried.empty());

  const Json other = {{"extensions",
                       {{"KHR_materials_volume", kVolume},
                        {"KHR_materials_diffuse_transmission", {{"diffuseTransmissionFactor", 1}}},
                        {"KHR_materials_scatter",
                         {{"scatterStrengthFactor", .5}, {"multiscatterColorFactor", {.8, .6, .1}}}}}}};
  expect_medium(scene_of(cube_of(other).glb(), "a.glb").media.at(0), {.4, .3, .05}, 0, 1.5);
}

// Claim: an albedo of 1 absorbs nothing and one of 0 scatters nothing. Fails if the inversion is not held to [0, 1].
TEST(GltfMaterials, TheInversionEndsAtItsEnds) {
  const Json material = {{"extensions",
                          {{"KHR_materials_volume", kVolume},
                           {"KHR_materials_volume_scatter", {{"multiscatterColor", {1, 0, .5}}}}}}};
  const Scene scene = scene_of(cube_of(material).glb(), "a.glb");
  const auto& medium = std::get<PhysicalMedium>(scene.media.at(0).coefficients);
  EXPECT_NEAR(medium.sigma_a.x, 0, 1e-9);
  EXPECT_NEAR(medium.sigma_s_prime.y, 0, 1e-5);
  EXPECT_GT(medium.sigma_a.x, -1e-30);
  EXPECT_GT(medium.sigma_s_prime.y, -1e-30);
}

// Claim: a material that does not scatter is opaque, of its base colour, metalness and roughness, and says what it loses;
// glTF's default is white. Fails if clear volumes become media.
TEST(GltfMaterials, OthersAreOpaque) {
  const Json material = {
      {"name", "glass"},
      {"pbrMetallicRoughness",
       {{"baseColorFactor", {.1, .2, .3, .5}},
        {"baseColorTexture", {{"index", 0}}},
        {"roughnessFactor", .25}}},
      {"alphaMode", "BLEND"},
      {"extensions",
       {{"KHR_materials_volume", kVolume},
        {"KHR_materials_transmission", {{"transmissionFactor", 1}, {"transmissionTexture", {{"index", 0}}}}},
        {"KHR_materials_clearcoat", {{"clearcoatFactor", 1}}}}}};
  Asset asset = cube_of(material);
  asset.json["textures"] = Json::array({{{"source", 0}}});
  const Scene scene = scene_of(asset.glb(), "a.glb");
  EXPECT_TRUE(scene.media.empty());
  EXPECT_EQ(scene.shapes.at(0).medium, std::nullopt);
  EXPECT_EQ(scene.shapes.at(0).reflectance, Rgb(.1, .2, .3));
  ASSERT_TRUE(scene.shapes.at(0).gloss);
  EXPECT_EQ(scene.shapes.at(0).gloss->metalness, 1);
  EXPECT_EQ(scene.shapes.at(0).gloss->roughness, .25);
  const std::vector<std::string> lines = imported(asset).not_carried;
  for (const char* line :
       {"material 'glass': baseColorTexture: its mesh has no TEXCOORD_0", "texture transmissionTexture",
        "alphaMode 'BLEND'", "material 'glass': KHR_materials_volume",
        "KHR_materials_transmission: a clear, non-scattering body",
        "material 'glass': KHR_materials_clearcoat"})
    EXPECT_TRUE(has(lines, line)) << line;
  EXPECT_EQ(scene_of(cube_asset().glb(), "a.glb").shapes.at(0).reflectance, Rgb(1, 1, 1));
}

// Claim: specularFactor is the share that the coat of an opaque material or a body mirrors at right angles, .04 of the
// light without it; its colour is told to be lost. Source: KHR_materials_specular. Fails if it is passed over, or told to
// be.
TEST(GltfMaterials, SpecularFactorWeighsTheCoat) {
  Json material = {{"extensions", {{"KHR_materials_specular", {{"specularFactor", .25}}}}}};
  const Scene scene = scene_of(cube_of(material).glb(), "a.glb");
  ASSERT_TRUE(scene.shapes.at(0).gloss);
  const double eta = scene.shapes[0].gloss->eta, root = (eta - 1) / (eta + 1);
  EXPECT_NEAR(root * root, .25 * .04, 1e-9);
  EXPECT_TRUE(imported(cube_of(material)).not_carried.empty());
  material["extensions"]["KHR_materials_specular"]["specularColorFactor"] = {1, .5, 0};
  EXPECT_TRUE(has(imported(cube_of(material)).not_carried, "specularColorFactor"));
  material["extensions"]["KHR_materials_volume"] = kVolume;
  material["extensions"]["KHR_materials_volume_scatter"] = {{"multiscatterColor", {.5, .5, .5}}};
  EXPECT_TRUE(has(imported(cube_of(material)).not_carried, "specularColorFactor"));
  EXPECT_FALSE(has(imported(cube_of(material)).not_carried, "KHR_materials_specular"));
  EXPECT_TRUE(has(imported(cube_of(material)).translated, "specularFactor -> specular_weight 0.25"));
  const double of_body = scene_of(cube_of(material).glb(), "a.glb").media.at(0).eta;
  EXPECT_NEAR((of_body - 1) / (of_body + 1), std::sqrt(.25 * .04), 1e-9);
}

// Claim: anisotropy has both of glTF's alphas, mix(alpha, 1, strength^2) along the tangent and alpha across, turned by
// degrees, of what is opaque and of bodies; it is said where no UVs tell the tangent. Source: KHR_materials_anisotropy. Fails
// if the strength is not squared, or roughness stays what it was.
TEST(GltfMaterials, AnisotropyHasBothAlphas) {
  Json material = {{"pbrMetallicRoughness", {{"roughnessFactor", .4}}},
                   {"extensions",
                    {{"KHR_materials_anisotropy", {{"anisotropyStrength", .5}, {"anisotropyRotation", 1}}}}}};
  const auto expect = [](double roughness, const Grain& grain) {
    const FacetAlphas alphas = facet_alphas(float(roughness), float(grain.anisotropy));
    EXPECT_NEAR(alphas.across, .16, 1e-6);
    EXPECT_NEAR(alphas.along, .16 + .84 * .25, 1e-6);
    EXPECT_NEAR(grain.rotation, 57.29578, 1e-5);
  };
  const Scene opaque = scene_of(cube_of(material).glb(), "a.glb");
  expect(opaque.shapes.at(0).gloss.value().roughness, opaque.shapes[0].gloss->grain);
  EXPECT_TRUE(imported(cube_of(material)).not_carried.empty());
  EXPECT_TRUE(has(imported(cube_of(material)).translated, "around y, because its mesh has no TEXCOORD_0"));
  material["extensions"]["KHR_materials_volume"] = kVolume;
  material["extensions"]["KHR_materials_volume_scatter"] = {{"multiscatterColor", {.5, .5, .5}}};
  const Scene body = scene_of(cube_of(material).glb(), "a.glb");
  expect(body.media.at(0).specular_roughness, body.media[0].grain);
}

// Claim: sheen is fuzz with the largest channel of its colour as weight, on opaque surfaces and bodies. Source:
// KHR_materials_sheen. Tolerance: rounding. Fails if: it is reported as not carried, or lost on bodies.
TEST(GltfMaterials, SheenIsFuzz) {
  Json material = {
      {"extensions",
       {{"KHR_materials_sheen", {{"sheenColorFactor", {.2, .8, .4}}, {"sheenRoughnessFactor", .6}}}}}};
  const auto expect = [](const Fuzz& fuzz) {
    EXPECT_NEAR(fuzz.weight, .8, 1e-6);
    EXPECT_NEAR(fuzz.color.x, .25, 1e-6);
    EXPECT_NEAR(fuzz.color.y, 1, 1e-6);
    EXPECT_NEAR(fuzz.roughness, .6, 1e-6);
  };
  expect(scene_of(cube_of(material).glb(), "a.glb").shapes.at(0).fuzz);
  EXPECT_TRUE(imported(cube_of(material)).not_carried.empty());
  material["extensions"]["KHR_materials_volume"] = kVolume;
  material["extensions"]["KHR_materials_volume_scatter"] = {{"multiscatterColor", {.5, .5, .5}}};
  expect(scene_of(cube_of(material).glb(), "a.glb").media.at(0).fuzz);
  material["extensions"]["KHR_materials_sheen"].erase("sheenColorFactor");
  EXPECT_EQ(scene_of(cube_of(material).glb(), "a.glb").media.at(0).fuzz, Fuzz());
}

// Claim: emissiveFactor times emissiveStrength is the radiance of a shape's light, in nits as W/(mm^2 sr), of opaque and
// translucent materials; a texture that cannot be used leaves the surface dark, and the loss is listed. Source: glTF 2.0,
// KHR_materials_emissive_strength. Tolerance: rounding. Fails if: the strength is lost, or an unusable texture makes all of
// the surface emit.
TEST(GltfMaterials, EmissionIsALightOfTheShape) {
  Json material = {{"name", "lamp"},
                   {"emissiveFactor", {.5, .25, 0}},
                   {"extensions", {{"KHR_materials_emissive_strength", {{"emissiveStrength", 8}}}}}};
  const auto radiance = [&]() -> Rgb {
    const Scene scene = scene_of(cube_of(material).glb(), "a.glb");
    for (const Light& light : scene.lights)
      if (const auto* emitted = std::get_if<ShapeLight>(&light.source)) return emitted->radiance;
    return {};
  };
  EXPECT_EQ(radiance(), Rgb(4, 2, 0));
  EXPECT_TRUE(imported(cube_of(material)).not_carried.empty());
  EXPECT_TRUE(has(imported(cube_of(material)).translated, "emissiveFactor -> emission [4, 2, 0]"));
  material["extensions"]["KHR_materials_volume"] = kVolume;
  material["extensions"]["KHR_materials_volume_scatter"] = {{"multiscatterColor", {.5, .5, .5}}};
  EXPECT_EQ(radiance(), Rgb(4, 2, 0));
  material["emissiveTexture"] = {{"index", 0}};
  EXPECT_EQ(radiance(), Rgb(0, 0, 0));
  EXPECT_TRUE(has(imported(cube_of(material)).not_carried, "material 'lamp': emissiveFactor"));
}

// Claim: values that leave nothing to scatter, or lie outside of what a medium may have, are replaced and said. Fails if
// one of them makes a scene file that is refused.
TEST(GltfMaterials, ValuesOutOfRangeAreSaid) {
  Json material = {
      {"extensions",
       {{"KHR_materials_volume", kVolume},
        {"KHR_materials_ior", {{"ior", 0}}},
        {"KHR_materials_volume_scatter", {{"multiscatterColor", {2, .5, -1}}, {"scatterAnisotropy", -1}}}}}};
  Json& volume = material["extensions"]["KHR_materials_volume"];
  volume["attenuationColor"] = {1, 0, .5};
  volume["thicknessFactor"] = 0;
  const std::vector<std::string> lines = imported(cube_of(material)).not_carried;
  for (const char* line : {"attenuationColor [1, 0, 0.5] outside", "ior 0, outside", "thicknessFactor 0",
                           "transmissionFactor 0 and diffuseTransmissionFactor 0"})
    EXPECT_TRUE(has(lines, line)) << line;
  EXPECT_EQ(scene_of(cube_of(material).glb(), "a.glb").media.at(0).eta, 1.5);
  volume.erase("attenuationDistance");
  EXPECT_TRUE(scene_of(cube_of(material).glb(), "a.glb").media.empty());
  EXPECT_TRUE(has(imported(cube_of(material)).not_carried, "a multiscatter colour; treated as opaque"));
}

// Claim: a number outside of the range that glTF 2.0 or an extension gives it is clamped, with one warning that names its place,
// the range and the value; numbers at the ends of their range are taken without a word. Source: the JSON schemas of glTF 2.0 and
// its extensions. Fails if a row of the table is missing, or the warning of a material repeats for its second mesh.
TEST(GltfMaterials, NumbersOutOfRangeAreClampedWithAWarning) {
  const Json bad = {
      {"emissiveFactor", {0, -1, 0}},
      {"alphaCutoff", -1},
      {"pbrMetallicRoughness",
       {{"baseColorFactor", {1.7, -.2, .5, 1}}, {"roughnessFactor", 3}, {"metallicFactor", -1}}},
      {"extensions",
       {{"KHR_materials_ior", {{"ior", .5}}},
        {"KHR_materials_anisotropy", {{"anisotropyStrength", -2}}},
        {"KHR_materials_specular", {{"specularFactor", 2}}},
        {"KHR_materials_transmission", {{"transmissionFactor", -.5}}},
        {"KHR_materials_volume",
         {{"thicknessFactor", -1}, {"attenuationDistance", -1}, {"attenuationColor", {2, 1, 1}}}}}}};
  Asset asset = cube_of(bad);
  asset.json["meshes"][0]["primitives"].push_back(asset.json["meshes"][0]["primitives"][0]);
  asset.json["meshes"][0]["primitives"][1]["attributes"].erase("NORMAL");
  const ImportedAsset result = imported(asset);
  const auto expect_one = [&](const std::string& key, const std::string& expected, const std::string& got) {
    const std::string text =
        ": materials[0]." + key + " is out of range (expected " + expected + ", got " + got;
    EXPECT_EQ(std::ranges::count_if(result.warnings,
                                    [&](const std::string& line) { return line.find(text) != line.npos; }),
              1)
        << text;
  };
  expect_one("emissiveFactor", "0 to 1", "[0,-1,0]");
  expect_one("alphaCutoff", "at least 0", "-1");
  expect_one("pbrMetallicRoughness.baseColorFactor", "0 to 1", "[1.7,-0.2,0.5,1]): uses [1.0,0.0,0.5,1]");
  expect_one("pbrMetallicRoughness.roughnessFactor", "0 to 1", "3): uses 1.0");
  expect_one("pbrMetallicRoughness.metallicFactor", "0 to 1", "-1): uses 0.0");
  expect_one("extensions.KHR_materials_ior.ior", "at least 1, or 0", "0.5): uses 1.0");
  expect_one("extensions.KHR_materials_anisotropy.anisotropyStrength", "0 to 1", "-2");
  expect_one("extensions.KHR_materials_specular.specularFactor", "0 to 1", "2");
  expect_one("extensions.KHR_materials_transmission.transmissionFactor", "0 to 1", "-0.5");
  expect_one("extensions.KHR_materials_volume.thicknessFactor", "at least 0", "-1");
  expect_one("extensions.KHR_materials_volume.attenuationDistance", "above 0", "-1): uses the default");
  expect_one("extensions.KHR_materials_volume.attenuationColor", "0 to 1", "[2,1,1]");
  const Scene scene = scene_of(asset.glb(), "a.glb");
  EXPECT_EQ(scene.shapes.at(0).reflectance, Rgb(1, 0, .5));
  EXPECT_EQ(scene.shapes.at(0).gloss.value().roughness, 1);

  const Json good = {{"emissiveFactor", {0, 1, 0}},
                     {"alphaCutoff", 7},
                     {"pbrMetallicRoughness",
                      {{"baseColorFactor", {1, 0, .5, 1}}, {"roughnessFactor", 0}, {"metallicFactor", 1}}},
                     {"extensions",
                      {{"KHR_materials_ior", {{"ior", 1}}},
                       {"KHR_materials_specular", {{"specularColorFactor", {9, 1, 0}}}}}}};
  EXPECT_FALSE(has(imported(cube_of(good)).warnings, "out of range"));
}

// Claim: primitives of one mesh that share a medium are one body, those of another node another. Fails if light stops
// where a primitive ends.
TEST(GltfMaterials, PrimitivesOfOneMediumAreOneBody) {
  Asset asset = cube_of({{"extensions",
                          {{"KHR_materials_volume", kVolume},
                           {"KHR_materials_volume_scatter", {{"multiscatterColor", {.5, .5, .5}}}}}}});
  auto& primitives = asset.json["meshes"][0]["primitives"];
  primitives.push_back(primitives[0]);
  asset.root(asset.node({{"mesh", 0}}));
  const Scene scene = scene_of(asset.glb(), "a.glb");
  ASSERT_EQ(scene.shapes.size(), 4u);
  EXPECT_FALSE(scene.shapes[0].group.empty());
  EXPECT_EQ(scene.shapes[0].group, scene.shapes[1].group);
  EXPECT_NE(scene.shapes[0].group, scene.shapes[2].group);
}

}  // namespace
}  // namespace opaline::asset_test
