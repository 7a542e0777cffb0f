// SPDX-License-Identifier: GPL-3.0-or-later
#include "irradiance/shadow_edges.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "core/parallel.h"
#include "irradiance/cell_points.h"
#include "irradiance/neighbour_grid.h"
#include "irradiance/shadow_batch.h"

namespace opaline {
namespace {

// Distance of neighbours, in spacings: includes those with adjacent cells, and few more.
constexpr float kReach = 1.5f;
// Least difference of the visible fractions of neighbours facing a light, and least difference over the
// light's mean weight, for a shadow edge.
constexpr float kChange = .5f, kOfMean = .25f;

// Smallest and largest visible fraction of a light at a set of samples, and the largest unoccluded weight.
struct Span {
  float low = 1, high = 0, brightest = 0;
  void add(const Span& s) {
    low = std::min(low, s.low);
    high = std::max(high, s.high);
    brightest = std::max(brightest, s.brightest);
  }
  bool is_sharp(float floor) const { return high - low > kChange && (high - low) * brightest > floor; }
};

Span seen(float weight, float unblocked) {
  if (!(unblocked > 0)) return {};
  const float part = weight / unblocked;
  return {part, part, unblocked};
}

struct Refined {
  std::uint32_t light, sample;
  float weight;
};

// A sample beside an edge of a light's shadow, and the number of its cell.
struct Mark {
  std::uint32_t sample, cell;
};

class EdgeFinder {
 public:
  EdgeFinder(std::span<const SurfaceSample> samples, std::span<const std::vector<float>> unblocked,
             std::span<const LightTransfer> transfers, float spacing)
      : samples_(samples),
        unblocked_(unblocked),
        transfers_(transfers),
        reach_(kReach * spacing),
        grid_(samples_, reach_),
        spans_(grid_.cells().size() * transfers.size()),
        has_edge_near_(grid_.cells().size()) {
    for (const LightTransfer& t : transfers) {
      const double sum = std::accumulate(t.weights.begin(), t.weights.end(), 0.0);
      floors_.push_back(kOfMean * float(sum / double(t.weights.size())));
    }
    for (std::size_t c = 0; c < grid_.cells().size(); ++c)
      for (const auto& [position, i] : grid_.members(grid_.cells()[c]))
        for (std::size_t l = 0; l < transfers.size(); ++l)
          spans_[c * transfers.size() + l].add(span_of(l, i));
    // Conservative test for an edge nearby; false for most cells.
    constexpr float kMissing = 1 - 0.99f * kChange;
    std::array<std::uint32_t, 27> indices;
    for (std::size_t i = 0; i < spans_.size(); ++i)
      if (spans_[i].low < kMissing)
        for (const std::uint32_t c : grid_.around(grid_.cells()[i / transfers.size()], indices))
          has_edge_near_[c] = true;
  }

  std::size_t cells() const { return grid_.cells().size(); }

  /// Calls use(sample, its neighbours and itself, lights with an edge there) for each sample of a cell beside
  /// an edge.
  template <class Use>
  void for_edges(std::size_t cell, const Use& use) const {
    if (!has_edge_near_[cell]) return;
    std::array<std::uint32_t, 27> indices;
    const std::span<const std::uint32_t> around = grid_.around(grid_.cells()[cell], indices);
    std::vector<std::uint32_t> candidates, neighbours, lights;
    for (std::uint32_t l = 0; l < transfers_.size(); ++l) {
      Span span;
      for (const std::uint32_t c : around) span.add(spans_[c * transfers_.size() + l]);
      if (span.is_sharp(floors_[l])) candidates.push_back(l);
    }
    if (candidates.empty()) return;
    for (const auto& [position, i] : grid_.members(grid_.cells()[cell])) {
      neighbours.clear();
      lights.clear();
      for (const std::uint32_t c : around)
        for (const auto& [other, j] : grid_.members(grid_.cells()[c])) {
          const Vec3f d = other - position;
          if (dot(d, d) <= reach_ * reach_ && same_sheet(samples_[i].normal, samples_[j].normal))
            neighbours.push_back(j);
        }
      for (const std::uint32_t l : candidates) {
        Span span;
        for (const std::uint32_t j : neighbours) span.add(span_of(l, j));
        if (span.is_sharp(floors_[l])) lights.push_back(l);
      }
      if (!lights.empty()) use(i, neighbours, lights);
    }
  }

 private:
  Span span_of(std::size_t light, std::uint32_t sample) const {
    return seen(transfers_[light].weights[sample], unblocked_[light][sample]);
  }

