// SPDX-License-Identifier: GPL-3.0-or-later
#include "volume/free_distance.h"

#include <algorithm>
#include <cmath>

#include "core/parallel.h"

namespace opaline {
namespace {

constexpr int kReach = 15;  // voxels: 15^2 fits into a byte
constexpr std::uint8_t kFar = kReach * kReach;

/// Squared gap between voxels `steps` apart along one axis; 0 between adjacent ones.
constexpr int gap2(int steps) {
  const int gap = std::max(0, std::abs(steps) - 1);
  return gap * gap;
}

/// Number of pieces per side that limits a triangle's pieces to one voxel edge; its square is the total.
int pieces_along(const Vec3d& ab, const Vec3d& ac, double inverse_edge) {
  const Vec3d bc = ac - ab;
  const double longest = std::sqrt(std::max({dot(ab, ab), dot(ac, ac), dot(bc, bc)}));
  return int(std::clamp(std::ceil(longest * inverse_edge), 1.0, 4096.0));
}

/// Fraction of a triangle's box lying in another.
double share_inside(const Bounds& box, const Vec3d& a, const Vec3d& b, const Vec3d& c) {
  const Vec3d low = component_min(component_min(a, b), c), high = component_max(component_max(a, b), c);
  double share = 1;
  for (const auto along : {&Vec3d::x, &Vec3d::y, &Vec3d::z}) {
    const double length = high.*along - low.*along,
                 inside = std::min(high.*along, box.high.*along) - std::max(low.*along, box.low.*along);
    if (inside < 0) return 0;
    if (length > 0) share *= inside / length;
  }
  return share;
}

/// True if the plane of a triangle may cross a box: (middle, half edge), normal of any length.
bool crosses(const Vec3d& corner, const Vec3d& normal, const Vec3d& middle, double half) {
  const double reach = half * (std::abs(normal.x) + std::abs(normal.y) + std::abs(normal.z));
  return std::abs(dot(normal, middle - corner)) <= reach * (1 + 1e-9);
}

}  // namespace

Vec3d FreeDistance::counts_of(const Vec3d& size, double edge) {
  const auto count = [edge](double length) { return std::floor(length / edge) + 3; };
  return {count(size.x), count(size.y), count(size.z)};
}

double FreeDistance::edge_for(const Vec3d& size, double edge) {
  edge = std::clamp(edge, max_component(size) * 1e-3,
                    max_component(size) * 1e6);  // infinite in a clear medium
  if (!(edge > 0)) edge = 1;
  const auto voxels = [&] {
    const Vec3d counts = counts_of(size, edge);
    return counts.x * counts.y * counts.z;
  };
  while (voxels() > double(kMostVoxels)) edge *= 1.1;
  return edge;
}

double FreeDistance::expected_bytes(const World& world, const Bounds& box, double edge) {
  constexpr double kVoxelsOfPiece = 5;  // by bench: between 3 and 6
  constexpr double kOfVoxel = sizeof(std::uint8_t) + sizeof(Plane) + 2 * sizeof(std::uint32_t);
  const Vec3d size = box.high - box.low;
  const double used = edge_for(size, edge);
  const Bounds around{box.low - Vec3d(used), box.high + Vec3d(used)};
  double pieces = 0;
  for (const Mesh& mesh : world.meshes)
    for (const auto& [i, j, k] : mesh.triangles) {
      const Vec3d &a = mesh.positions[i], &b = mesh.positions[j], &c = mesh.positions[k];
      const double share = share_inside(around, a, b, c);
      if (share > 0) pieces += share * std::pow(pieces_along(b - a, c - a, 1 / used), 2);
    }
  const Vec3d counts = counts_of(size, used);
  return counts.x * counts.y * counts.z * kOfVoxel +
         pieces * (sizeof(Piece) + kVoxelsOfPiece * sizeof(std::uint32_t));
}

FreeDistance::FreeDistance(const World& world, const Bounds& box, double edge, double reach) {
  const Vec3d size = box.high - box.low;
  edge_ = edge_for(size, edge);
  inverse_edge_ = 1 / edge_;
  reach_ = reach * edge_;
  reach_steps_ = reach / kOffsetUnit;
  counts_ = counts_of(size, edge_);
  nx_ = std::size_t(counts_.x), ny_ = std::size_t(counts_.y), nz_ = std::size_t(counts_.z);
  low_ = .5 * (box.low + box.high) - .5 * edge_ * counts_;
  for (std::size_t i = 0; i < distances_.size(); ++i)
    distances_[i] = std::sqrt(double(i)) * edge_ * (1 - 1e-6);
  const Pieces pieces = pieces_of(world);
  steps_.resize(nx_ * ny_ * nz_);
  for (std::size_t v = 0; v < steps_.size(); ++v)
    steps_[v] = pieces.first[v + 1] > pieces.first[v] ? 0 : kFar;
  spread();
  planes_.resize(steps_.size());
  parallel_chunks(steps_.size(), 4096, [&](std::size_t begin, std::size_t end, std::size_t) {
    for (std::size_t v = begin; v < end; ++v)
      if (steps_[v] == 0) planes_[v] = plane_of(v, pieces);
  });
}

/// Calls use(corners, normal with the length of the area) for all triangles, subdivided until no side is
/// longer than an edge.
template <class Use>
void FreeDistance::for_pieces(const World& world, const Use& use) const {
  for (const Mesh& mesh : world.meshes)
    for (const auto& [i, j, k] : mesh.triangles) {
      const Vec3d &a = mesh.positions[i], ab = mesh.positions[j] - a, ac = mesh.positions[k] - a;
      const int n = pieces_along(ab, ac, inverse_edge_);
      const Vec3d normal = cross(ab, ac) * (.5 / (double(n) * double(n)));
      const auto at = [&](int u, int v) { return a + ab * (double(u) / n) + ac * (double(v) / n); };
      for (int v = 0; v < n; ++v)
        for (int u = 0; u + v < n; ++u) {
          use(std::array{at(u, v), at(u + 1, v), at(u, v + 1)}, normal);
          if (u + v + 1 < n) use(std::array{at(u + 1, v), at(u + 1, v + 1), at(u, v + 1)}, normal);
        }
    }
}

/// Voxels of the piece's box that intersect its plane, with a margin for the single precision of rays.
template <class Use>
void FreeDistance::for_voxels(const std::array<Vec3d, 3>& piece, const Use& use) const {
  const double margin = 1e-5 * edge_ * (double(nx_) + double(ny_) + double(nz_));
  const auto& [a, b, c] = piece;
  const Vec3d low = component_min(component_min(a, b), c) - Vec3d(margin),
              high = component_max(component_max(a, b), c) + Vec3d(margin), normal = cross(b - a, c - a);
  const auto first = [&](double at, double from) {
    return std::size_t(std::max(0.0, std::floor((at - from) * inverse_edge_)));
  };
  const auto end = [&](double at, double from, std::size_t n) {
    const double voxel = std::floor((at - from) * inverse_edge_) + 1;
    return voxel <= 0 ? 0 : std::min(n, std::size_t(std::min(voxel, double(n))));
  };
  const std::size_t x1 = end(high.x, low_.x, nx_), y1 = end(high.y, low_.y, ny_),
                    z1 = end(high.z, low_.z, nz_);
  for (std::size_t z = first(low.z, low_.z); z < z1; ++z)
    for (std::size_t y = first(low.y, low_.y); y < y1; ++y)
      for (std::size_t x = first(low.x, low_.x); x < x1; ++x) {
        const std::size_t voxel = x + nx_ * (y + ny_ * z);
        if (crosses(a, normal, middle_of(voxel), .5 * edge_ + margin)) use(voxel);
      }
}

FreeDistance::Pieces FreeDistance::pieces_of(const World& world) const {
  Pieces result;
  result.first.resize(nx_ * ny_ * nz_ + 1);
  std::size_t count = 0;
  for_pieces(world, [&](const std::array<Vec3d, 3>& corners, const Vec3d&) {
    std::size_t voxels = 0;
    for_voxels(corners, [&](std::size_t voxel) {
      ++result.first[voxel + 1];
      ++voxels;
    });
    if (voxels > 0) ++count;
  });
  for (std::size_t v = 1; v < result.first.size(); ++v) result.first[v] += result.first[v - 1];
  result.of_voxels.resize(result.first.back());
  result.pieces.reserve(count);
  std::vector<std::uint32_t> next(result.first.begin(), result.first.end() - 1);
  for_pieces(world, [&](const std::array<Vec3d, 3>& corners, const Vec3d& normal) {
    std::size_t voxels = 0;
    for_voxels(corners, [&](std::size_t voxel) {
      result.of_voxels[next[voxel]++] = std::uint32_t(result.pieces.size());
      ++voxels;
    });
    const auto& [a, b, c] = corners;
    if (voxels > 0) result.pieces.push_back({{Vec3f(a), Vec3f(b), Vec3f(c)}, Vec3f(normal * (1 / 3.0))});
  });
  return result;
}

// Least squared gap to a voxel with a triangle, axis by axis: gaps along the axes are independent.
void FreeDistance::spread() {
  const auto along = [&](std::size_t lines, std::size_t length, std::size_t stride, const auto& start) {
    parallel_chunks(lines, 64, [&](std::size_t begin, std::size_t end, std::size_t) {
      std::vector<int> before(length);
      for (std::size_t line = begin; line < end; ++line) {
        std::uint8_t* at = steps_.data() + start(line);
        bool is_far = true;
        for (std::size_t i = 0; i < length; ++i) {
          before[i] = at[i * stride];
          is_far = is_far && before[i] == kFar;
        }
        if (is_far) continue;
        for (std::size_t i = 0; i < length; ++i) {
          int least = kFar;
          const std::size_t first = i < kReach ? 0 : i - kReach, last = std::min(length - 1, i + kReach);
          for (std::size_t j = first; j <= last; ++j)
            least = std::min(least, before[j] + gap2(int(j) - int(i)));
          at[i * stride] = std::uint8_t(least);
        }
      }
    });
  };
  along(ny_ * nz_, nx_, 1, [&](std::size_t line) { return line * nx_; });
  along(nx_ * nz_, ny_, nx_, [&](std::size_t line) { return line % nx_ + line / nx_ * nx_ * ny_; });
  along(nx_ * ny_, nz_, nx_ * ny_, [&](std::size_t line) { return line; });
}

// Plane along the mean normal of the surface within reach, lowered by the rounding of corners to floats.
FreeDistance::Plane FreeDistance::plane_of(std::size_t voxel, const Pieces& pieces) const {
  const int steps = int(std::ceil(reach_ * inverse_edge_));
  const double within2 = reach_ * inverse_edge_ * (reach_ * inverse_edge_);
  const auto x0 = int(voxel % nx_), y0 = int(voxel / nx_ % ny_), z0 = int(voxel / (nx_ * ny_));
  const auto for_near = [&](const auto& use) {
    for (int z = std::max(0, z0 - steps); z <= std::min(int(nz_) - 1, z0 + steps); ++z)
      for (int y = std::max(0, y0 - steps); y <= std::min(int(ny_) - 1, y0 + steps); ++y)
        for (int x = std::max(0, x0 - steps); x <= std::min(int(nx_) - 1, x0 + steps); ++x) {
          if (double(gap2(x - x0) + gap2(y - y0) + gap2(z - z0)) > within2) continue;
          const std::size_t other = std::size_t(x) + nx_ * (std::size_t(y) + ny_ * std::size_t(z));
          for (std::uint32_t i = pieces.first[other]; i < pieces.first[other + 1]; ++i)
            use(pieces.pieces[pieces.of_voxels[i]]);
        }
  };
  Vec3f sum;
  for_near([&](const Piece& piece) {
    for (std::size_t c = 0; c < 3; ++c) sum += piece.normal;
  });
  const Vec3d mean = normalized(Vec3d(sum)) * kNormal;
  Plane plane{std::int8_t(std::lround(mean.x)), std::int8_t(std::lround(mean.y)),
              std::int8_t(std::lround(mean.z)), kNoPlane};
  const Vec3f normal(float(plane.x), float(plane.y), float(plane.z));
  float least = std::numeric_limits<float>::infinity();
  for_near([&](const Piece& piece) {
    for (const Vec3f& corner : piece.corners) least = std::min(least, dot(normal, corner));
  });
  if (!std::isfinite(least) || mean == Vec3d{}) return plane;
  const double margin = 1e-5 * kNormal * (std::abs(low_.x) + std::abs(low_.y) + std::abs(low_.z) + edge_);
  const double offset =
      std::floor((double(least) - margin - dot(Vec3d(normal), middle_of(voxel))) / (kOffsetUnit * edge_));
  if (offset > double(kNoPlane)) plane.offset = std::int8_t(std::min(127.0, offset));
  return plane;
}

}  // namespace opaline
