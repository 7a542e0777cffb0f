// SPDX-License-Identifier: GPL-3.0-or-later
#include "render/bounced_light.h"

#include <algorithm>
#include <cmath>
#include <cstring>

#include "opaline/core/parallel.h"
#include "opaline/core/random.h"

namespace opaline {
namespace {

constexpr std::uint64_t kSeed = 4000;
// Rays from a sample, whose neighbours' are added to its own by the medium; from a hit that nothing stands for; from a
// place that stands for the pixels around it: for each of them, at least and at most.
constexpr int kOfSample = 16, kOfHit = 24, kOfPixel = 3, kFewestOfPlace = 48, kMostOfPlace = 192;
constexpr std::size_t kPlacesAtOnce = 256;  // each of many rays, and the threads share them
constexpr int kAcross = 64;                 // places along the picture's longer side
constexpr int kAround = 2;                  // beyond each border
// Distance from a place's plane, over the places' spacing, at which it stands for a hit half as well.
constexpr float kOffPlane = 0.2f;
constexpr float kLeastWeight = 0.05f;  // of all places around a hit, where a place at the hit has 1

// Of a row's places, one a lane; GCC's and Clang's.
using Lanes = float __attribute__((vector_size(BouncedPlaces::kBeside * sizeof(float))));

Lanes absolute(const Lanes& values) {
  return values < 0 ? -values : values;
}

// Emptied where others gathered.
HeldView::Gathering& of_points(HeldView::Gathering& held, const std::vector<std::uint32_t>& points) {
  if (held.points != points) held = {points, {}};
  return held;
}

HeldView::Gathering& gathering_of(std::unique_ptr<HeldView::Gathering>& held,
                                  const std::vector<std::uint32_t>& points) {
  if (held == nullptr) held = std::make_unique<HeldView::Gathering>();
  return of_points(*held, points);
}

HeldView::Gathering& gathering_of(std::vector<HeldView::Gathering>& by_field, std::size_t field,
                                  const std::vector<std::uint32_t>& points) {
  by_field.resize(std::max(by_field.size(), field + 1));
  return of_points(by_field[field], points);
}

}  // namespace

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
  irradiance_.resize(rays.size());
  gather(input, shader, rays);
}

void BouncedPlaces::gather(const RenderInput& input, const Shader& shader, std::span<const TracedRay> rays) {
  const double apart = step_ * pixel_width(input.scene.camera, input.scene.film);  // at depth 1
  const int rays_each = std::clamp(kOfPixel * step_ * step_, kFewestOfPlace, kMostOfPlace);
  std::vector<std::uint64_t> keys(rays.size());
  for (std::size_t i = 0; i < keys.size(); ++i) keys[i] = i;
  HeldView* const view = input.view;
  if (view != nullptr) view->at_places.resize(chunk_count(rays.size(), kPlacesAtOnce));
  parallel_chunks(rays.size(), kPlacesAtOnce, [&](std::size_t begin, std::size_t end, std::size_t chunk) {
    const std::vector<Shader::SeenSurfaces> seen =
        shader.surfaces_along(rays.subspan(begin, end - begin), std::span(keys).subspan(begin, end - begin));
    for (const auto& [field, hits, eta] : seen) {
      HeldView::Gathering* const held =
          view != nullptr ? &gathering_of(view->at_places[chunk], field, hits.rays) : nullptr;
      const std::vector<RgbF> irradiance =
          gathered_irradiance({input.rays, shader, hits.points, hits.keys, eta, rays_each,
                               hash_bits(input.scene.settings.seed, kSeed), held, view});
      for (std::size_t i = 0; i < hits.points.size(); ++i) {
        const std::size_t place = begin + hits.rays[i];
        places_.set(place, hits.points[i], eta, float(apart * double(rays[place].ray.far)));
        irradiance_[place] = irradiance[i];
      }
    }
  });
}

BouncedLight::BouncedLight(const RenderInput& input, const Shader& shader)
    : input_(input),
      shader_(shader),
      places_(input.bounced != nullptr ? input.bounced
                                       : std::make_shared<const BouncedPlaces>(input, shader)) {}

std::vector<RgbF> BouncedLight::at(const SurfaceHits& hits, float eta, HeldView::Surface* held) const {
  std::vector<RgbF> irradiance(hits.points.size());
  std::vector<SurfacePoint> points;
  std::vector<std::uint64_t> keys;
  std::vector<std::uint32_t> alone;
  for (std::size_t i = 0; i < hits.points.size(); ++i) {
    if (const std::optional<RgbF> known = places_->at(hits.points[i], eta)) {
      irradiance[i] = *known;
      continue;
    }
    alone.push_back(std::uint32_t(i));
    points.push_back(hits.points[i]);
    keys.push_back(hits.keys[i]);
  }
  if (alone.empty()) return irradiance;
  const std::vector<RgbF> gathered = gathered_irradiance(
      {input_.rays, shader_, points, keys, eta, kOfHit, hash_bits(input_.scene.settings.seed, kSeed + 1),
       held != nullptr ? &gathering_of(held->gathering, alone) : nullptr, input_.view});
  for (std::size_t k = 0; k < alone.size(); ++k) irradiance[alone[k]] = gathered[k];
  return irradiance;
}

