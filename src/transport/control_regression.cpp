// SPDX-License-Identifier: GPL-3.0-or-later
#include "transport/control_regression.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

namespace opaline {
namespace {

double mean_of(std::span<const double> values) {
  return std::accumulate(values.begin(), values.end(), 0.0) / double(values.size());
}

double product(std::span<const double> a, std::span<const double> b) {
  return std::inner_product(a.begin(), a.end(), b.begin(), 0.0);
}

double norm(std::span<const double> a) {
  return std::sqrt(product(a, a));
}

void subtract(std::vector<double>& a, double factor, std::span<const double> b) {
  for (std::size_t i = 0; i < a.size(); ++i) a[i] -= factor * b[i];
}

}  // namespace

WalkedValue batch_mean(std::span<const double> values) {
  return ControlRegression(std::vector<std::vector<double>>(values.size())).mean(values);
}

ControlRegression::ControlRegression(const std::vector<std::vector<double>>& controls)
    : shares_(controls.size(), 1 / double(controls.size())), leverage_(shares_) {
  for (std::size_t c = 0; c < controls.front().size(); ++c) {
    Column column{std::vector<double>(controls.size()), 0};
    for (std::size_t b = 0; b < controls.size(); ++b) column.values[b] = controls[b][c];
    column.mean = mean_of(column.values);
    for (double& value : column.values) value -= column.mean;
    take_in(std::move(column), c == 0);
  }
}

void ControlRegression::take_in(Column column, bool is_balance) {
  constexpr double kDependent = 1e-6;  // relative to its own deviation
  constexpr double kMostOff = 5;       // standard errors of its mean
  constexpr double kFewBatches = 40;
  const double spread = norm(column.values);
  for (int round = 0; round < 2; ++round)  // removes the rounding errors of the first round
    for (const Column& other : columns_) {
      const double factor = product(column.values, other.values);
      subtract(column.values, factor, other.values);
      column.mean -= factor * other.mean;
    }
  const double left = norm(column.values);
  if (!(left > kDependent * spread)) return;
  double fourth = 0;  // sum of fourth powers: one over the effective number of batches
  for (double& value : column.values) {
    value /= left;
    fourth += value * value * value * value;
  }
  column.mean /= left;
  const bool is_sampled =
      fourth * kFewBatches < 1 && std::abs(column.mean) * double(shares_.size()) < kMostOff;
  if (!is_sampled && !is_balance) return;
  for (std::size_t b = 0; b < shares_.size(); ++b) {
    shares_[b] -= column.mean * column.values[b];
    leverage_[b] += column.values[b] * column.values[b];
  }
  columns_.push_back(std::move(column));
}

WalkedValue ControlRegression::mean(std::span<const double> values) const {
  const double plain = mean_of(values);
  std::vector<double> rest(values.begin(), values.end());
  for (double& value : rest) value -= plain;
  for (const Column& column : columns_) subtract(rest, product(rest, column.values), column.values);
  double variance = 0;
  for (std::size_t b = 0; b < rest.size(); ++b) {
    const double without_itself = rest[b] / std::max(1e-3, 1 - leverage_[b]);  // leave-one-out residual
    variance += shares_[b] * shares_[b] * without_itself * without_itself;
  }
  return {product(shares_, values), std::sqrt(variance)};
}

}  // namespace opaline
