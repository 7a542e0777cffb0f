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
  std::string file;          ///< the scene file, or "--set path=value"; empty: made by a program
  int line = 0, column = 0;  ///< as in Error
  /// Where a thing is written is no part of what it is: scenes that differ in blanks alone are equal.
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

// ---- textures -------------------------------------------------------------------------------------------

class TextureFile;
/// A picture in place of a constant, laid over a surface by the UVs of its mesh.
struct Texture {
  std::shared_ptr<const TextureFile> file;
  Rgb scale{1, 1, 1};       ///< times its colours; the first one times its numbers
  std::size_t channel = 0;  ///< channel of the file, for a number
  /// From UVs to the picture, about its upper left corner: scaled, turned (degrees), moved (KHR_texture_transform).
  std::array<double, 2> uv_offset{0, 0}, uv_scale{1, 1};
  double uv_rotation = 0;
  bool is_relative = false;  ///< scaled to a mean of 1: its texels may exceed 1, other colours may not
  SourcePlace place{};
  friend bool operator==(const Texture&, const Texture&) = default;
};

/// A rough boundary that mirrors differently along and across a tangent: that of growing u, or, where the mesh has no UVs,
/// the level one, at right angles to +y.
struct Grain {
  double anisotropy = 0;  ///< [0, 1], specular_roughness_anisotropy of OpenPBR: 0 is the same all around
  double rotation = 0;    ///< rotation of the tangent about the normal, counterclockwise, degrees
  friend bool operator==(const Grain&, const Grain&) = default;
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

/// Default profile of a medium.
struct ChosenProfile {
  ProfileKind kind = ProfileKind::dipole;
  double thickness = std::numeric_limits<double>::infinity();  ///< as Medium::thickness
  NormalizedDiffusionFit fit = NormalizedDiffusionFit::refit;
  friend bool operator==(const ChosenProfile&, const ChosenProfile&) = default;
};

struct Medium {
  std::string name;
  std::variant<PhysicalMedium, ArtistMedium> coefficients;
  double eta = 1.3;
  std::optional<ProfileKind> profile = ProfileKind::dipole;  ///< none: chosen for each body (choose_models.h)
  SourcePlace place{};
  /// Mean cosine g of the scattering angle, (-1, 1), where the coefficients are reduced ones. Random walks alone
  /// follow it; diffusion knows no more than (1 - g) sigma_s.
  double scatter_anisotropy = 0;
  /// Thickness of the plates and bodies made of it, mm, > 0; infinite: thick. ProfileKind::multipole alone asks.
  double thickness = std::numeric_limits<double>::infinity();
  double specular_roughness = 0;  ///< roughness of the dielectric boundary, [0, 1]; GGX's alpha is its square
  /// Tint of its light: t = tint x texture, in [0, 1] except for textures with mean 1.
  Rgb tint{1, 1, 1};
  std::optional<Texture> tint_texture{}, roughness_texture{};
  TextureMix texture_mix = TextureMix::split;
  /// Texture of ArtistMedium::subsurface_radius over its mean; the record stores the mean.
  std::optional<Texture> radius_texture{};
  /// Fraction of the light scattering inside, [0, 1]; the rest is reflected diffusely at the surface, by base_color.
  double subsurface_weight = 1;
  Rgb base_color{.8, .8, .8};
  std::optional<Texture> weight_texture{}, base_texture{};  ///< times these
  ChosenProfile chosen{};                                   ///< where profile is none
  NormalizedDiffusionFit fit =
      NormalizedDiffusionFit::refit;  ///< ProfileKind::normalized_diffusion alone asks
  Grain grain{};                      ///< grain of the boundary
  friend bool operator==(const Medium&, const Medium&) = default;
};

// ---- shapes ---------------------------------------------------------------------------------------------

struct MeshFile {
  std::string path;         ///< as opened: the scene file's folder is already in front of a relative path
  bool fill_holes = false;  ///< close every hole before rendering
  /// If set: scale so that the largest side of the bounding box is this long (mm), centre x and z on the
  /// origin, and stand the mesh on y = 0; applied before the shape's transform.
  std::optional<double> fit_size;
  /// Part of a file with several meshes: the indices "mesh/primitive" of a glTF asset, or the material name of an OBJ.
  /// Empty: the whole file.
  std::string part{};
  /// True: vertex colours multiply the surface's colour; none: they do unless a texture gives that colour.
  std::optional<bool> vertex_colors{};
  /// Where it has no normals: edges that bend by more are sharp, degrees, [0, 180]; none: as the file says.
  std::optional<double> crease_angle{};
  friend bool operator==(const MeshFile&, const MeshFile&) = default;
};

/// Most fineness of a built-in curved shape: 4^fineness times as many triangles. 6 leaves .00005 of a sphere's area out,
/// and each one less four times that.
constexpr int kMostFineness = 6, kLeastFineness = 4;

// Built-in shapes; lengths in mm. `Slab` is a box named for its use: x and z extent, thickness along y.
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

/// Specular reflection of an opaque surface: GGX facets of a dielectric over its colour, or of a metal of that colour.
struct Gloss {
  double metalness = 0, roughness = 1;  ///< [0, 1]; the square of the latter is GGX's alpha
  std::optional<Texture> metalness_texture{}, roughness_texture{};
  double eta = 1.5;  ///< eta of the dielectric, outside air
  Grain grain{};
  friend bool operator==(const Gloss&, const Gloss&) = default;
};

/// Reflectance of an opaque shape unless the scene gives it.
inline constexpr Rgb kDefaultReflectance{0.5, 0.5, 0.5};

struct Shape {
  std::string name;
  ShapeSource source;
  Transform to_world;  ///< from mm in the shape's space to mm in the world
  NormalMode normals = NormalMode::smooth;
  /// Index into Scene::media, or none for an opaque Lambert surface of `reflectance`.
  std::optional<std::size_t> medium;
  Rgb reflectance = kDefaultReflectance;
  bool has_reflectance = false;  ///< the scene gives it; else vertex colours stand for it
  /// Translucent shapes with the same non-empty group blend as one object; others never bleed into each
  /// other.
  std::string group;
  SourcePlace place{};                           ///< place of its source
  std::optional<Texture> reflectance_texture{};  ///< times the reflectance
  std::optional<Texture> normal_map{};           ///< its scale is of the slopes
  std::optional<Texture> bump_map{};             ///< heights; its scale is mm
  std::optional<Gloss> gloss{};                  ///< specular reflection of an opaque shape; none: diffuse
  friend bool operator==(const Shape&, const Shape&) = default;
};

// ---- lights ---------------------------------------------------------------------------------------------

struct PointLight {
  static constexpr std::string_view kType = "point";
  static constexpr bool kCanBeSeen = false;  ///< by a camera: it has the key `visible`
  Vec3d position;
  Rgb intensity;  ///< W/sr; irradiance at distance d mm is intensity / d^2 in W/mm^2
  friend bool operator==(const PointLight&, const PointLight&) = default;
};
struct SpotLight {  ///< a point's light within a cone
  static constexpr std::string_view kType = "spot";
  static constexpr bool kCanBeSeen = false;
  Vec3d position;
  Vec3d direction;          ///< unit, the way its middle shines
  Rgb intensity;            ///< along the middle, W/sr
  double outer_angle = 45;  ///< from the middle to the rim, degrees, (0, 90]
  double inner_angle = 0;   ///< to where it begins to fade, degrees, below outer_angle
  friend bool operator==(const SpotLight&, const SpotLight&) = default;
};
struct DirectionalLight {
  static constexpr std::string_view kType = "directional";
  static constexpr bool kCanBeSeen = true;
  Vec3d direction;   ///< unit, the way the light travels
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
struct Surroundings {  ///< the same radiance from everywhere
  static constexpr std::string_view kType = "surroundings";
  static constexpr bool kCanBeSeen = false;
  Rgb radiance;
  friend bool operator==(const Surroundings&, const Surroundings&) = default;
};
class EnvironmentPicture;
/// A picture's radiance, by direction. A coloured picture becomes three lights of one name, a channel each: so what
/// arrives from each of them is one number, as from any light.
struct EnvironmentLight {
  static constexpr std::string_view kType = "environment";
  static constexpr bool kCanBeSeen = true;
  std::shared_ptr<const EnvironmentPicture> picture;
  Rgb strength{1, 1, 1};               ///< times its radiance
  double rotation = 0;                 ///< about +y, counterclockwise seen from above, degrees
  std::optional<std::size_t> channel;  ///< it shines in this one alone; none: the picture is grey
  friend bool operator==(const EnvironmentLight&, const EnvironmentLight&) = default;
};
class LightTree;
/// Many lights as one, of which each point draws a few. No scene file has it: lights become it once they are in the
/// world's space, where they are many (with_trees in lights/light_tree.h). Of different colours they become three of
/// one name, a channel each.
struct ManyLights {
  static constexpr std::string_view kType = "many";
  static constexpr bool kCanBeSeen = false;
  std::shared_ptr<const LightTree> tree;
  Rgb strength{1, 1, 1};               ///< times the tree's colours
  std::optional<std::size_t> channel;  ///< it shines in this one alone; none: all lights have one colour
  friend bool operator==(const ManyLights&, const ManyLights&) = default;
};

using LightSource = std::variant<PointLight, SpotLight, DirectionalLight, SphereLight, QuadLight,
                                 Surroundings, EnvironmentLight, ManyLights>;

struct Light {
  std::string name;  ///< the channels of one picture have the same
  LightSource source;
  SourcePlace place{};
  bool is_seen = true;  ///< by the camera; others see it all the same, boundaries that reflect it among them
  friend bool operator==(const Light&, const Light&) = default;
};

// ---- picture --------------------------------------------------------------------------------------------

struct Camera {
  Vec3d position{0, 0, 5}, look_at{0, 0, 0}, up{0, 1, 0};
  double field_of_view = 40;  ///< full vertical angle, degrees, (0, 180)
  friend bool operator==(const Camera&, const Camera&) = default;
};

struct Film {
  std::array<int, 2> resolution{512, 512};  ///< width, height
  std::optional<std::array<int, 4>> crop;   ///< x0, y0, x1, y1 in pixels, upper ends excluded; from top left
  int samples_per_pixel = 1;
  PixelFilter filter =
      PixelFilter::box;  ///< box of one pixel; gaussian of standard deviation 0.5, radius 1.5
  bool half = true;      ///< 16-bit EXR; false: 32-bit
  double exposure = 0;   ///< stops, for PNG only
  ViewTransform view = ViewTransform::soft;                 ///< for PNG only
  FilmColorSpace color_space = FilmColorSpace::lin_rec709;  ///< for EXR only
  friend bool operator==(const Film&, const Film&) = default;
};

/// Default entry samples of `direct`, where neither Settings::entry_samples nor Settings::until_error says.
inline constexpr std::size_t kDefaultEntrySamples = 256;

/// Switches for experiments with the methods themselves (docs/laboratory.md).
struct Laboratory {
  InstructionSet instruction_set = InstructionSet::automatic;  ///< dual_tree
  double max_solid_angle = 0.05;  ///< classic: open a node when area / distance^2 exceeds it, sr
  bool near_field = true;         ///< split the kernel near the shading point
  NearIrradiance near_irradiance = NearIrradiance::mixed;
  EntryStrategy entry_strategy = EntryStrategy::disc_axes;  ///< direct: how entry points are drawn
  friend bool operator==(const Laboratory&, const Laboratory&) = default;
};

struct Settings {
  Method method = Method::hierarchical;
  EvaluatorKind evaluator = EvaluatorKind::automatic;
  double tolerance = 0.005;  ///< dual_tree, surface_cache: p99 of the relative error against the exact sum
  std::optional<double> sample_spacing;  ///< sqrt(area / samples), mm; none: from the mean free path
  std::optional<std::size_t> samples;    ///< per group; none: from the spacing
  std::size_t max_samples = 2000000;     ///< per group
  int light_samples = 64;                ///< shadow rays per sample (opaque: pixel) and light with an area
  std::optional<std::size_t> entry_samples;  ///< direct: per pixel at most; none: 256, or until until_error
  std::optional<double>
      until_error;             ///< direct, volume: stop at this estimated relative error of the pixels, cells
  bool reenter = true;         ///< volume: enables re-entry of light into a body
  double cell_size = 2;        ///< volume_diffusion: of the cells at the surface, mean free paths
  std::optional<int> bounces;  ///< 1: one bounce of light between surfaces; none: bounces_of()
  std::uint64_t seed = 0;
  int reference_frame = 1;  ///< frame in which samples are placed; they move with the surface in others
  Laboratory laboratory{};
  friend bool operator==(const Settings&, const Settings&) = default;
};

struct Scene {
  std::string file;         ///< for messages
  std::string translation;  ///< summary of an asset's import, one line; empty: a scene file
  /// Deprecated spellings in the file, and deviations from an asset that change the image, one line each.
  std::vector<std::string> warnings;
  std::size_t asset_bytes = 0;  ///< memory of an asset's records
  double mm_per_unit = 1;       ///< unit of the file, for output in its units; all lengths here are mm
  std::vector<Medium> media;
  std::vector<Shape> shapes;
  std::vector<Light> lights;
  Camera camera;
  Film film;
  Settings settings;
  /// Frames from the first key of the camera or film to the last where nothing else changes from frame to
  /// frame: pictures of the same surfaces in the same light; else 1.
  std::size_t camera_frames = 1;
  friend bool operator==(const Scene&, const Scene&) = default;
};

// ---- loading -------------------------------------------------------------------------------------------

/// Reads and checks a scene file, or an asset (GLB, glTF, OBJ) as what import_asset makes of it; lengths are converted to mm by its mm_per_unit.
/// in    overrides: "media.marble.eta=1.4": a path of keys (array elements by index or by "name") and a JSON
/// value
///       (a value that is not JSON is taken as a string), applied before checking
/// error Error{bad_input} with file, line and column, what was expected, what was found, and the nearest
/// valid
///       name: no such file, broken JSON, unknown or duplicate key, wrong type, value out of range
/// frame: which one, of values and mesh files that change.
Scene load_scene(const std::string& path, std::span<const std::string> overrides = {}, int frame = 1);

/// The same from text; `file` stands in messages and its folder in front of relative mesh paths.
Scene parse_scene(std::string_view text, const std::string& file, std::span<const std::string> overrides = {},
                  int frame = 1);

/// A medium by itself: a JSON object such as a member of a scene's `media`; its name is "medium".
/// in    file: what messages call the text
/// error as parse_scene
Medium parse_medium(std::string_view text, const std::string& file);

}  // namespace opaline
