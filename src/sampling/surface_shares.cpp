// SPDX-License-Identifier: GPL-3.0-or-later
#include "sampling/surface_shares.h"

#include <algorithm>
#include <span>

#include "core/parallel.h"
#include "sampling/sample_surface.h"
#include "sampling/share_tasks.h"
#include "sampling/triangle_divider.h"

namespace opaline {
namespace {

/// Barycentrics of points in a triangle's plane.
class Barycentrics {
 public:
  explicit Barycentrics(const TriangleList::Corners& t) : origin_(t.a) {
    const Vec3d ab = t.b - t.a, ac = t.c - t.a, normal = cross(ab, ac);
    const double scale = dot(normal, normal) > 0 ? 1 / dot(normal, normal) : 0;
    along_u_ = cross(ac, normal) * scale;
    along_v_ = cross(normal, ab) * scale;
  }
  float u(const Vec3d& p) const { return float(dot(p - origin_, along_u_)); }
  float v(const Vec3d& p) const { return float(dot(p - origin_, along_v_)); }

 private:
  Vec3d origin_, along_u_, along_v_;
};

/// Sums the contributions of each sample, in place; returns the number of samples.
std::size_t merge_by_sample(std::span<Share> shares) {
  constexpr std::size_t kFew = 64;
  const bool sorted = shares.size() > kFew;  // a sample's contributions are adjacent
  if (sorted) std::ranges::stable_sort(shares, {}, &Share::sample);
  std::size_t count = 0;
  for (const Share& share : shares) {
    std::size_t i = sorted && count > 0 ? count - 1 : 0;
    while (i < count && shares[i].sample != share.sample) ++i;
    if (i == count) {
      shares[count++] = share;
    } else {
      shares[i].area += share.area;
      shares[i].moment += share.moment;
    }
  }
  return count;
}

/// Pieces of one triangle; consumes its contributions.
void add_pieces(const TriangleList& triangles, const SampleGrid& grid, std::span<Share> shares,
                std::vector<SurfacePiece>& pieces) {
  if (shares.empty()) return;
  const std::uint32_t triangle = shares[0].triangle;
  const Barycentrics at(triangles.corners(triangles.id(triangle)));
  const double whole = triangles.area(triangle);
  for (const Share& sum : shares.first(merge_by_sample(shares))) {
    if (!(sum.area > 0)) continue;
    const Vec3d middle = Vec3d(grid.position(sum.sample)) + sum.moment / sum.area;
    pieces.push_back({triangle, sum.sample, float(sum.area / whole), at.u(middle), at.v(middle)});
  }
}

struct TaskResult {
  std::vector<Share> shares;
  std::vector<SurfacePiece> pieces;  // if requested
};

/// Divides a task's triangles. Sums contributions by sample regularly, at counts not reached by ordinary
/// triangles, so needles meeting the same samples do not accumulate many.
void divide_task(const TriangleList& triangles, const SampleGrid& grid, float radius, const Task& task,
                 Monitor* monitor, bool keep, TaskResult& result) {
  constexpr std::size_t kMany = 8192;
  result.shares.clear();
  result.pieces.clear();
  TriangleDivider divider(triangles, grid, radius, monitor, result.shares);
  std::vector<Share> of_triangle;
  std::size_t most = kMany;
  for (std::size_t t = task.first; t < task.last; ++t) {
    const std::size_t before = result.shares.size();
    divider.divide(t, task);
    if (keep) {
      of_triangle.assign(result.shares.begin() + std::ptrdiff_t(before), result.shares.end());
      add_pieces(triangles, grid, of_triangle, result.pieces);
    }
    if (result.shares.size() <= most) continue;
    result.shares.resize(merge_by_sample(result.shares));
    most = std::max(kMany, 2 * result.shares.size());
  }
}

}  // namespace

std::vector<SurfaceShare> surface_shares(const TriangleList& triangles, const SampleGrid& grid, float radius,
                                         Monitor* monitor, std::vector<SurfacePiece>* kept) {
  std::vector<SurfaceShare> shares(grid.size());
  const Tasks tasks(triangles, triangles.area() / double(grid.size()), radius);
  // Blocks bound the memory of the contributions; within one, tasks are summed in order, independent of
  // threads.
  constexpr std::size_t kBlock = 256;
  std::vector<TaskResult> results(std::min(kBlock, tasks.all().size()));
  for (std::size_t begin = 0; begin < tasks.all().size(); begin += kBlock) {
    const std::span<const Task> block =
        std::span(tasks.all()).subspan(begin, std::min(kBlock, tasks.all().size() - begin));
    parallel_chunks(block.size(), 1, [&](std::size_t i, std::size_t, std::size_t) {
      const Task& task = block[i];
      divide_task(triangles, grid, radius, task, monitor, kept != nullptr, results[i]);
      advance(monitor, task.is_whole() ? task.last - task.first : 0);
    });
    for (std::size_t i = 0; i < block.size(); ++i) {
      for (const Share& share : results[i].shares) {
        shares[share.sample].area += share.area;
        shares[share.sample].moment += share.moment;
      }
      if (kept != nullptr) kept->insert(kept->end(), results[i].pieces.begin(), results[i].pieces.end());
    }
  }
  return shares;
}

}  // namespace opaline
