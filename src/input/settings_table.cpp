// SPDX-License-Identifier: GPL-3.0-or-later
#include "input/settings_table.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <optional>
#include <type_traits>

#include "input/key_rows.h"
#include "scene/names.h"
#include "spectra/wavelengths.h"

namespace opaline {
namespace {

constexpr double kMostSamples = 1e9, kLargestSide = 65536;

template <class Owner>
constexpr std::string_view kSection;
template <>
constexpr std::string_view kSection<Film> = "film";
template <>
constexpr std::string_view kSection<Settings> = "settings";
template <>
constexpr std::string_view kSection<Laboratory> = "settings.laboratory";

// ---- members of one value ---------------------------------------------------------------------------------

template <class T>
void read_into(T& member, const Value& value, double mm_per_unit) {
  if constexpr (std::is_same_v<T, bool>)
    member = value.flag();
  else if constexpr (std::is_enum_v<T>)
    member = T(value.choice());
  else if constexpr (std::is_integral_v<T>)
    member = T(value.whole_number());
  else
    member = value.info().type == ValueType::length ? value.length(mm_per_unit) : value.number();
}
template <class T>
void read_into(std::optional<T>& member, const Value& value, double mm_per_unit) {
  read_into(member.emplace(), value, mm_per_unit);
}

template <class T>
std::string json_of(const T& value) {
  if constexpr (std::is_enum_v<T>)
    return fmt::format("\"{}\"", name_of(value));
  else
    return fmt::format("{}", value);
}
template <class T>
std::string json_of(const std::optional<T>& value) {
  return value ? json_of(*value) : std::string();
}

template <class Owner, class T>
Owner owner_of(T Owner::*);
template <class Owner, class T>
T value_of(T Owner::*);

/// Row of a value for one member. Without a documented default, shows the member's.
template <auto kMember>
auto member(std::string_view key, ValueType type, std::string_view unit, const Range& range,
            std::string default_value, std::vector<KeyedStage> stages, std::string_view meaning) {
  using Owner = decltype(owner_of(kMember));
  using T = decltype(value_of(kMember));
  const auto read = [](Owner& owner, const Value& value, double mm_per_unit) {
    read_into(owner.*kMember, value, mm_per_unit);
  };
  const auto json = [](const Owner& owner) { return json_of(owner.*kMember); };
  KeyInfo info{kSection<Owner>, key, type, unit, range, std::move(default_value), meaning};
  if constexpr (std::is_enum_v<T>) info.choices = names_of(T{});
  if (info.default_value.empty()) {
    info.default_value = json(Owner{});
    if (type == ValueType::choice) info.default_value = '`' + info.default_value + '`';
  }
  return Member<Owner>{std::move(info), read, json, std::move(stages)};
}

Member<Settings> read_by(void (*read)(Settings&, const Value&, double), Member<Settings> member) {
  member.read = read;
  return member;
}

constexpr double kLeastTolerance = 1e-4;  // limit of single precision

void read_tolerance(Settings& settings, const Value& value, double) {
  const Node& node = value.node();
  if (node.kind == Node::Kind::number && node.number > 0 && node.number < kLeastTolerance)
    value.fail("is below the limit of single precision: sums have an error of 0.006 %",
               "at least 1e-4; \"evaluator\": \"brute_force\" is exact");
  settings.tolerance = value.number();
}

void read_laboratory(Settings& settings, const Value& value, double mm_per_unit) {
  settings.laboratory = read_members(value, kSection<Laboratory>, laboratory_members(), mm_per_unit);
}

/// Adds "key":value for each member with a value, of one stage or of all.
template <class Owner>
void add_json(std::string& json, std::span<const Member<Owner>> members, const Owner& owner,
              std::optional<KeyedStage> stage = {}) {
  for (const Member<Owner>& member : members) {
    if (stage && std::ranges::count(member.stages, *stage) == 0) continue;
    if (const std::string value = member.json(owner); !value.empty())
      json += fmt::format("{}\"{}\":{}", json.empty() ? "" : ",", member.info.key, value);
  }
}

std::string laboratory_json(const Settings& settings) {
  std::string json;
  add_json(json, laboratory_members(), settings.laboratory);
  return '{' + json + '}';
}

// ---- rows of more than one value --------------------------------------------------------------------------

void read_resolution(Film& film, const Value& value, double) {
  const std::vector<Value> sides = value.list(2, "[width, height]");
  film.resolution = {static_cast<int>(sides[0].whole_number()), static_cast<int>(sides[1].whole_number())};
}

void read_crop(Film& film, const Value& value, double) {
  const std::vector<Value> ends = value.list(4, "[x0, y0, x1, y1]");
  std::array<int, 4>& crop = film.crop.emplace();
  for (std::size_t i = 0; i < 4; ++i) {
    crop[i] = static_cast<int>(ends[i].whole_number());
    const int largest = film.resolution[i % 2];
    if (crop[i] > largest)
      ends[i].fail("is out of range", fmt::format("a whole number from 0 to {}, the image's {}", largest,
                                                  i % 2 == 0 ? "width" : "height"));
  }
  if (crop[0] >= crop[2] || crop[1] >= crop[3]) value.fail("contains no pixels", "x0 < x1 and y0 < y1");
}

void read_pixel_type(Film& film, const Value& value, double) {
  film.half = value.choice() == 0;
}

std::string resolution_json(const Film& film) {
  return fmt::format("[{}]", fmt::join(film.resolution, ","));
}

std::string crop_json(const Film& film) {
  return film.crop ? fmt::format("[{}]", fmt::join(*film.crop, ",")) : std::string();
}

constexpr std::array<std::string_view, 2> kPixelTypes{"half", "float"};

std::string pixel_type_json(const Film& film) {
  return fmt::format("\"{}\"", kPixelTypes[film.half ? 0 : 1]);
}

}  // namespace

std::span<const Member<Film>> film_members() {
  using enum ValueType;
  using enum KeyedStage;
  static const std::vector<Member<Film>> table{
      {row("film", "resolution", list, "pixels, each 1 to 65536, at most 2^28 in total", {1, kLargestSide},
           "[512, 512]", "image size, [width, height]"),
       read_resolution,
       resolution_json,
       {view}},
      {row("film", "crop", list, "pixels", {0, kLargestSide}, "everything",
           "renders only the pixels [x0, y0, x1, y1], counted from the top left, without x1 and y1"),
       read_crop,
       crop_json,
       {view}},  // after the resolution, as it must lie within
      member<&Film::pixel_aspect>(
          "pixel_aspect", number, "", {.01, 100}, "", {view, view_near},
          "width of a pixel over its height; 2 for anamorphic images, to be shown twice as wide; "
          "the header of the EXR states it"),
      member<&Film::samples_per_pixel>("samples_per_pixel", whole_number, "", {1, 65536}, "",
                                       {view, view_near}, "camera rays per pixel"),
      member<&Film::filter>("filter", choice, "", kFiniteNumber, "", {view},
                            "pixel filter: `\"box\"`: one pixel wide; `\"gaussian\"`: softer, standard "
                            "deviation 0.5, radius 1.5 pixels"),
      {row("film", "pixel_type", choice, "", kFiniteNumber, "`\"half\"`",
           "bits per value of the EXR: `\"half\"`: 16; `\"float\"`: 32", kPixelTypes),
       read_pixel_type, pixel_type_json},
      member<&Film::exposure>("exposure", number, "stops", {-100, 100}, "", {},
                              "exposure of the PNG; one stop is a factor of 2"),
      member<&Film::view>(
          "view", choice, "", kFiniteNumber, "", {},
          "tone mapping of the PNG: `\"soft\"`: unchanged below 0.8 of white, compressed above; "
          "`\"neutral\"`: Khronos PBR Neutral, compressed above 0.8 of white, after subtracting up to 0.04; "
          "`\"agx\"`: AgX, filmic, with less contrast and saturation; `\"srgb\"`: clipped at white"),
      member<&Film::color_space>("color_space", choice, "", kFiniteNumber, "", {},
                                 "colour space of the EXR: `\"lin_rec709\"`: that of the scene; "
                                 "`\"acescg\"`: converted to ACEScg (AP1)"),
      member<&Film::wavelengths>(
          "wavelengths", whole_number, "", {kFewestWavelengths, kMostWavelengths},
          "the fewest for the scene's spectra, with colours within 1 %; without spectra, "
          "red, green and blue",
          {}, "number of wavelengths of spectra, a multiple of 3; each three take the time of an image"),
      member<&Film::denoise>(
          "denoise", flag, "", kFiniteNumber, "", {},
          "removes noise with Open Image Denoise, if it is installed; the diffuse light of "
          "translucent shapes changes by at most twice its estimated error"),
      member<&Film::shutter>(
          "shutter", number, "frames", kUnitInterval, "", {view},
          "motion blur of the camera and of shapes with keyed values: time of exposure around the "
          "frame; 0.5 is a shutter of 180 degrees. Light stays that of the frame"),
  };
  return table;
}

std::span<const Member<Settings>> settings_members() {
  using enum ValueType;
  using enum KeyedStage;
  static const std::vector<Member<Settings>> table{
      member<&Settings::method>(
          "method", choice, "", kFiniteNumber, "", {surfaces, view_surfaces},
          "`\"auto\"`: for each body `\"volume_diffusion\"`, or `\"hierarchical\"` if its mesh is open, its "
          "profile or the evaluator is set, or it is too large for cells; `\"hierarchical\"`: BSSRDF with a "
          "radial profile, by hierarchical evaluation; `\"lambert\"`: "
          "diffuse reflection, usually fastest; `\"direct\"`: the same BSSRDF by unbiased Monte Carlo "
          "sampling, slow and noisy; `\"volume\"`: random walks inside the bodies, slow and noisy, the "
          "reference; `\"volume_diffusion\"`: the diffusion equation solved inside the bodies, close to the "
          "reference; `\"preintegrated\"`: each hit as on a ball of the local curvature, at less than twice "
          "the cost of `\"lambert\"`, for objects in motion; `\"image_space\"`: `\"hierarchical\"` with "
          "samples "
          "seen from the lights, for objects in motion"),
      member<&Settings::evaluator>(
          "evaluator", choice, "", kFiniteNumber, "", {exitance, surfaces},
          "hierarchical evaluation: `\"dual_tree\"`: clusters of shading points against octree nodes, to "
          "`tolerance`; `\"surface_cache\"`: the same at points all over the surface, interpolated at "
          "shading points; `\"automatic\"`: one of the two, depending on the number of points; "
          "`\"classic\"`: octree traversal per shading point, as published; `\"brute_force\"`: the exact "
          "sum, slow"),
      read_by(read_tolerance,
              member<&Settings::tolerance>(
                  "tolerance", number, "", {kLeastTolerance, 1}, "", {exitance, surfaces},
                  "evaluators `dual_tree` and `surface_cache`: maximum relative error against the exact sum, "
                  "at 99 % of the points; single precision sets the lower limit")),
      member<&Settings::sample_spacing>("sample_spacing", length, "", kFiniteNumber,
                                        "from the medium's mean free path", {},
                                        "distance between samples, sqrt(area / samples)"),
      member<&Settings::samples>("samples", whole_number, "", {1, kMostSamples}, "from the spacing", {},
                                 "number of samples per body; overrides `sample_spacing`; `volume_diffusion` "
                                 "uses at least one per surface cell"),
      member<&Settings::max_samples>("max_samples", whole_number, "", {1, kMostSamples}, "", {},
                                     "maximum number of samples per body"),
      member<&Settings::light_samples>("light_samples", whole_number, "", {1, 65536}, "",
                                       {transfers, exitance, view_surfaces},
                                       "shadow rays per sample, and per pixel of an opaque surface, to each "
                                       "area light and to the surroundings; with more than 16 lights: to all "
                                       "area lights together, and a third as many to all other lights"),
      member<&Settings::entry_samples>(
          "entry_samples", whole_number, "", {1, kMostSamples},
          fmt::format("{}, or enough for `until_error`", kDefaultEntrySamples), {},
          "`direct`: sampled points of entry per pixel, rounded to whole passes of 16"),
      member<&Settings::until_error>(
          "until_error", number, "", {0, 1, true}, "none", {},
          "relative noise at which to stop (rms of the estimated standard error): "
          "`direct`, of the diffuse light of pixels; `volume`, of cells; others, of "
          "pixels, by camera rays in place of `samples_per_pixel`"),
      member<&Settings::cell_size>(
          "cell_size", number, "mean free paths", {.05, 100}, "", {cells},
          "`volume_diffusion`: size of the cells at the surface, in mean free paths or, if shorter, in units "
          "of 0.45 diffuse mean free paths, down to a quarter of it in small bodies; smaller cells are "
          "slower and "
          "more accurate"),
      member<&Settings::reenter>(
          "reenter", flag, "", kFiniteNumber, "", {walks},
          "`volume` and `volume_diffusion`: re-entry of outgoing light into the same body, as in "
          "concavities, "
          "for `volume` of reflected light too; `false`: such light is lost, unless `bounces` is 1. Other "
          "methods: `bounces`"),
      member<&Settings::bounces>(
          "bounces", whole_number, "", {0, 1}, "1 if one surface can light another", {},
          "all methods but `volume`: 1: light between surfaces, such as from a floor to the object on it, "
          "until it fades; from bodies of other methods than `volume_diffusion`, one bounce; 0: direct light "
          "only, without re-entry"),
      member<&Settings::seed>("seed", whole_number, "", kMostWholeNumber, "",
                              {samples, transfers, exitance, walks, surfaces, gathered, view_surfaces},
                              "random seed; the same seed gives the same image"),
      member<&Settings::reference_frame>(
          "reference_frame", whole_number, "", {0, 1e9}, "", {},
          "frame ranges: samples are placed on the surfaces of this frame and move with them in all others"),
      {row("settings", "laboratory", object, "", kFiniteNumber, "none",
           "switches for experiments, see `docs/laboratory.md`"),
       read_laboratory, laboratory_json},
  };
  return table;
}

std::span<const Member<Laboratory>> laboratory_members() {
  using enum ValueType;
  using enum KeyedStage;
  static const std::vector<Member<Laboratory>> table{
      member<&Laboratory::instruction_set>("instruction_set", choice, "", kFiniteNumber, "", {exitance},
                                           "SIMD instructions of the dual tree: `\"automatic\"` (the widest "
                                           "of the processor), `\"baseline\"`, `\"avx2\"` or `\"avx512\"`"),
      member<&Laboratory::max_solid_angle>("max_solid_angle", number, "sr", {0, 1e30, true}, "", {surfaces},
                                           "evaluator `classic`: maximum solid angle of an octree node that "
                                           "is evaluated as a whole; smaller is slower and more accurate"),
      member<&Laboratory::near_field>(
          "near_field", flag, "", kFiniteNumber, "", {kernel},
          "integrates the kernel near the shading point separately; `false` requires many more samples"),
      member<&Laboratory::near_irradiance>(
          "near_irradiance", choice, "", kFiniteNumber, "", {kernel},
          "irradiance of the near field: `\"samples\"`: mean of the samples around the point; `\"point\"`: "
          "traced at the point; `\"mixed\"`: a blend that preserves the width of the kernel, traced at "
          "surrounding points where the two differ"),
      member<&Laboratory::entry_strategy>("entry_strategy", choice, "", kFiniteNumber, "", {},
                                          "method `direct`, sampling of entry points: `\"disc_axes\"`: lines "
                                          "through discs along three axes; `\"chords\"`: chords of spheres"),
  };
  return table;
}

std::string settings_json(const Scene& scene) {
  std::string json;
  add_json(json, settings_members(), scene.settings);
  add_json(json, film_members(), scene.film);
  return '{' + json + '}';
}

std::string settings_in_key(KeyedStage stage, const Scene& scene) {
  std::string json;
  add_json(json, film_members(), scene.film, stage);
  add_json(json, settings_members(), scene.settings, stage);
  add_json(json, laboratory_members(), scene.settings.laboratory, stage);
  return json;
}

}  // namespace opaline
