// SPDX-License-Identifier: GPL-3.0-or-later
#include "render/mattes.h"

#include <fmt/format.h>
#include <murmurhash.h>

#include <algorithm>
#include <array>
#include <bit>
#include <nlohmann/json.hpp>

#include "core/parallel.h"
#include "image/add_channels.h"
#include "lights/light.h"
#include "render/camera_rays.h"
#include "render/tile_renderer.h"

namespace opaline {
namespace {

constexpr std::size_t kRanksOfLayer = 2;  // in R, G and in B, A

std::uint32_t hash_of(std::string_view name) {
  std::uint32_t hash = 0;
  lmmh_x86_32(name.data(), unsigned(name.size()), 0, &hash);
  return hash;
}

/// Names of one kind, and the name of each mesh.
struct MatteLayer {
  std::string name;
  std::vector<std::string> names;
  std::vector<std::size_t> of_mesh{};
  std::size_t first_channel = 0;  ///< in the image
};

MatteLayer objects_of(const Scene& scene) {
  MatteLayer layer{"CryptoObject", {}};
  for (const Shape& shape : scene.shapes) {
    layer.of_mesh.push_back(layer.names.size());
    layer.names.push_back(shape.name);
  }
  return layer;
}

MatteLayer materials_of(const Scene& scene) {
  MatteLayer layer{"CryptoMaterial", {}};
  for (const Shape& shape : scene.shapes) {
    const std::string& name = shape.medium ? scene.media[*shape.medium].name : shape.name;
    const auto known = std::ranges::find(layer.names, name);
    layer.of_mesh.push_back(std::size_t(known - layer.names.begin()));
    if (known == layer.names.end()) layer.names.push_back(name);
  }
  return layer;
}

void describe(const MatteLayer& layer, Image& picture) {
  nlohmann::ordered_json manifest = nlohmann::ordered_json::object();
  for (const std::string& name : layer.names)
    manifest[name] = fmt::format("{:08x}", std::bit_cast<std::uint32_t>(matte_id(name)));
  const std::string key = "cryptomatte/" + fmt::format("{:08x}", hash_of(layer.name)).substr(0, 7) + '/';
  constexpr auto kReplace = nlohmann::ordered_json::error_handler_t::replace;
  picture.metadata.emplace_back(key + "name", layer.name);
  picture.metadata.emplace_back(key + "hash", "MurmurHash3_32");
  picture.metadata.emplace_back(key + "conversion", "uint32_to_float32");
  picture.metadata.emplace_back(key + "manifest", manifest.dump(-1, ' ', false, kReplace));
}

void append_channels(MatteLayer& layer, std::size_t first, std::vector<std::string>& channels) {
  layer.first_channel = first + channels.size();
  for (std::size_t i = 0; i < kMatteRanks / kRanksOfLayer; ++i)
    for (const char channel : {'R', 'G', 'B', 'A'})
      channels.push_back(fmt::format("{}{:02}.{}", layer.name, i, channel));
}

/// Number of camera rays of a pixel per mesh.
struct SeenMesh {
  std::uint32_t mesh;
  int rays;
};
using SeenMeshes = std::vector<SeenMesh>;

void count(SeenMeshes& seen, std::uint32_t mesh) {
  const auto known = std::ranges::find(seen, mesh, &SeenMesh::mesh);
  if (known != seen.end())
    ++known->rays;
  else
    seen.push_back({mesh, 1});
}

/// Visible lights in front of the surfaces.
std::vector<Light> hiding_lights(const RenderInput& input) {
  std::vector<Light> lights;
  for (const Light& light : recentred_lights(input.scene, input.world))
    if (!is_delta(light) && !is_of_shape(light) && light.is_seen && extent(light).center)
      lights.push_back(light);
  return lights;
}

/// counts: numbers of rays, row by row in the tile
std::vector<SeenMeshes> seen_in(const Rectangle& tile, std::span<const int> counts, const RenderInput& input,
                                const CameraRays& camera, std::span<const Light> lights) {
  std::vector<SeenMeshes> seen(counts.size());
  std::vector<TracedRay> rays;
  std::vector<std::size_t> pixel_of_ray;
  const int most = *std::ranges::max_element(counts);
  for (int s = 0; s < most; ++s) {
    if (s < input.scene.film.samples_per_pixel) advance(input.monitor, 1);
    rays.clear();
    pixel_of_ray.clear();
    std::size_t pixel = 0;
    for (int y = tile.y0; y < tile.y1; ++y)
      for (int x = tile.x0; x < tile.x1; ++x, ++pixel)
        if (s < counts[pixel]) {
          rays.push_back({camera.ray(x, y, s), {}});
          pixel_of_ray.push_back(pixel);
        }
    intersect_from_camera(input.scene, input.rays, rays);
    for (std::size_t i = 0; i < rays.size(); ++i) {
      const Ray& ray = rays[i].ray;
      const Hit& hit = rays[i].hit;
      const bool is_hidden = std::ranges::any_of(lights, [&](const Light& light) {
        return intersect_emitter(light, ray.origin, ray.direction, ray.far).hit;
      });
      if (hit.mesh != Hit::kMiss && !is_hidden) count(seen[pixel_of_ray[i]], hit.mesh);
    }
  }
  return seen;
}

/// Stores the names covering most of the pixel, largest first.
void store(const SeenMeshes& seen, const MatteLayer& layer, std::span<const float> ids, int rays,
           float* pixel) {
  SeenMeshes names;
  for (const auto& [mesh, met] : seen) {
    const auto name = std::uint32_t(layer.of_mesh[mesh]);
    const auto known = std::ranges::find(names, name, &SeenMesh::mesh);
    if (known != names.end())
      known->rays += met;
    else
      names.push_back({name, met});
  }
  std::ranges::sort(names, [](const SeenMesh& a, const SeenMesh& b) {
    return a.rays != b.rays ? a.rays > b.rays : a.mesh < b.mesh;
  });
  float* at = pixel + layer.first_channel;
  for (std::size_t i = 0; i < std::min(names.size(), kMatteRanks); ++i) {
    *at++ = ids[names[i].mesh];
    *at++ = float(names[i].rays) / float(rays);
  }
}

}  // namespace

float matte_id(std::string_view name) {
  std::uint32_t bits = hash_of(name);
  const std::uint32_t exponent = bits >> 23 & 255;
  if (exponent == 0 || exponent == 255) bits ^= 1u << 23;
  return std::bit_cast<float>(bits);
}

void add_mattes(const RenderInput& input, Image& picture) {
  const Film& film = input.scene.film;
  std::array<MatteLayer, 2> layers{objects_of(input.scene), materials_of(input.scene)};
  std::array<std::vector<float>, 2> ids;
  std::vector<std::string> channels;
  for (std::size_t k = 0; k < layers.size(); ++k) {
    append_channels(layers[k], picture.channels.size(), channels);
    describe(layers[k], picture);
    for (const std::string& name : layers[k].names) ids[k].push_back(matte_id(name));
  }
  add_channels(picture, channels);
  CameraRays camera(input.scene, input.world);
  if (!input.adaptive_rays.empty()) camera.make_progressive(input.scene.settings.seed);
  const std::vector<Light> lights = hiding_lights(input);
  const std::vector<Rectangle> tiles = tiles_of(film);
  const std::size_t step = picture.channels.size();
  if (input.monitor != nullptr)
    input.monitor->begin("mattes", tiles.size() * std::size_t(film.samples_per_pixel));
  parallel_chunks(tiles.size(), 1, [&](std::size_t begin, std::size_t, std::size_t) {
    const Rectangle& tile = tiles[begin];
    const auto place_of = [&](int x, int y) {
      return std::size_t(y - picture.crop_y) * std::size_t(picture.width) + std::size_t(x - picture.crop_x);
    };
    std::vector<int> counts(std::size_t(tile.x1 - tile.x0) * std::size_t(tile.y1 - tile.y0),
                            film.samples_per_pixel);
    if (!input.adaptive_rays.empty())
      for_each_pixel(tile, rendered_part(film),
                     [&](int x, int y, std::size_t i) { counts[i] = input.adaptive_rays[place_of(x, y)]; });
    const std::vector<SeenMeshes> seen = seen_in(tile, counts, input, camera, lights);
    for_each_pixel(tile, rendered_part(film), [&](int x, int y, std::size_t i) {
      if (seen[i].empty()) return;
      float* const pixel = picture.pixels.data() + place_of(x, y) * step;
      for (std::size_t k = 0; k < layers.size(); ++k) store(seen[i], layers[k], ids[k], counts[i], pixel);
    });
  });
}

}  // namespace opaline
