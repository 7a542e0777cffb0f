// SPDX-License-Identifier: GPL-3.0-or-later
#include "volume/light_entry.h"

#include <algorithm>

#include "core/morton.h"
#include "lights/light.h"

namespace opaline {
namespace {

/// Possible contribution of a light.
struct Offer {
  LightSample sample{};
  Rgb irradiance{};
  double size = 0;  ///< the largest channel
};

Offer offer_of(const Light& light, bool unit_emission, const SurfacePoint& point, WalkNumbers& numbers) {
  const std::array<double, 2> square{numbers.next(), numbers.next()};
  const LightSample sample = sample_light(light, point.position, point.geometric, square, 1);
  const double cosine = double(dot(point.geometric, sample.direction));
  if (!(sample.weight > 0 && cosine > 0)) return {};
  const Rgb irradiance = (unit_emission ? Rgb(1) : emission(light)) * (double(sample.weight) * cosine);
  return {sample, irradiance, max_component(irradiance)};
}

/// Barycentrics of a point in one of a triangle's count^2 equal pieces: rows of upright and inverted ones.
std::array<double, 2> place_in_piece(std::uint32_t count, std::uint32_t index, double u, double v) {
  // Rows counted from the edge opposite the third corner: row r has 2 (count - r) - 1 pieces.
  std::uint32_t row = 0, before = 0;
  while (before + 2 * (count - row) - 1 <= index) before += 2 * (count - row++) - 1;
  const std::uint32_t place = index - before, column = place / 2;
  const double size = 1 / double(count);
  if (place % 2 == 1) return {(double(column) + 1 - u) * size, (double(row) + 1 - v) * size};
  return {(double(column) + u) * size, (double(row) + v) * size};
}

/// Along the Morton curve of a cube with unit edges.
std::uint64_t key_of(const Vec3d& place) {
  const auto coordinate = [](double c) { return std::uint32_t(std::clamp(c, 0.0, 1.0) * 1048575); };
  return morton_key(coordinate(place.x), coordinate(place.y), coordinate(place.z));
}

}  // namespace

EvenPoints::EvenPoints(const RayScene& rays, const World& world, std::span<const std::uint32_t> meshes,
                       double largest_piece)
    : rays_(rays) {
  struct Placed {
    std::uint64_t key;
    Piece piece;
    double area;
  };
  const Bounds box = bounds(world, meshes);
  const double scale = 1 / std::max(1e-300, max_component(box.high - box.low));
  std::vector<Placed> placed;
  for (const std::uint32_t m : meshes) {
    const Mesh& mesh = world.meshes[m];
    for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
      const auto& [i, j, k] = mesh.triangles[t];
      const Vec3d &a = mesh.positions[i], ab = mesh.positions[j] - a, ac = mesh.positions[k] - a;
      const double area = .5 * length(cross(ab, ac));
      const auto count = std::uint32_t(std::clamp(std::ceil(std::sqrt(area / largest_piece)), 1.0, 4096.0));
      for (std::uint32_t p = 0; p < count * count; ++p) {
        const auto [u, v] = place_in_piece(count, p, 1 / 3.0, 1 / 3.0);
        placed.push_back({key_of((a + ab * u + ac * v - box.low) * scale),
                          {m, t, count, p},
                          area / (double(count) * double(count))});
      }
    }
  }
  std::ranges::stable_sort(placed, {}, &Placed::key);
  double sum = 0;
  for (const Placed& p : placed) {
    pieces_.push_back(p.piece);
    ends_.push_back(sum += p.area);
  }
}

EvenPoint EvenPoints::at(double share, double u, double v, std::size_t& hint) const {
  const double area_before = share * area();
  constexpr std::size_t kSteps = 16;
  for (std::size_t step = 0; step < kSteps && hint + 1 < ends_.size() && ends_[hint] <= area_before; ++step)
    ++hint;
  const bool is_here = ends_[hint] > area_before && (hint == 0 || ends_[hint - 1] <= area_before);
  if (!is_here) {
    const auto found = std::ranges::upper_bound(ends_, area_before);
    hint = std::min(std::size_t(found - ends_.begin()), ends_.size() - 1);
  }
  const Piece& piece = pieces_[hint];
  if (u + v > 1) u = 1 - u, v = 1 - v;
  const auto [in_u, in_v] = place_in_piece(piece.pieces, piece.index, u, v);
  const auto place_u = float(in_u), place_v = float(in_v);
  return {rays_.surface_point(piece.mesh, piece.triangle, place_u, place_v), piece.mesh, piece.triangle,
          place_u, place_v};
}

// Resampled importance sampling (Talbot et al. 2005): chooses among candidate points on the lights by
// unoccluded irradiance. Candidates are far cheaper than a walk.
ArrivedLight light_at(const RayScene& rays, std::span<const Light> lights, bool unit_emission,
                      const SurfacePoint& point, WalkNumbers& numbers) {
  constexpr int kCandidates = 16;
  Offer taken;
  double sum = 0;
  for (const Light& light : lights) {
    const int candidates = is_delta(light) ? 1 : kCandidates;
    for (int i = 0; i < candidates; ++i) {
      Offer offer = offer_of(light, unit_emission, point, numbers);
      const double size = offer.size / candidates;
      sum += size;
      if (size > 0 && (size == sum || numbers.next() * sum < size)) taken = offer;
    }
  }
  if (!(taken.size > 0)) return {};
  Ray shadow(point.position + point.geometric * rays.offset(point), taken.sample.direction,
             taken.sample.distance * 0.9999f);
  rays.occluded({&shadow, 1});
  if (shadow.far < 0) return {};
  return {-Vec3d(taken.sample.direction), taken.irradiance * (sum / taken.size)};
}

}  // namespace opaline
