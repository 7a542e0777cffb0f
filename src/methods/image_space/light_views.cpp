// SPDX-License-Identifier: GPL-3.0-or-later
#include "methods/image_space/light_views.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "bodies/surface_textures.h"
#include "core/parallel.h"
#include "core/random.h"
#include "irradiance/shadow_batch.h"
#include "lights/shared_rays.h"

namespace opaline {
namespace {

constexpr std::size_t kMostChannels = 3;  // lights sharing their rays
constexpr float kInfinity = std::numeric_limits<float>::infinity();

using Weights = std::array<float, kMostChannels>;

/// One view: a point of a light, or a direction.
struct Standpoint {
  std::array<double, 2> square;  // for the light's samples
  Vec3f direction;               // from the body towards the light
  float distance = kInfinity;
  Weights weights{};  // one per light sharing its rays; parallel light only
};

std::array<Vec3d, 8> corners_of(const Bounds& box) {
  std::array<Vec3d, 8> corners;
  for (std::size_t i = 0; i < corners.size(); ++i)
    corners[i] = {(i & 1) != 0 ? box.high.x : box.low.x, (i & 2) != 0 ? box.high.y : box.low.y,
                  (i & 4) != 0 ? box.high.z : box.low.z};
  return corners;
}

/// The next step of a few per octave, so that slow motion keeps it.
double stepped(double value) {
  constexpr double kSteps = 4;
  return std::exp2(std::floor(kSteps * std::log2(value)) / kSteps);
}

/// Rectangle of a view's plane, covered by pixels on a fixed lattice: in motion, points stay.
struct Grid {
  double low_u = 1e300, high_u = -1e300, low_v = 1e300, high_v = -1e300;
  std::array<double, 2> shift{};  // position of the lattice, in pixels

  void add(double u, double v) {
    low_u = std::min(low_u, u), high_u = std::max(high_u, u);
    low_v = std::min(low_v, v), high_v = std::max(high_v, v);
  }
  struct Size {
    std::size_t columns = 0, rows = 0;
    double side = 0;
  };
  /// Calls use(u, v, area) at the middle of each pixel, row by row.
  template <class Use>
  Size for_each_pixel(double spacing, std::size_t most, const Use& use) const {
    const double width = high_u - low_u, height = high_v - low_v;
    const double side = stepped(std::max(
        {spacing, 1.2 * std::sqrt(width * height / double(most)), std::max(width, height) / double(most)}));
    const double first_u = std::floor(low_u / side - shift[0]) + shift[0],
                 first_v = std::floor(low_v / side - shift[1]) + shift[1];
    Size size{.side = side};
    for (double row = first_v; row * side < high_v; ++row, ++size.rows) {
      size.columns = 0;
      for (double column = first_u; column * side < high_u; ++column, ++size.columns)
        use((column + .5) * side, (row + .5) * side, side * side);
    }
    return size;
  }
};

/// A direction nearby, the same for slow motion.
Vec3d steady(const Vec3d& direction) {
  constexpr double kSteps = 4;
  const auto rounded = [](double x) { return std::round(kSteps * x) / kSteps; };
  return normalized(Vec3d{rounded(direction.x), rounded(direction.y), rounded(direction.z)});
}

void add_perspective(const Vec3d& position, const Vec3d& forward, const Grid& grid, double spacing,
                     std::size_t most, LightView& view) {
  Vec3d x, y;
  tangent_frame(forward, x, y);
  const std::size_t first = view.rays.size();
  const auto [columns, rows, side] = grid.for_each_pixel(spacing, most, [&](double u, double v, double area) {
    const double length2 = 1 + u * u + v * v, length = std::sqrt(length2);
    view.rays.emplace_back(Vec3f(position), Vec3f((forward + x * u + y * v) / length));
    view.measures.push_back(float(area / (length2 * length)));
  });
  view.planes.push_back({first, columns, rows, Vec3f(x * side), Vec3f(y * side), Vec3f(forward)});
}

bool is_all_around(const Light& light) {
  const LightExtent shape = extent(light);
  return !is_delta(light) && !shape.center && !shape.towards;
}

// Directions of a light all around the body. Six hemispheres share each direction by the squared cosines to
// their axes, to bound the weights of directions near a horizon.
std::vector<Standpoint> directions_of(std::span<const Light> lights, const Vec3f& centre, int count,
                                      std::uint64_t seed) {
  const int candidates = 16 * count;  // per hemisphere
  std::vector<Standpoint> all;
  std::vector<double> sums{0};
  for (int side = 0; side < 6; ++side) {
    Vec3f axis{};
    axis[std::size_t(side / 2)] = side % 2 == 0 ? 1.f : -1.f;
    const std::array<double, 2> shift{unit_double(hash_bits(seed, std::uint64_t(2 * side))),
                                      unit_double(hash_bits(seed, std::uint64_t(2 * side + 1)))};
    for (int i = 0; i < candidates; ++i) {
      Standpoint one{.square = r2_point(std::uint64_t(i), shift), .direction = {}};
      const LightSample sample = sample_lights(lights, centre, axis, one.square, candidates, one.weights);
      const float cosine = dot(axis, sample.direction);
      if (!(cosine > 0)) continue;
      one.direction = sample.direction;
      double bright = 0;
      for (std::size_t l = 0; l < lights.size(); ++l) {
        one.weights[l] *= cosine * cosine;
        bright += double(one.weights[l]) * max_component(emission(lights[l]));
      }
      if (!(bright > 0)) continue;
      all.push_back(one);
      sums.push_back(sums.back() + bright);
    }
  }
  std::vector<Standpoint> chosen;
  const double step = sums.back() / count;
  for (int k = 0; k < count && step > 0; ++k) {
    const double at = (k + .5) * step;
    const auto i =
        std::min(all.size() - 1, std::size_t(std::ranges::upper_bound(sums, at) - sums.begin()) - 1);
    Standpoint one = all[i];
    const double expected = (sums[i + 1] - sums[i]) / step;  // times it is chosen
    for (float& weight : one.weights) weight = float(double(weight) / expected);
    chosen.push_back(one);
  }
  return chosen;
}

std::vector<Standpoint> standpoints(std::span<const Light> lights, const Vec3f& centre, int light_samples,
                                    std::uint64_t seed) {
  const Light& light = lights[0];
  if (is_all_around(light)) return directions_of(lights, centre, light_samples, seed);
  const int count = is_delta(light) ? 1 : light_samples;
  std::vector<Standpoint> all;
  for (int i = 0; i < count; ++i) {
    Standpoint one{.square = r2_point(std::uint64_t(i), {.5, .5}), .direction = {}};
    const LightSample sample = sample_light(light, centre, {0, 0, 1}, one.square, count);
    one.direction = sample.direction;
    one.distance = sample.distance;
    one.weights[0] = sample.weight;
    if (std::isfinite(sample.distance) || sample.weight > 0) all.push_back(one);
  }
  return all;
}

/// Collects the points of one body in the views.
class Views {
 public:
  Views(const PrecomputeInput& input, const Body& body)
      : input_(input),
        textures_(input.scene, input.world),
        boundary_(body.boundary),
        is_own_(input.world.meshes.size()) {
    for (const std::uint32_t mesh : body.plan.meshes) is_own_[mesh] = true;
  }

