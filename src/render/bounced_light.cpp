// SPDX-License-Identifier: GPL-3.0-or-later
#include "render/bounced_light.h"

#include <algorithm>
#include <cstring>
#include <numeric>

#include "core/parallel.h"
#include "core/random.h"
#include "subsurface/method.h"
#include "volume/nearest_sample.h"

namespace opaline {
namespace {

constexpr std::uint64_t kSeed = 4000;
// Gathered rays: from a hit without cached irradiance; from a cache point, per pixel of its spacing, at least
// and at most. Closer cache points use the maximum.
constexpr int kOfHit = 24, kOfPixel = 3, kFewestOfPlace = 48, kMostOfPlace = 192;
constexpr std::size_t kPlacesAtOnce = 128;       // each of many rays, and the threads share them
constexpr int kAcross = 64;                      // cache points along the image's longer side, first lattice
constexpr std::uint64_t kKeysOfMore = 1u << 31;  // first key of a second gathering, by more rays
constexpr int kAround = 2;                       // beyond each border
constexpr std::size_t kLattices = 3;
// Mean inverse distance of a cache point's hits, times the spacing, above which closer cache points are
// added. A wall meeting a floor gives 0.21 at a distance of one spacing.
constexpr float kNear = 0.07f;
// Required variation of four cache points: the difference of the largest and the smallest irradiance, over
// the largest.
constexpr float kVaried = 0.2f;
// Distance from a cache point's tangent plane, over the spacing, at which its weight is a half.
constexpr float kOffPlane = 0.2f;
constexpr float kLeastWeight = 0.05f;  // sum of the weights around a hit, each at most 1

// Vector of a row's cache points; extension of GCC and Clang.
using Lanes = float __attribute__((vector_size(BouncedPlaces::kBeside * sizeof(float))));

Lanes absolute(const Lanes& values) {
  return values < 0 ? -values : values;
}

// Few rays meet a small bright surface, as above a lamp: more rays, and smoothing, above this noise.
constexpr double kNoisy = .3, kNoisyAtSamples = .6;

/// Standard error of gathered light over its root mean square, of the worst channel, times the share of rays with
/// light: with few, other light matters more.
double noise_of(std::span<const RgbF> values, std::span<const RgbF> variance, std::span<const float> met) {
  double noise = 0;
  for (std::size_t c = 0; c < 3; ++c) {
    double error = 0, size = 0;
    for (std::size_t i = 0; i < values.size(); ++i) {
      error += double(std::max(0.f, variance[i][c])) * double(met[i]) * double(met[i]);
      size += double(values[i][c]) * double(values[i][c]);
    }
    if (size > 0) noise = std::max(noise, std::sqrt(error / size));
  }
  return noise;
}

/// The nearest value to `smooth` within two standard errors.
RgbF within_noise(const RgbF& smooth, const RgbF& own, const RgbF& variance) {
  RgbF value;
  for (std::size_t c = 0; c < 3; ++c) {
    const float error = 2 * std::sqrt(std::max(0.f, variance[c]));
    value[c] = std::clamp(smooth[c], own[c] - error, own[c] + error);
  }
  return value;
}

HeldView::Gathering& gathering_of(std::vector<HeldView::Gathering>& by_field, std::size_t field,
                                  const std::vector<std::uint32_t>& points) {
  by_field.resize(std::max(by_field.size(), field + 1));
  return gathering_of(by_field[field], points);
}

}  // namespace

BouncedPlaces::BouncedPlaces(const RenderInput& input, const Shader& shader)
    : camera_(input.scene.camera, input.scene.film, input.world) {
  const Film& film = input.scene.film;
  int step = std::max(1, std::max(film.resolution[0], film.resolution[1]) / kAcross);
  Lattice& first = lattices_.emplace_back(film, step);
  std::vector<std::uint32_t> places(first.irradiance.size());
  std::iota(places.begin(), places.end(), 0);
  gather(input, shader, first, places);
  while (lattices_.size() < kLattices && step > 1) {
    step /= 2;
    Lattice fine(film, step);
    places = places_beside_near(lattices_.back(), fine);
    if (places.empty()) break;
    gather(input, shader, fine, places);
    lattices_.push_back(std::move(fine));
  }
  if (input.view != nullptr) input.view->at_places.resize(chunks_);  // removes chunks of an earlier image
}

void BouncedPlaces::gather(const RenderInput& input, const Shader& shader, Lattice& lattice,
                           std::span<const std::uint32_t> places) {
  constexpr int kMore = 4;
  const bool is_first = &lattice == &lattices_.front();
  const int rays_each = is_first
                            ? std::clamp(kOfPixel * lattice.step * lattice.step, kFewestOfPlace, kMostOfPlace)
                            : kMostOfPlace;
  gather(input, shader, lattice, places, rays_each, 0);
  const bool is_noisy = noise_of(lattice.irradiance, lattice.variance, lattice.met) > kNoisy;
  if (is_noisy) gather(input, shader, lattice, places, kMore * rays_each, kKeysOfMore);
  lattice.smooth_further();
  if (is_noisy && is_first) lattice.smooth_noise();  // the others have steep gradients
}

void BouncedPlaces::gather(const RenderInput& input, const Shader& shader, Lattice& lattice,
                           std::span<const std::uint32_t> places, int rays_each, std::uint64_t first_key) {
  const bool is_first = &lattice == &lattices_.front();
  const std::size_t lattice_index = is_first ? 0 : lattices_.size();
  std::vector<TracedRay> rays;
  std::vector<std::uint64_t> keys;
  for (const std::uint32_t place : places) {
    const int row = int(place) / lattice.columns, column = int(place) % lattice.columns;
    rays.push_back(
        {camera_.middle_ray((column - kAround) * lattice.step, (row - kAround) * lattice.step), {}});
    keys.push_back(first_key + place * kLattices + lattice_index);
  }
  intersect_from_camera(input.scene, input.rays, rays);
  const PixelWidth pixel = pixel_width(input.scene.camera, input.scene.film, input.world);
  HeldView* const view = input.view;
  const std::size_t first_chunk = chunks_;
  chunks_ += chunk_count(rays.size(), kPlacesAtOnce);
  if (view != nullptr) view->at_places.resize(std::max(chunks_, view->at_places.size()));
  std::vector<char> is_near(rays.size());
  parallel_chunks(rays.size(), kPlacesAtOnce, [&](std::size_t begin, std::size_t end, std::size_t chunk) {
    const std::vector<Shader::SeenSurfaces> seen = shader.surfaces_along(
        std::span(rays).subspan(begin, end - begin), std::span(keys).subspan(begin, end - begin));
    for (const auto& [field, hits, boundary] : seen) {
      std::vector<std::uint32_t> held_places;  // selection in a closer lattice depends on the lights
      for (const std::uint32_t ray : hits.rays) held_places.push_back(std::uint32_t(keys[begin + ray]));
      HeldView::Gathering* const held =
          view != nullptr ? &gathering_of(view->at_places[first_chunk + chunk], field, held_places) : nullptr;
      std::vector<RgbF> irradiance(hits.points.size()), further(hits.points.size()),
          squares(hits.points.size());
      std::vector<float> met(hits.points.size());
      std::vector<float> nearness(hits.points.size());  // mean inverse distance of the hits
      for_each_gathered({input.rays, shader, hits.points, hits.keys, boundary, rays_each,
                         hash_bits(input.scene.settings.seed, kSeed), held, view},
                        [&](const SurfaceLight& light) {
                          irradiance[light.point] += light.irradiance;
                          further[light.point] += light.further;
                          squares[light.point] += light.irradiance * light.irradiance;
                          if (max_component(light.irradiance) > 0) met[light.point] += 1 / float(rays_each);
                          nearness[light.point] += 1 / (float(rays_each) * light.distance);
                        });
      for (std::size_t i = 0; i < hits.points.size(); ++i) {
        if (boundary.is_textured()) {  // cached without the fuzz of the point
          const float entering = boundary.at(hits.points[i]).past_fuzz();
          irradiance[i] *= 1 / entering, further[i] *= 1 / entering;
          squares[i] *= 1 / (entering * entering);
        }
        const std::size_t k = begin + hits.rays[i], place = places[k];
        const auto spacing = float(lattice.step * pixel.at(double(rays[k].ray.far)));
        lattice.places.set(place, hits.points[i], boundary.number(), spacing);
        lattice.irradiance[place] = irradiance[i];
        lattice.further[place] = further[i];
        lattice.met[place] = met[i];
        lattice.variance[place] = squares[i] - irradiance[i] * irradiance[i] * (1 / float(rays_each));
        is_near[k] = spacing * nearness[i] > kNear;
      }
    }
  });
  for (std::size_t k = 0; k < places.size(); ++k) lattice.is_near[places[k]] = is_near[k] != 0;
}

// Cache points of the finer lattice around hits near a close pair of surfaces.
std::vector<std::uint32_t> BouncedPlaces::places_beside_near(const Lattice& coarse,
                                                             const Lattice& fine) const {
  std::vector<std::uint32_t> places;
  for (int row = 0; row < fine.rows; ++row)
    for (int column = 0; column < fine.columns; ++column) {
      const double x = (column - kAround) * fine.step + .5, y = (row - kAround) * fine.step + .5;
      const double reach = 2 * fine.step;
      bool is_beside = false;
      for (const double dy : {-reach, 0., reach})
        for (const double dx : {-reach, 0., reach})
          is_beside = is_beside || coarse.needs_closer_places({x + dx, y + dy, 1});
      if (is_beside) places.push_back(std::uint32_t(row * fine.columns + column));
    }
  return places;
}

BouncedPlaces::Lattice::Lattice(const Film& film, int pixels)
    : step(pixels),
      columns(film.resolution[0] / step + 1 + 2 * kAround),
      rows(film.resolution[1] / step + 1 + 2 * kAround),
      irradiance(std::size_t(columns) * std::size_t(rows)),
      further(irradiance.size()),
      variance(irradiance.size()),
      met(irradiance.size()),
      is_near(irradiance.size()) {
  places.resize(irradiance.size());
}

std::array<double, 2> BouncedPlaces::Lattice::in_places(const CameraRays::FilmPlace& seen) const {
  return {(seen.x - .5) / step + kAround, (seen.y - .5) / step + kAround};
}

bool BouncedPlaces::Lattice::needs_closer_places(const CameraRays::FilmPlace& seen) const {
  const auto [x, y] = in_places(seen);
  if (!(x >= 0 && y >= 0 && x < columns - 1 && y < rows - 1)) return false;
  const std::size_t above = std::size_t(y) * std::size_t(columns) + std::size_t(x),
                    below = above + std::size_t(columns);
  if (!(is_near[above] || is_near[above + 1] || is_near[below] || is_near[below + 1])) return false;
  RgbF least = irradiance[above], most = least;
  for (const std::size_t place : {above + 1, below, below + 1}) {
    least = component_min(least, irradiance[place]);
    most = component_max(most, irradiance[place]);
  }
  const RgbF apart = most - least;  // per channel: a light of another colour changes nothing
  return apart.x > kVaried * most.x || apart.y > kVaried * most.y || apart.z > kVaried * most.z;
}

std::optional<RgbF> BouncedPlaces::at(const SurfacePoint& point, const OuterBoundary& boundary) const {
  const CameraRays::FilmPlace seen = camera_.film_place(Vec3d(point.position));
  if (!(seen.depth > 0)) return {};
  for (std::size_t l = lattices_.size(); l-- > 0;) {
    if (l > 0 && !lattices_[l - 1].needs_closer_places(seen)) continue;
    const std::optional<RgbF> known = lattices_[l].at(seen, point, boundary.number());
    if (known) return boundary.is_textured() ? *known * boundary.at(point).past_fuzz() : *known;
  }
  return {};
}

std::optional<RgbF> BouncedPlaces::Lattice::at(const CameraRays::FilmPlace& seen, const SurfacePoint& point,
                                               float boundary) const {
  const auto [x, y] = in_places(seen);
  if (!(x >= 0 && y >= 0 && x < columns && y < rows)) return {};
  return mean(irradiance, x, y, point.position, point.normal, boundary);
}

std::optional<RgbF> BouncedPlaces::Lattice::mean(std::span<const RgbF> values, double x, double y,
                                                 const Vec3f& point, const Vec3f& normal,
                                                 float boundary) const {
  RgbF sum;
  float weights = 0;
  const int left = std::clamp(int(x) - 1, 0, columns - int(kBeside));
  for (int row = std::max(0, int(y) - 1); row <= std::min(rows - 1, int(y) + 2); ++row) {
    const std::size_t first = std::size_t(row) * std::size_t(columns) + std::size_t(left);
    const std::array<float, kBeside> of_row =
        places.weights({point, normal, boundary, float(x - left), float(y - row)}, first);
    for (std::size_t k = 0; k < kBeside; ++k) {
      if (!(of_row[k] > 0)) continue;
      sum += values[first + k] * of_row[k];
      weights += of_row[k];
    }
  }
  if (!(weights > kLeastWeight)) return {};
  return sum * (1 / weights);
}

template <class Combine>
void BouncedPlaces::Lattice::smooth(std::vector<RgbF>& values, int times, const Combine& combine) const {
  for (int time = 0; time < times; ++time) {
    std::vector<RgbF> smooth = values;
    parallel_chunks(values.size(), 256, [&](std::size_t begin, std::size_t end, std::size_t) {
      for (std::size_t i = begin; i < end; ++i) {
        if (!(places.boundary[i] >= 0)) continue;
        const Vec3f point(places.x[i], places.y[i], places.z[i]),
            normal(places.normal_x[i], places.normal_y[i], places.normal_z[i]);
        const std::size_t row = i / std::size_t(columns), column = i % std::size_t(columns);
        if (const std::optional<RgbF> around =
                mean(values, double(column), double(row), point, normal, places.boundary[i]))
          smooth[i] = combine(i, *around);
      }
    });
    values = std::move(smooth);
  }
}

void BouncedPlaces::Lattice::smooth_noise() {
  constexpr int kTimes = 6;
  const auto replace = [](std::size_t, const RgbF& around) { return around; };
  smooth(variance, 2, replace);  // it is unknown at places without a bright ray
  const std::vector<RgbF> own = irradiance;
  smooth(irradiance, kTimes, [&](std::size_t i, const RgbF& around) {
    return is_near[i] ? own[i] : within_noise(around, own[i], variance[i]);
  });
}

void BouncedPlaces::Lattice::smooth_further() {
  constexpr int kTimes = 6;
  if (std::ranges::all_of(further, [](const RgbF& value) { return value == RgbF{}; })) return;
  for (std::size_t place = 0; place < further.size(); ++place) irradiance[place] -= further[place];
  smooth(further, kTimes, [](std::size_t, const RgbF& around) { return around; });
  for (std::size_t place = 0; place < further.size(); ++place) irradiance[place] += further[place];
}

BouncedLight::BouncedLight(const RenderInput& input, const Shader& shader)
    : input_(input),
      shader_(shader),
      places_(input.bounced != nullptr ? input.bounced
                                       : std::make_shared<const BouncedPlaces>(input, shader)) {}

std::vector<RgbF> BouncedLight::at(const SurfaceHits& hits, const OuterBoundary& boundary,
                                   HeldView::Surface* held) const {
  std::vector<RgbF> irradiance(hits.points.size());
  std::vector<SurfacePoint> points;
  std::vector<std::uint64_t> keys;
  std::vector<std::uint32_t> alone;
  for (std::size_t i = 0; i < hits.points.size(); ++i) {
    if (const std::optional<RgbF> known = places_->at(hits.points[i], boundary)) {
      irradiance[i] = *known;
      continue;
    }
    alone.push_back(std::uint32_t(i));
    points.push_back(hits.points[i]);
    keys.push_back(hits.keys[i]);
  }
  if (alone.empty()) return irradiance;
  const std::vector<RgbF> gathered = gathered_irradiance(
      {input_.rays, shader_, points, keys, boundary, kOfHit, hash_bits(input_.scene.settings.seed, kSeed + 1),
       held != nullptr ? &gathering_of(held->gathering, alone) : nullptr, input_.view});
  for (std::size_t k = 0; k < alone.size(); ++k) irradiance[alone[k]] = gathered[k];
  return irradiance;
}

void BouncedPlaces::Places::resize(std::size_t count) {
  for (auto* values : {&x, &y, &z, &normal_x, &normal_y, &normal_z, &reach}) values->resize(count);
  boundary.resize(count, -1);
}

void BouncedPlaces::Places::set(std::size_t i, const SurfacePoint& point, float number, float spacing) {
  x[i] = point.position.x, y[i] = point.position.y, z[i] = point.position.z;
  normal_x[i] = point.normal.x, normal_y[i] = point.normal.y, normal_z[i] = point.normal.z;
  reach[i] = 2 * kOffPlane * spacing;
  boundary[i] = number;
}

std::array<float, BouncedPlaces::kBeside> BouncedPlaces::Places::weights(const Asked& asked,
                                                                         std::size_t first) const {
  const auto from = [&](const std::vector<float>& values) {
    Lanes lanes;
    std::memcpy(&lanes, values.data() + first, sizeof lanes);
    return lanes;
  };
  const auto& [point, normal, number, dx, dy] = asked;
  const Lanes across = dx - Lanes{0, 1, 2, 3}, near = 1 - (across * across + dy * dy) / 4;
  const Lanes nx = from(normal_x), ny = from(normal_y), nz = from(normal_z);
  const Lanes cosine = normal.x * nx + normal.y * ny + normal.z * nz;
  const Lanes px = point.x - from(x), py = point.y - from(y), pz = point.z - from(z);
  const Lanes off =
      (absolute(px * normal.x + py * normal.y + pz * normal.z) + absolute(px * nx + py * ny + pz * nz)) /
      from(reach);
  const Lanes alike = cosine * cosine / (1 + off * off);
  const auto counts = (near > 0) & (cosine > 0) & (from(boundary) == number);
  const Lanes weights = counts ? near * near * alike * alike : Lanes{};
  std::array<float, kBeside> each;
  std::memcpy(each.data(), &weights, sizeof weights);
  return each;
}

std::shared_ptr<const BouncedPlaces> bounced_places(const RenderInput& input) {
  return std::make_shared<const BouncedPlaces>(input, Shader(input));
}

namespace {

/// Means of values at the samples with those around them, several times; combine(i, mean): the new value.
template <class Combine>
std::vector<RgbF> smoothed(const SurfaceSamples& surface, std::vector<RgbF> values, const Combine& combine) {
  constexpr int kTimes = 3;
  constexpr float kReach = 6;             // spacings
  constexpr float kLeastAgreement = .7f;  // cosine of the normals
  const std::vector<SurfaceSample>& samples = surface.samples;
  const auto reach = float(kReach * surface.spacing());
  const NearestSample grid(samples, nullptr, kReach);
  for (int time = 0; time < kTimes; ++time) {
    std::vector<RgbF> smooth = values;
    parallel_chunks(values.size(), 256, [&](std::size_t begin, std::size_t end, std::size_t) {
      for (std::size_t i = begin; i < end; ++i) {
        RgbF sum;
        float weights = 0;
        grid.for_near(samples[i].position, reach, [&](const NearestSample::Member& member) {
          const Vec3f apart = member.position - samples[i].position;
          const float near = 1 - dot(apart, apart) / (reach * reach);
          if (!(near > 0 && dot(member.normal, samples[i].normal) > kLeastAgreement)) return;
          const float weight = near * samples[member.sample].area;
          sum += values[member.sample] * weight;
          weights += weight;
        });
        if (weights > 0) smooth[i] = combine(i, sum * (1 / weights));
      }
    });
    values = std::move(smooth);
  }
  return values;
}

}  // namespace

std::vector<std::vector<RgbF>> bounced_at_samples(const PrecomputeInput& input, std::span<const Body> bodies,
                                                  MirroredByBodies mirrored, HeldView* view) {
  const RenderInput lit{input.scene, input.world, input.rays, bodies, input.monitor, view};
  Shader shader(lit);
  shader.set_mirrored_by_bodies(mirrored);
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
    std::vector<RgbF> further(samples.size()), variance(samples.size());
    std::vector<float> met(samples.size());
    const std::uint64_t seed = hash_bits(input.scene.settings.seed, kSeed + 2 + bounced.size());
    const int rays_each = method_of(body.plan.method).gathered_rays();
    parallel_chunks(
        samples.size(), kGatheredAtOnce, [&](std::size_t begin, std::size_t end, std::size_t chunk) {
          std::vector<SurfacePoint> points;
          std::vector<std::uint64_t> keys;
          for (std::size_t i = begin; i < end; ++i) {
            const SurfaceSample& s = samples[i];
            points.push_back(input.rays.surface_point(s.mesh, s.triangle, s.u, s.v));
            points.back().width = std::sqrt(s.area);
            keys.push_back(i);
          }
          for_each_gathered({input.rays, shader, points, keys, body.boundary, rays_each, seed,
                             held != nullptr ? &(*held)[chunk] : nullptr, view},
                            [&](const SurfaceLight& light) {
                              own[begin + light.point] += light.irradiance;
                              further[begin + light.point] += light.further;
                              variance[begin + light.point] += light.irradiance * light.irradiance;
                              if (max_component(light.irradiance) > 0)
                                met[begin + light.point] += 1 / float(rays_each);
                            });
          advance(input.monitor, end - begin);
        });
    const auto is_dark = [](const RgbF& value) { return value == RgbF{}; };
    const auto replace = [](std::size_t, const RgbF& around) { return around; };
    if (std::ranges::all_of(own, is_dark)) continue;
    for (std::size_t i = 0; i < own.size(); ++i) variance[i] -= own[i] * own[i] * (1 / float(rays_each));
    if (!std::ranges::all_of(further, is_dark)) {
      const std::vector<RgbF> smooth = smoothed(body.surface, further, replace);
      for (std::size_t i = 0; i < own.size(); ++i) own[i] += smooth[i] - further[i];
    }
    if (!(noise_of(own, variance, met) > kNoisyAtSamples)) continue;
    variance = smoothed(body.surface, std::move(variance), replace);
    own = smoothed(body.surface, own, [&, first = own](std::size_t i, const RgbF& around) {
      return within_noise(around, first[i], variance[i]);
    });
  }
  return bounced;
}

}  // namespace opaline
