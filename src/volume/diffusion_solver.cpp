// SPDX-License-Identifier: GPL-3.0-or-later
#include "volume/diffusion_solver.h"

#include <algorithm>
#include <cmath>

#include "core/parallel.h"

namespace opaline {
namespace {

constexpr std::size_t kChunk = 4096;
constexpr int kMostIterations = 4000;

using Four = Channels::Four;
using Sums = std::array<double, 4>;

void add(Sums& sums, const Four& values) {
  for (std::size_t c = 0; c < 4; ++c) sums[c] += double(values[c]);
}

class ConjugateGradients {
 public:
  ConjugateGradients(const DiffusionProblem& problem, std::vector<Channels> start)
      : problem_(problem), count_(problem.grid.cells().size()), x_(std::move(start)) {
    for (std::size_t c = 0; c < 3; ++c) diffusivity_[c] = problem.diffusivity[c];
    const bool from_zero = x_.size() != count_;
    if (from_zero) x_.assign(count_, {});
    residual_ = problem.source;
    choose_scale();
    for (Channels& value : residual_) value.c *= scale_;
    for (Channels& value : x_) value.c = has_source_ ? value.c * scale_ : Four{};
    inverse_.resize(count_);
    direction_.resize(count_);
    product_.resize(count_);
    if (!problem.diffusivities.empty()) weigh_links();
    squared_ = sum([&](std::size_t i, Sums& sums) {
      Four weight{};
      if (conductances_.empty())
        for (const DiffusionGrid::Link& link : problem_.grid.links(i)) weight += link.conductance;
      else
        for (const Channels& conductance : conductances_of(i)) weight += conductance.c;
      const Four diagonal = diffusivity_ * weight + problem_.loss[i].c;
      inverse_[i].c = diagonal > 0 ? 1 / diagonal : Four{};
      add(sums, residual_[i].c * (residual_[i].c * inverse_[i].c));
    });
    source_ = squared_;
    if (!from_zero) {
      direction_ = x_;
      multiply();
      squared_ = sum([&](std::size_t i, Sums& sums) {
        residual_[i].c -= product_[i].c;
        add(sums, residual_[i].c * (residual_[i].c * inverse_[i].c));
      });
    }
    sum([&](std::size_t i, Sums&) { direction_[i].c = residual_[i].c * inverse_[i].c; });
  }

  bool has_converged(double tolerance) const {
    for (std::size_t c = 0; c < 3; ++c)
      if (squared_[c] > tolerance * tolerance * source_[c]) return false;
    return true;
  }

  void step() {
    const Sums curvature = multiply();
    Four length{};
    for (std::size_t c = 0; c < 4; ++c) length[c] = curvature[c] > 0 ? float(squared_[c] / curvature[c]) : 0;
    const Sums next = sum([&](std::size_t i, Sums& sums) {
      x_[i].c += length * direction_[i].c;
      residual_[i].c -= length * product_[i].c;
      add(sums, residual_[i].c * (residual_[i].c * inverse_[i].c));
    });
    Four turn{};
    for (std::size_t c = 0; c < 4; ++c) turn[c] = squared_[c] > 0 ? float(next[c] / squared_[c]) : 0;
    squared_ = next;
    sum([&](std::size_t i, Sums&) {
      direction_[i].c = residual_[i].c * inverse_[i].c + turn * direction_[i].c;
    });
  }

  /// The solution, scaled to conserve energy: total loss equals total source.
  std::vector<Channels> take() {
    const Sums lost = sum([&](std::size_t i, Sums& sums) {
      for (std::size_t c = 0; c < 4; ++c) sums[c] += double(problem_.loss[i].c[c]) * double(x_[i].c[c]);
    });
    const Sums came = sum([&](std::size_t i, Sums& sums) { add(sums, problem_.source[i].c * scale_); });
    Four scale{};
    for (std::size_t c = 0; c < 4; ++c) scale[c] = lost[c] > 0 ? float(came[c] / lost[c]) : 1;
    sum([&](std::size_t i, Sums&) { x_[i].c = x_[i].c * scale / scale_; });
    return std::move(x_);
  }

