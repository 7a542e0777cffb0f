// SPDX-License-Identifier: GPL-3.0-or-later
#include "input/readers.h"
#include "input/settings_table.h"

namespace opaline {
namespace {

constexpr std::uint64_t kMostPixels = std::uint64_t{1} << 28;

/// Cropped images have no size limit.
void check_pixels(const Film& film, const Value& value) {
  const std::array<int, 4> part =
      film.crop.value_or(std::array<int, 4>{0, 0, film.resolution[0], film.resolution[1]});
  if (std::uint64_t(part[2] - part[0]) * std::uint64_t(part[3] - part[1]) > kMostPixels)
    value.fail("has too many pixels",
               "at most 2^28 = " + std::to_string(kMostPixels) + " in total, or a smaller 'crop'");
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
  if (up) camera.up = up->triple();
  if (const auto field_of_view = reader.find("field_of_view")) camera.field_of_view = field_of_view->number();
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
