// SPDX-License-Identifier: GPL-3.0-or-later
#include "render/bounced_light.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "opaline/core/parallel.h"
#include "opaline/core/random.h"
#include "opaline/transport/fresnel.h"

namespace opaline {
namespace {

constexpr std::size_t kPointsAtOnce = 64;
constexpr std::uint64_t kSeed = 4000;
// Rays from a sample, whose neighbours' are added to its own by the medium; from a hit that nothing stands for; from a
// place that stands for the pixels around it: for each of them, at least and at most.
constexpr int kOfSample = 16, kOfHit = 24, kOfPixel = 3, kFewestOfPlace = 48, kMostOfPlace = 192;
constexpr int kAcross = 64;  // places along the picture's longer side
constexpr int kAround = 2;   // beyond each border
// Distance from a place's plane, over the places' spacing, at which it stands for a hit half as well.
constexpr float kOffPlane = 0.2f;
constexpr float kLeastWeight = 0.05f;  // of all places around a hit, where a place at the hit has 1

struct Gathered {
  std::vector<TracedRay> rays;
  std::vector<std::uint64_t> keys;
  std::vector<std::uint32_t> points;
  std::vector<float> weights;
};

// Directions drawn by the cosine, those that leave the surface.
void add_rays(const GatherInput& input, std::uint32_t p, Gathered& gathered) {
  const SurfacePoint& point = input.points[p];
  Vec3f x, y;
  tangent_frame(point.normal, x, y);
  const std::uint64_t key = input.keys[p];
  const std::array<double, 2> shift{unit_double(hash_bits(input.seed, 2 * key)),
                                    unit_double(hash_bits(input.seed, 2 * key + 1))};
  const float each = float(std::numbers::pi) / float(input.rays_each);
  for (int k = 0; k < input.rays_each; ++k) {
    const auto [u, v] = r2_point(std::uint64_t(k), shift);
    const float radius = float(std::sqrt(u)), cosine = float(std::sqrt(1 - u));
    const double angle = 2 * std::numbers::pi * v;
    const Vec3f direction =
        x * (radius * float(std::cos(angle))) + y * (radius * float(std::sin(angle))) + point.normal * cosine;
    if (!(dot(direction, point.geometric) > 0)) continue;
    const float transmitted = input.eta > 0 ? fresnel_transmittance(cosine, input.eta) : 1.0f;
    gathered.rays.push_back({{point.position + point.geometric * point.offset, direction}, {}});
    gathered.keys.push_back(hash_bits(key, std::uint64_t(k)));
    gathered.points.push_back(p);
    gathered.weights.push_back(each * transmitted);
  }
}

// Leaves the rays that met a surface.
void keep_hits(Gathered& gathered) {
  std::size_t kept = 0;
  for (std::size_t r = 0; r < gathered.rays.size(); ++r) {
    if (gathered.rays[r].hit.mesh == Hit::kMiss) continue;
    gathered.rays[kept] = gathered.rays[r];
    gathered.keys[kept] = gathered.keys[r];
    gathered.points[kept] = gathered.points[r];
    gathered.weights[kept++] = gathered.weights[r];
  }
  gathered.rays.resize(kept);
  gathered.keys.resize(kept);
}

}  // namespace

void for_each_gathered(const GatherInput& input, const UseOfGathered& use) {
  for (std::size_t begin = 0; begin < input.points.size(); begin += kPointsAtOnce) {
    const std::size_t end = std::min(begin + kPointsAtOnce, input.points.size());
    Gathered gathered;
    for (std::size_t p = begin; p < end; ++p) add_rays(input, std::uint32_t(p), gathered);
    input.rays.intersect(gathered.rays);
    keep_hits(gathered);
    const std::vector<RgbF> radiance = input.shader.radiance_along(gathered.rays, gathered.keys);
    for (std::size_t r = 0; r < radiance.size(); ++r)
      use(gathered.points[r], gathered.rays[r].ray.direction, radiance[r] * gathered.weights[r]);
  }
}

std::vector<RgbF> gathered_irradiance(const GatherInput& input) {
  std::vector<RgbF> irradiance(input.points.size());
  for_each_gathered(input, [&](std::size_t p, const Vec3f&, const RgbF& light) { irradiance[p] += light; });
  return irradiance;
}

BouncedPlaces::BouncedPlaces(const RenderInput& input, const Shader& shader)
    : camera_(input.scene.camera, input.scene.film, input.world) {
  const Film& film = input.scene.film;
  step_ = std::max(1, std::max(film.resolution[0], film.resolution[1]) / kAcross);
  // Of the whole picture, so that a crop is a piece of it; and a little around it.
  columns_ = film.resolution[0] / step_ + 1 + 2 * kAround;
  rows_ = film.resolution[1] / step_ + 1 + 2 * kAround;
  std::vector<TracedRay> rays;
  for (int row = 0; row < rows_; ++row)
    for (int column = 0; column < columns_; ++column)
      rays.push_back({camera_.ray((column - kAround) * step_, (row - kAround) * step_, 0), {}});
  input.rays.intersect(rays);
  places_.resize(rays.size());
  gather(input, shader, rays);
}

void BouncedPlaces::gather(const RenderInput& input, const Shader& shader, std::span<const TracedRay> rays) {
  const double apart = step_ * pixel_width(input.scene.camera, input.scene.film);  // at depth 1
  const int rays_each = std::clamp(kOfPixel * step_ * step_, kFewestOfPlace, kMostOfPlace);
  std::vector<std::uint64_t> keys(rays.size());
  for (std::size_t i = 0; i < keys.size(); ++i) keys[i] = i;
  parallel_chunks(rays.size(), kPointsAtOnce, [&](std::size_t begin, std::size_t end, std::size_t) {
    const std::vector<Shader::SeenSurfaces> seen =
        shader.surfaces_along(rays.subspan(begin, end - begin), std::span(keys).subspan(begin, end - begin));
    for (const auto& [hits, eta] : seen) {
      const std::vector<RgbF> irradiance =
          gathered_irradiance({input.rays, shader, hits.points, hits.keys, eta, rays_each,
                               hash_bits(input.scene.settings.seed, kSeed)});
      for (std::size_t i = 0; i < hits.points.size(); ++i) {
        const std::size_t place = begin + hits.rays[i];
        places_[place] = {true, hits.points[i], irradiance[i], eta,
                          float(apart * double(rays[place].ray.far))};
      }
    }
  });
}

BouncedLight::BouncedLight(const RenderInput& input, const Shader& shader)
    : input_(input),
      shader_(shader),
      places_(input.bounced != nullptr ? input.bounced
                                       : std::make_shared<const BouncedPlaces>(input, shader)) {}

std::vector<RgbF> BouncedLight::at(const SurfaceHits& hits, float eta) const {
  std::vector<RgbF> irradiance(hits.points.size());
  std::vector<SurfacePoint> points;
  std::vector<std::uint64_t> keys;
  std::vector<std::size_t> alone;
  for (std::size_t i = 0; i < hits.points.size(); ++i) {
    if (const std::optional<RgbF> known = places_->at(hits.points[i], eta)) {
      irradiance[i] = *known;
      continue;
    }
    alone.push_back(i);
    points.push_back(hits.points[i]);
    keys.push_back(hits.keys[i]);
  }
  const std::vector<RgbF> gathered = gathered_irradiance(
      {input_.rays, shader_, points, keys, eta, kOfHit, hash_bits(input_.scene.settings.seed, kSeed + 1)});
  for (std::size_t k = 0; k < alone.size(); ++k) irradiance[alone[k]] = gathered[k];
  return irradiance;
}

std::optional<RgbF> BouncedPlaces::at(const SurfacePoint& point, float eta) const {
  const CameraRays::FilmPlace seen = camera_.film_place(Vec3d(point.position));
  if (!(seen.depth > 0)) return {};
  // In places, from the first one.
  const double x = (seen.x - .5) / step_ + kAround, y = (seen.y - .5) / step_ + kAround;
  if (!(x >= 0 && y >= 0 && x < columns_ && y < rows_)) return {};
  RgbF sum;
  float weights = 0;
  for (int row = std::max(0, int(y) - 1); row <= std::min(rows_ - 1, int(y) + 2); ++row)
    for (int column = std::max(0, int(x) - 1); column <= std::min(columns_ - 1, int(x) + 2); ++column) {
      const Place& place = places_[std::size_t(row) * std::size_t(columns_) + std::size_t(column)];
      if (!place.is_there || place.eta != eta) continue;
      const float dx = float(x - column), dy = float(y - row), near = 1 - (dx * dx + dy * dy) / 4;
      const float cosine = dot(point.normal, place.point.normal);
      if (!(near > 0 && cosine > 0)) continue;
      const Vec3f apart = point.position - place.point.position;
      const float off = (std::abs(dot(apart, point.normal)) + std::abs(dot(apart, place.point.normal))) /
                        (2 * kOffPlane * place.spacing);
      const float alike = cosine * cosine / (1 + off * off);
      const float weight = near * near * alike * alike;
      sum += place.irradiance * weight;
      weights += weight;
    }
  if (!(weights > kLeastWeight)) return {};
  return sum * (1 / weights);
}

std::shared_ptr<const BouncedPlaces> bounced_places(const RenderInput& input) {
  return std::make_shared<const BouncedPlaces>(input, Shader(input));
}

std::vector<std::vector<RgbF>> bounced_at_samples(const PrecomputeInput& input,
                                                  std::span<const Body> bodies) {
  const RenderInput lit{input.scene, input.world, input.rays, bodies, input.monitor};
  const Shader shader(lit);
  std::vector<std::vector<RgbF>> bounced;
  if (input.monitor != nullptr) {
    std::size_t points = 0;
    for (const Body& body : bodies) points += body.surface.samples.size();
    input.monitor->begin("bounces", points);
  }
  for (const Body& body : bodies) {
    const std::vector<SurfaceSample>& samples = body.surface.samples;
    std::vector<RgbF>& own = bounced.emplace_back(samples.size());
    parallel_chunks(samples.size(), kPointsAtOnce, [&](std::size_t begin, std::size_t end, std::size_t) {
      std::vector<SurfacePoint> points;
      std::vector<std::uint64_t> keys;
      for (std::size_t i = begin; i < end; ++i) {
        const SurfaceSample& s = samples[i];
        points.push_back(input.rays.surface_point(s.mesh, s.triangle, s.u, s.v));
        keys.push_back(i);
      }
      const std::vector<RgbF> gathered =
          gathered_irradiance({input.rays, shader, points, keys, float(body.profile.eta), kOfSample,
                               hash_bits(input.scene.settings.seed, kSeed + 2 + bounced.size())});
      std::ranges::copy(gathered, own.begin() + std::ptrdiff_t(begin));
      advance(input.monitor, end - begin);
    });
  }
  return bounced;
}

}  // namespace opaline
