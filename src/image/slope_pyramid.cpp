// SPDX-License-Identifier: GPL-3.0-or-later
#include "image/slope_pyramid.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace opaline {
namespace {

constexpr int kCell = 4;  // texels of a side of the smallest cells

template <class Values>
Values mixed(const Values& a, const Values& b, float share) {
  Values result;
  for (std::size_t i = 0; i < result.size(); ++i) result[i] = a[i] * (1 - share) + b[i] * share;
  return result;
}

}  // namespace

SlopePyramid::SlopePyramid(int width, int height) : width_(width), height_(height) {
  Level base{(width + kCell - 1) / kCell, (height + kCell - 1) / kCell, {}};
  base.cells.resize(std::size_t(base.width) * std::size_t(base.height));
  levels_.push_back(std::move(base));
}

// Rows beyond the edges are those at the edges.
void SlopePyramid::add_row(std::vector<float> heights) {
  if (next_row_ == 0) above_ = row_ = heights;
  if (next_row_ > 0) {
    add_slopes(next_row_ - 1, heights);
    above_ = std::move(row_);
    row_ = std::move(heights);
  }
  if (++next_row_ < height_) return;
  add_slopes(height_ - 1, row_);
  finish();
}

void SlopePyramid::add_slopes(int y, const std::vector<float>& below) {
  constexpr float kBeside = 1.f / 6, kMiddle = 4.f / 6;
  for (int x = 0; x < width_; ++x) {
    const auto left = std::size_t(std::max(x - 1, 0)), middle = std::size_t(x),
               right = std::size_t(std::min(x + 1, width_ - 1));
    const auto across = [&](const std::vector<float>& of) { return (of[right] - of[left]) / 2; };
    const auto down = [&](std::size_t at) { return (below[at] - above_[at]) / 2; };
    const float du = (kBeside * (across(above_) + across(below)) + kMiddle * across(row_)) * float(width_),
                dv = (kBeside * (down(left) + down(right)) + kMiddle * down(middle)) * float(height_);
    Squares& cell =
        levels_[0].cells[std::size_t(y / kCell) * std::size_t(levels_[0].width) + std::size_t(x / kCell)];
    cell[0] += du * du, cell[1] += du * dv, cell[2] += dv * dv;
  }
}

void SlopePyramid::finish() {
  above_ = row_ = {};
  Level& base = levels_[0];
  for (int y = 0; y < base.height; ++y)
    for (int x = 0; x < base.width; ++x) {
      const int count = std::min(kCell, width_ - x * kCell) * std::min(kCell, height_ - y * kCell);
      for (float& value : base.cells[std::size_t(y) * std::size_t(base.width) + std::size_t(x)])
        value /= float(count);
    }
  while (levels_.back().cells.size() > 1) {
    const Level& finer = levels_.back();
    Level coarser{(finer.width + 1) / 2, (finer.height + 1) / 2, {}};
    for (int y = 0; y < coarser.height; ++y)
      for (int x = 0; x < coarser.width; ++x)
        coarser.cells.push_back(
            finer.at((float(x) + .5f) / float(coarser.width), (float(y) + .5f) / float(coarser.height)));
    levels_.push_back(std::move(coarser));
  }
}

SlopePyramid::Squares SlopePyramid::Level::at(float u, float v) const {
  const auto place = [](float value, int count) {
    const float at = (value - std::floor(value)) * float(count) - .5f, first = std::floor(at);
    const int i = (int(first) + count) % count;
    return std::pair{std::array{std::size_t(i), std::size_t((i + 1) % count)}, at - first};
  };
  const auto x = place(u, width), y = place(v, height);
  const auto row = [&](std::size_t i) {
    const Squares* const cells_of_row = &cells[i * std::size_t(width)];
    return mixed(cells_of_row[x.first[0]], cells_of_row[x.first[1]], x.second);
  };
  return mixed(row(y.first[0]), row(y.first[1]), y.second);
}

std::array<float, 3> SlopePyramid::at(float u, float v, float texels) const {
  const float level = std::clamp(std::log2(std::max(texels, 1.f) / kCell), 0.f, float(levels_.size() - 1));
  const std::size_t i = std::min(std::size_t(level), levels_.size() - 1),
                    next = std::min(i + 1, levels_.size() - 1);
  return mixed(levels_[i].at(u, v), levels_[next].at(u, v), level - float(i));
}

}  // namespace opaline
