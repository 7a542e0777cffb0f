// SPDX-License-Identifier: GPL-3.0-or-later
#include "sampling/sample_surface.h"

#include <tbb/parallel_sort.h>

#include <algorithm>
#include <tuple>

#include "core/cancel_check.h"
#include "core/parallel.h"
#include "geometry/surface_point.h"
#include "opaline/error.h"
#include "sampling/cell_parts.h"
#include "sampling/poisson_disk.h"

namespace opaline {
namespace {

// Radius over sqrt(area / count) for 6 rounds; test_density checks the resulting count.
constexpr double kRadiusPerSpacing = 0.7195;

// Ratio of samples to the requested number at which rounds stop. Six rounds on a smooth surface are within
// 3 % of the number.
constexpr double kEnough = 1.1;

// Unsorted samples.
struct PlacedSamples {
  std::vector<SampleGrid::Place> places;
  std::vector<SurfaceShare> shares;
  std::vector<SurfacePiece> pieces;  // on request
};

PlacedSamples place_samples(const SamplingInput& input, const TriangleList& triangles, float radius,
                            bool want_pieces) {
  PoissonDisk poisson(triangles, bounds(input.world, input.meshes), radius);
  // Where the surface is thinner than the radius, darts never meet, and each round adds as many samples.
  const auto enough = std::size_t(kEnough * double(input.count));
  for (int round = 0; round < input.candidate_rounds && poisson.grid().size() <= enough; ++round)
    poisson.throw_darts(input.count, hash_bits(input.seed, std::uint64_t(round)), input.monitor);
  poisson.cover_centroids(input.monitor);
  poisson.grid().finish();
  std::vector<SurfacePiece> pieces;
  std::vector<SurfaceShare> shares =
      surface_shares(triangles, poisson.grid(), radius, input.monitor, want_pieces ? &pieces : nullptr);
  return {poisson.grid().take_places(), std::move(shares), std::move(pieces)};
}

struct Ordered {
  std::uint64_t id;  // mesh and triangle
  std::uint32_t sample;
};

std::vector<Ordered> order_of(const std::vector<SampleGrid::Place>& places, const TriangleList& triangles) {
  const CancelCheck check;
  std::vector<Ordered> order(places.size());
  parallel_chunks(order.size(), 4096, [&](std::size_t begin, std::size_t end, std::size_t) {
    for (std::size_t i = begin; i < end; ++i) {
      const TriangleId id = triangles.id(places[i].triangle);
      order[i] = {std::uint64_t(id.mesh) << 32 | id.triangle, std::uint32_t(i)};
    }
  });
  tbb::parallel_sort(order, [&](const Ordered& a, const Ordered& b) {
    check();
    if (a.id != b.id) return a.id < b.id;
    const SampleGrid::Place &p = places[a.sample], &q = places[b.sample];
    return std::tie(p.u, p.v) < std::tie(q.u, q.v);
  });
  return order;
}

SurfaceSample make_sample(const TriangleList& triangles, const SampleGrid::Place& place,
                          const SurfaceShare& share) {
  const TriangleId id = triangles.id(place.triangle);
  const SurfacePoint point = surface_point(triangles.mesh(id), id.triangle, place.u, place.v);
  const Vec3f offset = share.area > 0 ? Vec3f(share.moment / share.area) : Vec3f{};
  return {id.mesh,        id.triangle,  place.u,           place.v,
          point.position, point.normal, float(share.area), point.position + offset};
}

}  // namespace

double SurfaceSamples::spacing() const {
  return samples.empty() ? 0 : std::sqrt(area / double(samples.size()));
}

SurfaceSamples sample_surface(const SamplingInput& input, SurfaceCells* cells) {
  const TriangleList triangles(input.world, input.meshes);
  SurfaceSamples result;
  result.area = triangles.area();
  if (triangles.size() == 0) return result;
  require(triangles.size() < 0xFFFFFFFFu, "fewer than 2^32 triangles in a group");
  require(input.count >= 1, "at least one sample");
  const float radius = float(kRadiusPerSpacing * std::sqrt(result.area / double(input.count)));
  result.radius = double(radius);
  if (input.monitor != nullptr)
    input.monitor->begin("sampling",
                         input.count * std::size_t(input.candidate_rounds) + 2 * triangles.size());

  const PlacedSamples placed = place_samples(input, triangles, radius, cells != nullptr);
  const std::vector<Ordered> order = order_of(placed.places, triangles);
  result.samples.resize(order.size());
  parallel_chunks(order.size(), 1024, [&](std::size_t begin, std::size_t end, std::size_t) {
    advance(input.monitor, 0);
    for (std::size_t i = begin; i < end; ++i)
      result.samples[i] =
          make_sample(triangles, placed.places[order[i].sample], placed.shares[order[i].sample]);
  });
  if (cells == nullptr) return result;
  std::vector<std::uint32_t> numbers(order.size());
  std::ranges::transform(order, numbers.begin(), &Ordered::sample);
  *cells = collect_cells(triangles, placed.pieces, numbers, input.meshes);
  return result;
}

}  // namespace opaline
