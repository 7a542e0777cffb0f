// SPDX-License-Identifier: GPL-3.0-or-later
#include "volume/boundary_elements.h"

#include <algorithm>
#include <cmath>

#include "opaline/core/parallel.h"
#include "opaline/geometry/surface_point.h"
#include "opaline/volume/nearest_sample.h"

namespace opaline {
namespace {

constexpr std::uint32_t kNone = ~0u;

/// Sums of what is merged to one element.
struct ElementSum {
  Vec3d position{}, normal{};  // times area
  double area = 0;
  std::uint32_t next = kNone;  // of the same cell
};

/// The elements of each cell of a lattice.
class ElementTable {
 public:
  explicit ElementTable(const Lattice& lattice)
      : lattice_(lattice),
        bricks_of_{(lattice.nx + 7) / 8, (lattice.ny + 7) / 8, (lattice.nz + 7) / 8},
        bricks_(std::size_t(bricks_of_[0]) * std::size_t(bricks_of_[1]) * std::size_t(bricks_of_[2]), kNone) {
  }

  /// Adds to the element of the cell around a place whose normal agrees, which is made if there is none.
  std::uint32_t add(const Vec3d& position, const Vec3d& normal, double area) {
    constexpr double kLeastAgreement = .9;  // of normals in one element
    std::uint32_t& first = head(lattice_.into(position));
    std::uint32_t found = first;
    while (found != kNone && dot(sums_[found].normal, normal) < kLeastAgreement * length(sums_[found].normal))
      found = sums_[found].next;
    if (found == kNone) {
      found = std::uint32_t(sums_.size());
      sums_.push_back({{}, {}, 0, first});
      first = found;
    }
    sums_[found].position += position * area;
    sums_[found].normal += normal * area;
    sums_[found].area += area;
    return found;
  }

  std::vector<BoundaryElement> take() const {
    std::vector<BoundaryElement> elements;
    elements.reserve(sums_.size());
    for (const ElementSum& sum : sums_)
      elements.push_back({Vec3f(sum.position / sum.area), Vec3f(normalized(sum.normal)), float(sum.area)});
    return elements;
  }

 private:
  std::uint32_t& head(const Vec3d& place) {
    const auto at = [](double c, int count) { return std::clamp(int(std::floor(c)), 0, count - 1); };
    const int x = at(place.x, lattice_.nx), y = at(place.y, lattice_.ny), z = at(place.z, lattice_.nz);
    std::uint32_t& brick = bricks_[std::size_t(((z / 8) * bricks_of_[1] + y / 8) * bricks_of_[0] + x / 8)];
    if (brick == kNone) {
      brick = std::uint32_t(heads_.size() / 512);
      heads_.resize(heads_.size() + 512, kNone);
    }
    return heads_[std::size_t(brick) * 512 + std::size_t(((z & 7) * 8 + (y & 7)) * 8 + (x & 7))];
  }

  const Lattice& lattice_;
  std::array<int, 3> bricks_of_;
  std::vector<std::uint32_t> bricks_, heads_;
  std::vector<ElementSum> sums_;
};

/// A convex polygon; a triangle that six planes have cut has nine corners at most.
struct Polygon {
  std::array<Vec3d, 12> corners;
  std::size_t count = 0;

  void add(const Vec3d& corner) { corners[count++] = corner; }
};

/// Cuts at the planes of integers along an axis and calls found(polygon) for each part.
template <class Found>
void cut(Polygon polygon, std::size_t axis, const Found& found) {
  double low = polygon.corners[0][axis], high = low;
  for (std::size_t i = 1; i < polygon.count; ++i) {
    low = std::min(low, polygon.corners[i][axis]);
    high = std::max(high, polygon.corners[i][axis]);
  }
  for (double plane = std::floor(low) + 1; plane < high; ++plane) {
    Polygon below, above;
    for (std::size_t i = 0; i < polygon.count; ++i) {
      const Vec3d &a = polygon.corners[i], &b = polygon.corners[i + 1 < polygon.count ? i + 1 : 0];
      const double from = a[axis] - plane, to = b[axis] - plane;
      (from < 0 ? below : above).add(a);
      if ((from < 0) == (to < 0)) continue;
      const Vec3d crossing = a + (b - a) * (from / (from - to));
      below.add(crossing);
      above.add(crossing);
    }
    if (below.count >= 3) found(below);
    polygon = above;
    if (polygon.count < 3) return;
  }
  found(polygon);
}

class Cutter {
 public:
  Cutter(const World& world, std::span<const SurfaceSample> samples, const Lattice& lattice)
      : world_(world), samples_(samples), lattice_(lattice), table_(lattice) {}

