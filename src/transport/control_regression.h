// SPDX-License-Identifier: GPL-3.0-or-later
// Means of batches with the part taken out that sums of known mean 0 foretell.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "transport/laboratory.h"

namespace opaline {

/// Mean of a value of each batch, and its standard error.
WalkedValue batch_mean(std::span<const double> values);

/// Linear regression on control variates over batches (Lavenberg & Welch 1981): what controls explain of the
/// differences between batches is taken out of the mean. As the coefficients come from the same batches, a bias of
/// about (controls / batches) standard errors remains. The standard error is the jackknife's: each batch's distance
/// from what the others foretell (HC3 of MacKinnon & White 1985).
class ControlRegression {
 public:
  /// in    controls[batch]: each of mean 0, at least 50 batches. Left out are controls that others explain, and
  ///       those that this many walks sample badly: they live on fewer than 40 batches, or their mean over the
  ///       batches is five standard errors off. The first control is always taken in: it is the balance of energy,
  ///       and where nothing absorbs it explains all there is.
  explicit ControlRegression(const std::vector<std::vector<double>>& controls);

  /// As batch_mean, with less error.
  WalkedValue mean(std::span<const double> values) const;

  std::size_t controls_used() const { return columns_.size(); }

 private:
  struct Column {
    std::vector<double> values;  ///< values of each batch, centred; orthonormal to the other columns
    double mean = 0;             ///< mean of the same sum of controls, before it was centred
  };
  void take_in(Column column, bool is_balance);

  std::vector<Column> columns_;
  std::vector<double> shares_;    ///< shares of each batch in the mean
  std::vector<double> leverage_;  ///< leverage of each batch on its own prediction
};

}  // namespace opaline
