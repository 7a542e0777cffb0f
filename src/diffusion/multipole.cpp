// SPDX-License-Identifier: GPL-3.0-or-later
#include "diffusion/multipole.h"

#include <algorithm>
#include <boost/math/special_functions/bessel.hpp>
#include <cmath>
#include <functional>
#include <numbers>
#include <utility>

#include "diffusion/find_radius.h"
#include "diffusion/mean_decay.h"
#include "transport/fresnel.h"

namespace opaline {
namespace {

using std::numbers::pi;

// Pairs of images summed on either side; an integral approximates the rest. Error about 1e-6 of R_d where the
// two sides nearly cancel in a thin plate, otherwise below 1e-7 (MultipoleProfile.IsTheSumOverImages). Images
// serve below half of the plate's height, modes beyond.
constexpr int kImages = 16;
constexpr double kNegligible = 40;  // exponents

// Thickness, in diffuse mean free paths or in distances of interest, above which the far face is negligible.
constexpr double kThick = 1e6;

double height(const Multipole& p) {
  return p.thickness + 2 * p.extrapolation;
}

bool is_dipole(const Multipole& p) {
  return !(p.thickness < kThick) || p.decay * p.thickness > kNegligible;
}

// sinh(s a) / sinh(s b), 0 <= a <= b, a / b at s = 0.
double sinh_ratio(double s, double a, double b) {
  return std::exp(-s * (b - a)) * (a * mean_decay(2 * s * a)) / (b * mean_decay(2 * s * b));
}

// Flux through the face at a point under a source at the height z, and its fraction within r. Odd in z.
struct Flux {
  double decay, r;
  double density(double z) const {
    const double d = std::hypot(r, z);
    return z * (1 + decay * d) * std::exp(-decay * d) / (d * d * d);
  }
  // Integral of density over z to infinity; z > 0.
  double density_above(double z) const {
    const double d = std::hypot(r, z);
    return std::exp(-decay * d) / d;
  }
  double within(double z) const {
    if (z == 0) return 0;
    const double high = std::abs(z), d = std::hypot(r, z), apart = r * (r / (d + high));
    const double share = std::exp(-decay * high) * (apart - high * std::expm1(-decay * apart)) / d;
    return z > 0 ? share : -share;
  }
  double within_above(double z) const {
    const double d = std::hypot(r, z), apart = r * (r / (d + z));
    return std::exp(-decay * z) * apart * mean_decay(decay * apart);
  }
};

// Sum over all images of f, for the face at `face`: sources at i period + depth, sinks at i period - depth -
// 2 b. F: the integral of f from a height on.
template <class F, class Above>
double sum_of_images(const Multipole& p, double face, const F& f, const Above& above) {
  const double period = 2 * height(p), sink = -p.depth - 2 * p.extrapolation;
  // Towards the face's outside: a source at z sends f(z) up through the upper face, f(d - z) down through the
  // lower.
  const double sign = face > 0 ? -1 : 1;
  const double a = p.depth - face, b = sink - face;
  double sum = f(a) - f(b);
  int i = 1;
  for (; i <= kImages && p.decay * period * (i - 1) < kNegligible; ++i) {
    const double z = i * period;
    sum += (f(z + a) + f(a - z)) - (f(z + b) + f(b - z));
  }
  const double rest = (i - .5) * period;
  sum += ((above(rest + a) - above(rest - a)) - (above(rest + b) - above(rest - b))) / period;
  return sign * sum;
}

// Sum over the modes of their flux through a face times g(rate), over pi times the height.
template <class G>
double sum_of_modes(const Multipole& p, double face, double r, const G& g) {
  const double whole = height(p);
  double sum = 0;
  for (int m = 1;; ++m) {
    const double k = m * pi / whole, rate = std::hypot(p.decay, k);
    const double slope = k * std::cos(k * (face + p.extrapolation));
    sum += slope * std::sin(k * (p.depth + p.extrapolation)) * g(rate);
    if ((rate - std::hypot(p.decay, pi / whole)) * r > kNegligible) break;
  }
  return (face > 0 ? -1 : 1) * sum / (pi * whole);
}

bool is_near(const Multipole& p, double r) {
  return r < height(p) / 2;
}

// 1/mean free path^2, of a source of strength 1.
double density(const Multipole& p, double face, double r) {
  if (is_dipole(p)) {
    if (face > 0) return 0;
    const Flux flux{p.decay, r};
    return (flux.density(p.depth) + flux.density(p.depth + 2 * p.extrapolation)) / (4 * pi);
  }
  if (is_near(p, r)) {
    const Flux flux{p.decay, r};
    return std::max(0.0, sum_of_images(
                             p, face, [&](double z) { return flux.density(z); },
                             [&](double z) { return flux.density_above(z); }) /
                             (4 * pi));
  }
  return std::max(
      0.0, sum_of_modes(p, face, r, [r](double rate) { return boost::math::cyl_bessel_k(0, rate * r); }));
}

double total(const Multipole& p, double face) {
  const double s = p.decay, b = p.extrapolation, z = p.depth;
  if (is_dipole(p)) return face > 0 ? 0 : (std::exp(-s * z) + std::exp(-s * (z + 2 * b))) / 2;
  // cosh(s b) is taken to the sines: sinh(x) cosh(y) = (sinh(x + y) + sinh(x - y)) / 2.
  const double x = face > 0 ? z + b : p.thickness + b - z, whole = height(p);
  return (sinh_ratio(s, x + b, whole) + sinh_ratio(s, std::max(0.0, x - b), whole)) / 2;
}

double beyond(const Multipole& p, double face, double r);

double within(const Multipole& p, double face, double r) {
  if (is_dipole(p)) {
    if (face > 0) return 0;
    const Flux flux{p.decay, r};
    return (flux.within(p.depth) + flux.within(p.depth + 2 * p.extrapolation)) / 2;
  }
  if (!is_near(p, r)) return total(p, face) - beyond(p, face, r);
  const Flux flux{p.decay, r};
  return std::max(0.0, sum_of_images(
                           p, face, [&](double z) { return flux.within(z); },
                           [&](double z) { return flux.within_above(z); }) /
                           2);
}

double beyond(const Multipole& p, double face, double r) {
  if (is_dipole(p)) {
    if (face > 0) return 0;
    const auto source = [&](double z) {
      const double d = std::hypot(r, z);
      return z / d * std::exp(-p.decay * d);
    };
    return (source(p.depth) + source(p.depth + 2 * p.extrapolation)) / 2;
  }
  if (is_near(p, r)) return total(p, face) - within(p, face, r);
  return std::max(0.0, sum_of_modes(p, face, r, [r](double rate) {
                    return 2 * pi * r * boost::math::cyl_bessel_k(1, rate * r) / rate;
                  }));
}

constexpr double kLeast = -60;  // log2 of a radius, mean free paths

constexpr int kPerOctave = 16;
constexpr double kTrusted = 1e-9;  // smaller tails cancel in the sum over images
constexpr double kTableStep = std::numbers::ln2 / kPerOctave;

/// From 1e-4 of the smallest length to a remaining fraction of 1e-20.
std::shared_ptr<const ShareTable> make_shares(const Multipole& p) {
  ShareTable table;
  const double all = total(p, 0), slowest = std::hypot(p.decay, pi / height(p));
  const double first = std::log(std::min(p.depth, height(p)) * 1e-4),
               last = std::log(50 / slowest + height(p));
  for (double u = first; u < last; u += kTableStep) {
    const double r = std::exp(u), ring = 2 * pi * r * r * density(p, 0, r);
    const double inside = within(p, 0, r), outside = beyond(p, 0, r);
    if (!(ring > 0 && inside > 0 && outside > 0)) break;
    if (is_near(p, r) && outside < kTrusted * all) continue;
    if (!table.distance.empty() && !(std::log(outside / all) < table.beyond.back())) continue;
    table.distance.push_back(u);
    table.within.push_back(std::log(inside / all));
    table.beyond.push_back(std::log(outside / all));
    table.slope_within.push_back(inside / ring);
    table.slope_beyond.push_back(-outside / ring);
  }
  table.decay = slowest;
  return std::make_shared<const ShareTable>(std::move(table));
}

/// Hermite's cubic in x through two rows of ascending y with their slopes.
double hermite(double x, double x0, double x1, double y0, double y1, double s0, double s1) {
  const double h = x1 - x0, t = (x - x0) / h, u = 1 - t;
  return std::clamp(u * u * ((1 + 2 * t) * y0 + t * h * s0) + t * t * ((1 + 2 * u) * y1 - u * h * s1), y0,
                    y1);
}

double distance_beyond(const ShareTable& table, double share) {
  if (share >= 1) return 0;
  const bool is_far = share < .5;
  const double x = is_far ? std::log(share) : std::log1p(-share);
  const std::vector<double>& key = is_far ? table.beyond : table.within;
  const std::vector<double>& slope = is_far ? table.slope_beyond : table.slope_within;
  const auto above = is_far ? std::lower_bound(key.begin(), key.end(), x, std::greater<>())
                            : std::lower_bound(key.begin(), key.end(), x);
  // Before the first row the profile is flat, and after the last one an exponential.
  if (above == key.begin()) return std::exp(table.distance[0] + (x - key[0]) * (is_far ? slope[0] : .5));
  if (above == key.end())
    return std::exp(table.distance.back()) + (is_far ? (key.back() - x) / table.decay : 0);
  const auto i = std::size_t(above - key.begin());
  return std::exp(
      hermite(x, key[i - 1], key[i], table.distance[i - 1], table.distance[i], slope[i - 1], slope[i]));
}

}  // namespace

Multipole make_profile(const ReducedMedium& medium, std::type_identity<Multipole>) {
  const double l = medium.mean_free_path, tau = l > 0 ? medium.thickness / l : INFINITY;
  // Mean depth 1 - tau / (e^tau - 1).
  const double depth = tau < 1e-3 ? tau / 2 * (1 - tau / 6) : tau < 700 ? 1 - tau / std::expm1(tau) : 1;
  Multipole p{.mean_free_path = l,
              .thickness = tau,
              .strength = (1 - medium.absorbed) * -std::expm1(-tau),
              .depth = depth,
              .extrapolation = 2. / 3 * boundary_mismatch(medium.eta),
              .decay = std::sqrt(3 * medium.absorbed),
              .shares = {}};
  if (!is_dipole(p)) p.shares = make_shares(p);
  return p;
}

double diffuse_reflectance_profile(const Multipole& p, double r) {
  const double l = p.mean_free_path;
  return l == 0 ? 0 : p.strength / (l * l) * density(p, 0, r / l);
}

double diffuse_reflectance_within(const Multipole& p, double r) {
  if (r <= 0) return 0;
  return p.mean_free_path == 0 ? total_diffuse_reflectance(p)
                               : p.strength * within(p, 0, r / p.mean_free_path);
}

double total_diffuse_reflectance(const Multipole& p) {
  return p.strength * total(p, 0);
}

double sample_diffusion_distance(const Multipole& p, double share) {
  if (p.shares != nullptr) return p.mean_free_path * distance_beyond(*p.shares, share);
  const double all = total(p, 0);
  return p.mean_free_path * find_radius([&](double r) { return beyond(p, 0, r) / all; }, share, kLeast);
}

// By parts: the integral beyond R is the profile beyond R plus pi R^2 R_d(R).
double sample_chord_sphere_radius(const Multipole& p, double u, double) {
  const double all = total(p, 0);
  const auto falling = [&](double r) { return (beyond(p, 0, r) + pi * r * r * density(p, 0, r)) / all; };
  return p.mean_free_path * find_radius(falling, 1 - u, kLeast);
}

double slowest_decay(const Multipole& p) {
  if (p.mean_free_path == 0) return 0;
  return (is_dipole(p) ? p.decay : std::hypot(p.decay, pi / height(p))) / p.mean_free_path;
}

double diffuse_transmittance_profile(const Multipole& p, double r) {
  const double l = p.mean_free_path;
  return l == 0 ? 0 : p.strength / (l * l) * density(p, p.thickness, r / l);
}

double diffuse_transmittance_within(const Multipole& p, double r) {
  if (r <= 0 || p.mean_free_path == 0) return 0;
  return p.strength * within(p, p.thickness, r / p.mean_free_path);
}

double total_diffuse_transmittance(const Multipole& p) {
  return p.mean_free_path == 0 ? 0 : p.strength * total(p, p.thickness);
}

}  // namespace opaline
