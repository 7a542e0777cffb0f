// SPDX-License-Identifier: GPL-3.0-or-later
// Textures of a scene at points of its surfaces.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "cache/stage_key.h"
#include "geometry/surface_point.h"
#include "geometry/surface_uv.h"
#include "geometry/world.h"
#include "image/solid_lookup.h"
#include "sampling/sample_surface.h"

namespace opaline {

/// Filter footprint on a surface: two sides of a parallelogram, world units.
struct Footprint {
  Vec3f x{}, y{};
};

/// Factors on light as it enters a surface and as it leaves.
struct SurfaceTint {
  RgbF entering{1, 1, 1}, leaving{1, 1, 1};
};

/// Factors on a textured medium's properties at a point, relative to their means; constant properties are 1.
struct MediumFactors {
  RgbF color{1, 1, 1}, radius{1, 1, 1};
};

/// Grain at a point, over a footprint.
struct LocalGrain {
  Vec3f tangent{};  ///< unit, across the shading normal, the direction of largest roughness; 0: isotropic
  float anisotropy = 0;  ///< facet_alphas
  float alignment = 1;   ///< filtered_alphas
};

class SurfaceTextures {
 public:
  /// Both must outlive the object.
  /// error Error{bad_input}: UVs reach a missing tile of a texture, reported at the texture's position in the
  ///       file
  SurfaceTextures(const Scene& scene, const World& world);

  /// True if no surface has other values at other points, a tint, or an anisotropic boundary.
  bool empty() const { return is_empty_; }
  /// True if it has a tint on transmission into the body.
  bool tints_entering(std::uint32_t mesh) const;

  /// One point of a mesh, with one footprint for all lookups.
  struct Place {
    std::uint32_t mesh;
    std::optional<SurfaceUv> uv;  ///< none: not needed, or missing in the mesh
    Footprint footprint;
    SolidPlace solid{};          ///< unset: no texture of the mesh needs it
    Tangent tangent{};           ///< tangent of the mesh, world units; zero: missing
    RgbF color{1, 1, 1};         ///< color of the mesh's vertices
    bool from_behind = false;    ///< the normals are flipped: the back of a sheet is visible
    bool on_whole_face = false;  ///< on a flat face with UVs from 0 to 1
  };
  Place place(std::uint32_t mesh, std::uint32_t triangle, float u, float v, const Footprint& footprint) const;

  /// Factors on light entering and exiting at a point. An opaque surface's reflectance texture and vertex
  /// colours apply on exit; a body's subsurface weight applies once.
  SurfaceTint tint(const Place& place) const;
  /// Fraction of the light diffusely reflected at the surface of a body, instead of entering.
  RgbF reflected(const Place& place) const;
  MediumFactors medium(const Place& place) const;
  LocalGrain grain(const Place& place, const SurfacePoint& point) const;
  /// Bends the point's shading normal by the normal map and then the bump map, if present. Returns the variance of their
  /// slopes within the footprint, along each axis; without a rough boundary, that of the normal map.
  float bend(const Place& place, SurfacePoint& point) const;
  /// The same over the width of a point, in all directions. Returns a factor of the light entering, which tilted parts
  /// lose in uniform light: 1 / sqrt(c) with the cosine c of the tilt, within 0.2 % of 2 / (1 + c) up to 27 degrees.
  float bend(SurfacePoint& point) const;

 private:
  struct OfMesh {
    const Texture *tint = nullptr, *normals = nullptr, *heights = nullptr, *weight = nullptr, *base = nullptr,
                  *color_inside = nullptr, *radius_inside = nullptr;
    Rgb factor{1, 1, 1};               ///< times the tint's texture
    double at_entry = 0, at_exit = 1;  ///< exponents of the tint
    bool has_whole_faces = false, has_tint = false, has_uv = false, has_tangents = false, has_colors = false;
    bool is_rough = false;  ///< the boundary
    const Grain* grain = nullptr;
    const Medium* partly_opaque = nullptr;
    std::optional<SolidSpace> space{};  ///< for textures without UVs
  };

  const World& world_;
  std::vector<OfMesh> of_mesh_;
  std::optional<ThreeWavelengths> wavelengths_;
  bool is_empty_ = true;
};

/// in    u, v: barycentrics of the triangle's second and third corner; sides: of the footprint, world units
SolidPlace solid_place(const SolidSpace& space, const World& world, std::uint32_t mesh,
                       std::uint32_t triangle, float u, float v, const std::array<Vec3f, 2>& sides);

/// True if every face of a shape has the whole image of a texture.
bool has_whole_faces(const Shape& shape);
/// Colour of a texture at a point, with its details.
RgbF color_at(const Texture& texture, const SurfaceTextures::Place& place);
/// Number of a texture of lengths, not limited to 1; 1: no texture.
float factor_at(const Texture* texture, const SurfaceTextures::Place& place);
/// Number of a texture, from 0 to 1; none: no texture.
std::optional<float> number_at(const Texture* texture, const SurfaceTextures::Place& place);
/// The same for a colour.
std::optional<RgbF> color_at(const Texture* texture, const SurfaceTextures::Place& place);
inline const Texture* pointer_to(const std::optional<Texture>& texture) {
  return texture ? &*texture : nullptr;
}

/// SubsurfaceMethod::follows_textures_inside.
bool follows_textures_inside(Method method, bool is_closed);  // methods.cpp

/// True if vertex colours multiply the colour of the shape.
bool uses_vertex_colors(const Scene& scene, const Shape& shape, const Mesh& mesh);

/// Tint of transmitted light at the samples of a body: a power of the tint, averaged over each sample's cell;
/// empty if no tint applies there.
std::vector<RgbF> entering_tints(const SurfaceTextures& textures, std::span<const SurfaceSample> samples);

/// Adds the space of textures without UVs to a key, for shapes with such textures.
void add_solid_space(KeyBuilder& key, const Scene& scene, std::size_t shape);
/// Adds the UVs of meshes, or the space of textures without them.
void add_spaces(KeyBuilder& key, const Scene& scene, const World& world,
                std::span<const std::uint32_t> meshes);
/// Adds a scene's texture to a key: its file's contents and mapping; with the UVs of some meshes.
void add_to_key(KeyBuilder& key, const Texture& texture);
/// A mesh's vertex colours, at the wavelengths of the scene.
void add_vertex_colors(KeyBuilder& key, const Scene& scene, const Mesh& mesh);
/// A mesh's UVs and tangents.
void add_coordinates(KeyBuilder& key, const Mesh& mesh);
/// Cache key of a body's entering_tints; zero if there are none.
StageKey tint_key(const Scene& scene, const World& world, std::span<const std::uint32_t> meshes,
                  const StageKey& samples);
/// Cache key of the textures varying a medium inside bodies of these meshes; a key of zeros if there are
/// none.
StageKey medium_key(const Scene& scene, const World& world, std::span<const std::uint32_t> meshes);

/// Square footprint of the width of a point.
Footprint footprint_of(const SurfacePoint& point);
/// Footprint of a cone on a surface.
/// in    direction: of the ray, of any length; width: of the cone there
Footprint footprint_of(const SurfacePoint& point, const Vec3f& direction, float width);

}  // namespace opaline
