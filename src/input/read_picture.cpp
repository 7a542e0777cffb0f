// SPDX-License-Identifier: GPL-3.0-or-later
#include <cmath>
#include <numbers>

#include "input/readers.h"
#include "input/settings_table.h"

namespace opaline {
namespace {

constexpr std::uint64_t kMostPixels = std::uint64_t{1} << 28;
constexpr double kFilmHeight = 24;  // mm, of f-numbers

/// error if both are given
void allow_one(const std::optional<Value>& a, const std::optional<Value>& b) {
  if (a && b) b->fail_key("cannot stand beside '" + a->path() + "'", "one of the two");
}

void read_projection(const ObjectReader& reader, double mm_per_unit, Camera& camera) {
  const auto angle = reader.find("field_of_view"), height = reader.find("orthographic_height");
  allow_one(angle, height);
  if (angle) camera.field_of_view = angle->number();
  if (height) camera.orthographic_height = height->length(mm_per_unit);
  if (const auto shift = reader.find("shift")) camera.shift = read_pair(*shift);
}

void read_lens(const ObjectReader& reader, double mm_per_unit, Camera& camera) {
  const auto aperture = reader.find("aperture"), f_number = reader.find("f_number");
  allow_one(aperture, f_number);
  allow_one(reader.find("orthographic_height"), f_number);
  if (aperture) camera.aperture = aperture->number() * mm_per_unit;
  if (f_number)
    camera.aperture =
        kFilmHeight / 2 / std::tan(camera.field_of_view * std::numbers::pi / 360) / f_number->number();
  const auto distance = reader.find("focus_distance"), point = reader.find("focus_point");
  allow_one(distance, point);
  if (distance) camera.focus_distance = distance->length(mm_per_unit);
  if (point) {
    const double depth =
        dot(point->point(mm_per_unit) - camera.position, normalized(camera.look_at - camera.position));
    if (depth > 0) camera.focus_distance = depth;  // else that of look_at: a free camera may turn away
  }
  constexpr double kMostTilt = 1e6;  // rays tilted further lose single precision
  const double focus = camera.focus_distance.value_or(length(camera.look_at - camera.position));
  if (camera.aperture > kMostTilt * focus)
    (aperture ? aperture : f_number)
        ->fail("opens the lens more than 1,000,000 times the distance in focus", "a smaller lens");
  if (const auto blades = reader.find("blades")) {
    camera.blades = int(blades->whole_number());
    if (camera.blades == 1 || camera.blades == 2) blades->fail("forms no iris", "0 or at least 3");
  }
}

/// Cropped images have no size limit.
void check_pixels(const Film& film, const Value& value) {
  const std::array<int, 4> part =
      film.crop.value_or(std::array<int, 4>{0, 0, film.resolution[0], film.resolution[1]});
  if (std::uint64_t(part[2] - part[0]) * std::uint64_t(part[3] - part[1]) > kMostPixels)
    value.fail("has too many pixels",
               "at most 2^28 = " + std::to_string(kMostPixels) + " in total, or a smaller 'crop'");
}

}  // namespace

std::array<double, 2> read_pair(const Value& value) {
  const std::vector<Value> numbers = value.list(2, "a list of 2 numbers");
  return {numbers[0].number(), numbers[1].number()};
}

Camera read_camera(const std::optional<Value>& value, double mm_per_unit) {
  Camera camera;
  camera.position *= mm_per_unit;
  camera.look_at *= mm_per_unit;
  if (!value) return camera;
  const ObjectReader reader(*value, "camera");
  const auto position = reader.find("position"), look_at = reader.find("look_at"), up = reader.find("up");
  if (position) camera.position = position->point(mm_per_unit);
  if (look_at) camera.look_at = look_at->point(mm_per_unit);
  if (up) camera.up = up->triple();
  read_projection(reader, mm_per_unit, camera);
  const Vec3d view = normalized(camera.look_at - camera.position);
  if (view == Vec3d{}) {
    if (position && (!look_at || position->node().override_index > look_at->node().override_index))
      position->fail("defines no view direction", "'position' different from 'look_at'");
    (look_at ? *look_at : *value).fail("defines no view direction", "'look_at' different from 'position'");
  }
  if (length(cross(view, normalized(camera.up))) < 1e-6)
    (up ? *up : *value)
        .fail("leaves the camera roll undefined: 'up' is parallel to the view direction or zero",
              "'up' not parallel to the line from 'position' to 'look_at'");
  read_lens(reader, mm_per_unit, camera);
  return camera;
}

Film read_film(const Value& value) {
  const Film film = read_members(value, "film", film_members(), 1);
  const ObjectReader reader(value, "film");
  const std::optional<Value> resolution = reader.find("resolution"), crop = reader.find("crop");
  if (resolution) check_pixels(film, crop ? *crop : *resolution);
  return film;
}

Settings read_settings(const Value& value, double mm_per_unit) {
  return read_members(value, "settings", settings_members(), mm_per_unit);
}

}  // namespace opaline