void BouncedPlaces::Places::resize(std::size_t count) {
  for (auto* values : {&x, &y, &z, &normal_x, &normal_y, &normal_z, &reach}) values->resize(count);
  eta.resize(count, -1);
}

void BouncedPlaces::Places::set(std::size_t i, const SurfacePoint& point, float boundary, float spacing) {
  x[i] = point.position.x, y[i] = point.position.y, z[i] = point.position.z;
  normal_x[i] = point.normal.x, normal_y[i] = point.normal.y, normal_z[i] = point.normal.z;
  reach[i] = 2 * kOffPlane * spacing;
  eta[i] = boundary;
}

std::array<float, BouncedPlaces::kBeside> BouncedPlaces::Places::weights(const Asked& asked,
                                                                         std::size_t first) const {
  const auto from = [&](const std::vector<float>& values) {
    Lanes lanes;
    std::memcpy(&lanes, values.data() + first, sizeof lanes);
    return lanes;
  };
  const auto& [point, normal, boundary, dx, dy] = asked;
  const Lanes across = dx - Lanes{0, 1, 2, 3}, near = 1 - (across * across + dy * dy) / 4;
  const Lanes nx = from(normal_x), ny = from(normal_y), nz = from(normal_z);
  const Lanes cosine = normal.x * nx + normal.y * ny + normal.z * nz;
  const Lanes px = point.x - from(x), py = point.y - from(y), pz = point.z - from(z);
  const Lanes off =
      (absolute(px * normal.x + py * normal.y + pz * normal.z) + absolute(px * nx + py * ny + pz * nz)) /
      from(reach);
  const Lanes alike = cosine * cosine / (1 + off * off);
  const auto counts = (near > 0) & (cosine > 0) & (from(eta) == boundary);
  const Lanes weights = counts ? near * near * alike * alike : Lanes{};
  std::array<float, kBeside> each;
  std::memcpy(each.data(), &weights, sizeof weights);
  return each;
}

std::optional<RgbF> BouncedPlaces::at(const SurfacePoint& point, float eta) const {
  const CameraRays::FilmPlace seen = camera_.film_place(Vec3d(point.position));
  if (!(seen.depth > 0)) return {};
  // In places, from the first one.
  const double x = (seen.x - .5) / step_ + kAround, y = (seen.y - .5) / step_ + kAround;
  if (!(x >= 0 && y >= 0 && x < columns_ && y < rows_)) return {};
  RgbF sum;
  float weights = 0;
  const int left = std::clamp(int(x) - 1, 0, columns_ - int(kBeside));
  for (int row = std::max(0, int(y) - 1); row <= std::min(rows_ - 1, int(y) + 2); ++row) {
    const std::size_t first = std::size_t(row) * std::size_t(columns_) + std::size_t(left);
    const std::array<float, kBeside> of_row =
        places_.weights({point.position, point.normal, eta, float(x - left), float(y - row)}, first);
    for (std::size_t k = 0; k < kBeside; ++k) {
      if (!(of_row[k] > 0)) continue;
      sum += irradiance_[first + k] * of_row[k];
      weights += of_row[k];
    }
  }
  if (!(weights > kLeastWeight)) return {};
  return sum * (1 / weights);
}

std::shared_ptr<const BouncedPlaces> bounced_places(const RenderInput& input) {
  return std::make_shared<const BouncedPlaces>(input, Shader(input));
}

std::vector<std::vector<RgbF>> bounced_at_samples(const PrecomputeInput& input, std::span<const Body> bodies,
                                                  HeldView* view) {
  const RenderInput lit{input.scene, input.world, input.rays, bodies, input.monitor, {}, view};
  const Shader shader(lit);
  std::vector<std::vector<RgbF>> bounced;
  if (input.monitor != nullptr) {
    std::size_t points = 0;
    for (const Body& body : bodies) points += body.surface.samples.size();
    input.monitor->begin("bounces", points);
  }
  if (view != nullptr) view->at_samples.resize(bodies.size());
  for (const Body& body : bodies) {
    const std::vector<SurfaceSample>& samples = body.surface.samples;
    std::vector<HeldView::Gathering>* const held =
        view != nullptr ? &view->at_samples[bounced.size()] : nullptr;
    if (held != nullptr) held->resize(chunk_count(samples.size(), kGatheredAtOnce));
    std::vector<RgbF>& own = bounced.emplace_back(samples.size());
    const std::uint64_t seed = hash_bits(input.scene.settings.seed, kSeed + 2 + bounced.size());
    parallel_chunks(
        samples.size(), kGatheredAtOnce, [&](std::size_t begin, std::size_t end, std::size_t chunk) {
          std::vector<SurfacePoint> points;
          std::vector<std::uint64_t> keys;
          for (std::size_t i = begin; i < end; ++i) {
            const SurfaceSample& s = samples[i];
            points.push_back(input.rays.surface_point(s.mesh, s.triangle, s.u, s.v));
            keys.push_back(i);
          }
          const std::vector<RgbF> gathered =
              gathered_irradiance({input.rays, shader, points, keys, float(body.profile.eta), kOfSample, seed,
                                   held != nullptr ? &(*held)[chunk] : nullptr, view});
          std::ranges::copy(gathered, own.begin() + std::ptrdiff_t(begin));
          advance(input.monitor, end - begin);
        });
  }
  return bounced;
}

}  // namespace opaline
