// SPDX-License-Identifier: GPL-3.0-or-later
#include "volume/boundary_elements.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <optional>
#include <set>
#include <tuple>

#include "core/cancel_check.h"
#include "core/parallel.h"
#include "geometry/surface_point.h"
#include "geometry/vertex_normals.h"
#include "volume/outer_surface.h"

namespace opaline {
namespace {

constexpr std::uint32_t kNone = ~0u;

/// Sums of the parts merged into one element.
struct ElementSum {
  Vec3d position{}, normal{};  // times area
  double area = 0;
  std::uint32_t next = kNone;  // next element of the same cell
  bool faces_back = false;     // true if it faces another element of the cell
};

/// The elements of each cell of a lattice.
class ElementTable {
 public:
  explicit ElementTable(const Lattice& lattice)
      : lattice_(&lattice),
        bricks_of_{(lattice.nx + 7) / 8, (lattice.ny + 7) / 8, (lattice.nz + 7) / 8},
        bricks_(std::size_t(bricks_of_[0]) * std::size_t(bricks_of_[1]) * std::size_t(bricks_of_[2]), kNone) {
  }

  /// Adds a part to the element of its cell and sheet, or to a new one; returns the element.
  std::uint32_t add(const Vec3d& position, const Vec3d& normal, double area) {
    check_();
    std::uint32_t& first = head(lattice_->into(position));
    std::uint32_t found = first;
    bool faces_back = false;
    for (; found != kNone && !is_of(sums_[found], position, normal); found = sums_[found].next)
      if (is_opposite(sums_[found], normal)) faces_back = sums_[found].faces_back = true;
    if (found == kNone) {
      found = std::uint32_t(sums_.size());
      sums_.push_back({{}, {}, 0, first});
      first = found;
    }
    sums_[found].position += position * area;
    sums_[found].normal += normal * area;
    sums_[found].area += area;
    sums_[found].faces_back |= faces_back;
    return found;
  }

  /// True if another sheet in the element's cell faces the other way: a thin part, or a fold.
  bool faces_back(std::uint32_t element) const { return sums_[element].faces_back; }

  std::vector<BoundaryElement> elements() const {
    std::vector<BoundaryElement> elements;
    elements.reserve(sums_.size());
    for (const ElementSum& sum : sums_)
      elements.push_back({Vec3f(sum.position / sum.area), Vec3f(normalized(sum.normal)), float(sum.area)});
    return elements;
  }

 private:
  bool is_of(const ElementSum& sum, const Vec3d& position, const Vec3d& normal) const {
    constexpr double kLeastAgreement = .9;  // least agreement of normals in one element
    constexpr double kFarthest = .3;        // cells, above or below it
    const double along = length(sum.normal);
    if (dot(sum.normal, normal) < kLeastAgreement * along) return false;
    return std::abs(dot(position - sum.position / sum.area, sum.normal)) <=
           kFarthest * lattice_->cell * along;
  }

  static bool is_opposite(const ElementSum& sum, const Vec3d& normal) {
    constexpr double kOpposite = -.5;
    return dot(sum.normal, normal) < kOpposite * length(sum.normal);
  }

  std::uint32_t& head(const Vec3d& place) {
    const auto at = [](double c, int count) { return std::clamp(int(std::floor(c)), 0, count - 1); };
    const int x = at(place.x, lattice_->nx), y = at(place.y, lattice_->ny), z = at(place.z, lattice_->nz);
    std::uint32_t& brick = bricks_[std::size_t(((z / 8) * bricks_of_[1] + y / 8) * bricks_of_[0] + x / 8)];
    if (brick == kNone) {
      brick = std::uint32_t(heads_.size() / 512);
      heads_.resize(heads_.size() + 512, kNone);
    }
    return heads_[std::size_t(brick) * 512 + std::size_t(((z & 7) * 8 + (y & 7)) * 8 + (x & 7))];
  }

  CancelCheck check_;
  const Lattice* lattice_;
  std::array<int, 3> bricks_of_;
  std::vector<std::uint32_t> bricks_, heads_;
  std::vector<ElementSum> sums_;
};

/// A convex polygon; a triangle clipped by six planes has at most nine corners.
struct Polygon {
  std::array<Vec3d, 12> corners;
  std::size_t count = 0;