  /// in    count: views of the light
  std::vector<FluxSample> points(const LightView& view, std::span<const Light> lights, const Standpoint& from,
                                 int count) const {
    constexpr std::size_t kChunk = 4096, kParted = 256;
    std::vector<std::uint8_t> parts(view.rays.size());  // 0: the middle of the pixel is not on the body
    std::vector<FluxSample> all;
    collect(view.rays.size(), kChunk, all, [&](std::size_t begin, std::size_t end, Collected& found) {
      std::vector<TracedRay> rays;
      for (std::size_t i = begin; i < end; ++i) rays.push_back({view.rays[i], {}});
      input_.rays.intersect(rays);
      for (std::size_t i = begin; i < end; ++i) {
        const TracedRay& met = rays[i - begin];
        if (!is_own(met)) continue;
        parts[i] = parts_of(met);
        if (parts[i] == 1) add(met, measure(view, i, met), lights, from, count, found);
      }
    });
    const std::vector<Parted> parted = parted_pixels(view, parts);
    collect(parted.size(), kParted, all, [&](std::size_t begin, std::size_t end, Collected& found) {
      const std::span<const Parted> pixels = std::span(parted).subspan(begin, end - begin);
      std::vector<TracedRay> rays = rays_of_parts(view, pixels);
      input_.rays.intersect(rays);
      auto met = rays.begin();
      for (const auto& [plane, pixel, count_of_parts] : pixels)
        for (unsigned k = 0; k < count_of_parts; ++k, ++met)
          if (is_own(*met))
            add(*met, measure(view, pixel, *met) / float(count_of_parts), lights, from, count, found);
    });
    return all;
  }

 private:
  using Collected = std::vector<FluxSample>;
  /// A pixel seen by several rays.
  struct Parted {
    const LightView::Plane* plane;
    std::size_t pixel;
    std::uint8_t parts;
  };

