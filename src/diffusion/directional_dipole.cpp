// SPDX-License-Identifier: GPL-3.0-or-later
#include "diffusion/directional_dipole.h"

#include <algorithm>
#include <boost/math/quadrature/gauss.hpp>
#include <cmath>
#include <memory>
#include <numbers>
#include <utility>
#include <vector>

#include "transport/fresnel.h"
#include "transport/half_space.h"
#include "transport/smooth_boundary.h"

namespace opaline {
namespace {

using std::numbers::pi;

constexpr double kD = 1. / 3;  // diffusion coefficient over the mean free path

/// Exitance at x along the normal n, from a source of direction w at the distance d.
double source_exitance(const DirectionalKernel& p, const Vec3d& x, const Vec3d& w, double d, const Vec3d& n) {
  const double s = p.decay * d, one = 1 + s, along = dot(x, w);
  const double fluence = d * d / kD + 3 * one * along;
  const double flux =
      3 * kD * one * dot(w, n) - (one + 3 * kD * (3 * one + s * s) / (d * d) * along) * dot(x, n);
  return std::exp(-s) / (4 * pi * d * d * d) * (p.from_fluence * fluence - p.from_flux * flux);
}

/// Modified normal at the entry: of the plane through entry and exit nearest to the surface.
Vec3d modified_normal(const Vec3d& x, const Vec3d& normal) {
  const double r2 = dot(x, x);
  if (!(r2 > 0)) return normal;
  const Vec3d across = normal - x * (dot(normal, x) / r2);
  const double size = length(across);
  if (size > 1e-9) return across * (1 / size);
  Vec3d u, v;
  tangent_frame(x * (1 / std::sqrt(r2)), u, v);
  return u;
}

/// Refracted direction, unit.
Vec3d way_inside(const Vec3d& towards_light, const Vec3d& normal, double eta) {
  return refracted_inward(-towards_light, normal, eta);
}

/// x: from entry to exit, in mean free paths; w: way_inside. 1/mean free path^2.
double exitance(const DirectionalKernel& p, const Vec3d& x, const Vec3d& entry_normal, const Vec3d& w,
                const Vec3d& exit_normal) {
  const double r2 = dot(x, x), de = p.extrapolation, along = dot(x, w);
  const Vec3d n = modified_normal(x, entry_normal);
  const double cos_beta = -std::sqrt(std::max(0.0, r2 - along * along) / (r2 + de * de));
  const double mu = -dot(exit_normal, w);
  const double d = mu > 0 ? std::sqrt(kD * mu * (kD * mu - 2 * de * cos_beta) + r2) : std::sqrt(kD * kD + r2);
  const Vec3d from_image = x - n * p.image;
  if (!(d > 0)) return 0;
  return std::max(0.0, source_exitance(p, x, w, d, exit_normal) -
                           source_exitance(p, from_image, mirrored(w, n), length(from_image), exit_normal));
}

/// A refracted direction of diffuse light, with its fraction of the flux.
struct WayInside {
  Vec3d direction;  ///< in the plane y = 0 of a surface with the normal z
  double share;
};

WayInside way_at(double cosine, double eta) {
  return {way_inside({std::sqrt(std::max(0.0, 1 - cosine * cosine)), 0, cosine}, {0, 0, 1}, eta),
          2 * cosine * fresnel_transmittance(cosine, eta)};
}

std::vector<WayInside> diffuse_ways(double eta) {
  constexpr unsigned kCosines = 12;
  using Rule = boost::math::quadrature::gauss<double, kCosines>;
  const double low = eta < 1 ? std::sqrt(1 - eta * eta) : 0;  // total reflection below
  std::vector<WayInside> ways;
  double sum = 0;
  for (std::size_t i = 0; i < Rule::abscissa().size(); ++i)
    for (const double side : {-1., 1.}) {
      const double u = .5 + .5 * side * Rule::abscissa()[i];
      WayInside way = way_at(low + (1 - low) * u * u, eta);
      way.share *= u * Rule::weights()[i];
      sum += way.share;
      ways.push_back(way);
    }
  for (WayInside& way : ways) way.share /= sum;
  return ways;
}

/// Mean over the directions and over the azimuth at the distance r on a plane, mean free paths.
double ring_mean(const DirectionalKernel& p, const std::vector<WayInside>& ways, double r) {
  constexpr int kAzimuths = 12;  // azimuths of a half circle
  const Vec3d normal{0, 0, 1};
  double sum = 0;
  for (int i = 0; i < kAzimuths; ++i) {
    const double angle = pi * (i + .5) / kAzimuths;
    const Vec3d x{r * std::cos(angle), r * std::sin(angle), 0};
    for (const WayInside& way : ways) sum += way.share * exitance(p, x, normal, way.direction, normal);
  }
  return sum / kAzimuths;
}

/// Integral over the plane of a function of r with a dipole's decay: trapezoids over ln r.
template <class F>
double plane_integral(const F& f, double decay, double width) {
  constexpr double kStep = std::numbers::ln10 / 20, kFirst = 1e-3;
  double sum = 0, r = kFirst, last = 0;
  for (; r < 1e5 * width && decay * r < 60; r *= std::exp(kStep)) {
    last = 2 * pi * r * r * f(r);
    sum += kStep * last;
  }
  return sum + last / (1 + decay * r) + pi * kFirst * kFirst * f(kFirst);
}

ProfileShape mean_shape(const DirectionalKernel& kernel) {
  const std::vector<WayInside> ways = diffuse_ways(kernel.eta);
  const RadialReference reference{kernel.decay, kernel.image / 2};
  std::vector<double> logarithms;
  for (std::size_t i = 0; i < RadialTable::kKnots; ++i) {
    const double r = RadialTable::knot(i), over = ring_mean(kernel, ways, r) / reference(r);
    // Constant ratio beyond the exponential's underflow.
    logarithms.push_back(over > 0 ? std::log(over) : logarithms.empty() ? 0 : logarithms.back());
  }
  return {RadialTable(reference, std::move(logarithms)),
          plane_integral([&](double r) { return ring_mean(kernel, ways, r); }, kernel.decay, kernel.image)};
}

}  // namespace

double published_total(const DirectionalDipole& p) {
  return p.shape->get().integral;
}

double directional_reflectance(const DirectionalDipole& p, const DirectedPlace& entry,
                               const Vec3d& towards_light, const DirectedPlace& exit) {
  const double l = p.mean_free_path;
  if (l == 0) return 0;
  const Vec3d w = way_inside(towards_light, entry.normal, p.kernel.eta);
  return p.total / published_total(p) / (l * l) *
         exitance(p.kernel, (exit.position - entry.position) * (1 / l), entry.normal, w, exit.normal);
}

double total_directional_reflectance(const DirectionalDipole& p, double cosine) {
  const std::vector<WayInside> ways{{way_at(cosine, p.kernel.eta).direction, 1}};
  return p.total / published_total(p) *
         plane_integral([&](double r) { return ring_mean(p.kernel, ways, r); }, p.kernel.decay,
                        p.kernel.image);
}

DirectionalDipole make_profile(const ReducedMedium& medium, std::type_identity<DirectionalDipole>) {
  const double C1 = average_reflectance_inside(medium.eta) / 2, C2 = reflectance_moment_inside(medium.eta);
  DirectionalKernel kernel;
  kernel.eta = medium.eta;
  kernel.decay = std::sqrt(medium.absorbed / kD);
  kernel.extrapolation = 2.131 * kD / std::sqrt(1 - medium.absorbed);
  kernel.image = 2 * (1 + 3 * C2) / (1 - 2 * C1) * kernel.extrapolation;
  kernel.from_fluence = (1 - 2 * C1) / 4;
  kernel.from_flux = (1 - 3 * C2) / 2;
  return {{medium.mean_free_path, half_space_albedo(medium.absorbed, medium.eta), kernel.decay,
           std::make_shared<const LazyShape>(
               [kernel] { return std::make_shared<const ProfileShape>(mean_shape(kernel)); })},
          kernel};
}

}  // namespace opaline
