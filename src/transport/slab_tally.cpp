// SPDX-License-Identifier: GPL-3.0-or-later
#include "transport/slab_tally.h"

#include <algorithm>
#include <numbers>
#include <utility>

#include "transport/control_regression.h"

namespace opaline {
namespace {

/// Means over batches of sums over walks, with control variates.
class BatchMeans {
 public:
  BatchMeans(std::span<const SlabTally> batches, std::size_t walks_each)
      : batches_(batches), walks_each_(double(walks_each)), regression_(controls_of(batches)) {}

  /// Function of(batch): the sum over its walks.
  template <class Of>
  WalkedValue mean(const Of& of) const {
    return regression_.mean(values_of(of));
  }

  /// Without regression.
  template <class Of>
  WalkedValue plain_mean(const Of& of) const {
    return batch_mean(values_of(of));
  }

  /// The ratio of two sums; its error is that of numerator - ratio denominator, over the denominator.
  template <class Numerator, class Denominator>
  WalkedValue ratio(const Numerator& numerator, const Denominator& denominator) const {
    const double below = mean(denominator).value;
    if (!(below > 0)) return {};
    const double ratio = mean(numerator).value / below;
    const auto off = [&](const SlabTally& b) { return numerator(b) - ratio * denominator(b); };
    return {ratio, mean(off).error / below};
  }

  std::span<const SlabTally> batches() const { return batches_; }

 private:
  static std::vector<std::vector<double>> controls_of(std::span<const SlabTally> batches) {
    std::vector<std::vector<double>> controls;
    for (const SlabTally& b : batches) controls.emplace_back(b.controls.begin(), b.controls.end());
    return controls;
  }
  template <class Of>
  std::vector<double> values_of(const Of& of) const {
    std::vector<double> values;
    for (const SlabTally& batch : batches_) values.push_back(of(batch) / walks_each_);
    return values;
  }

  std::span<const SlabTally> batches_;
  double walks_each_;
  ControlRegression regression_;
};

WalkedValue scaled(const WalkedValue& value, double factor) {
  return {value.value * factor, value.error * factor};
}

using Face = FaceTally SlabTally::*;

std::vector<WalkedRing> summarize_rings(const TallyBins& bins, const BatchMeans& means, Face face) {
  std::vector<WalkedRing> rings(bins.radii.size());
  std::vector<double> inner(means.batches().size());  // per batch: weight within the rings so far
  for (std::size_t i = 0; i < rings.size(); ++i) {
    WalkedRing& ring = rings[i];
    ring.low = i == 0 ? 0 : bins.radii[i - 1];
    ring.high = bins.radii[i];
    ring.share = means.mean([&](const SlabTally& b) { return (b.*face).rings[i]; });
    for (std::size_t b = 0; b < inner.size(); ++b) inner[b] += (means.batches()[b].*face).rings[i];
    ring.within =
        means.mean([&](const SlabTally& b) { return inner[std::size_t(&b - means.batches().data())]; });
    const double area = std::numbers::pi * (ring.high - ring.low) * (ring.high + ring.low);
    ring.profile = scaled(ring.share, 1 / area);
  }
  return rings;
}

/// Equal cosines; the cosine-weighted fraction of a bin is high^2 - low^2.
template <class ValueOf>
std::vector<WalkedCosine> cosine_table(std::size_t count, const ValueOf& value_of) {
  std::vector<WalkedCosine> table(count);
  for (std::size_t i = 0; i < count; ++i)
    table[i] = {double(i) / double(count), double(i + 1) / double(count), value_of(i)};
  return table;
}

WalkedFace summarize_face(const TallyBins& bins, const BatchMeans& means, Face face) {
  const auto mean = [&](const auto& of) {
    return means.mean([&](const SlabTally& b) { return of(b.*face); });
  };
  WalkedFace result;
  result.total = mean([](const FaceTally& f) { return f.total; });
  result.uncollided = mean([](const FaceTally& f) { return f.uncollided; });
  result.rings = summarize_rings(bins, means, face);
  result.beyond = mean([](const FaceTally& f) { return f.rings.back(); });
  result.angular_exit = cosine_table(bins.cosines, [&](std::size_t i) {
    const auto n = double(bins.cosines);
    const double lambert = (2 * double(i) + 1) / (n * n);
    return scaled(means.ratio([&](const SlabTally& b) { return (b.*face).cosines[i]; },
                              [&](const SlabTally& b) { return (b.*face).total; }),
                  1 / lambert);
  });
  return result;
}

}  // namespace

std::size_t TallyBins::ring_of(double squared_radius) const {
  return std::size_t(std::ranges::upper_bound(squared_radii, squared_radius) - squared_radii.begin());
}

std::size_t TallyBins::cosine_of(double cosine) const {
  return std::min(cosines - 1, std::size_t(std::max(0.0, cosine) * double(cosines)));
}

TallyBins make_bins(std::vector<double> radii, std::size_t cosines, bool by_entry) {
  TallyBins bins{std::move(radii), {}, cosines, by_entry};
  for (const double r : bins.radii) bins.squared_radii.push_back(r * r);
  return bins;
}

SlabTally empty_tally(const TallyBins& bins) {
  SlabTally tally;
  for (FaceTally* face : {&tally.back, &tally.through}) {
    face->rings.resize(bins.radii.size() + 1);
    face->cosines.resize(bins.cosines);
  }
  if (bins.by_entry) {
    tally.entered.resize(bins.cosines);
    tally.returned.resize(bins.cosines);
  }
  return tally;
}

SlabWalks summarize(const TallyBins& bins, std::span<const SlabTally> batches, std::size_t walks_each) {
  const BatchMeans means(batches, walks_each);
  SlabWalks result;
  result.walks = walks_each * batches.size();
  result.collisions = means.plain_mean([](const SlabTally& b) { return b.collisions; }).value;
  result.back = summarize_face(bins, means, &SlabTally::back);
  result.through = summarize_face(bins, means, &SlabTally::through);
  result.absorbed = means.mean([](const SlabTally& b) { return b.absorbed; });
  result.unfinished = means.mean([](const SlabTally& b) { return b.unfinished; });
  result.energy = means.mean(
      [](const SlabTally& b) { return b.back.total + b.through.total + b.absorbed + b.unfinished; });
  if (bins.by_entry)
    result.albedo_by_entry = cosine_table(bins.cosines, [&](std::size_t i) {
      return means.ratio([i](const SlabTally& b) { return b.returned[i]; },
                         [i](const SlabTally& b) { return b.entered[i]; });
    });
  return result;
}

}  // namespace opaline
