// SPDX-License-Identifier: GPL-3.0-or-later
#include "asset_test.h"
#include "geometry/formats/gltf_part.h"
#include "image/texture_file.h"
#include "scene/scene_properties.h"
#include "support/pictures.h"

namespace opaline::asset_test {
namespace {

/// The bytes of a PNG whose left half is `left` and whose right half is black.
std::string png_of(int left) {
  const ScratchFolder folder;
  test::put_png(folder.file("p.png"), 4, 2, [&](int x, int) {
    return x < 2 ? test::Bytes{left, left, left} : test::Bytes{0, 0, 0};
  });
  return bytes_of(folder.file("p.png"));
}

/// A triangle with UVs (0, 0), (1, 0), (0, 1) as glTF counts them, of this material, which has texture 0.
Asset textured_triangle(const Json& material, const Json& image) {
  Asset asset;
  const int positions = asset.accessor<float>("VEC3", kFloat, {0, 0, 0, 1, 0, 0, 0, 1, 0});
  const int uvs = asset.accessor<float>("VEC2", kFloat, {0, 0, 1, 0, 0, 1});
  asset.mesh({{"attributes", {{"POSITION", positions}, {"TEXCOORD_0", uvs}}},
              {"material", asset.material(material)}});
  asset.root(asset.node({{"mesh", 0}}));
  asset.json["images"] = Json::array({image});
  asset.json["textures"] = Json::array({{{"source", 0}}});
  return asset;
}

Json colored(const Json& texture_info = {{"index", 0}}) {
  return {{"pbrMetallicRoughness", {{"baseColorTexture", texture_info}, {"metallicFactor", 0}}}};
}

/// Appends an image's bytes as a buffer view.
Json embedded(Asset& asset, const std::string& bytes) {
  asset.json["bufferViews"].push_back(
      {{"buffer", 0}, {"byteOffset", asset.buffer.size()}, {"byteLength", bytes.size()}});
  asset.buffer += bytes;
  return {{"bufferView", asset.json["bufferViews"].size() - 1}, {"mimeType", "image/png"}};
}

double left_texel(const TextureFile& texture) {
  return double(texture.at({.25f, .5f, {}, {}})[0]);
}

/// A PNG of 4 x 2 texels whose alpha is 1 in its left half and 0 in its right one.
constexpr const char* kHalfClear =
    "data:image/png;base64,iVBORw0KGgoAAAANSUhEUgAAAAQAAAACCAYAAAB/"
    "qH1jAAAAFElEQVR42mM4kWL0H4oZQJgBXQAAEfsO7agUvlMAAA"
    "AASUVORK5CYII=";

// Claim: a texture of anisotropy has its direction in red and green and its strength in blue; a rotation beside it is
// reported. Source: KHR_materials_anisotropy. Fails if: a channel is another, or the rotation is lost silently.
TEST(GltfTextures, AnisotropyHasDirections) {
  const Json anisotropy = {
      {"anisotropyStrength", 1}, {"anisotropyRotation", 1}, {"anisotropyTexture", {{"index", 0}}}};
  const Asset asset =
      textured_triangle({{"extensions", {{"KHR_materials_anisotropy", anisotropy}}}}, {{"uri", kHalfClear}});
  const ImportedAsset import = imported(asset);
  EXPECT_EQ(import.not_carried.size(), 1u);
  EXPECT_TRUE(has(import.not_carried, "anisotropyRotation beside anisotropyTexture"));
  const Grain grain = scene_of(asset.gltf()).shapes.at(0).gloss.value().grain;
  ASSERT_TRUE(grain.cosine_texture && grain.sine_texture);
  EXPECT_EQ(grain.cosine_texture->channel, 0u);
  EXPECT_EQ(grain.sine_texture->channel, 1u);
  EXPECT_EQ(grain.anisotropy_texture.value().channel, 2u);
}

// Claim: EXT_texture_webp's image is used, from within the asset. The bytes are `cwebp -lossless` of one texel of (200, 100, 50).
TEST(GltfTextures, ImagesMayBeWebP) {
  const std::string webp = "data:image/webp;base64,UklGRh4AAABXRUJQVlA4TBEAAAAvAAAAAAdQsiJXpv+BiOh/AAA=";
  Asset asset = textured_triangle(colored(), {{"uri", webp}});
  asset.json["textures"] = Json::array({{{"extensions", {{"EXT_texture_webp", {{"source", 0}}}}}}});
  asset.json["extensionsRequired"] = asset.json["extensionsUsed"] = {"EXT_texture_webp"};
  const ImportedAsset import = imported(asset);
  EXPECT_TRUE(import.warnings.empty()) << import.warnings.front();
  ASSERT_EQ(import.textures.size(), 1u);
  EXPECT_NEAR(left_texel(*import.textures.front()), test::linear_of_byte(200), 1e-3);
}

// Claim: alphaMode MASK is the opacity of an opaque shape, with alphaFactor and alphaCutoff in its scale: a hole where
// factor * alpha < cutoff; BLEND is one of half, with a warning. A texture without alpha, an emitting surface and a mode of
// OPAQUE have no holes. Source: glTF 2.0, alphaMode. Fails if: the cutoff is lost, or colours are taken for opacity.
TEST(GltfTextures, AlphaMasksAreOpacity) {
  const std::string opaque = "data:image/png;base64," + base64(png_of(128));
  const auto import_of = [](const Json& material, const std::string& image = kHalfClear) {
    return imported(textured_triangle(material, {{"uri", image}}));
  };
  const auto shape_of = [](const ImportedAsset& import) {
    return Json::parse(import.text, nullptr, true, true).at("shapes").at(0);
  };
  Json material = colored();
  material["pbrMetallicRoughness"]["baseColorFactor"] = {1, 1, 1, .8};
  EXPECT_FALSE(shape_of(import_of(material)).contains("opacity"));
  material["alphaMode"] = "MASK";
  material["alphaCutoff"] = .25;
  const Json mask = shape_of(import_of(material)).at("opacity");
  EXPECT_EQ(mask.at("channel"), "a");
  EXPECT_NEAR(mask.at("scale").get<double>(), 1.6, 1e-12);
  EXPECT_FALSE(shape_of(import_of(material, opaque)).contains("opacity"));
  EXPECT_TRUE(has(import_of(material, opaque).warnings, "without a texture of alpha has no holes"));
  material["alphaMode"] = "BLEND";
  const ImportedAsset blended = import_of(material);
  EXPECT_NEAR(shape_of(blended).at("opacity").at("scale").get<double>(), .8, 1e-12);
  EXPECT_TRUE(has(blended.warnings, "partial transparency is not supported"));
  Json wax = material;
  wax["extensions"] = {
      {"KHR_materials_volume", {{"attenuationColor", {.5, .3, .1}}, {"attenuationDistance", .002}}},
      {"KHR_materials_scatter", {{"multiscatterColorFactor", {.9, .7, .4}}}}};
  EXPECT_FALSE(shape_of(import_of(wax)).contains("opacity"));
  EXPECT_TRUE(has(import_of(wax).warnings, "a translucent body has no holes"));
  material["emissiveFactor"] = {1, 1, 1};
  EXPECT_FALSE(shape_of(import_of(material)).contains("opacity"));
  material.erase("emissiveFactor");
  const Scene scene = scene_of(textured_triangle(material, {{"uri", kHalfClear}}).gltf());
  ASSERT_TRUE(scene.shapes.at(0).opacity);
  const Texture& opacity = *scene.shapes.at(0).opacity;
  EXPECT_EQ(opacity.source->image()->at({.25f, .5f, {}, {}})[opacity.channel], 1);
  EXPECT_EQ(opacity.source->image()->at({.75f, .5f, {}, {}})[opacity.channel], 0);
}

// Claim: images are found in the asset, in its text, and beside it under an encoded name; colours are sRGB. No file is
// left. Fails if one of the three is not, or bytes go through a file.
TEST(GltfTextures, AreFoundWhereverTheyAre) {
  const std::string png = png_of(128);
  Asset inside = textured_triangle(colored(), {});
  inside.json["images"][0] = embedded(inside, png);
  const Asset in_text = textured_triangle(colored(), {{"uri", "data:image/png;base64," + base64(png)}});
  const Asset beside = textured_triangle(colored(), {{"uri", "a%20picture.png"}});
  for (const Asset& asset : {inside, in_text, beside}) {
    const ScratchFolder folder;
    put_bytes(folder.file("a picture.png"), png);
    put_bytes(folder.file("a.glb"), asset.glb());
    const Scene scene = load_scene(folder.file("a.glb"));
    const std::optional<Texture>& texture = scene.shapes.at(0).reflectance_texture;
    ASSERT_TRUE(texture);
    EXPECT_NEAR(left_texel(*texture->source->image()), test::linear_of_byte(128), 2e-4);
    EXPECT_EQ(folder.entries(), 2u);
  }
}

// Claim: a picture within an asset is looked up in any order. Fails if going back opens it anew as a file.
TEST(GltfTextures, AreLookedUpInAnyOrder) {
  const ScratchFolder folder;
  test::put_png(folder.file("p.png"), 8, 1024, [](int, int y) { return test::Bytes{y / 4, 0, 255}; });
  Asset asset = textured_triangle(colored(), {});
  asset.json["images"][0] = embedded(asset, bytes_of(folder.file("p.png")));
  put_bytes(folder.file("a.glb"), asset.glb());
  const auto texture = TextureFile::open(folder.file("a.glb#image/0"), ColorSpace::linear);
  for (int i = 0; i < 64; ++i) {
    const int row = (i * 37 + 63) % 64 * 16 + 2;
    EXPECT_NEAR(double(texture->at({.5f, (float(row) + .5f) / 1024, {}, {}})[0]) * 255, row / 4, .01) << row;
  }
}

// Claim: v is turned upwards, once: the corner that glTF calls (0, 1) is at the picture's lower edge. Fails if it is at
// its upper one.
TEST(GltfTextures, CountUpwards) {
  const ScratchFolder folder;
  put_bytes(folder.file("a.glb"), textured_triangle(Json::object(), {{"uri", "x.png"}}).glb());
  Shape shape;
  shape.source = MeshFile{folder.file("a.glb"), false, {}, "0/0"};
  const Mesh mesh = make_mesh(shape, MeshUvs::required).mesh;
  for (std::size_t k = 0; k < 3; ++k) {
    const Vec3d& p = mesh.positions[mesh.triangles[0][k]];
    EXPECT_EQ(mesh.uvs.at(0)[k], (std::array<float, 2>{float(p.x), float(1 - p.y)}));
  }
}

// Claim: a part has the UVs of its base colour's texture, by texCoord or KHR_texture_transform; a texture of another set is
// said. Source: glTF 2.0, textureInfo.texCoord. Fails if: TEXCOORD_0 is read always, or the other set's texture stays.
TEST(GltfTextures, HaveTheUvsOfTheBaseColour) {
  const Json image = {{"uri", "data:image/png;base64," + base64(png_of(200))}},
             moved = {{"index", 0}, {"extensions", {{"KHR_texture_transform", {{"texCoord", 1}}}}}};
  for (const Json& info : {Json{{"index", 0}, {"texCoord", 1}}, moved}) {
    Json material = colored(info);
    material["normalTexture"] = {{"index", 0}};
    Asset asset = textured_triangle(material, image);
    asset.json["meshes"][0]["primitives"][0]["attributes"]["TEXCOORD_1"] =
        asset.accessor<float>("VEC2", kFloat, {.25f, 1, .5f, 1, .75f, .5f});
    const ScratchFolder folder;
    put_bytes(folder.file("a.glb"), asset.glb());
    const Scene scene = load_scene(folder.file("a.glb"));
    EXPECT_TRUE(scene.shapes.at(0).reflectance_texture);
    EXPECT_FALSE(scene.shapes.at(0).normal_map);
    const GltfPart part = read_gltf_part(folder.file("a.glb"), "0/0", MeshUvs::required);
    EXPECT_EQ(part.uvs, (std::vector<std::array<float, 2>>{{.25f, 0}, {.5f, 0}, {.75f, .5f}}));
    EXPECT_TRUE(has(imported(asset).warnings, "normalTexture: textures[0] uses another set of UVs"));
  }
  const Json lamp = {{"emissiveFactor", {1, 1, 1}}, {"emissiveTexture", {{"index", 0}, {"texCoord", 1}}}};
  Asset asset = textured_triangle(lamp, image);
  asset.json["meshes"][0]["primitives"][0]["attributes"]["TEXCOORD_1"] =
      asset.accessor<float>("VEC2", kFloat, {.25f, 1, .5f, 1, .75f, .5f});
  EXPECT_TRUE(scene_of(asset.glb(), "a.glb").shapes.at(0).emission_texture);
}

// Claim: the sheen's textures are those of fuzz: the weight by the brightest channel, times its factor, the mean hue for the fibres, the
// roughness by alpha. Source: by hand: linear .8 and .2 in the left half, times (.5, 1, 1). Tolerance: bytes, .003. Fails if: the colour
// counts as linear, the channel is red, the hue is that of the factor alone, or a texture is reported as lost.
TEST(GltfTextures, OfSheenAreThoseOfFuzz) {
  const ScratchFolder folder;
  test::put_png(folder.file("p.png"), 4, 2, [&](int x, int) {
    return x < 2 ? test::Bytes{231, 231, 124} : test::Bytes{0, 0, 0};
  });
  Json material = {{"extensions",
                    {{"KHR_materials_sheen",
                      {{"sheenColorFactor", {.5, 1, 1}},
                       {"sheenColorTexture", {{"index", 0}}},
                       {"sheenRoughnessFactor", .6},
                       {"sheenRoughnessTexture", {{"index", 0}}}}}}}};
  const Json image = {{"uri", "data:image/png;base64," + base64(bytes_of(folder.file("p.png")))}};
  const std::string glb = textured_triangle(material, image).glb();
  const Fuzz fuzz = scene_of(glb, "a.glb").shapes.at(0).fuzz;
  ASSERT_TRUE(fuzz.weight_texture && fuzz.roughness_texture);
  EXPECT_EQ(fuzz.weight_texture->channel, 1u);
  EXPECT_EQ(fuzz.weight_texture->scale.x, 1);
  EXPECT_NEAR(double(fuzz.weight_texture->source->image()->at({.25f, .5f, {}, {}})[1]), .8, .003);
  EXPECT_EQ(fuzz.roughness_texture->channel, 3u);
  EXPECT_EQ(fuzz.roughness_texture->scale.x, .6);
  EXPECT_NEAR(fuzz.color.x, .5, .003);
  EXPECT_NEAR(fuzz.color.y, 1, .003);
  EXPECT_NEAR(fuzz.color.z, .25, .004);
  put_bytes(folder.file("a.glb"), glb);
  EXPECT_TRUE(import_asset(folder.file("a.glb"), folder.file("a.glb")).not_carried.empty());
}

// Claim: what glTF says of textures becomes what the scene says: factors, channels, KHR_texture_transform, the strength of
// normals; of a translucent body a tint and a roughness. Fails if a channel is another or a factor is lost.
TEST(GltfTextures, BecomeTheScenes) {
  const Json transform = {{"offset", {.25, .5}}, {"rotation", 1.5707963267948966}, {"scale", {2, 3}}};
  Json material = {
      {"name", "paint"},
      {"pbrMetallicRoughness",
       {{"baseColorFactor", {.5, 1, 1, 1}},
        {"baseColorTexture", {{"index", 0}, {"extensions", {{"KHR_texture_transform", transform}}}}},
        {"metallicRoughnessTexture", {{"index", 0}}},
        {"metallicFactor", .75},
        {"roughnessFactor", .5}}},
      {"normalTexture", {{"index", 0}, {"scale", 2}}}};
  const Json image = {{"uri", "data:image/png;base64," + base64(png_of(200))}};
  const Shape opaque = scene_of(textured_triangle(material, image).glb(), "a.glb").shapes.at(0);
  const Texture& color = opaque.reflectance_texture.value();
  EXPECT_EQ(color.scale, Rgb(.5, 1, 1));
  EXPECT_EQ(color.uv_offset, (std::array<double, 2>{.25, .5}));
  EXPECT_EQ(color.uv_scale, (std::array<double, 2>{2, 3}));
  EXPECT_NEAR(color.uv_rotation, 90, 1e-12);
  const Gloss& gloss = opaque.gloss.value();
  EXPECT_EQ(gloss.metalness_texture.value().channel, 2u);
  EXPECT_EQ(gloss.metalness_texture->scale.x, .75);
  EXPECT_EQ(gloss.roughness_texture.value().channel, 1u);
  EXPECT_EQ(gloss.roughness_texture->scale.x, .5);
  EXPECT_NEAR(left_texel(*gloss.roughness_texture->source->image()), 200 / 255., 1e-6);
  EXPECT_EQ(opaque.normal_map.value().scale.x, 2);

  material["extensions"] = {
      {"KHR_materials_volume",
       {{"thicknessFactor", 1}, {"attenuationDistance", .01}, {"attenuationColor", {.5, .4, .3}}}},
      {"KHR_materials_volume_scatter", {{"multiscatterColor", {.8, .6, .4}}}}};
  const Scene scene = scene_of(textured_triangle(material, image).glb(), "a.glb");
  EXPECT_EQ(scene.media.at(0).tint_texture.value().scale, Rgb(.5, 1, 1));
  EXPECT_EQ(scene.media.at(0).roughness_texture.value().channel, 1u);
  EXPECT_TRUE(scene.shapes.at(0).normal_map);
  EXPECT_FALSE(scene.shapes.at(0).gloss);
}

// Claim: light that is transmitted, clearly or diffusely, is the share that scatters inside: t + (1 - t) d; the rest is
// reflected in the base colour, and what is transmitted diffusely alone is tinted by its own colour. A texture of the one
// that there is is one of weights, red or alpha. Source: KHR_materials_transmission, KHR_materials_diffuse_transmission.
// Fails if the shares add up, or the base colour tints what enters diffusely.
TEST(GltfTextures, WeighWhatIsTransmitted) {
  const Json image = {{"uri", "data:image/png;base64," + base64(png_of(200))}};
  const auto medium = [&](const Json& clear, const Json& diffuse) {
    const Json material = {
        {"pbrMetallicRoughness", {{"baseColorFactor", {.5, .6, .7, 1}}}},
        {"extensions",
         {{"KHR_materials_volume",
           {{"thicknessFactor", 1}, {"attenuationDistance", .01}, {"attenuationColor", {.5, .4, .3}}}},
          {"KHR_materials_volume_scatter", {{"multiscatterColor", {.8, .6, .4}}}},
          {"KHR_materials_transmission", clear},
          {"KHR_materials_diffuse_transmission", diffuse}}}};
    const Asset asset = textured_triangle(material, image);
    EXPECT_TRUE(imported(asset).not_carried.empty()) << imported(asset).not_carried.at(0);
    return scene_of(asset.glb(), "a.glb").media.at(0);
  };
  const Json none = Json::object();
  const Medium both = medium({{"transmissionFactor", .5}}, {{"diffuseTransmissionFactor", .2}});
  EXPECT_NEAR(both.subsurface_weight, .6, 1e-12);
  EXPECT_EQ(both.base_color, Rgb(.5, .6, .7));
  EXPECT_EQ(both.tint, Rgb(.5, .6, .7));
  const Medium diffuse = medium(none, {{"diffuseTransmissionFactor", .25},
                                       {"diffuseTransmissionTexture", {{"index", 0}}},
                                       {"diffuseTransmissionColorFactor", {1, .9, .8}}});
  EXPECT_EQ(diffuse.tint, Rgb(1, .9, .8));
  EXPECT_EQ(diffuse.weight_texture.value().scale.x, .25);
  EXPECT_EQ(diffuse.weight_texture->channel, 3u);
  const Medium clear = medium({{"transmissionFactor", .5}, {"transmissionTexture", {{"index", 0}}}}, none);
  EXPECT_EQ(clear.weight_texture.value().scale.x, .5);
  EXPECT_EQ(clear.weight_texture->channel, 0u);
  const Medium all = medium({{"transmissionFactor", 1}}, none);
  EXPECT_FALSE(is_partly_opaque(all));
  EXPECT_EQ(all.tint, Rgb(.5, .6, .7));
}

// Claim: a texture that cannot be had leaves its factor, and is said; the rest of the asset is read. Fails if it is an
// error, or goes unsaid.
TEST(GltfTextures, ThatCannotBeHadAreSaid) {
  const Json good = {{"uri", "data:image/png;base64," + base64(png_of(200))}};
  const auto expect = [](const Asset& asset, const std::string& what) {
    const ImportedAsset result = imported(asset);
    EXPECT_TRUE(has(result.not_carried, "baseColorTexture: ") && has(result.not_carried, what)) << what;
    EXPECT_TRUE(has(result.warnings, "baseColorTexture: ") && has(result.warnings, what)) << what;
    EXPECT_FALSE(scene_of(asset.glb(), "a.glb").shapes.at(0).reflectance_texture);
  };
  expect(textured_triangle(colored({{"index", 7}}), good), "textures[7] is not there");
  expect(textured_triangle(colored({{"index", 0}, {"texCoord", 1}}), good), "another set of UVs");
  expect(textured_triangle(colored(), {{"uri", "absent.png"}}), "refers to a missing file");
  expect(textured_triangle(colored(), {{"uri", "data:image/png;base64," + base64("no picture")}}),
         "images[0]");
  expect(textured_triangle(colored(), {{"bufferView", 99}}), "images[0].bufferView");
  Asset other = textured_triangle(colored(), good);
  other.json["textures"][0] = {{"extensions", {{"KHR_texture_basisu", {{"source", 0}}}}}};
  expect(other, "no supported image");
}

// Claim: OBJ's map_Kd is taken from beside its library, with Kd, where there are UVs; -s and -o scale and move UVs from
// the lower left corner, which the scene counts from the upper one; -mm multiplies. Options that are not carried over are
// warned of. Source: Wavefront's MTL format. Fails if paths start at another folder, or an option is taken for a name.
TEST(ObjTextures, AreTakenFromLibraries) {
  const ScratchFolder folder;
  std::filesystem::create_directory(folder.path / "maps");
  put_bytes(folder.file("maps/p.png"), png_of(128));
  put_bytes(folder.file("maps/a.mtl"),
            "newmtl wood\nKd .8 .6 .4\nmap_Kd p.png\nnewmtl odd\nKd 0 0 0\nmap_Kd -blendu on -s 2 3 1 -o .25 "
            ".5 -mm 0 .5 -clamp on p.png\n");
  const std::string mesh = "mtllib maps/a.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\n";
  const std::string faces = "usemtl wood\nf 1/1 2/2 3/3\nusemtl odd\nf 1/1 2/2 4/3\n";
  put_bytes(folder.file("a.obj"), mesh + "vt 0 0\nvt 1 0\nvt 0 1\n" + faces);
  const Scene scene = load_scene(folder.file("a.obj"));
  ASSERT_TRUE(scene.shapes.at(0).reflectance_texture);
  EXPECT_EQ(scene.shapes[0].reflectance_texture->scale, Rgb(.8, .6, .4));
  EXPECT_NEAR(left_texel(*scene.shapes[0].reflectance_texture->source->image()), test::linear_of_byte(128),
              2e-4);
  const Texture& odd = scene.shapes.at(1).reflectance_texture.value();
  EXPECT_EQ(odd.uv_scale, (std::array<double, 2>{2, 3}));
  EXPECT_EQ(odd.uv_offset,
            (std::array<double, 2>{.25, -2.5}));  // v = 0, downwards 1, becomes .5, downwards .5
  EXPECT_EQ(odd.scale, Rgb(.5));
  EXPECT_EQ(
      scene.warnings,
      (std::vector<std::string>{folder.file("maps/a.mtl") +
                                ":6: map_Kd 'p.png' of material 'odd': the option '-clamp on' is ignored"}));
}

// Claim: OBJ's bump maps are heights in the OBJ's lengths, times -bm, under any of their names; one that is blue, as
// normal maps are, is a normal map, and so is `norm`. Pictures that are not there are said. Fails if -bm is taken for the
// name, or a normal map for heights.
TEST(ObjTextures, OfHeightsAreBumps) {
  const ScratchFolder folder;
  put_bytes(folder.file("h.png"), png_of(128));
  test::put_png(folder.file("a normal.png"), 4, 2, [](int x, int) { return test::Bytes{120 + x, 128, 255}; });
  put_bytes(folder.file("a.mtl"),
            "newmtl a\nmap_Bump -bm 0.25 h.png\nnewmtl b\nbump a normal.png\nnewmtl c\nmap_bump h.png\n"
            "newmtl d\nbump -s 2 2 2 -bm .5 h.png\nnewmtl e\nbump -bm 2 gone.png\n"
            "newmtl f\nnorm h.png\nPr .5\nPm 0.0\nTf 1 1 1\n");
  std::string text = "mtllib a.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nvt 0 0\nvt 1 0\nvt 0 1\n";
  for (const char* name : {"a", "b", "c", "d", "e", "f"})
    text += std::string("usemtl ") + name + "\nf 1/1 2/2 3/3\n";
  put_bytes(folder.file("a.obj"), text);
  const Scene scene = load_scene(folder.file("a.obj"));
  EXPECT_EQ(scene.shapes.at(0).bump_map.value().scale.x, .25);
  EXPECT_TRUE(scene.shapes.at(1).normal_map && !scene.shapes[1].bump_map);
  EXPECT_EQ(scene.shapes.at(2).bump_map.value().scale.x, 1);
  EXPECT_EQ(scene.shapes.at(3).bump_map.value().uv_scale, (std::array<double, 2>{2, 2}));
  EXPECT_EQ(scene.shapes[3].bump_map->scale.x, .5);
  EXPECT_FALSE(scene.shapes.at(4).bump_map);
  EXPECT_TRUE(scene.shapes.at(5).normal_map);
  const ImportedAsset import = import_asset(folder.file("a.obj"), "a.obj");
  EXPECT_TRUE(has(import.translated, "map_Bump -> bump_map h.png, white 0.25 mm high"));
  EXPECT_TRUE(has(import.translated, "bump -> normal_map a normal.png, slopes times 1"));
  EXPECT_TRUE(has(import.not_carried, "material 'f': Pr"));
  EXPECT_FALSE(has(import.not_carried, "material 'f': Pm") || has(import.not_carried, "material 'f': Tf"));
  EXPECT_TRUE(has(import.warnings, "bump 'gone.png' of material 'e': there is no such file"));
}

}  // namespace
}  // namespace opaline::asset_test