 private:
  // Powers of two: exact, and products of very large or small values stay within the range of floats.
  void choose_scale() {
    Four largest{};
    for (const Channels& source : problem_.source)
      for (std::size_t c = 0; c < 4; ++c) largest[c] = std::max(largest[c], std::abs(source.c[c]));
    for (std::size_t c = 0; c < 4; ++c) {
      int exponent = 0;
      std::frexp(largest[c], &exponent);
      scale_[c] = std::ldexp(1.f, -std::clamp(exponent, -120, 120));
    }
    has_source_ = largest > 0;
  }

  // A variable diffusivity is included in the conductances; a constant one is 1 here.
  void weigh_links() {
    const DiffusionGrid& grid = problem_.grid;
    diffusivity_ = Four{1, 1, 1, 1};
    conductances_.resize(count_ > 0 ? grid.first_link(count_) : 0);
    parallel_chunks(count_, kChunk, [&](std::size_t begin, std::size_t end, std::size_t) {
      for (std::size_t i = begin; i < end; ++i) {
        Channels* conductance = conductances_.data() + grid.first_link(i);
        for (const DiffusionGrid::Link& link : grid.links(i)) {
          *conductance = problem_.between(std::uint32_t(i), link.to);
          conductance->c *= link.conductance;
          ++conductance;
        }
      }
    });
  }
  std::span<const Channels> conductances_of(std::size_t i) const {
    const std::size_t first = problem_.grid.first_link(i);
    return std::span(conductances_).subspan(first, problem_.grid.first_link(i + 1) - first);
  }

  // product = matrix x direction; their dot products.
  Sums multiply() {
    return sum([&](std::size_t i, Sums& sums) {
      const Four own = direction_[i].c;
      Four flow{};
      if (conductances_.empty()) {
        for (const DiffusionGrid::Link& link : problem_.grid.links(i))
          flow += link.conductance * (own - direction_[link.to].c);
      } else {
        const Channels* conductance = conductances_of(i).data();
        for (const DiffusionGrid::Link& link : problem_.grid.links(i))
          flow += (conductance++)->c * (own - direction_[link.to].c);
      }
      product_[i].c = diffusivity_ * flow + problem_.loss[i].c * own;
      add(sums, product_[i].c * own);
    });
  }

  // Calls visit(cell, sums) for each cell, and adds up the sums of chunks in their order.
  template <class Visit>
  Sums sum(const Visit& visit) {
    std::vector<Sums> parts(chunk_count(count_, kChunk));
    parallel_chunks(count_, kChunk, [&](std::size_t begin, std::size_t end, std::size_t chunk) {
      Sums part{};
      for (std::size_t i = begin; i < end; ++i) visit(i, part);
      parts[chunk] = part;
    });
    Sums total{};
    for (const Sums& part : parts)
      for (std::size_t c = 0; c < 4; ++c) total[c] += part[c];
    return total;
  }

  const DiffusionProblem& problem_;
  std::size_t count_;
  Four diffusivity_{};
  Four scale_{};                        // factors of sources and fluences
  decltype(Four{} > 0) has_source_{};   // per channel; without one, the fluence is 0
  std::vector<Channels> conductances_;  // one per link of the grid, or none
  std::vector<Channels> x_, residual_, inverse_, direction_, product_;
  Sums squared_{}, source_{};  // norms of the residual and of the source
};

}  // namespace

Channels DiffusionProblem::between(std::uint32_t a, std::uint32_t b) const {
  Channels result;
  if (diffusivities.empty()) {
    for (std::size_t c = 0; c < 3; ++c) result.c[c] = diffusivity[c];
    return result;
  }
  const auto of_a = float(grid.cells()[a].size), of_b = float(grid.cells()[b].size);
  for (std::size_t c = 0; c < 3; ++c)
    result.c[c] = (of_a + of_b) / (of_a / diffusivities[a].c[c] + of_b / diffusivities[b].c[c]);
  return result;
}

DiffusionSolution solve_diffusion(const DiffusionProblem& problem, double tolerance,
                                  std::vector<Channels> start, Monitor* monitor) {
  ConjugateGradients gradients(problem, std::move(start));
  DiffusionSolution solution;
  while (!gradients.has_converged(tolerance) && solution.iterations < kMostIterations) {
    gradients.step();
    ++solution.iterations;
    advance(monitor, 0);
  }
  solution.fluence = gradients.take();
  return solution;
}

}  // namespace opaline
