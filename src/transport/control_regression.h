// SPDX-License-Identifier: GPL-3.0-or-later
// Batch means with control variates: removes the part explained by sums of known mean 0.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "transport/laboratory.h"

namespace opaline {

/// Mean of a value of each batch, and its standard error.
WalkedValue batch_mean(std::span<const double> values);

/// Linear regression on control variates over batches (Lavenberg & Welch 1981). The coefficients come from
/// the same batches, causing a bias of about (controls / batches) standard errors. The standard error is the
/// jackknife's, from each batch's deviation from the prediction by the others (HC3 of MacKinnon & White
/// 1985).
class ControlRegression {
 public:
  /// in    controls[batch]: each of mean 0, at least 50 batches. Excludes controls explained by others, and
  ///       badly sampled ones: with fewer than 40 effective batches, or a mean beyond five standard errors.
  ///       Always includes the first control, the energy balance, which explains everything without
  ///       absorption.
  explicit ControlRegression(const std::vector<std::vector<double>>& controls);

  /// Like batch_mean, with a smaller error.
  WalkedValue mean(std::span<const double> values) const;

  std::size_t controls_used() const { return columns_.size(); }

 private:
  struct Column {
    std::vector<double> values;  ///< values of each batch, centred; orthonormal to the other columns
    double mean = 0;             ///< mean of the same sum of controls, before centring
  };
  void take_in(Column column, bool is_balance);

  std::vector<Column> columns_;
  std::vector<double> shares_;    ///< weights of each batch in the mean
  std::vector<double> leverage_;  ///< leverage of each batch on its own prediction
};

}  // namespace opaline
