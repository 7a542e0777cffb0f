// SPDX-License-Identifier: GPL-3.0-or-later
#include "volume/diffusion_solver.h"

#include <algorithm>
#include <cmath>

#include "core/parallel.h"

namespace opaline {
namespace {

constexpr std::size_t kChunk = 4096;
constexpr int kMostIterations = 4000;

using Sums = std::array<double, 4>;

class ConjugateGradients {
 public:
  ConjugateGradients(const DiffusionProblem& problem, std::vector<Channels> start)
      : problem_(problem), count_(problem.grid.cells().size()), x_(std::move(start)) {
    for (std::size_t c = 0; c < 3; ++c) diffusivity_.c[c] = problem.diffusivity[c];
    const bool from_zero = x_.size() != count_;
    if (from_zero) x_.assign(count_, {});
    residual_ = problem.source;
    choose_scale();
    for (std::vector<Channels>* values : {&residual_, &x_})
      for (Channels& value : *values)
        for (std::size_t c = 0; c < 4; ++c) value.c[c] *= scale_.c[c];
    inverse_.resize(count_);
    direction_.resize(count_);
    product_.resize(count_);
    if (!problem.diffusivities.empty()) weigh_links();
    squared_ = sum([&](std::size_t i, Sums& sums) {
      Channels weight;
      if (conductances_.empty()) {
        for (const DiffusionGrid::Link& link : problem_.grid.links(i))
          for (std::size_t c = 0; c < 4; ++c) weight.c[c] += link.conductance;
      } else {
        for (const Channels& conductance : conductances_of(i))
          for (std::size_t c = 0; c < 4; ++c) weight.c[c] += conductance.c[c];
      }
      for (std::size_t c = 0; c < 4; ++c) {
        const float diagonal = diffusivity_.c[c] * weight.c[c] + problem_.loss[i].c[c];
        inverse_[i].c[c] = diagonal > 0 ? 1 / diagonal : 0;
        sums[c] += double(residual_[i].c[c]) * double(residual_[i].c[c]) * double(inverse_[i].c[c]);
      }
    });
    source_ = squared_;
    if (!from_zero) {
      direction_ = x_;
      multiply();
      squared_ = sum([&](std::size_t i, Sums& sums) {
        for (std::size_t c = 0; c < 4; ++c) {
          residual_[i].c[c] -= product_[i].c[c];
          sums[c] += double(residual_[i].c[c]) * double(residual_[i].c[c]) * double(inverse_[i].c[c]);
        }
      });
    }
    sum([&](std::size_t i, Sums&) {
      for (std::size_t c = 0; c < 4; ++c) direction_[i].c[c] = residual_[i].c[c] * inverse_[i].c[c];
    });
  }

  bool has_converged(double tolerance) const {
    for (std::size_t c = 0; c < 3; ++c)
      if (squared_[c] > tolerance * tolerance * source_[c]) return false;
    return true;
  }

  void step() {
    const Sums curvature = multiply();
    Channels length;
    for (std::size_t c = 0; c < 4; ++c)
      length.c[c] = curvature[c] > 0 ? float(squared_[c] / curvature[c]) : 0;
    const Sums next = sum([&](std::size_t i, Sums& sums) {
      for (std::size_t c = 0; c < 4; ++c) {
        x_[i].c[c] += length.c[c] * direction_[i].c[c];
        residual_[i].c[c] -= length.c[c] * product_[i].c[c];
        const float scaled = residual_[i].c[c] * inverse_[i].c[c];
        sums[c] += double(residual_[i].c[c] * scaled);
      }
    });
    Channels turn;
    for (std::size_t c = 0; c < 4; ++c) turn.c[c] = squared_[c] > 0 ? float(next[c] / squared_[c]) : 0;
    squared_ = next;
    sum([&](std::size_t i, Sums&) {
      for (std::size_t c = 0; c < 4; ++c)
        direction_[i].c[c] = residual_[i].c[c] * inverse_[i].c[c] + turn.c[c] * direction_[i].c[c];
    });
  }

  /// The solution, scaled to conserve energy: total loss equals total source.
  std::vector<Channels> take() {
    const Sums lost = sum([&](std::size_t i, Sums& sums) {
      for (std::size_t c = 0; c < 4; ++c) sums[c] += double(problem_.loss[i].c[c]) * double(x_[i].c[c]);
    });
    const Sums came = sum([&](std::size_t i, Sums& sums) {
      for (std::size_t c = 0; c < 4; ++c) sums[c] += double(problem_.source[i].c[c]) * double(scale_.c[c]);
    });
    Channels scale;
    for (std::size_t c = 0; c < 4; ++c) scale.c[c] = lost[c] > 0 ? float(came[c] / lost[c]) : 1;
    sum([&](std::size_t i, Sums&) {
      for (std::size_t c = 0; c < 4; ++c) x_[i].c[c] = x_[i].c[c] * scale.c[c] / scale_.c[c];
    });
    return std::move(x_);
  }

 private:
  // Powers of two: exact, and products of very large or small values stay within the range of floats.
  void choose_scale() {
    Channels largest;
    for (const Channels& source : problem_.source)
      for (std::size_t c = 0; c < 4; ++c) largest.c[c] = std::max(largest.c[c], std::abs(source.c[c]));
    for (std::size_t c = 0; c < 4; ++c) {
      int exponent = 0;
      std::frexp(largest.c[c], &exponent);
      scale_.c[c] = std::ldexp(1.f, -std::clamp(exponent, -120, 120));
    }
  }

  // A variable diffusivity is included in the conductances; a constant one is 1 here.
  void weigh_links() {
    const DiffusionGrid& grid = problem_.grid;
    diffusivity_.c.fill(1);
    conductances_.resize(count_ > 0 ? grid.first_link(count_) : 0);
    parallel_chunks(count_, kChunk, [&](std::size_t begin, std::size_t end, std::size_t) {
      for (std::size_t i = begin; i < end; ++i) {
        Channels* conductance = conductances_.data() + grid.first_link(i);
        for (const DiffusionGrid::Link& link : grid.links(i)) {
          *conductance = problem_.between(std::uint32_t(i), link.to);
          for (float& c : conductance->c) c *= link.conductance;
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
      const Channels own = direction_[i];
      Channels flow;
      if (conductances_.empty()) {
        for (const DiffusionGrid::Link& link : problem_.grid.links(i))
          for (std::size_t c = 0; c < 4; ++c)
            flow.c[c] += link.conductance * (own.c[c] - direction_[link.to].c[c]);
      } else {
        const Channels* conductance = conductances_of(i).data();
        for (const DiffusionGrid::Link& link : problem_.grid.links(i)) {
          for (std::size_t c = 0; c < 4; ++c)
            flow.c[c] += conductance->c[c] * (own.c[c] - direction_[link.to].c[c]);
          ++conductance;
        }
      }
      for (std::size_t c = 0; c < 4; ++c) {
        product_[i].c[c] = diffusivity_.c[c] * flow.c[c] + problem_.loss[i].c[c] * own.c[c];
        sums[c] += double(product_[i].c[c] * own.c[c]);
      }
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
  Channels diffusivity_;
  Channels scale_;                      // factors of sources and fluences
  std::vector<Channels> conductances_;  // one per link of the grid, or none
  std::vector<Channels> x_, residual_, inverse_, direction_, product_;
  Sums squared_{}, source_{};  // norms of the residual and of the source
};

}  // namespace

Channels DiffusionProblem::between(std::uint32_t a, std::uint32_t b) const {
  Channels result;
  if (diffusivities.empty()) {
    std::ranges::copy(diffusivity, result.c.begin());
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