  std::span<const SurfaceSample> samples_;
  std::span<const std::vector<float>> unblocked_;
  std::span<const LightTransfer> transfers_;
  float reach_;
  NeighbourGrid grid_;
  std::vector<Span> spans_;          // cells x lights
  std::vector<bool> has_edge_near_;  // one per cell; may be true without an edge
  std::vector<float> floors_;        // one per light
};

// Mean weight of one light over the points of each marked sample's cell. An area light's samples are
// distributed over the points, twice as many as for a single point.
void average(const IrradianceInput& input, std::uint32_t light, std::span<const Mark> marks,
             const CellPoints& points, std::vector<Refined>& refined) {
  const bool delta = is_delta(input.lights[light]);
  const int rays = shadow_rays(input.lights[light], input.light_samples);
  const std::uint32_t most = delta ? CellPoints::kMost : std::min(CellPoints::kMost, 2 * std::uint32_t(rays));
  const int each = delta ? 1 : 2 * rays / int(most);
  ShadowBatch batch(input.rays, input.lights[light], input.boundary, each,
                    light_seed(input.seed, input.lights[light]));
  const std::size_t batch_size = batch_points(int(most) * each);
  for (std::size_t begin = 0; begin < marks.size(); begin += batch_size) {
    const std::span<const Mark> part = marks.subspan(begin, std::min(batch_size, marks.size() - begin));
    std::vector<std::uint32_t> owners;  // owners of the points in the batch
    std::vector<float> areas;           // areas of the same points, times their factors
    std::vector<double> sums(part.size()), whole(part.size());
    for (std::uint32_t m = 0; m < part.size(); ++m)
      for (const CellPoints::Point& point : points.points(part[m].cell)) {
        if (point.line >= most) break;
        SurfacePoint at = point.at;
        const float factor = enter_at(input, at);
        batch.add(at, part[m].sample, std::uint64_t(point.line) * std::uint64_t(each));
        owners.push_back(m);
        areas.push_back(point.weight * factor);
        whole[m] += double(point.weight);
      }
    batch.trace([&](std::size_t p, int, float e, float) { sums[owners[p]] += double(areas[p]) * double(e); });
    for (std::uint32_t m = 0; m < part.size(); ++m)
      if (whole[m] > 0) refined.push_back({light, part[m].sample, float(sums[m] / whole[m])});
  }
}

/// Displacement of refined samples, times their areas.
struct Shift {
  double sum = 0, squares = 0, ray_noise = 0;

  void add(double moved, double noise) {
    sum += moved;
    squares += moved * moved;
    ray_noise += noise * noise;
  }
  /// The part of the sum due to the selection of samples by noise of few rays, beyond the sum's own noise.
  double by_chance() const {
    if (!(squares > 0)) return 0;
    return std::copysign(std::sqrt(std::max(0.0, sum * sum - squares)), sum) *
           std::min(1.0, ray_noise / squares);
  }
};

/// Standard deviation of a weight from this number of binary rays; for one ray, by the mean over the cell.
double ray_noise(float weight, float mean, float unblocked, int rays) {
  if (!(unblocked > 0)) return 0;
  const double seen = std::clamp(double((rays > 1 ? weight : mean) / unblocked), 0.0, 1.0);
  return double(unblocked) * std::sqrt(seen * (1 - seen) / std::max(1, rays - 1));
}

double relative_shift(const Shift& shift, std::span<const SurfaceSample> samples,
                      std::span<const float> weights) {
  double sum = 0;
  for (std::size_t i = 0; shift.sum != 0 && i < samples.size(); ++i)
    sum += double(samples[i].area) * double(weights[i]);
  return sum > 0 ? shift.by_chance() / sum : 0;
}

}  // namespace

void refine_shadow_edges(const IrradianceInput& input, std::span<const std::vector<float>> unblocked,
                         std::span<LightTransfer> transfers) {
  double area = 0;
  for (const SurfaceSample& s : input.samples) area += double(s.area);
  if (!(area > 0) || transfers.empty()) return;
  const float spacing = float(std::sqrt(area / double(input.samples.size())));
  const EdgeFinder finder(input.samples, unblocked, transfers, spacing);
  const std::vector<bool> surface = meshes_of(input.samples);
  constexpr std::size_t kCells = 256;
  std::vector<std::vector<Refined>> refined(chunk_count(finder.cells(), kCells));
  parallel_chunks(finder.cells(), kCells, [&](std::size_t begin, std::size_t end, std::size_t chunk) {
    CellPoints points(input.rays, input.samples, surface, spacing);
    std::vector<std::vector<Mark>> marks(transfers.size());
    for (std::size_t c = begin; c < end; ++c)
      finder.for_edges(c, [&](std::uint32_t i, std::span<const std::uint32_t> neighbours,
                              std::span<const std::uint32_t> lights) {
        const std::uint32_t cell = points.add(i, neighbours);
        for (const std::uint32_t l : lights) marks[l].push_back({i, cell});
      });
    points.project();
    for (std::uint32_t l = 0; l < transfers.size(); ++l) average(input, l, marks[l], points, refined[chunk]);
    advance(input.monitor, 0);
  });
  std::vector<Shift> shifts(transfers.size());
  for (const std::vector<Refined>& part : refined)
    for (const Refined& r : part) {
      float& weight = transfers[r.light].weights[r.sample];
      const double cell = double(input.samples[r.sample].area),
                   noise = ray_noise(weight, r.weight, unblocked[r.light][r.sample],
                                     shadow_rays(input.lights[r.light], input.light_samples));
      shifts[r.light].add(cell * double(r.weight - weight), cell * noise);
      weight = r.weight;
    }
  for (std::size_t l = 0; l < transfers.size(); ++l)
    transfers[l].edge_shift = relative_shift(shifts[l], input.samples, transfers[l].weights);
}

}  // namespace opaline