  void add(const Vec3d& corner) { corners[count++] = corner; }
};

/// Clips at the integer planes of an axis and calls found(polygon) for each part.
template <class Found>
void cut(const Polygon& whole, std::size_t axis, const Found& found) {
  double low = whole.corners[0][axis], high = low;
  for (std::size_t i = 1; i < whole.count; ++i) {
    low = std::min(low, whole.corners[i][axis]);
    high = std::max(high, whole.corners[i][axis]);
  }
  double plane = std::floor(low) + 1;
  if (!(plane < high)) return found(whole);
  for (Polygon polygon = whole;; ++plane) {
    if (!(plane < high)) return found(polygon);
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
}

/// Part of a triangle in an element.
struct Part {
  Vec3f position;  // mean
  std::uint32_t mesh, triangle, element;
  bool is_piece = false;   // other pieces of its triangle may lie inside the body
  bool is_turned = false;  // its triangle faces into the body
};

class Cutter {
 public:
  Cutter(const World& world, const Lattice& lattice) : world_(world), lattice_(lattice), table_(lattice) {}

  /// Cuts in parallel, and adds the parts in the order of their triangles.
  void add(std::uint32_t m) {
    const std::vector<Vec3d> corners = corners_of(m);
    const std::size_t triangles = world_.meshes[m].triangles.size();
    constexpr std::size_t kAtOnce = 256, kChunks = 256;  // triangles of a chunk, chunks in memory
    for (std::size_t first = 0; first < triangles; first += kAtOnce * kChunks) {
      std::array<std::vector<CutPart>, kChunks> chunks;
      parallel_chunks(std::min(triangles - first, kAtOnce * kChunks), kAtOnce,
                      [&](std::size_t begin, std::size_t end, std::size_t chunk) {
                        for (std::size_t t = first + begin; t < first + end; ++t)
                          cut_triangle(m, std::uint32_t(t), corners,
                                       [&](const Polygon& part, const Vec3d& normal) {
                                         if (const std::optional<Placed> placed = placed_of(part, normal))
                                           chunks[chunk].push_back({*placed, normal, std::uint32_t(t)});
                                       });
                      });
      for (const std::vector<CutPart>& chunk : chunks)
        for (const auto& [placed, normal, t] : chunk) add(placed, normal, m, t);
    }
  }

  /// Removes parts not bounding the solid, in smaller pieces around such parts.
  void keep_outer(const RayScene& rays, std::span<const std::uint32_t> meshes) {
    constexpr double kLeastGap = .5;  // cells
    const OuterSurface outer(rays, world_, meshes, kLeastGap * lattice_.cell);
    const std::vector<bool> is_folded = folded_parts(outer, meshes);
    if (is_folded.empty()) return;
    parts_.clear();
    table_ = ElementTable(lattice_);
    std::size_t next = 0;
    for (const std::uint32_t m : meshes) {
      const std::vector<Vec3d> corners = corners_of(m);
      for (std::uint32_t t = 0; t < world_.meshes[m].triangles.size(); ++t)
        cut_triangle(m, t, corners, [&](const Polygon& part, const Vec3d& normal) {
          const std::optional<Placed> placed = placed_of(part, normal);
          if (!placed) return;
          if (is_folded[next++])
            add_pieces(outer, part, normal, m, t);
          else
            add(*placed, normal, m, t);
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
    result.surface.samples.resize(order.size());
    parallel_chunks(order.size(), 1024, [&](std::size_t begin, std::size_t end, std::size_t) {
      for (std::size_t s = begin; s < end; ++s)
        result.surface.samples[s] = sample_of(elements[order[s]], *middles[order[s]]);
    });
    for (const std::uint32_t i : order) {
      result.normals.push_back(elements[i].normal);
      result.surface.area += double(elements[i].area);
    }
    return result;
  }

 private:
  static constexpr double kLeastArea = 1e-9;  // least area of a cell's face

  struct Placed {
    Vec3d position;  // mean
    double area;
  };
  struct CutPart {
    Placed placed;
    Vec3d normal;
    std::uint32_t triangle;
  };

  std::vector<Vec3d> corners_of(std::uint32_t m) const {
    std::vector<Vec3d> corners;
    corners.reserve(world_.meshes[m].positions.size());
    for (const Vec3d& p : world_.meshes[m].positions) corners.push_back(lattice_.into(p));
    return corners;
  }

  /// Calls found(polygon, normal) for the part of a triangle in each cell.
  template <class Found>
  void cut_triangle(std::uint32_t m, std::uint32_t t, std::span<const Vec3d> corners,
                    const Found& found) const {
    const Mesh& mesh = world_.meshes[m];
    const auto& [i, j, k] = mesh.triangles[t];
    const Vec3d &a = mesh.positions[i], &b = mesh.positions[j], &c = mesh.positions[k];
    const Vec3d across = cross(b - a, c - a);
    const double doubled = length(across);
    if (!(doubled > 0)) return;
    const Vec3d normal = across / doubled;
    Polygon triangle;
    for (const std::uint32_t corner : {i, j, k}) triangle.add(corners[corner]);
    cut(triangle, 0, [&](const Polygon& x) {
      cut(x, 1, [&](const Polygon& y) { cut(y, 2, [&](const Polygon& part) { found(part, normal); }); });
    });
  }

  /// In the world; none if the part is too small.
  std::optional<Placed> placed_of(const Polygon& part, const Vec3d& normal) const {
    Vec3d sum{};
    double area = 0;
    for (std::size_t i = 2; i < part.count; ++i) {
      const Vec3d &a = part.corners[0], &b = part.corners[i - 1], &c = part.corners[i];
      const double doubled = dot(cross(b - a, c - a), normal);
      sum += (a + b + c) * doubled;
      area += doubled;
    }
    area *= .5;
    if (!(area > kLeastArea)) return {};
    return Placed{sum / (6 * area) * lattice_.cell + lattice_.low, area * (lattice_.cell * lattice_.cell)};
  }

  void add(const Placed& placed, const Vec3d& normal, std::uint32_t mesh, std::uint32_t triangle) {
    parts_.push_back(
        {Vec3f(placed.position), mesh, triangle, table_.add(placed.position, normal, placed.area)});
  }

  Vec3d unit_normal(std::uint32_t mesh, std::uint32_t triangle) const {
    const std::vector<Vec3d>& positions = world_.meshes[mesh].positions;
    const auto& [i, j, k] = world_.meshes[mesh].triangles[triangle];
    return normalized(cross(positions[j] - positions[i], positions[k] - positions[i]));
  }

  using Place = std::array<int, 3>;
  Place place_of(const Vec3f& position) const {
    const Vec3d p = lattice_.into(Vec3d(position));
    return {int(std::floor(p.x)), int(std::floor(p.y)), int(std::floor(p.z))};
  }

  /// Flags parts of triangles reversed by a fold.
  std::vector<std::uint8_t> reversed_parts(std::span<const std::uint32_t> meshes) const {
    std::vector<std::uint8_t> result(parts_.size());
    std::set<std::array<std::uint32_t, 2>> reversed;
    for (const std::uint32_t m : meshes)
      for (const std::uint32_t t : reversed_triangles(world_.meshes[m])) reversed.insert({m, t});
    for (std::size_t i = 0; i < parts_.size() && !reversed.empty(); ++i)
      result[i] = reversed.contains({parts_[i].mesh, parts_[i].triangle});
    return result;
  }

  /// Flags parts in and around cells with a reversed piece or one that is not a plain boundary; empty: there
  /// is none.
  std::vector<bool> folded_parts(const OuterSurface& outer, std::span<const std::uint32_t> meshes) const {
    const auto piece_of = [&](std::size_t i) -> BoundaryPiece {
      const Part& part = parts_[i];
      return {part.position, unit_normal(part.mesh, part.triangle), part.mesh, part.triangle};
    };
    const bool has_inner = outer.has_inner(parts_.size(), piece_of);  // false: at most folds
    std::vector<std::uint8_t> is_folded = reversed_parts(meshes);
    parallel_chunks(parts_.size(), 1024, [&](std::size_t begin, std::size_t end, std::size_t) {
      for (std::size_t i = begin; i < end; ++i)
        if (has_inner || table_.faces_back(parts_[i].element)) is_folded[i] |= !outer.is_plain(piece_of(i));
    });
    std::set<Place> folded;
    for (std::size_t i = 0; i < parts_.size(); ++i) {
      if (is_folded[i] == 0) continue;
      const auto [x, y, z] = place_of(parts_[i].position);
      for (int n = 0; n < 27; ++n) folded.insert({x + n % 3 - 1, y + n / 3 % 3 - 1, z + n / 9 - 1});
    }
    if (folded.empty()) return {};
    std::vector<bool> result;
    for (const Part& part : parts_) result.push_back(folded.contains(place_of(part.position)));
    return result;
  }

  void add_pieces(const OuterSurface& outer, const Polygon& part, const Vec3d& normal, std::uint32_t mesh,
                  std::uint32_t triangle) {
    constexpr int kSplit = 3;  // subdivision of each side of a triangle
    for (std::size_t i = 2; i < part.count; ++i) {
      const Vec3d &a = part.corners[0], b = part.corners[i - 1] - a, c = part.corners[i] - a;
      const double area = .5 * dot(cross(b, c), normal) / (kSplit * kSplit);
      for (int v = 0; v < kSplit; ++v)
        for (int u = 0; u + v < kSplit; ++u) {
          add_piece(outer, a + b * ((u + 1 / 3.) / kSplit) + c * ((v + 1 / 3.) / kSplit), area, normal, mesh,
                    triangle);
          if (u + v + 1 < kSplit)
            add_piece(outer, a + b * ((u + 2 / 3.) / kSplit) + c * ((v + 2 / 3.) / kSplit), area, normal,
                      mesh, triangle);
        }
    }
  }

  /// middle, area: in the lattice
  void add_piece(const OuterSurface& outer, const Vec3d& middle, double area, const Vec3d& normal,
                 std::uint32_t mesh, std::uint32_t triangle) {
    const Vec3d position = middle * lattice_.cell + lattice_.low;
    const auto [share, is_turned] = outer.of({Vec3f(position), normal, mesh, triangle});
    area *= double(share) * lattice_.cell * lattice_.cell;
    if (!(area > 0)) return;
    const std::uint32_t element = table_.add(position, is_turned ? -normal : normal, area);
    parts_.push_back({Vec3f(position), mesh, triangle, element, true, is_turned});
  }

  // Part of each element nearest to its centre; transmitted light uses the triangle's normal, so a flipped
  // triangle represents the element only without an alternative.
  std::vector<const Part*> middles_of(std::span<const BoundaryElement> elements) const {
    std::vector<const Part*> middles(elements.size());
    std::vector<float> distances(elements.size(), INFINITY);
    const auto behind_others = float(1e6 * lattice_.cell * lattice_.cell);
    for (const Part& part : parts_) {
      const Vec3f apart = part.position - elements[part.element].position;
      const float distance = dot(apart, apart) + (part.is_turned ? behind_others : 0);
      if (!(distance < distances[part.element])) continue;
      distances[part.element] = distance;
      middles[part.element] = &part;
    }
    return middles;
  }

  // Sample on the part's triangle, at the projection of the element's centroid, or of the part's.
  SurfaceSample sample_of(const BoundaryElement& element, const Part& part) const {
    const Mesh& mesh = world_.meshes[part.mesh];
    const auto& [i, j, k] = mesh.triangles[part.triangle];
    const Vec3d corner = mesh.positions[i], b = mesh.positions[j] - corner, c = mesh.positions[k] - corner;
    const Vec3d normal = cross(b, c);
    float u = 0, v = 0;
    for (const Vec3f& place : {part.is_piece ? part.position : element.position, part.position}) {
      const Vec3d apart = Vec3d(place) - corner;
      u = float(dot(cross(apart, c), normal) / dot(normal, normal));
      v = float(dot(cross(b, apart), normal) / dot(normal, normal));
      if (u >= 0 && v >= 0 && u + v <= 1) break;
    }
    u = std::clamp(u, 0.f, 1.f);
    v = std::clamp(v, 0.f, 1 - u);
    const SurfacePoint point = surface_point(mesh, part.triangle, u, v);
    const Vec3f& outward = part.is_piece ? element.normal : point.normal;
    return {part.mesh, part.triangle, u, v, point.position, outward, element.area, element.position};
  }

  const World& world_;
  const Lattice& lattice_;
  ElementTable table_;
  std::vector<Part> parts_;
};

}  // namespace

CutSurface cut_by_lattice(const World& world, std::span<const std::uint32_t> meshes, const Lattice& lattice,
                          const RayScene* rays) {
  Cutter cutter(world, lattice);
  for (const std::uint32_t m : meshes) cutter.add(m);
  if (rays != nullptr) cutter.keep_outer(*rays, meshes);
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
