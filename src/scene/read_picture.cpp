// SPDX-License-Identifier: GPL-3.0-or-later
#include <array>

#include "readers.h"

namespace opaline {
namespace {

constexpr std::array<std::string_view, 2> filter_names{"box", "gaussian"};
constexpr std::array<std::string_view, 2> pixel_type_names{"half", "float"};
constexpr std::array<std::string_view, 3> method_names{"hierarchical", "lambert", "direct"};
constexpr std::array<std::string_view, 5> evaluator_names{"automatic", "dual_tree", "surface_cache",
                                                          "classic", "brute_force"};
constexpr std::array<std::string_view, 4> instruction_set_names{"automatic", "baseline", "avx2", "avx512"};
constexpr std::array<std::string_view, 3> near_irradiance_names{"mixed", "samples", "point"};
constexpr std::array<std::string_view, 2> strategy_names{"disc_axes", "chords"};

constexpr std::uint64_t largest_side = 65536, most_pixels = std::uint64_t{1} << 28;
constexpr double least_tolerance = 1e-4;  // asked for 1e-5, the p99 on a sphere is 6.2e-5
constexpr std::uint64_t most_samples = 1000000000;
constexpr std::uint64_t most_frame = 1000000000;

std::array<int, 2> read_resolution(const Value& value) {
  const std::vector<Value> sides = value.list(2, "[width, height]");
  const std::uint64_t width = sides[0].integer(1, largest_side), height = sides[1].integer(1, largest_side);
  return {static_cast<int>(width), static_cast<int>(height)};
}

std::array<int, 4> read_crop(const Value& value, const std::array<int, 2>& resolution) {
  const std::vector<Value> ends = value.list(4, "[x0, y0, x1, y1]");
  std::array<int, 4> crop{};
  for (std::size_t i = 0; i < 4; ++i)
    crop[i] = static_cast<int>(ends[i].integer(0, static_cast<std::uint64_t>(resolution[i % 2])));
  if (crop[0] >= crop[2] || crop[1] >= crop[3]) value.fail("holds no pixel", "x0 < x1 and y0 < y1");
  return crop;
}

/// A cropped picture may be as large as it likes.
void check_pixels(const Film& film, const Value& value) {
  const std::array<int, 4> part =
      film.crop.value_or(std::array<int, 4>{0, 0, film.resolution[0], film.resolution[1]});
  if (std::uint64_t(part[2] - part[0]) * std::uint64_t(part[3] - part[1]) > most_pixels)
    value.fail("has too many pixels",
               "at most 2^28 = " + std::to_string(most_pixels) + " in all, or a 'crop' of so many");
}

}  // namespace

Camera read_camera(const std::optional<Value>& value, double mm_per_unit) {
  Camera camera;
  camera.position *= mm_per_unit;
  camera.look_at *= mm_per_unit;
  if (!value) return camera;
  const ObjectReader reader(*value, "camera");
  const auto position = reader.find("position"), look_at = reader.find("look_at"), up = reader.find("up");
  if (position) camera.position = position->point(mm_per_unit);
  if (look_at) camera.look_at = look_at->point(mm_per_unit);
  if (up) camera.up = up->triple(finite_number);
  if (const auto field_of_view = reader.find("field_of_view"))
    camera.field_of_view = field_of_view->number({0, 180, true, true});
  const Vec3d view = normalized(camera.look_at - camera.position);
  if (view == Vec3d{})
    (look_at    ? *look_at
     : position ? *position
                : *value)
        .fail("gives no direction to look in", "'look_at' away from 'position'");
  if (length(cross(view, normalized(camera.up))) < 1e-6)
    (up ? *up : *value)
        .fail("leaves the camera's roll open: 'up' is along the view or zero",
              "'up' across the line from 'position' to 'look_at'");
  return camera;
}

Film read_film(const Value& value) {
  const ObjectReader reader(value, "film");
  Film film;
  const auto resolution = reader.find("resolution");
  if (resolution) film.resolution = read_resolution(*resolution);
  const auto crop = reader.find("crop");
  if (crop) film.crop = read_crop(*crop, film.resolution);
  if (resolution) check_pixels(film, crop ? *crop : *resolution);
  if (const auto samples = reader.find("samples_per_pixel"))
    film.samples_per_pixel = static_cast<int>(samples->integer(1, 65536));
  if (const auto filter = reader.find("filter"))
    film.filter = static_cast<PixelFilter>(filter->choice(filter_names));
  if (const auto pixel_type = reader.find("pixel_type"))
    film.half = pixel_type->choice(pixel_type_names) == 0;
  if (const auto exposure = reader.find("exposure")) film.exposure = exposure->number({-100, 100});
  return film;
}

Settings read_settings(const Value& value, double mm_per_unit) {
  const ObjectReader reader(value, "settings");
  Settings settings;
  if (const auto method = reader.find("method"))
    settings.method = static_cast<Method>(method->choice(method_names));
  if (const auto evaluator = reader.find("evaluator"))
    settings.evaluator = static_cast<EvaluatorKind>(evaluator->choice(evaluator_names));
  if (const auto tolerance = reader.find("tolerance")) {
    settings.tolerance = tolerance->number({0, 1, true, false});
    if (settings.tolerance < least_tolerance)
      tolerance->fail("cannot be kept: sums in single precision are off by .006 %",
                      "at least 1e-4; \"evaluator\": \"brute_force\" is exact");
  }
  if (const auto set = reader.find("instruction_set"))
    settings.instruction_set = static_cast<InstructionSet>(set->choice(instruction_set_names));
  if (const auto angle = reader.find("max_solid_angle"))
    settings.max_solid_angle = angle->number({0, 1e30, true, false});
  if (const auto near_field = reader.find("near_field")) settings.near_field = near_field->boolean();
  if (const auto near_irradiance = reader.find("near_irradiance"))
    settings.near_irradiance = static_cast<NearIrradiance>(near_irradiance->choice(near_irradiance_names));
  if (const auto spacing = reader.find("sample_spacing"))
    settings.sample_spacing = spacing->length(mm_per_unit);
  if (const auto samples = reader.find("samples")) settings.samples = samples->integer(1, most_samples);
  if (const auto samples = reader.find("max_samples"))
    settings.max_samples = samples->integer(1, most_samples);
  if (const auto samples = reader.find("light_samples"))
    settings.light_samples = static_cast<int>(samples->integer(1, 65536));
  if (const auto strategy = reader.find("entry_strategy"))
    settings.entry_strategy = static_cast<EntryStrategy>(strategy->choice(strategy_names));
  if (const auto samples = reader.find("entry_samples"))
    settings.entry_samples = samples->integer(1, most_samples);
  if (const auto error = reader.find("until_error"))
    settings.until_error = error->number({0, 1, true, false});
  if (const auto seed = reader.find("seed")) settings.seed = seed->integer(0, UINT64_MAX);
  if (const auto frame = reader.find("reference_frame"))
    settings.reference_frame = static_cast<int>(frame->integer(0, most_frame));
  return settings;
}

}  // namespace opaline