  // Appends the samples found by find(begin, end, found) in each chunk, in order.
  template <class Find>
  static void collect(std::size_t n, std::size_t chunk, std::vector<FluxSample>& all, const Find& find) {
    std::vector<Collected> found(chunk_count(n, chunk));
    parallel_chunks(n, chunk,
                    [&](std::size_t begin, std::size_t end, std::size_t i) { find(begin, end, found[i]); });
    for (const Collected& some : found) all.insert(all.end(), some.begin(), some.end());
  }

  bool is_own(const TracedRay& met) const { return met.hit.mesh != Hit::kMiss && is_own_[met.hit.mesh]; }

  static std::vector<TracedRay> rays_of_parts(const LightView& view, std::span<const Parted> pixels) {
    std::vector<TracedRay> rays;
    for (const auto& [plane, pixel, parts] : pixels)
      for (unsigned k = 0; k < parts; ++k) {
        const auto [u, v] = part(k, parts);
        rays.push_back({view.ray(*plane, pixel, u, v), {}});
      }
    return rays;
  }

  // Hammersley's points about the middle of a pixel.
  static std::array<float, 2> part(unsigned k, unsigned parts) {
    float reversed = 0, digit = .5f;
    for (unsigned rest = k; rest > 0; rest /= 2, digit /= 2) reversed += float(rest % 2) * digit;
    const float first = .5f / float(parts) - .5f;
    return {float(k) / float(parts) + first, reversed + first};
  }

  // An oblique pixel covers a long strip; its parts have about the area of one seen from the front.
  static std::uint8_t parts_of(const TracedRay& met) {
    constexpr int kMost = 16;
    const float across = length(met.hit.edges_cross),
                facing = across > 0 ? -dot(met.hit.edges_cross, met.ray.direction) / across : 0;
    int parts = 1;
    while (facing > 0 && parts < kMost && float(parts) * facing < 1) parts *= 2;
    return std::uint8_t(parts);
  }

  // Oblique pixels, and those beyond an outline beside them.
  static std::vector<Parted> parted_pixels(const LightView& view, std::span<const std::uint8_t> parts) {
    std::vector<Parted> parted;
    for (const LightView::Plane& plane : view.planes)
      for (std::size_t row = 0; row < plane.rows; ++row)
        for (std::size_t column = 0; column < plane.columns; ++column) {
          const std::size_t pixel = plane.first + row * plane.columns + column;
          std::uint8_t own = parts[pixel];
          if (own == 0) {
            for (std::size_t r = std::max<std::size_t>(row, 1) - 1; r < std::min(plane.rows, row + 2); ++r)
              for (std::size_t c = std::max<std::size_t>(column, 1) - 1;
                   c < std::min(plane.columns, column + 2); ++c)
                own = std::max(own, parts[plane.first + r * plane.columns + c]);
          }
          if (own > 1) parted.push_back({&plane, pixel, own});
        }
    return parted;
  }

  static float measure(const LightView& view, std::size_t pixel, const TracedRay& met) {
    return view.is_parallel ? view.measures[pixel] : view.measures[pixel] * met.ray.far * met.ray.far;
  }

  // Grazing pixels cover long strips; their area is limited, as their light is.
  void add(const TracedRay& met, float across, std::span<const Light> lights, const Standpoint& from,
           int count, std::vector<FluxSample>& points) const {
    constexpr float kLeastCosine = .02f;
    SurfacePoint point = input_.rays.surface_point(met.hit.mesh, met.hit.triangle, met.hit.u, met.hit.v);
    point.width = std::sqrt(across);
    Weights weights = from.weights;
    Vec3f direction = from.direction;
    if (std::isfinite(from.distance)) {
      const LightSample sample =
          sample_lights(lights, point.position, point.normal, from.square, count, weights);
      direction = sample.direction;
    }
    const Vec3f smooth = point.normal;  // tells the sides of the surface apart
    const float facing = dot(point.geometric, direction), factor = textures_.bend(point),
                cosine = std::min(1.f, dot(point.normal, direction));
    if (!(facing > 0) || !(cosine > 0)) return;
    RgbF emitted;
    for (std::size_t l = 0; l < lights.size(); ++l) emitted += RgbF(emission(lights[l])) * weights[l];
    if (!(max_component(emitted) > 0)) return;
    if (textures_.tints_entering(met.hit.mesh)) {
      const auto place = textures_.place(met.hit.mesh, met.hit.triangle, met.hit.u, met.hit.v,
                                         footprint_of(point, met.ray.direction, point.width));
      emitted = emitted * textures_.tint(place).entering;
    }
    points.push_back({point.position, across / std::max(facing, kLeastCosine),
                      emitted * (factor * cosine * boundary_.at(point).transmittance(cosine)), smooth});
  }

