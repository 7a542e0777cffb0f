// SPDX-License-Identifier: GPL-3.0-or-later
#include "bodies/surface_textures.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/cancel_check.h"
#include "image/texture_file.h"
#include "image/uv_lookup.h"
#include "opaline/error.h"
#include "scene/scene_properties.h"
#include "scene/source_place.h"

namespace opaline {
namespace {

TexturePlace texture_place(const Texture& texture, const SurfaceUv& at, const Footprint& footprint,
                           bool on_whole_face = false) {
  const auto side = [&](const Vec3f& along) {
    return std::array<double, 2>{double(dot(at.gradient_u, along)), double(dot(at.gradient_v, along))};
  };
  return uv_lookup(texture, at.uv, {side(footprint.x), side(footprint.y)}, on_whole_face);
}

std::array<float, 4> looked_up(const Texture& texture, const SurfaceTextures::Place& place) {
  if (is_solid(texture)) return solid_value(texture, place.solid);
  return texture.source->image()->at(texture_place(texture, *place.uv, place.footprint, place.on_whole_face));
}

float value_at(const Texture& texture, const SurfaceTextures::Place& place) {
  return looked_up(texture, place)[texture.channel] * float(texture.scale.x);
}

// 8-bit images have no exact half: the values 127 and 128 on both sides of it count as one half.
constexpr float kRoundingOfHalf = 1.01f / 255;

/// Colour under a detail; a detail of one half has no effect. Continuous and monotone in both, unlike the plain overlay,
/// which has another slope on both sides of one half.
RgbF overlaid(const RgbF& color, const RgbF& detail) {
  RgbF result = color;
  for (std::size_t c = 0; c < 3; ++c) {
    const float s = color[c], d = detail[c];
    if (!(s < 1) || std::abs(2 * d - 1) < kRoundingOfHalf) continue;  // 1 stays 1, emission may exceed it
    const float linear = 2 * s * d, twice = 2 * s - 1;
    result[c] = s < .5f   ? linear
                : d < .5f ? linear + (s - linear) * twice * twice
                          : 1 - 2 * (1 - s) * (1 - d);
  }
  return result;
}

// Zero at one half.
float slope_of(float value) {
  const float slope = 2 * value - 1;
  return std::abs(slope) < kRoundingOfHalf ? 0 : slope;
}

/// True for a texture and for its details.
bool is_of(const Texture& texture, const Texture* one) {
  return &texture == one ||
         std::ranges::any_of(texture.details, [&](const Texture& detail) { return &detail == one; });
}

/// error if a tile of the texture is missing at the centroid of a triangle
void check_tiles(const Texture& texture, const Mesh& mesh, const std::string& shape) {
  if (is_solid(texture) || texture.source->image()->has_tile(-1, -1)) return;
  for (const CornerUvs& uvs : mesh.uvs) {
    SurfaceUv middle;
    for (const auto& corner : uvs)
      for (std::size_t k = 0; k < 2; ++k) middle.uv[k] += corner[k] / 3;
    const TexturePlace place = texture_place(texture, middle, {});
    const int column = int(std::floor(place.u)), row = int(std::floor(1 - place.v));
    if (texture.source->image()->has_tile(column, row)) continue;
    throw told_at(texture.place,
                  bad_file(texture.source->path(), "has no tile where the UVs of '" + shape + "' need one",
                           "a file " + std::to_string(1001 + column + 10 * row)));
  }
}

RgbF powered(const RgbF& value, double exponent) {
  RgbF result;
  for (std::size_t c = 0; c < 3; ++c)
    result[c] = exponent == 1    ? value[c]
                : exponent == .5 ? std::sqrt(value[c])
                : exponent == 0  ? 1.0f
                                 : std::pow(value[c], float(exponent));
  return result;
}

/// Directions of u and v in the shading tangent plane; zeros if the UVs are degenerate.
struct TangentFrame {
  Vec3f tangent{}, bitangent{};
};

/// From the mesh's tangent, if present. Its handedness refers to the outside of the surface.
TangentFrame frame_of(const SurfaceTextures::Place& place, const SurfacePoint& point) {
  const auto& [direction, handedness] = place.tangent;
  const Vec3f own = normalized(direction - point.normal * dot(direction, point.normal));
  if (own != Vec3f{}) return {own, cross(point.normal, own) * (place.from_behind ? -handedness : handedness)};
  if (!place.uv) return {};
  const Vec3f across_v = cross(place.uv->gradient_v, point.geometric);
  const float side = dot(place.uv->gradient_u, across_v);
  if (!(std::abs(side) > 0)) return {};
  const Vec3f along = across_v * (side > 0 ? 1.0f : -1.0f);
  const Vec3f tangent = normalized(along - point.normal * dot(along, point.normal));
  return {tangent, cross(point.normal, tangent) * (side > 0 ? 1.0f : -1.0f)};
}

/// Orientation of a tilted normal: 1, or -1 if seen from behind.
float outward(const SurfaceTextures::Place& place) {
  return place.from_behind ? -1.0f : 1.0f;
}

/// Variance of the slopes within a footprint, by the length of its mean normal; Gaussian slopes, fitted to 10 % for
/// deviations up to 1. Zero within a texel: the length of 8-bit normals is inexact.
float slope_variance(const Texture& texture, const SurfaceTextures::Place& place,
                     const std::array<float, 4>& texel) {
  constexpr float kMost = 4;
  float squares = 0;
  for (std::size_t c = 0; c < 3; ++c) squares += (2 * texel[c] - 1) * (2 * texel[c] - 1);
  if (!(squares < 1)) return 0;
  const float variance = std::min(kMost, (1 / std::max(squares * squares, 1e-4f) - 1) / 4);
  const float texels =
      texture.source->image()->texels_across(texture_place(texture, *place.uv, place.footprint));
  return variance * std::clamp(texels - 1, 0.f, 1.f);
}

/// Returns the variance of slopes within the footprint.
float map_normal(const Texture& texture, const SurfaceTextures::Place& place, SurfacePoint& point) {
  const std::array<float, 4> texel = looked_up(texture, place);
  const float strength = float(texture.scale.x) * outward(place);
  const float x = slope_of(texel[0]) * strength, y = slope_of(texel[1]) * strength;
  const float variance = slope_variance(texture, place, texel) * strength * strength;
  if (x == 0 && y == 0) return variance;
  const auto [tangent, bitangent] = frame_of(place, point);
  if (tangent == Vec3f{}) return 0;
  point.normal =
      normalized(tangent * x + bitangent * y + point.normal * std::max(2 * texel[2] - 1, 1.0f / 255));
  return variance;
}

/// Height gradients of the heights over the surface, mm per world unit.
struct HeightGradient {
  Vec3f mean{};
  float variance = 0;  ///< along each axis
};

/// in    needs_variance: false: 0
HeightGradient height_gradient(const Texture& texture, const SurfaceTextures::Place& place,
                               bool needs_variance) {
  const TextureFile& image = *texture.source->image();
  const TexturePlace at = texture_place(texture, *place.uv, place.footprint, place.on_whole_face);
  const auto [along_u, along_v] = image.slope(at, texture.channel);
  // Angle of the image's u and v, by the mesh's.
  const double angle = texture.uv_rotation * std::numbers::pi / 180;
  const double cosine = std::cos(angle), sine = std::sin(angle);
  const Vec3f x = place.uv->gradient_u * float(texture.uv_scale[0]),
              y = place.uv->gradient_v * float(-texture.uv_scale[1]);
  const Vec3f of_u = x * float(cosine) + y * float(sine), of_v = y * float(cosine) - x * float(sine);
  const auto scale = float(texture.scale.x);
  HeightGradient gradient{(of_u * along_u + of_v * along_v) * scale};
  constexpr float kFewTexels = 4;  // the smallest mean of squares
  const float texels = needs_variance ? image.texels_across(at) : 0;
  if (!(texels > kFewTexels / 2)) return gradient;
  const auto [uu, uv, vv] = image.squared_slopes(at, texture.channel, texels);
  const float squares =
      (dot(of_u, of_u) * uu + 2 * dot(of_u, of_v) * uv + dot(of_v, of_v) * vv) * scale * scale;
  gradient.variance = std::max(0.f, squares - dot(gradient.mean, gradient.mean)) / 2 *
                      std::min(1.f, 2 * texels / kFewTexels - 1);
  return gradient;
}

/// Around +y, as turned on a lathe; where the normal is +y itself, along x.
TangentFrame level_frame(const Vec3f& normal) {
  Vec3f tangent{normal.z, 0, -normal.x};
  if (dot(tangent, tangent) < 1e-12f) tangent = Vec3f{1, 0, 0} - normal * normal.x;
  tangent = normalized(tangent);
  return {tangent, cross(normal, tangent)};
}

/// True if the method varies the medium inside the body of this shape.
bool follows_textures_of(const Scene& scene, const World& world, std::size_t shape) {
  bool is_closed = true;
  for (std::size_t m = 0; m < scene.shapes.size(); ++m)
    if (m == shape || are_one_body(scene.shapes[m], scene.shapes[shape]))
      is_closed = is_closed && world.reports[m].open_edges == 0;
  return follows_textures_inside(scene.settings.method, is_closed);
}

}  // namespace

SurfaceTextures::SurfaceTextures(const Scene& scene, const World& world)
    : world_(world), wavelengths_(scene.wavelengths) {
  for (std::size_t m = 0; m < scene.shapes.size(); ++m) {
    const Shape& shape = scene.shapes[m];
    OfMesh& own = of_mesh_.emplace_back();
    own.normals = pointer_to(shape.normal_map);
    own.heights = pointer_to(shape.bump_map);
    if (shape.medium) {
      const Medium& medium = scene.media[*shape.medium];
      const bool is_followed = varies_inside(medium) && follows_textures_of(scene, world, m);
      const bool is_inside = is_followed && has_color_inside(medium);
      (is_inside ? own.color_inside : own.tint) = pointer_to(medium.tint_texture);
      if (is_followed) own.radius_inside = pointer_to(medium.radius_texture);
      own.factor = medium.tint;
      if (is_partly_opaque(medium)) {
        own.partly_opaque = &medium;
        own.weight = pointer_to(medium.weight_texture);
        own.base = pointer_to(medium.base_texture);
      }
      own.at_entry = medium.texture_mix == TextureMix::pre    ? 1
                     : medium.texture_mix == TextureMix::post ? 0
                                                              : .5;
      own.at_exit = 1 - own.at_entry;
    } else {
      own.tint = pointer_to(shape.reflectance_texture);
    }
    own.has_colors = uses_vertex_colors(scene, shape, world.meshes[m]);
    if (own.has_colors && !shape.medium && !shape.has_reflectance)
      own.factor = Rgb(1 / kDefaultReflectance.x);
    own.has_tint = own.tint != nullptr || own.factor != Rgb(1) || own.weight != nullptr || own.has_colors;
    own.is_rough = is_rough(scene, shape);
    own.grain = grain_of(scene, shape);
    own.has_uv = uvs_of(scene, shape) != MeshUvs::unread && !world.meshes[m].uvs.empty();
    own.has_tangents = !world.meshes[m].tangents.empty();
    own.has_whole_faces = has_whole_faces(shape);
    std::vector<const Texture*> textures = textures_of(scene, shape);
    for (const Texture* texture : textures) check_tiles(*texture, world.meshes[m], shape.name);
    // Light, mesh and rays have these, hits do not.
    for (const std::optional<Texture>* other : {&shape.displacement, &shape.opacity, &shape.emission_texture})
      if (*other) std::erase_if(textures, [&](const Texture* texture) { return is_of(**other, texture); });
    if (std::ranges::any_of(textures, [](const Texture* texture) { return is_solid(*texture); }))
      own.space = solid_space(solid_to_world(shape));
    is_empty_ = is_empty_ && !own.has_tint && textures.empty() && own.grain == nullptr &&
                own.partly_opaque == nullptr;
  }
}

bool SurfaceTextures::tints_entering(std::uint32_t mesh) const {
  return of_mesh_[mesh].has_tint && of_mesh_[mesh].at_entry > 0;
}

SurfaceTextures::Place SurfaceTextures::place(std::uint32_t mesh, std::uint32_t triangle, float u, float v,
                                              const Footprint& footprint) const {
  Place place{mesh, {}, footprint};
  place.on_whole_face = of_mesh_[mesh].has_whole_faces;
  if (of_mesh_[mesh].has_uv) place.uv = surface_uv(world_.meshes[mesh], triangle, u, v);
  if (of_mesh_[mesh].space)
    place.solid =
        solid_place(*of_mesh_[mesh].space, world_, mesh, triangle, u, v, {footprint.x, footprint.y});
  if (of_mesh_[mesh].has_tangents) place.tangent = surface_tangent(world_.meshes[mesh], triangle, u, v);
  if (of_mesh_[mesh].has_colors) {
    place.color = surface_color(world_.meshes[mesh], triangle, u, v);
    if (wavelengths_)
      place.color = RgbF(component_max(at_wavelengths(wavelengths_->from_rgb, Rgb(place.color)), Rgb{}));
  }
  return place;
}

SurfaceTint SurfaceTextures::tint(const Place& place) const {
  const OfMesh& own = of_mesh_[place.mesh];
  const float weight = own.partly_opaque == nullptr ? 1 : float(own.partly_opaque->subsurface_weight);
  if (!own.has_tint) return {.leaving = RgbF(weight)};
  RgbF tint(own.factor);
  if (own.tint != nullptr) tint = tint * color_at(*own.tint, place);
  if (own.has_colors) tint = tint * place.color;
  tint *= number_at(own.weight, place).value_or(1);
  SurfaceTint result{powered(tint, own.at_entry), powered(tint, own.at_exit)};
  if (weight < 1) result.leaving *= weight;
  return result;
}

RgbF SurfaceTextures::reflected(const Place& place) const {
  const OfMesh& own = of_mesh_[place.mesh];
  if (own.partly_opaque == nullptr) return {};
  const float scattered = number_at(own.weight, place).value_or(float(own.partly_opaque->subsurface_weight));
  RgbF base(own.partly_opaque->base_color);
  if (own.base != nullptr) base = base * color_at(*own.base, place);
  if (own.has_colors) base = base * place.color;
  return base * (1 - scattered);
}

MediumFactors SurfaceTextures::medium(const Place& place) const {
  const OfMesh& own = of_mesh_[place.mesh];
  MediumFactors factors;
  if (own.color_inside != nullptr) factors.color = color_at(*own.color_inside, place);
  if (own.radius_inside != nullptr) factors.radius = color_at(*own.radius_inside, place);
  return factors;
}

SolidPlace solid_place(const SolidSpace& space, const World& world, std::uint32_t mesh,
                       std::uint32_t triangle, float u, float v, const std::array<Vec3f, 2>& sides) {
  const Mesh& surface = world.meshes[mesh];
  std::array<Vec3d, 3> corners;
  for (std::size_t k = 0; k < 3; ++k)
    corners[k] = out_of_world(world, Vec3d(surface.positions[surface.triangles[triangle][k]]));
  const auto inside = [&](const Vec3d& outside) { return space.inside(outside); };
  const Vec3d side_u = inside(corners[1] - corners[0]), side_v = inside(corners[2] - corners[0]);
  return {inside(corners[0] - space.origin) + side_u * double(u) + side_v * double(v),
          normalized(cross(side_u, side_v)), inside(Vec3d(sides[0]) * world.unit),
          inside(Vec3d(sides[1]) * world.unit)};
}

bool has_whole_faces(const Shape& shape) {
  return std::holds_alternative<QuadShape>(shape.source) || std::holds_alternative<BoxShape>(shape.source) ||
         std::holds_alternative<SlabShape>(shape.source);
}

RgbF color_at(const Texture& texture, const SurfaceTextures::Place& place) {
  std::array<float, 4> texel = looked_up(texture, place);
  if (texture.from_rgb) {
    const Rgb mixed = at_wavelengths(texture, {double(texel[0]), double(texel[1]), double(texel[2])});
    for (std::size_t c = 0; c < 3; ++c) texel[c] = float(mixed[c]);
  }
  RgbF color;
  for (std::size_t c = 0; c < 3; ++c) color[c] = std::max(0.0f, texel[c]);
  for (const Texture& detail : texture.details)
    if (detail.blend == DetailBlend::overlay) color = overlaid(color, color_at(detail, place));
  color = color * RgbF(texture.scale);
  for (const Texture& detail : texture.details)
    if (detail.blend == DetailBlend::relative) color = color * color_at(detail, place);
  return texture.is_relative ? color : component_min(color, RgbF(1));
}

float factor_at(const Texture* texture, const SurfaceTextures::Place& place) {
  if (texture == nullptr) return 1;
  return std::max(0.f, value_at(*texture, place));
}

std::optional<float> number_at(const Texture* texture, const SurfaceTextures::Place& place) {
  if (texture == nullptr) return {};
  return std::clamp(value_at(*texture, place), 0.0f, 1.0f);
}

std::optional<RgbF> color_at(const Texture* texture, const SurfaceTextures::Place& place) {
  if (texture == nullptr) return {};
  return color_at(*texture, place);
}

LocalGrain SurfaceTextures::grain(const Place& place, const SurfacePoint& point) const {
  const Grain* const grain = of_mesh_[place.mesh].grain;
  if (grain == nullptr) return {};
  TangentFrame frame = frame_of(place, point);
  if (frame.tangent == Vec3f{}) frame = level_frame(point.normal);
  LocalGrain here{
      .anisotropy =
          number_at(pointer_to(grain->anisotropy_texture), place).value_or(float(grain->anisotropy))};
  double angle = grain->rotation * std::numbers::pi / 180;
  if (grain->cosine_texture) {
    const float cosine = value_at(*grain->cosine_texture, place),
                sine = value_at(*grain->sine_texture, place);
    here.alignment = std::min(1.f, std::hypot(cosine, sine));
    angle += double(std::atan2(sine, cosine) / 2);
  }
  here.tangent = frame.tangent * float(std::cos(angle)) + frame.bitangent * float(std::sin(angle));
  return here;
}

float SurfaceTextures::bend(const Place& place, SurfacePoint& point) const {
  const OfMesh& own = of_mesh_[place.mesh];
  float variance = 0;
  if (own.normals != nullptr) {
    variance = map_normal(*own.normals, place, point);
    for (const Texture& detail : own.normals->details) variance += map_normal(detail, place, point);
  }
  if (own.heights == nullptr) return variance;
  Vec3f rise;
  if (is_solid(*own.heights)) {
    rise = solid_rise(*own.heights, *own.space, place.solid);
  } else {
    const auto unit = float(1 / world_.unit);
    const HeightGradient gradient = height_gradient(*own.heights, place, own.is_rough);
    rise = gradient.mean * unit;
    variance += gradient.variance * unit * unit;
  }
  const Vec3f along = rise - point.normal * dot(rise, point.normal);
  if (along != Vec3f{}) point.normal = normalized(point.normal - along * outward(place));
  return variance;
}

float SurfaceTextures::bend(SurfacePoint& point) const {
  const OfMesh& own = of_mesh_[point.mesh];
  if (own.normals == nullptr && own.heights == nullptr) return 1;
  constexpr float kLeastCosine = .1f;
  const Vec3f before = point.normal;
  bend(place(point.mesh, point.triangle, point.u, point.v, footprint_of(point)), point);
  return 1 / std::sqrt(std::max(kLeastCosine, dot(point.normal, before)));
}

bool uses_vertex_colors(const Scene& scene, const Shape& shape, const Mesh& mesh) {
  const auto* file = std::get_if<MeshFile>(&shape.source);
  if (file == nullptr || mesh.colors.empty()) return false;
  const bool has_texture = shape.medium ? scene.media[*shape.medium].tint_texture.has_value()
                                        : shape.reflectance_texture.has_value();
  return file->vertex_colors.value_or(!has_texture);
}

std::vector<RgbF> entering_tints(const SurfaceTextures& textures, std::span<const SurfaceSample> samples) {
  std::vector<RgbF> tints;
  if (std::ranges::none_of(samples, [&](const SurfaceSample& s) { return textures.tints_entering(s.mesh); }))
    return tints;
  tints.reserve(samples.size());
  const CancelCheck check;
  for (const SurfaceSample& s : samples) {
    check();
    Footprint footprint;
    tangent_frame(s.normal, footprint.x, footprint.y);
    footprint.x *= std::sqrt(s.area);
    footprint.y *= std::sqrt(s.area);
    tints.push_back(textures.tint(textures.place(s.mesh, s.triangle, s.u, s.v, footprint)).entering);
  }
  return tints;
}

void add_coordinates(KeyBuilder& key, const Mesh& mesh) {
  key.add_array(std::span(mesh.uvs));
  if (!mesh.tangents.empty()) key.add_array(std::span(mesh.tangents));
}

void add_to_key(KeyBuilder& key, const Texture& texture) {
  key.add(texture.source->hash())
      .add(texture.scale)
      .add(std::uint64_t(texture.channel))
      .add(texture.is_relative);
  if (texture.from_rgb)
    for (const Rgb& row : *texture.from_rgb) key.add(row);
  key.add(texture.uv_offset).add(texture.uv_scale).add(texture.uv_rotation);
  if (texture.triplanar_width > 0) key.add(std::string("triplanar")).add(texture.triplanar_width);
  for (const Texture& detail : texture.details)
    add_to_key(key.add(std::string(detail.blend == DetailBlend::overlay ? "overlay" : "detail")), detail);
}

void add_solid_space(KeyBuilder& key, const Scene& scene, std::size_t shape) {
  const auto solid = [](const Texture* texture) { return is_solid(*texture); };
  if (std::ranges::none_of(textures_of(scene, scene.shapes[shape]), solid)) return;
  const Transform space = solid_to_world(scene.shapes[shape]);
  key.add(std::string("space")).add(space.x).add(space.y).add(space.z).add(space.translation);
}

void add_spaces(KeyBuilder& key, const Scene& scene, const World& world,
                std::span<const std::uint32_t> meshes) {
  for (const std::uint32_t m : meshes) {
    key.add_array(std::span(world.meshes[m].uvs));
    add_solid_space(key, scene, m);
  }
}

void add_vertex_colors(KeyBuilder& key, const Scene& scene, const Mesh& mesh) {
  key.add_array(std::span(mesh.colors));
  if (scene.wavelengths)
    for (const Rgb& row : scene.wavelengths->from_rgb) key.add(row);
}

StageKey tint_key(const Scene& scene, const World& world, std::span<const std::uint32_t> meshes,
                  const StageKey& samples) {
  const Medium& medium = scene.media[scene.shapes[meshes.front()].medium.value()];
  const auto has_colors = [&](std::uint32_t m) {
    return uses_vertex_colors(scene, scene.shapes[m], world.meshes[m]);
  };
  const bool has_texture =
      medium.tint_texture && !(has_color_inside(medium) && follows_textures_of(scene, world, meshes.front()));
  const bool has_tint = medium.tint != Rgb(1) || has_texture || medium.weight_texture ||
                        std::ranges::any_of(meshes, has_colors);
  if (medium.texture_mix == TextureMix::post || !has_tint) return {};
  KeyBuilder key("entering tint", 2);
  key.add(samples).add(medium.tint).add(medium.texture_mix);
  for (const std::uint32_t m : meshes)
    if (has_colors(m))
      add_vertex_colors(key.add(std::string("vertex colours")).add(m), scene, world.meshes[m]);
  if (!has_texture && !medium.weight_texture) return key.key();
  if (has_texture) add_to_key(key, *medium.tint_texture);
  if (medium.weight_texture) add_to_key(key.add(std::string("weight")), *medium.weight_texture);
  add_spaces(key, scene, world, meshes);
  return key.key();
}

StageKey medium_key(const Scene& scene, const World& world, std::span<const std::uint32_t> meshes) {
  const Medium& medium = scene.media[scene.shapes[meshes.front()].medium.value()];
  if (!varies_inside(medium)) return {};
  if (!medium.layers.empty()) {
    KeyBuilder key("layers inside", 2);
    key.add(medium.eta);
    for (const MediumLayer& layer : medium.layers) {
      key.add(layer.coefficients).add(layer.thickness);
      if (layer.thickness_texture) add_to_key(key.add(std::string("thickness")), *layer.thickness_texture);
    }
    add_spaces(key, scene, world, meshes);
    return key.key();
  }
  const auto& mean = std::get<ArtistMedium>(medium.coefficients);
  KeyBuilder key("medium inside", 3);
  key.add(mean.subsurface_color).add(mean.subsurface_radius).add(mean.anisotropy).add(medium.eta);
  key.add(profile_kind(medium)).add(profile_thickness(medium));
  if (has_color_inside(medium)) add_to_key(key.add(std::string("color")), *medium.tint_texture);
  if (medium.radius_texture) add_to_key(key.add(std::string("radius")), *medium.radius_texture);
  add_spaces(key, scene, world, meshes);
  return key.key();
}

Footprint footprint_of(const SurfacePoint& point) {
  Footprint footprint;
  if (!(point.width > 0)) return footprint;
  tangent_frame(point.geometric, footprint.x, footprint.y);
  footprint.x *= point.width;
  footprint.y *= point.width;
  return footprint;
}

Footprint footprint_of(const SurfacePoint& point, const Vec3f& direction, float width) {
  constexpr float kLeastCosine = 1.0f / 32;  // as oblong as textures are filtered
  const Vec3f d = normalized(direction);
  const float cosine = std::abs(dot(point.geometric, d));
  Vec3f across, along;
  tangent_frame(point.geometric, across, along);
  if (cosine < .999f) across = normalized(cross(point.geometric, d));
  along = cross(point.geometric, across);
  return {across * width, along * (width / std::max(cosine, kLeastCosine))};
}

}  // namespace opaline
