// SPDX-License-Identifier: GPL-3.0-or-later
#include "sampling/draft_samples.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <tuple>

#include "core/cancel_check.h"
#include "core/morton.h"
#include "core/random.h"
#include "geometry/surface_point.h"

namespace opaline {
namespace {

constexpr std::uint32_t kCells = 32;  // along each axis: finer order is unnecessary

struct Piece {
  std::uint32_t mesh, triangle;
  double area;
  Vec3d centre;
};

std::vector<Piece> pieces_of(const World& world, std::span<const std::uint32_t> meshes) {
  std::vector<Piece> pieces;
  for (const std::uint32_t m : meshes) {
    const Mesh& mesh = world.meshes[m];
    pieces.reserve(pieces.size() + mesh.triangles.size());
    for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
      const auto& corner = mesh.triangles[t];
      const Vec3d a = mesh.positions[corner[0]], b = mesh.positions[corner[1]], c = mesh.positions[corner[2]];
      pieces.push_back({m, t, length(cross(b - a, c - a)) / 2, (a + b + c) / 3.0});
    }
  }
  return pieces;
}

/// Indices of the pieces by cell along the Morton curve, in file order within each.
std::vector<std::uint32_t> morton_order(const std::vector<Piece>& pieces) {
  Vec3d low = pieces[0].centre, high = low;
  for (const Piece& piece : pieces) widen(low, high, piece.centre);
  const Vec3d size = high - low;
  const double largest = std::max({size.x, size.y, size.z}), scale = largest > 0 ? (kCells - 1) / largest : 0;
  std::vector<std::uint32_t> cells, first(kCells * kCells * kCells + 1), order(pieces.size());
  cells.reserve(pieces.size());
  for (const Piece& piece : pieces) {
    const Vec3d p = (piece.centre - low) * scale;
    cells.push_back(std::uint32_t(morton_key(std::uint64_t(p.x), std::uint64_t(p.y), std::uint64_t(p.z))));
    ++first[cells.back() + 1];
  }
  std::partial_sum(first.begin(), first.end(), first.begin());
  for (std::uint32_t i = 0; i < order.size(); ++i) order[first[cells[i]]++] = i;
  return order;
}

/// Centroid of a triangle, or a random point of one with several samples.
SurfaceSample sample_on(const World& world, const Piece& piece, double share, const Vec3d& centroid,
                        std::size_t index) {
  SurfaceSample sample;
  sample.mesh = piece.mesh;
  sample.triangle = piece.triangle;
  sample.u = sample.v = 1 / 3.f;
  const bool has_several = piece.area > share;
  if (has_several) {
    const auto [u, v] = r2_point(index, {.5, .5});
    sample.u = float(u + v > 1 ? 1 - u : u);
    sample.v = float(u + v > 1 ? 1 - v : v);
  }
  const SurfacePoint point = surface_point(world.meshes[piece.mesh], piece.triangle, sample.u, sample.v);
  sample.position = point.position;
  sample.normal = point.normal;
  sample.area = float(share);
  sample.centroid = has_several ? point.position : Vec3f(centroid);
  return sample;
}

}  // namespace

SurfaceSamples draft_samples(const World& world, std::span<const std::uint32_t> meshes, std::size_t count) {
  const std::vector<Piece> pieces = pieces_of(world, meshes);
  SurfaceSamples result;
  for (const Piece& piece : pieces) result.area += piece.area;
  if (!(result.area > 0)) return result;
  const double share = result.area / double(count);
  result.radius = .7 * std::sqrt(share);
  std::vector<SurfaceSample>& samples = result.samples;
  samples.reserve(count);
  double missing = share;  // remaining area of the current part
  Vec3d moment{};
  std::uint32_t middle = 0;
  const auto take = [&](std::uint32_t p, double area) {
    if (missing > share / 2 && missing - area <= share / 2) middle = p;
    missing -= area;
    moment += pieces[p].centre * area;
  };
  const CancelCheck check;
  const auto finish = [&] {
    check();
    samples.push_back(sample_on(world, pieces[middle], share, moment / share, samples.size()));
    moment = {};
    missing = share;
  };
  for (const std::uint32_t p : morton_order(pieces)) {
    double left = pieces[p].area;
    while (left >= missing && samples.size() < count) {
      left -= missing;
      take(p, missing);
      finish();
    }
    take(p, left);
  }
  if (samples.size() < count) finish();  // remainder of rounding
  std::ranges::sort(samples, {}, [&](const SurfaceSample& s) {
    check();
    return std::tie(s.mesh, s.triangle, s.u, s.v);
  });
  return result;
}

}  // namespace opaline
