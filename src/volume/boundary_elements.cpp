// SPDX-License-Identifier: GPL-3.0-or-later
#include "volume/boundary_elements.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <tuple>

#include "core/cancel_check.h"
#include "opaline/geometry/surface_point.h"

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

  /// Adds to the element of the cell around a place whose sheet it is on, which is made if there is none.
  std::uint32_t add(const Vec3d& position, const Vec3d& normal, double area) {
    check_();
    std::uint32_t& first = head(lattice_.into(position));
    std::uint32_t found = first;
    while (found != kNone && !is_of(sums_[found], position, normal)) found = sums_[found].next;
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

  std::vector<BoundaryElement> elements() const {
    std::vector<BoundaryElement> elements;
    elements.reserve(sums_.size());
    for (const ElementSum& sum : sums_)
      elements.push_back({Vec3f(sum.position / sum.area), Vec3f(normalized(sum.normal)), float(sum.area)});
    return elements;
  }

 private:
  bool is_of(const ElementSum& sum, const Vec3d& position, const Vec3d& normal) const {
    constexpr double kLeastAgreement = .9;  // of normals in one element
    constexpr double kFarthest = .3;        // cells, above or below it
    const double along = length(sum.normal);
    if (dot(sum.normal, normal) < kLeastAgreement * along) return false;
    return std::abs(dot(position - sum.position / sum.area, sum.normal)) <= kFarthest * lattice_.cell * along;
  }

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

  const CancelCheck check_;
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

/// What a triangle has of an element.
struct Part {
  Vec3f position;  // mean
  std::uint32_t mesh, triangle, element;
};

class Cutter {
 public:
  Cutter(const World& world, const Lattice& lattice) : world_(world), lattice_(lattice), table_(lattice) {}

  void add(std::uint32_t m) {
    const Mesh& mesh = world_.meshes[m];
    std::vector<Vec3d> corners;
    corners.reserve(mesh.positions.size());
    for (const Vec3d& p : mesh.positions) corners.push_back(lattice_.into(p));
    for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
      const auto& [i, j, k] = mesh.triangles[t];
      const Vec3d &a = mesh.positions[i], &b = mesh.positions[j], &c = mesh.positions[k];
      const Vec3d across = cross(b - a, c - a);
      const double doubled = length(across);
      if (!(doubled > 0)) continue;
      const Vec3d normal = across / doubled;
      Polygon triangle;
      for (const std::uint32_t corner : {i, j, k}) triangle.add(corners[corner]);
      cut(triangle, 0, [&](const Polygon& x) {
        cut(x, 1,
            [&](const Polygon& y) { cut(y, 2, [&](const Polygon& part) { add(part, normal, m, t); }); });
      });
    }
  }

  CutSurface take() const {
    const std::vector<BoundaryElement> elements = table_.elements();
    const std::vector<const Part*> middles = middles_of(elements);
    std::vector<std::uint32_t> order(elements.size());
    std::iota(order.begin(), order.end(), 0u);
    std::ranges::sort(order, {},
                      [&](std::uint32_t i) { return std::tuple(middles[i]->mesh, middles[i]->triangle, i); });
    CutSurface result;
    for (const std::uint32_t i : order) {
      result.surface.samples.push_back(sample_of(elements[i], *middles[i]));
      result.normals.push_back(elements[i].normal);
      result.surface.area += double(elements[i].area);
    }
    return result;
  }

 private:
  static constexpr double kLeastArea = 1e-9;  // of a cell's face

  void add(const Polygon& part, const Vec3d& normal, std::uint32_t mesh, std::uint32_t triangle) {
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
    parts_.push_back({Vec3f(position), mesh, triangle, table_.add(position, normal, area)});
  }

  // Of each element the part next to its middle.
  std::vector<const Part*> middles_of(std::span<const BoundaryElement> elements) const {
    std::vector<const Part*> middles(elements.size());
    std::vector<float> distances(elements.size(), INFINITY);
    for (const Part& part : parts_) {
      const Vec3f apart = part.position - elements[part.element].position;
      const float distance = dot(apart, apart);
      if (!(distance < distances[part.element])) continue;
      distances[part.element] = distance;
      middles[part.element] = &part;
    }
    return middles;
  }

  // On the part's triangle: under the element's middle, or in that of the part.
  SurfaceSample sample_of(const BoundaryElement& element, const Part& part) const {
    const Mesh& mesh = world_.meshes[part.mesh];
    const auto& [i, j, k] = mesh.triangles[part.triangle];
    const Vec3d corner = mesh.positions[i], b = mesh.positions[j] - corner, c = mesh.positions[k] - corner;
    const Vec3d normal = cross(b, c);
    float u = 0, v = 0;
    for (const Vec3f& place : {element.position, part.position}) {
      const Vec3d apart = Vec3d(place) - corner;
      u = float(dot(cross(apart, c), normal) / dot(normal, normal));
      v = float(dot(cross(b, apart), normal) / dot(normal, normal));
      if (u >= 0 && v >= 0 && u + v <= 1) break;
    }
    u = std::clamp(u, 0.f, 1.f);
    v = std::clamp(v, 0.f, 1 - u);
    const SurfacePoint point = surface_point(mesh, part.triangle, u, v);
    return {part.mesh, part.triangle, u, v, point.position, point.normal, element.area, element.position};
  }

  const World& world_;
  const Lattice& lattice_;
  ElementTable table_;
  std::vector<Part> parts_;
};

}  // namespace

CutSurface cut_by_lattice(const World& world, std::span<const std::uint32_t> meshes, const Lattice& lattice) {
  Cutter cutter(world, lattice);
  for (const std::uint32_t m : meshes) cutter.add(m);
  return cutter.take();
}

Boundary merged(std::span<const BoundaryElement> samples, const Lattice& lattice) {
  ElementTable table(lattice);
  Boundary result;
  for (const BoundaryElement& sample : samples)
    result.of_sample.push_back(table.add(Vec3d(sample.position), Vec3d(sample.normal), double(sample.area)));
  result.elements = table.elements();
  return result;
}

}  // namespace opaline
