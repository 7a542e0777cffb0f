// SPDX-License-Identifier: GPL-3.0-or-later
#include "render/render.h"

#include <atomic>
#include <chrono>
#include <mutex>
#include <optional>
#include <shared_mutex>
#include <utility>

#include "core/parallel.h"
#include "render/bounced_light.h"
#include "render/tile_renderer.h"
#include "scene/scene_properties.h"
#include "subsurface/method.h"

namespace opaline {
namespace {

// Skips empty pixels: they are zero already, and their memory stays untouched.
std::size_t store(const Rectangle& tile, const std::vector<PixelSample>& sums, const Scene& scene,
                  RenderResult& result) {
  Image& image = result.image;
  const MethodLayers layers = method_of(scene.settings.method).layers();
  std::size_t non_finite = 0;
  if (sums.empty()) return non_finite;
  for_each_pixel(tile, rendered_part(scene.film), [&](int x, int y, std::size_t i) {
    if (sums[i].empty()) return;
    const std::size_t row = std::size_t(y - image.crop_y), column = std::size_t(x - image.crop_x);
    const std::size_t pixel = row * std::size_t(image.width) + column, place = pixel * image.channels.size();
    result.translucent[pixel] = 2 * sums[i].translucent > sums[i].coverage ? 1 : 0;
    non_finite += store_pixel(sums[i], scene.film.samples_per_pixel, layers, image.pixels.data() + place);
  });
  return non_finite;
}

/// Image in progress, for Monitor::show_partial.
class PartialImage {
 public:
  PartialImage(const Monitor* monitor, const Image& image) : monitor_(monitor), image_(image) {
    if (is_shown()) is_final_.resize(std::size_t(image.width) * std::size_t(image.height));
  }

  /// store(): writes the tile to the image.
  template <class Store>
  void add(const Rectangle& tile, const Film& film, const Store& store) {
    if (!is_shown()) return store();
    {
      const std::shared_lock lock(writing_);
      store();
      for_each_pixel(tile, rendered_part(film), [&](int x, int y, std::size_t) {
        is_final_[std::size_t(y - image_.crop_y) * std::size_t(image_.width) +
                  std::size_t(x - image_.crop_x)] = 1;
      });
    }
    show_if_due();
  }

 private:
  using Clock = std::chrono::steady_clock;
  bool is_shown() const { return monitor_ != nullptr && monitor_->show_partial != nullptr; }

  void show_if_due() {
    const std::unique_lock turn(showing_, std::try_to_lock);
    if (!turn.owns_lock() ||
        std::chrono::duration<double>(Clock::now() - shown_).count() < monitor_->partial_interval)
      return;
    std::unique_lock lock(writing_);
    Image image = image_;
    const std::vector<std::uint8_t> is_final = is_final_;
    lock.unlock();
    monitor_->show_partial(std::move(image), is_final);
    shown_ = Clock::now();
  }

  const Monitor* monitor_;
  const Image& image_;
  std::vector<std::uint8_t> is_final_;
  std::shared_mutex writing_;  // shared by writers of different tiles
  std::mutex showing_;
  Clock::time_point shown_ = Clock::now();
};

// True if so many bytes may be cached per camera ray.
bool fits(const Film& film, std::size_t bytes) {
  return std::size_t(film.resolution[0]) * std::size_t(film.resolution[1]) *
             std::size_t(film.samples_per_pixel) * bytes <=
         kMostHeldBytes;
}

// Least bytes of a cached camera ray.
std::size_t bytes_of_ray(std::size_t lights) {
  return sizeof(HeldView::CameraHit) + sizeof(std::uint32_t) + 2 * sizeof(float) * lights;
}

// Cache of earlier images and for this one, if memory allows.
HeldView* view_of(const RenderInput& input, std::size_t tiles) {
  const std::size_t least = bytes_of_ray(recentred_lights(input.scene, input.world).size());
  if (input.view == nullptr || !fits(input.scene.film, least)) return nullptr;
  input.view->tiles.resize(tiles);
  input.view->has_room = fits(input.scene.film, least + sizeof(SurfacePoint));
  return input.view;
}

}  // namespace

std::size_t held_view_bytes(const Film& film, std::size_t lights, std::size_t seen) {
  std::size_t of_hit = bytes_of_ray(lights) - sizeof(HeldView::CameraHit);
  if (!fits(film, bytes_of_ray(lights))) return 0;
  if (fits(film, bytes_of_ray(lights) + sizeof(SurfacePoint))) of_hit += sizeof(SurfacePoint);
  const Rectangle part = rendered_part(film);
  const std::size_t pixels = std::size_t(part.x1 - part.x0) * std::size_t(part.y1 - part.y0);
  return std::size_t(film.samples_per_pixel) * (pixels * sizeof(HeldView::CameraHit) + seen * of_hit);
}

RenderResult render(const RenderInput& input) {
  const Film& film = input.scene.film;
  RenderResult result;
  result.image =
      empty_image(rendered_part(film), film, layer_names(method_of(input.scene.settings.method).layers()));
  result.translucent.resize(std::size_t(result.image.width) * std::size_t(result.image.height));
  Shader shader(input);
  std::optional<BouncedLight> bounced;
  if (bounces_of(input.scene) > 0) shader.set_bounced_light(&bounced.emplace(input, shader));
  const TileRenderer renderer(input, shader);
  const std::vector<Rectangle> tiles = tiles_of(film);
  HeldView* const view = view_of(input, tiles.size());
  if (input.monitor != nullptr)
    input.monitor->begin("shading", tiles.size() * std::size_t(film.samples_per_pixel));
  std::atomic<std::size_t> queries{0}, non_finite{0};
  PartialImage partial(input.monitor, result.image);
  parallel_chunks(tiles.size(), 1, [&](std::size_t begin, std::size_t, std::size_t) {
    const TileRenderer::Tile tile =
        renderer.render(tiles[begin], {}, view != nullptr ? &view->tiles[begin] : nullptr);
    queries += tile.queries;
    partial.add(tiles[begin], film,
                [&] { non_finite += store(tiles[begin], tile.sums, input.scene, result); });
  });
  result.queries = queries;
  result.non_finite = non_finite;
  return result;
}

}  // namespace opaline