  const PrecomputeInput& input_;
  SurfaceTextures textures_;
  OuterBoundary boundary_;
  std::vector<bool> is_own_;
};

}  // namespace

LightView parallel_view(const Bounds& box, const Vec3d& towards, double reach, double spacing,
                        std::array<double, 2> shift) {
  Vec3d x, y;
  tangent_frame(towards, x, y);
  const Vec3d centre = .5 * (box.low + box.high);
  Grid grid{.shift = shift};
  for (const Vec3d& corner : corners_of(box)) grid.add(dot(corner, x), dot(corner, y));
  LightView view{.rays = {}, .measures = {}, .is_parallel = true, .planes = {}};
  const Vec3d outside = towards * (dot(centre, towards) + 2 * reach);
  const auto [columns, rows, side] =
      grid.for_each_pixel(spacing, kMostPixelsOfView, [&](double u, double v, double area) {
        view.rays.emplace_back(Vec3f(outside + x * u + y * v), Vec3f(-towards));
        view.measures.push_back(float(area));
      });
  view.planes.push_back({0, columns, rows, Vec3f(x * side), Vec3f(y * side), {}});
  return view;
}

Ray LightView::ray(const Plane& plane, std::size_t pixel, float u, float v) const {
  const Ray& middle = rays[pixel];
  const Vec3f shift = plane.x * u + plane.y * v;
  if (is_parallel) return {middle.origin + shift, middle.direction};
  return {middle.origin, normalized(middle.direction * (1 / dot(middle.direction, plane.forward)) + shift)};
}

LightView view_from(const Bounds& box, const Vec3d& position, double spacing, std::array<double, 2> shift) {
  constexpr double kNear = .2;  // times the distance of the box's centre
  const Vec3d centre = .5 * (box.low + box.high);
  const double distance = length(centre - position), radius = .5 * length(box.high - box.low);
  LightView view;
  Grid grid{.shift = shift};
  bool is_in_front = distance > 0;
  if (is_in_front) {
    const Vec3d forward = steady((centre - position) / distance);
    Vec3d x, y;
    tangent_frame(forward, x, y);
    for (const Vec3d& corner : corners_of(box)) {
      const Vec3d to = corner - position;
      const double depth = dot(to, forward);
      is_in_front = is_in_front && depth > kNear * distance;
      if (is_in_front) grid.add(dot(to, x) / depth, dot(to, y) / depth);
    }
    if (is_in_front) add_perspective(position, forward, grid, spacing / distance, kMostPixelsOfView, view);
  }
  if (is_in_front) return view;
  grid = {-1, 1, -1, 1};
  for (int side = 0; side < 6; ++side) {
    Vec3d forward{};
    forward[std::size_t(side / 2)] = side % 2 == 0 ? 1 : -1;
    add_perspective(position, forward, grid, spacing / std::max(distance, .5 * radius), kMostPixelsOfView / 6,
                    view);
  }
  return view;
}

std::vector<FluxSample> seen_from_lights(const PrecomputeInput& input, const Body& body, double spacing) {
  std::vector<Light> lights;  // without trees of lights
  for (const Light& light : input.scene.lights)
    lights.push_back(light_in_world(input.scene, input.world, light));
  const Bounds box = bounds(input.world, body.plan.meshes);
  const Vec3d centre = .5 * (box.low + box.high);
  const Views views(input, body);
  std::vector<FluxSample> all;
  for (std::size_t l = 0, together = 0; l < lights.size(); l += together) {
    together = sharing_rays(std::span(lights).subspan(l));
    const std::span<const Light> sharing = std::span(lights).subspan(l, together);
    const std::vector<Standpoint> from =
        standpoints(sharing, Vec3f(centre), input.scene.settings.light_samples,
                    light_seed(input.scene.settings.seed, sharing[0]));
    // Points of several views are less even, so there are almost four times as many.
    const double apart = from.size() > 1 ? .52 * spacing * std::sqrt(double(from.size())) : spacing;
    for (std::size_t i = 0; i < from.size(); ++i) {
      const Standpoint& one = from[i];
      const Vec3d towards(one.direction);
      // The lattices of similar views interleave.
      const std::array<double, 2> shift = r2_point(i, {});
      const LightView view = std::isfinite(one.distance)
                                 ? view_from(box, centre + towards * double(one.distance), apart, shift)
                                 : parallel_view(box, towards, input.world.diagonal, apart, shift);
      const std::vector<FluxSample> points = views.points(view, sharing, one, int(from.size()));
      all.insert(all.end(), points.begin(), points.end());
    }
  }
  return all;
}

}  // namespace opaline
