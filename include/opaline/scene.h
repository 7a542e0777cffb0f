// SPDX-License-Identifier: GPL-3.0-or-later
// A scene as plain data.
//
// Conventions, everywhere in the project: right-handed coordinates, +y up, normals outward, directions point
// away from the surface, lengths in mm, coefficients in 1/mm, irradiance and radiant exitance in W/mm^2,
// radiance in W/(mm^2 sr), colours linear Rec.709, eta = index of refraction inside / outside. Loading a
// scene converts its units to mm once (mm_per_unit); nothing after it converts again.
#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "opaline/enumerations.h"
#include "opaline/error.h"
#include "opaline/vec3.h"

namespace opaline {

/// Where a record of a scene was written.
struct SourcePlace {
  std::string file;          ///< the scene file, or "--set path=value"; empty: generated
  int line = 0, column = 0;  ///< as in Error
  /// Always equal: scenes differing in layout alone are equal.
  friend bool operator==(const SourcePlace&, const SourcePlace&) { return true; }
};

/// Affine map p -> x p.x + y p.y + z p.z + translation.
struct Transform {
  Vec3d x{1, 0, 0}, y{0, 1, 0}, z{0, 0, 1}, translation{};
  friend bool operator==(const Transform&, const Transform&) = default;
};

inline Vec3d transform_point(const Transform& t, const Vec3d& p) {
  return t.x * p.x + t.y * p.y + t.z * p.z + t.translation;
}

/// First `first`, then `second`.
inline Transform compose(const Transform& second, const Transform& first) {
  const auto linear = [&](const Vec3d& v) { return second.x * v.x + second.y * v.y + second.z * v.z; };
  return {linear(first.x), linear(first.y), linear(first.z), transform_point(second, first.translation)};
}

// ---- textures -------------------------------------------------------------------------------------------

/// Wavelengths rendered as the channels of an image, instead of red, green and blue.
struct ThreeWavelengths {
  std::array<std::array<double, 2>, 3> bands{};  ///< ends, nm, equal for a wavelength; red first
  /// Linear Rec.709 of a channel's value 1, white D65. Those of all groups sum to 1.
  std::array<Rgb, 3> to_rgb{};
  std::array<Rgb, 3> alone{};     ///< the same for an image of these wavelengths only
  std::array<Rgb, 3> from_rgb{};  ///< a channel's value for red, green and blue
  friend bool operator==(const ThreeWavelengths&, const ThreeWavelengths&) = default;
};

/// Values of a colour in red, green and blue at wavelengths; out of [0, 1] for a saturated one.
/// in    from_rgb: ThreeWavelengths::from_rgb
inline Rgb at_wavelengths(const std::array<Rgb, 3>& from_rgb, const Rgb& color) {
  return {dot(from_rgb[0], color), dot(from_rgb[1], color), dot(from_rgb[2], color)};
}

class TextureSource;
/// An image, or a pattern in space, replacing a constant.
struct Texture {
  std::shared_ptr<const TextureSource> source;
  Rgb scale{1, 1, 1};       ///< factor on its colours; the first one on its numbers
  std::size_t channel = 0;  ///< channel of the file, for a number
  /// From UVs to the image, about its upper left corner: scaled, rotated (degrees), translated
  /// (KHR_texture_transform).
  std::array<double, 2> uv_offset{0, 0}, uv_scale{1, 1};
  double uv_rotation = 0;
  /// Width of an image projected along the three axes of the shape's space, mm; 0: mapped by the mesh's UVs.
  double triplanar_width = 0;
  bool is_relative = false;  ///< scaled to a mean of 1: its texels may exceed 1, unlike other colours
  /// ThreeWavelengths::from_rgb, applied to its colours before `scale`; none: red, green and blue.
  std::optional<std::array<Rgb, 3>> from_rgb{};
  std::vector<Texture> details{};  ///< by their blends; those of a normal map turn its normals further
  DetailBlend blend = DetailBlend::relative;  ///< as a detail
  SourcePlace place{};
  friend bool operator==(const Texture&, const Texture&) = default;
};

/// A colour of a texture's file at the wavelengths of its scene, before Texture::scale.
inline Rgb at_wavelengths(const Texture& texture, const Rgb& color) {
  return texture.from_rgb ? at_wavelengths(*texture.from_rgb, color) : color;
}

/// An anisotropic boundary, with different roughness along and across a tangent: the direction of u, or
/// without UVs the horizontal one, perpendicular to +y.
struct Grain {
  double anisotropy = 0;  ///< [0, 1], specular_roughness_anisotropy of OpenPBR: 0 is isotropic
  double rotation = 0;    ///< rotation of the tangent about the normal, counterclockwise, degrees
  std::optional<Texture> anisotropy_texture{};
  /// Cosine and sine of twice a further rotation.
  std::optional<Texture> cosine_texture{}, sine_texture{};
  friend bool operator==(const Grain&, const Grain&) = default;
};

/// Fibres on a surface, OpenPBR's fuzz: they scatter light back, and less reaches the surface below.
struct Fuzz {
  double weight = 0;      ///< fraction of the surface with fibres, [0, 1]
  Rgb color{1, 1, 1};     ///< albedo of the fibres
  double roughness = .5;  ///< [0, 1]; below .25, all along the normal, as .25
  std::optional<Texture> weight_texture{}, color_texture{}, roughness_texture{};
  friend bool operator==(const Fuzz&, const Fuzz&) = default;
};

// ---- media ----------------------------------------------------------------------------------------------

/// Reduced coefficients per channel, 1/mm, finite and >= 0.
struct PhysicalMedium {
  Rgb sigma_a, sigma_s_prime;
  friend bool operator==(const PhysicalMedium&, const PhysicalMedium&) = default;
};

/// Artist's parameters after OpenPBR.
struct ArtistMedium {
  Rgb subsurface_color;   ///< total diffuse reflectance per transmitted flux, [0, 1]
  Rgb subsurface_radius;  ///< 1/sigma_t per channel, mm, >= 0 (radius times subsurface_radius_scale)
  double anisotropy = 0;  ///< mean cosine g, (-1, 1)
  friend bool operator==(const ArtistMedium&, const ArtistMedium&) = default;
};

/// The profile chosen for a medium that names none (choose_models.h).
struct ChosenProfile {
  ProfileKind kind = ProfileKind::dipole;
  double thickness = std::numeric_limits<double>::infinity();  ///< as Medium::thickness
  NormalizedDiffusionFit fit = NormalizedDiffusionFit::refit;
  friend bool operator==(const ChosenProfile&, const ChosenProfile&) = default;
};

/// Layer below the surface of a body, from the surface inwards.
struct MediumLayer {
  std::string medium;  ///< its name
  PhysicalMedium coefficients;
  double thickness = std::numeric_limits<double>::infinity();  ///< mm, >= 0; infinite in the last layer
  std::optional<Texture> thickness_texture{};                  ///< factor of the thickness
  double mean_factor = 1;                                      ///< mean of the texture
  friend bool operator==(const MediumLayer&, const MediumLayer&) = default;
};

struct Medium {
  std::string name;
  /// With layers: the equivalent medium of radial profiles (diffusion/layered_medium.h).
  std::variant<PhysicalMedium, ArtistMedium> coefficients;
  double eta = 1.3;
  /// None, as in a scene file without one: chosen for each body.
  std::optional<ProfileKind> profile = ProfileKind::dipole;
  SourcePlace place{};
  /// Mean cosine g of the scattering angle, (-1, 1), with reduced coefficients. Used by random walks only;
  /// diffusion depends on (1 - g) sigma_s alone.
  double scatter_anisotropy = 0;
  /// Thickness of the plates and bodies made of it, mm, > 0; infinite: thick. Used by ProfileKind::multipole
  /// only.
  double thickness = std::numeric_limits<double>::infinity();
  double specular_roughness = 0;  ///< roughness of the dielectric boundary, [0, 1]; GGX's alpha is its square
  /// Tint of its light: t = tint x texture, in [0, 1] except for textures with mean 1.
  Rgb tint{1, 1, 1};
  std::optional<Texture> tint_texture{}, roughness_texture{};
  TextureMix texture_mix = TextureMix::split;
  /// Texture of ArtistMedium::subsurface_radius over its mean; the record stores the mean.
  std::optional<Texture> radius_texture{};
  /// Fraction of the light scattering inside, [0, 1]; the rest is reflected diffusely at the surface, by
  /// base_color.
  double subsurface_weight = 1;
  Rgb base_color{.8, .8, .8};
  std::optional<Texture> weight_texture{}, base_texture{};     ///< factors
  ChosenProfile chosen{};                                      ///< if profile is none
  NormalizedDiffusionFit fit = NormalizedDiffusionFit::refit;  ///< for ProfileKind::normalized_diffusion
  Grain grain{};                                               ///< grain of the boundary
  Fuzz fuzz{};                                                 ///< fuzz above the boundary
  std::vector<MediumLayer> layers{};                           ///< empty: homogeneous, or by its textures
  /// Shortest mean free path and diffuse mean free path at all wavelengths of a spectral image, mm; 0: a medium
  /// in red, green and blue.
  double shortest_path = 0, shortest_fading = 0;
  friend bool operator==(const Medium&, const Medium&) = default;
};

/// Part of a surface with a value that may be a texture.
enum class SurfacePart { color, boundary, normals };

template <class Visit>
void for_each_textured(const Grain& grain, const Visit& visit) {
  visit(grain.anisotropy, grain.anisotropy_texture, SurfacePart::boundary);
  visit(grain.rotation, grain.cosine_texture, SurfacePart::boundary);
  visit(grain.rotation, grain.sine_texture, SurfacePart::boundary);
}

template <class Visit>
void for_each_textured(const Fuzz& fuzz, const Visit& visit) {
  if (!(fuzz.weight > 0)) return;
  visit(fuzz.weight, fuzz.weight_texture, SurfacePart::color);
  visit(fuzz.color, fuzz.color_texture, SurfacePart::color);
  visit(fuzz.roughness, fuzz.roughness_texture, SurfacePart::color);
}

/// Calls visit(value, texture, part) for each value of a medium that may be a texture; 1 for a texture alone.
template <class Visit>
void for_each_textured(const Medium& medium, const Visit& visit) {
  visit(medium.tint, medium.tint_texture, SurfacePart::color);
  visit(medium.specular_roughness, medium.roughness_texture, SurfacePart::boundary);
  for_each_textured(medium.grain, visit);
  visit(1.0, medium.radius_texture, SurfacePart::color);
  visit(medium.subsurface_weight, medium.weight_texture, SurfacePart::color);
  visit(medium.base_color, medium.base_texture, SurfacePart::color);
  for (const MediumLayer& layer : medium.layers)
    visit(layer.thickness, layer.thickness_texture, SurfacePart::color);
  for_each_textured(medium.fuzz, visit);
}

// ---- shapes ---------------------------------------------------------------------------------------------

/// A time of an animated asset.
struct AnimationTime {
  std::string animation{};  ///< name, or index; empty: the first
  double seconds = 0;
  friend bool operator==(const AnimationTime&, const AnimationTime&) = default;
};

struct MeshFile {
  std::string path;  ///< as opened: the scene file's folder precedes a relative path
  /// Closes every hole before rendering, or none. Unset: closes those of a translucent mesh if all are small.
  std::optional<bool> fill_holes;
  /// If set: scales the largest side of the bounding box to this length (mm), centres x and z on the origin,
  /// and moves the mesh to y >= 0; applied before the shape's transform.
  std::optional<double> fit_size;
  /// Part of a file with several meshes: the indices "mesh/primitive" of a glTF asset, or the material name
  /// of an OBJ. Empty: the whole file.
  std::string part{};
  /// True: vertex colours multiply the surface's colour; none: they do unless a texture defines that colour.
  std::optional<bool> vertex_colors{};
  /// Without normals: edges with a larger angle are creases, degrees, [0, 180]; none: by the file.
  std::optional<double> crease_angle{};
  /// Pose of a glTF asset; its part is then in the asset's space. None: at rest.
  std::optional<AnimationTime> pose{};
  double mm_per_unit = 1;  ///< scale of its vertices, a factor of Shape::to_world; 1 with a fit_size
  int subdivide = 0;  ///< rounds of Loop subdivision, each with 4 times as many triangles; 0 to kMostRounds
  static constexpr int kMostRounds = 6;
  friend bool operator==(const MeshFile&, const MeshFile&) = default;
};

/// Tessellation levels of built-in curved shapes: 4^fineness times as many triangles. The largest omits
/// 0.00005 of a sphere's area, each lower one four times as much.
constexpr int kMostFineness = 6, kLeastFineness = 4;

// Built-in shapes; lengths in mm. `Slab` is a box with a separate thickness: x and z extent, thickness along
// y.
struct SphereShape {
  Vec3d center{};
  double radius = 1;
  int fineness = kMostFineness;  ///< kLeastFineness to kMostFineness
  friend bool operator==(const SphereShape&, const SphereShape&) = default;
};
struct BoxShape {
  Vec3d low{-1, -1, -1}, high{1, 1, 1};
  friend bool operator==(const BoxShape&, const BoxShape&) = default;
};
struct QuadShape {  ///< the parallelogram corner, corner + u, corner + u + v, corner + v; normal along u x v
  Vec3d corner{}, u{1, 0, 0}, v{0, 1, 0};
  friend bool operator==(const QuadShape&, const QuadShape&) = default;
};
struct SlabShape {
  Vec3d center{};
  double width = 1, depth = 1, thickness = 1;  ///< along x, z, y
  friend bool operator==(const SlabShape&, const SlabShape&) = default;
};
struct TorusShape {  ///< axis along y
  Vec3d center{};
  double major_radius = 1, minor_radius = 0.25;
  int fineness = kMostFineness;  ///< kLeastFineness to kMostFineness
  friend bool operator==(const TorusShape&, const TorusShape&) = default;
};

using ShapeSource = std::variant<MeshFile, SphereShape, BoxShape, QuadShape, SlabShape, TorusShape>;

/// Specular reflection of an opaque surface: GGX facets of a dielectric over its colour, or of a metal with
/// that colour.
struct Gloss {
  double metalness = 0, roughness = 1;  ///< [0, 1]; the square of the latter is GGX's alpha
  std::optional<Texture> metalness_texture{}, roughness_texture{};
  double eta = 1.5;  ///< eta of the dielectric
  Grain grain{};
  friend bool operator==(const Gloss&, const Gloss&) = default;
};

/// Reflectance of an opaque shape without one in the scene.
inline constexpr Rgb kDefaultReflectance{0.5, 0.5, 0.5};

/// Shape::opacity below this is a hole.
inline constexpr float kHoleOpacity = 0.5f;

struct Shape {
  std::string name;
  ShapeSource source;
  Transform to_world;  ///< from mm in the shape's space to mm in the world
  NormalMode normals = NormalMode::smooth;
  /// Index into Scene::media, or none for an opaque Lambert surface of `reflectance`.
  std::optional<std::size_t> medium;
  Rgb reflectance = kDefaultReflectance;
  bool has_reflectance = false;  ///< given in the scene; otherwise vertex colours replace it
  /// Translucent shapes with the same non-empty group form one body; light never bleeds between others.
  std::string group;
  SourcePlace place{};                           ///< place of its source
  std::optional<Texture> reflectance_texture{};  ///< times the reflectance
  std::optional<Texture> normal_map{};           ///< its scale applies to the slopes
  std::optional<Texture> bump_map{};             ///< heights; its scale is in mm
  std::optional<Texture> displacement{};         ///< heights moving the vertices; its scale is in mm
  std::optional<Texture> opacity{};              ///< opaque shapes: holes where it is below kHoleOpacity
  std::optional<Texture> emission_texture{};     ///< factor of the radiance of its ShapeLight
  std::optional<Gloss> gloss{};                  ///< specular reflection of an opaque shape; none: diffuse
  Fuzz fuzz{};                                   ///< fuzz of an opaque shape
  bool is_seen = true;                           ///< visible to camera rays
  bool catches_shadows = false;                  ///< opaque; visible as shadows alone, in alpha
  friend bool operator==(const Shape&, const Shape&) = default;
};

/// The same for a shape, without its medium.
template <class Visit>
void for_each_textured(const Shape& shape, const Visit& visit) {
  visit(shape.reflectance, shape.reflectance_texture, SurfacePart::color);
  visit(1.0, shape.normal_map, SurfacePart::normals);
  visit(1.0, shape.bump_map, SurfacePart::normals);
  for_each_textured(shape.fuzz, visit);
  if (shape.displacement) visit(1.0, shape.displacement, SurfacePart::normals);
  if (shape.opacity) visit(1.0, shape.opacity, SurfacePart::normals);
  if (shape.emission_texture) visit(1.0, shape.emission_texture, SurfacePart::color);
  if (!shape.gloss) return;
  visit(shape.gloss->metalness, shape.gloss->metalness_texture, SurfacePart::color);
  visit(shape.gloss->roughness, shape.gloss->roughness_texture, SurfacePart::boundary);
  for_each_textured(shape.gloss->grain, visit);
}

// ---- lights ---------------------------------------------------------------------------------------------

struct PointLight {
  static constexpr std::string_view kType = "point";
  static constexpr bool kCanBeSeen = false;  ///< the key `visible` exists
  Vec3d position;
  Rgb intensity;  ///< W/sr; irradiance at distance d mm is intensity / d^2 in W/mm^2
  friend bool operator==(const PointLight&, const PointLight&) = default;
};
struct SpotLight {  ///< a point light within a cone
  static constexpr std::string_view kType = "spot";
  static constexpr bool kCanBeSeen = false;
  Vec3d position;
  Vec3d direction;          ///< unit, axis of emission
  Rgb intensity;            ///< on the axis, W/sr
  double outer_angle = 45;  ///< from the axis to the rim, degrees, (0, 90]
  double inner_angle = 0;   ///< from the axis to the beginning of the falloff, degrees, below outer_angle
  friend bool operator==(const SpotLight&, const SpotLight&) = default;
};
struct DirectionalLight {
  static constexpr std::string_view kType = "directional";
  static constexpr bool kCanBeSeen = true;
  Vec3d direction;   ///< unit, of propagation
  Rgb irradiance;    ///< on a surface facing it, W/mm^2
  double angle = 0;  ///< the disc's full angle, degrees, [0, 90]; 0: parallel light
  friend bool operator==(const DirectionalLight&, const DirectionalLight&) = default;
};
struct SphereLight {
  static constexpr std::string_view kType = "sphere";
  static constexpr bool kCanBeSeen = true;
  Vec3d center;
  double radius;
  Rgb radiance;
  friend bool operator==(const SphereLight&, const SphereLight&) = default;
};
struct QuadLight {  ///< emits on the side of u x v only
  static constexpr std::string_view kType = "quad";
  static constexpr bool kCanBeSeen = true;
  Vec3d corner, u, v;
  Rgb radiance;
  friend bool operator==(const QuadLight&, const QuadLight&) = default;
};
struct Surroundings {  ///< uniform radiance from all directions
  static constexpr std::string_view kType = "surroundings";
  static constexpr bool kCanBeSeen = false;
  Rgb radiance;
  friend bool operator==(const Surroundings&, const Surroundings&) = default;
};
class EnvironmentPicture;
/// Environment map. A coloured image becomes three lights of one name, one per channel, so each light's
/// irradiance is one number, as for other lights.
struct EnvironmentLight {
  static constexpr std::string_view kType = "environment";
  static constexpr bool kCanBeSeen = true;
  std::shared_ptr<const EnvironmentPicture> picture;
  Rgb strength{1, 1, 1};               ///< factor on its radiance
  double rotation = 0;                 ///< about +y, counterclockwise seen from above, degrees
  std::optional<std::size_t> channel;  ///< its only channel; none: the image is grey
  friend bool operator==(const EnvironmentLight&, const EnvironmentLight&) = default;
};
class LightTree;
/// Many lights as one, sampled a few at a time at each point. Scene files do not contain it: with_trees
/// (lights/light_tree.h) makes it from many lights in the world's space. Lights of different colours become
/// three of one name, one per channel.
struct ManyLights {
  static constexpr std::string_view kType = "many";
  static constexpr bool kCanBeSeen = false;
  std::shared_ptr<const LightTree> tree;
  Rgb strength{1, 1, 1};               ///< times the tree's colours
  std::optional<std::size_t> channel;  ///< its only channel; none: all lights have one colour
  friend bool operator==(const ManyLights&, const ManyLights&) = default;
};
class EmittingSurface;
/// Light emitted by a shape, on the outer side of its surface. Its texture is Shape::emission_texture; a
/// coloured one becomes three lights of one name, one per channel.
struct ShapeLight {
  static constexpr std::string_view kType = "shape";
  static constexpr bool kCanBeSeen = false;  ///< as its shape
  std::size_t shape = 0;                     ///< index into Scene::shapes
  Rgb radiance{};                            ///< times the texture
  std::optional<std::size_t> channel{};      ///< its only channel; none: the texture is grey
  /// Its triangles in the world's space, added by light_in_world (bodies/body.h); null in a Scene.
  std::shared_ptr<const EmittingSurface> surface{};
  friend bool operator==(const ShapeLight&, const ShapeLight&) = default;
};

using LightSource = std::variant<PointLight, SpotLight, DirectionalLight, SphereLight, QuadLight,
                                 Surroundings, EnvironmentLight, ManyLights, ShapeLight>;

struct Light {
  std::string name;  ///< equal for the channels of one image
  LightSource source;
  SourcePlace place{};
  bool is_seen = true;  ///< by the camera; reflections show the light in any case
  friend bool operator==(const Light&, const Light&) = default;
};

// ---- image ----------------------------------------------------------------------------------------------

struct Camera {
  Vec3d position{0, 0, 5}, look_at{0, 0, 0}, up{0, 1, 0};
  double field_of_view = 40;                    ///< full vertical angle, degrees, (0, 180)
  std::optional<double> orthographic_height{};  ///< mm: parallel rays in place of field_of_view
  std::array<double, 2> shift{0, 0};            ///< right and up, in widths and heights of the image
  double aperture = 0;                          ///< diameter of a thin lens, mm; 0: a pinhole
  std::optional<double> focus_distance{};       ///< along the view axis, mm; none: that of look_at
  int blades = 0;                               ///< iris of the lens; 0: round
  friend bool operator==(const Camera&, const Camera&) = default;
};

struct Film {
  std::array<int, 2> resolution{512, 512};  ///< width, height
  std::optional<std::array<int, 4>> crop;   ///< x0, y0, x1, y1 in pixels, upper ends excluded; from top left
  double pixel_aspect = 1;                  ///< width of a pixel over its height
  int samples_per_pixel = 1;
  PixelFilter filter =
      PixelFilter::box;  ///< box of one pixel; gaussian of standard deviation 0.5, radius 1.5
  bool half = true;      ///< 16-bit EXR; false: 32-bit
  double exposure = 0;   ///< stops, for PNG only
  ViewTransform view = ViewTransform::soft;                 ///< for PNG only
  FilmColorSpace color_space = FilmColorSpace::lin_rec709;  ///< for EXR only
  std::optional<int> wavelengths{};  ///< number of wavelengths; none: as few as the spectra allow
  bool denoise = false;              ///< by Open Image Denoise
  double shutter = 0;                ///< motion blur: opening time around the frame, in frames, [0, 1]
  friend bool operator==(const Film&, const Film&) = default;
};

/// Default entry samples of `direct`, without Settings::entry_samples and Settings::until_error.
inline constexpr std::size_t kDefaultEntrySamples = 256;

/// Switches for experiments with the methods themselves (docs/laboratory.md).
struct Laboratory {
  InstructionSet instruction_set = InstructionSet::automatic;  ///< dual_tree
  double max_solid_angle = 0.05;  ///< classic: opens a node if area / distance^2 exceeds it, sr
  bool near_field = true;         ///< splits the kernel near the shading point
  NearIrradiance near_irradiance = NearIrradiance::mixed;
  EntryStrategy entry_strategy = EntryStrategy::disc_axes;  ///< direct: sampling of entry points
  friend bool operator==(const Laboratory&, const Laboratory&) = default;
};

struct Settings {
  Method method = Method::automatic;
  EvaluatorKind evaluator = EvaluatorKind::automatic;
  double tolerance = 0.005;  ///< dual_tree, surface_cache: p99 of the relative error against the exact sum
  std::optional<double> sample_spacing;  ///< sqrt(area / samples), mm; none: from the mean free path
  std::optional<std::size_t> samples;    ///< per group; none: from the spacing
  std::size_t max_samples = 2000000;     ///< per group
  int light_samples = 64;                ///< shadow rays per sample (opaque: pixel) and light with an area
  std::optional<std::size_t> entry_samples;  ///< direct: per pixel at most; none: 256, or until until_error
  std::optional<double> until_error;  ///< stop at this estimated relative noise of the pixels (volume: cells)
  bool reenter = true;                ///< volume: enables re-entry of light into a body
  double cell_size = 2;               ///< volume_diffusion: size of the cells at the surface, mean free paths
  std::optional<int> bounces;         ///< 1: one bounce of light between surfaces; none: bounces_of()
  std::uint64_t seed = 0;
  int reference_frame = 1;  ///< frame of the samples' placement; in others, they move with the surface
  Laboratory laboratory{};
  friend bool operator==(const Settings&, const Settings&) = default;
};

/// The camera and the places of the shapes at a time while the shutter is open.
struct ShutterPose {
  Camera camera;
  std::vector<Shape> shapes;
  friend bool operator==(const ShutterPose&, const ShutterPose&) = default;
};

struct Scene {
  std::string file;         ///< for messages
  std::string translation;  ///< summary of an asset's import, one line; empty: a scene file
  /// Warnings of deprecated spellings and of deviations from an asset, one line each.
  std::vector<std::string> warnings;
  std::size_t asset_bytes = 0;  ///< memory of an asset's records
  double mm_per_unit = 1;       ///< unit of the file, for output in its units; all lengths here are mm
  std::vector<Medium> media;
  std::vector<Shape> shapes;
  std::vector<Light> lights;
  Camera camera;
  Film film;
  Settings settings;
  /// Radiance behind all shapes, visible to camera rays alone; none: surroundings and environments.
  std::optional<Rgb> backdrop{};
  /// Poses at equal steps of time from opening to closing, the scene's own in the middle: motion between them is
  /// straight. Empty: nothing moves, or no motion blur.
  std::vector<ShutterPose> shutter{};
  /// Frames from the first key of the camera or film to the last, if nothing else is keyed: images of the
  /// same surfaces under the same light; otherwise 1.
  std::size_t camera_frames = 1;
  /// Wavelengths of its colours, and the same scene at the others. None: red, green and blue.
  std::optional<ThreeWavelengths> wavelengths{};
  std::vector<Scene> other_wavelengths{};
  friend bool operator==(const Scene&, const Scene&) = default;
};

// ---- loading -------------------------------------------------------------------------------------------

/// Reads and checks a scene file, or an asset (GLB, glTF, OBJ) converted by import_asset; lengths are
/// converted to mm by its mm_per_unit.
/// in    overrides: "media.marble.eta=1.4": a path of keys (array elements by index or by "name") and a JSON
///       value (other texts are strings), applied before checking; frame: of keyed values and mesh sequences
/// error Error{bad_input} with file, line and column, the expected and the given value, and the nearest valid
///       name: no such file, broken JSON, unknown or duplicate key, wrong type, value out of range
Scene load_scene(const std::string& path, std::span<const std::string> overrides = {}, int frame = 1);

/// The same from text; `file` names it in messages, and its folder is the base of relative mesh paths.
Scene parse_scene(std::string_view text, const std::string& file, std::span<const std::string> overrides = {},
                  int frame = 1);

/// A single medium: a JSON object as in a scene's `media`; its name is "medium".
/// in    file: name of the text in messages
/// error as parse_scene
Medium parse_medium(std::string_view text, const std::string& file);

}  // namespace opaline
