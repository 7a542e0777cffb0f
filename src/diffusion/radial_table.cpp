// SPDX-License-Identifier: GPL-3.0-or-later
#include "diffusion/radial_table.h"

#include <algorithm>
#include <boost/math/quadrature/gauss.hpp>
#include <cmath>
#include <numbers>
#include <utility>

#include "opaline/error.h"

namespace opaline {
namespace {

using std::numbers::pi;

constexpr double kStep = std::numbers::ln10 / RadialTable::kPerDecade;  // step of ln r
// Range of the table; beyond it, the reference is a dipole's far field, or zero.
constexpr double kManyWidths = 1e5, kManyDecays = 60;
constexpr double kFarthest = 1400;  // knots: squares of such distances are in double's range

/// d ln reference / d ln r.
double slope(const RadialReference& reference, double r) {
  const double s = reference.decay * r, w2 = reference.width * reference.width;
  return -s * s / (1 + s) - 1 - 2 * r * r / (r * r + w2);
}

/// Second derivatives at the knots of the cubic spline through f with zero slope at its ends, steps of 1.
std::vector<double> spline_curvature(const std::vector<double>& f) {
  const std::size_t n = f.size();
  std::vector<double> right(n), pivot(n), m(n);
  for (std::size_t i = 0; i < n; ++i) {
    const double before = i > 0 ? f[i] - f[i - 1] : 0, after = i + 1 < n ? f[i + 1] - f[i] : 0;
    right[i] = 6 * (after - before);
    pivot[i] = i == 0 || i + 1 == n ? 2 : 4;
  }
  for (std::size_t i = 1; i < n; ++i) {
    pivot[i] -= 1 / pivot[i - 1];
    right[i] -= right[i - 1] / pivot[i - 1];
  }
  for (std::size_t i = n; i-- > 0;) m[i] = (right[i] - (i + 1 < n ? m[i + 1] : 0)) / pivot[i];
  return m;
}

}  // namespace

double RadialReference::operator()(double r) const {
  const double s = decay * r;
  return (1 + s) * std::exp(-s) / (r * (r * r + width * width));
}

double RadialTable::knot(std::size_t i) {
  return kFirst * std::exp(kStep * double(i));
}

RadialTable::RadialTable(const RadialReference& reference, std::vector<double> logarithms)
    : reference_(reference), logarithms_(std::move(logarithms)) {
  require(logarithms_.size() == kKnots && reference.width > 0, "a table with a value at each knot");
  constexpr double kLeastFall = .01;  // minimum slope of ln density over ln r, between knots
  for (std::size_t i = 1; i < kKnots; ++i) {
    const double steepest = -slope(reference_, knot(i - 1)) - kLeastFall;
    logarithms_[i] = std::min(logarithms_[i], logarithms_[i - 1] + kStep * steepest);
  }
  curvature_ = spline_curvature(logarithms_);
  const double last = std::min(kManyWidths * reference_.width,
                               reference_.decay > 0 ? kManyDecays / reference_.decay : INFINITY);
  const auto count = std::size_t(std::max(double(kKnots), std::ceil(std::log(last / kFirst) / kStep) + 1));
  std::vector<double> shares{ring(0)};  // before the first knot: 2 pi r times a constant over r
  for (std::size_t i = 1; i < count; ++i) shares.push_back(ring_integral(double(i - 1), double(i)));
  const double end = knot(count - 1), s = reference_.decay * end;
  shares.push_back(ring(double(count - 1)) / (1 + s));  // integral of (1 + kappa r) e^-kappa r / r^3
  within_.resize(count);
  beyond_.resize(count);
  double sum = 0;
  for (std::size_t i = 0; i < count; ++i) within_[i] = sum += shares[i];
  sum = 0;
  for (std::size_t i = count; i-- > 0;) beyond_[i] = sum += shares[i + 1];
  scale_ = 1 / (within_[0] + beyond_[0]);
  for (std::size_t i = 0; i < count; ++i) {
    within_[i] *= scale_;
    beyond_[i] *= scale_;
  }
}

double RadialTable::place_of(double r) const {
  return std::log(r / kFirst) / kStep;
}

double RadialTable::spline(double u) const {
  if (u <= 0) return logarithms_.front();
  if (u >= double(kKnots - 1)) return logarithms_.back();
  const auto i = std::size_t(u);
  const double t = u - double(i), s = 1 - t;
  return s * logarithms_[i] + t * logarithms_[i + 1] +
         (s * (s * s - 1) * curvature_[i] + t * (t * t - 1) * curvature_[i + 1]) / 6;
}

double RadialTable::ring(double u) const {
  const double r = kFirst * std::exp(kStep * u);
  return 2 * pi * r * r * scale_ * reference_(r) * std::exp(spline(u));
}

double RadialTable::ring_integral(double low, double high) const {
  if (!(high > low)) return 0;
  using Rule = boost::math::quadrature::gauss<double, 10>;
  return kStep * Rule::integrate([this](double u) { return ring(u); }, low, high);
}

double RadialTable::density(double r) const {
  const double u = place_of(r), end = double(within_.size() - 1);
  if (u <= 0) return ring(0) / (2 * pi * kFirst) / r;
  if (u <= end) return scale_ * reference_(r) * std::exp(spline(u));
  const double last = knot(within_.size() - 1), s = reference_.decay * r, s0 = reference_.decay * last;
  const double ratio = last / r;
  return ring(end) / (2 * pi * last * last) * ratio * ratio * ratio * ((1 + s) / (1 + s0)) * std::exp(s0 - s);
}

double RadialTable::within(double r) const {
  if (!(r > 0)) return 0;
  const double u = place_of(r);
  if (u <= 0) return within_[0] * (r / kFirst);
  if (u >= double(within_.size() - 1)) return 1 - beyond(r);
  const auto i = std::size_t(u);
  return within_[i] + ring_integral(double(i), u);
}

double RadialTable::beyond(double r) const {
  if (!(r > 0)) return 1;
  const double u = place_of(r);
  if (u <= 0) return 1 - within(r);
  const std::size_t n = within_.size();
  if (u >= double(n - 1)) {
    const double last = knot(n - 1);
    return beyond_.back() * (last / r) * std::exp(-reference_.decay * (r - last));
  }
  const auto i = std::size_t(u);
  return beyond_[i + 1] + ring_integral(u, double(i + 1));
}

// Bisection over ln r.
template <class Falling>
double RadialTable::find(const Falling& falling, double share, double low, double high) const {
  for (int i = 0; i < 100; ++i) {
    const double middle = .5 * (low + high);
    if (middle == low || middle == high) break;
    (falling(kFirst * std::exp(kStep * middle)) > share ? low : high) = middle;
  }
  return kFirst * std::exp(kStep * .5 * (low + high));
}

double RadialTable::radius_beyond(double share) const {
  if (share >= 1) return 0;
  if (1 - share <= within_[0]) return kFirst * (1 - share) / within_[0];
  if (share <= beyond_.back()) {
    double high = double(within_.size());
    while (beyond(kFirst * std::exp(kStep * high)) > share && high < kFarthest) high *= 2;
    return find([this](double r) { return beyond(r); }, share, double(within_.size() - 1), high);
  }
  const auto above =
      std::lower_bound(beyond_.begin(), beyond_.end(), share, [](double b, double s) { return b > s; });
  const std::size_t i = std::max<std::size_t>(1, std::size_t(above - beyond_.begin()));
  // Newton's method within an interval of nearly constant integrand; bisection if it leaves it.
  double low = double(i - 1), high = double(i), u = .5 * (low + high);
  for (int round = 0; round < 60; ++round) {
    const double off = beyond_[i] + ring_integral(u, double(i)) - share;
    (off > 0 ? low : high) = u;
    double next = u + off / (kStep * ring(u));
    if (!(next > low && next < high)) next = .5 * (low + high);
    if (std::abs(next - u) < 1e-15 * std::max(1.0, u)) break;
    u = next;
  }
  return kFirst * std::exp(kStep * u);
}

double RadialTable::chord_radius_beyond(double share) const {
  if (share >= 1) return 0;
  const auto falling = [this](double r) { return beyond(r) + pi * r * r * density(r); };
  double low = -400, high = double(within_.size());
  while (falling(kFirst * std::exp(kStep * high)) > share && high < kFarthest) high *= 2;
  return find(falling, share, low, high);
}

}  // namespace opaline