  void add(const Mesh& mesh) {
    std::vector<Vec3d> corners;
    corners.reserve(mesh.positions.size());
    for (const Vec3d& p : mesh.positions) corners.push_back(lattice_.into(p));
    for (const auto& [i, j, k] : mesh.triangles) {
      const Vec3d &a = mesh.positions[i], &b = mesh.positions[j], &c = mesh.positions[k];
      const Vec3d across = cross(b - a, c - a);
      const double doubled = length(across);
      if (!(doubled > 0)) continue;
      const Vec3d normal = across / doubled;
      Polygon triangle;
      for (const std::uint32_t corner : {i, j, k}) triangle.add(corners[corner]);
      cut(triangle, 0, [&](const Polygon& x) {
        cut(x, 1, [&](const Polygon& y) { cut(y, 2, [&](const Polygon& part) { add(part, normal); }); });
      });
    }
  }

  Boundary take() {
    const NearestSample nearest(samples_, &world_);
    parallel_chunks(normals_.size(), 1024, [&](std::size_t begin, std::size_t end, std::size_t) {
      for (std::size_t i = begin; i < end; ++i)
        boundary_.pieces[i].sample = nearest.at(boundary_.pieces[i].position, normals_[i]);
    });
    std::vector<bool> has_piece(samples_.size());
    for (const BoundaryPiece& piece : boundary_.pieces) has_piece[piece.sample] = true;
    for (std::uint32_t i = 0; i < samples_.size(); ++i) {
      if (has_piece[i]) continue;  // else no part of a triangle is nearest to it
      const SurfaceSample& s = samples_[i];
      const float area = kAlmostNothing * s.area;
      const Vec3f normal = surface_point(world_.meshes[s.mesh], s.triangle, s.u, s.v).geometric;
      boundary_.pieces.push_back(
          {s.position, area, i, table_.add(Vec3d(s.position), Vec3d(normal), double(area))});
    }
    boundary_.elements = table_.take();
    return std::move(boundary_);
  }

 private:
  static constexpr float kAlmostNothing = 1e-3f;  // of a sample's area, which other samples' pieces cover

  void add(const Polygon& part, const Vec3d& normal) {
    Vec3d sum{};
    double area = 0;
    for (std::size_t i = 2; i < part.count; ++i) {
      const Vec3d &a = part.corners[0], &b = part.corners[i - 1], &c = part.corners[i];
      const double doubled = dot(cross(b - a, c - a), normal);
      sum += (a + b + c) * doubled;
      area += doubled;
    }
    area *= .5;
    if (!(area > kLeastArea)) return;
    const Vec3d position = sum / (6 * area) * lattice_.cell + lattice_.low;
    area *= lattice_.cell * lattice_.cell;
    const std::uint32_t element = table_.add(position, normal, area);
    boundary_.pieces.push_back({Vec3f(position), float(area), 0, element});
    normals_.push_back(Vec3f(normal));
  }

  static constexpr double kLeastArea = 1e-9;  // of a cell's face

  const World& world_;
  std::span<const SurfaceSample> samples_;
  const Lattice& lattice_;
  ElementTable table_;
  Boundary boundary_;
  std::vector<Vec3f> normals_;  // of the pieces
};

}  // namespace

Boundary cut_boundary(const World& world, std::span<const std::uint32_t> meshes,
                      std::span<const SurfaceSample> samples, const Lattice& lattice) {
  Cutter cutter(world, samples, lattice);
  for (const std::uint32_t m : meshes) cutter.add(world.meshes[m]);
  return cutter.take();
}

Boundary coarsened(const Boundary& boundary, const Lattice& doubled) {
  ElementTable table(doubled);
  std::vector<std::uint32_t> places;
  for (const BoundaryElement& element : boundary.elements)
    places.push_back(table.add(Vec3d(element.position), Vec3d(element.normal), double(element.area)));
  Boundary result{table.take(), boundary.pieces};
  for (BoundaryPiece& piece : result.pieces) piece.element = places[piece.element];
  return result;
}

}  // namespace opaline
