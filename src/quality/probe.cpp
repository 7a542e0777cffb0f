// SPDX-License-Identifier: GPL-3.0-or-later
#include "quality/probe.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/random.h"
#include "opaline/compare.h"
#include "scene/scene_properties.h"

namespace opaline {
namespace {

/// Sums over pixels of the differences of a from b, and of b from c.
struct Differences {
  double first = 0, second = 0, first_square = 0, product = 0, count = 0;

  void add(double ab, double bc) {
    first += std::abs(ab);
    second += std::abs(bc);
    first_square += ab * ab;
    product += ab * bc;
    count += 1;
  }
};

void blacken_opaque(RenderResult& result) {
  const std::vector<std::string>& channels = result.image.channels;
  for (const char* channel : {"diffuse.R", "diffuse.G", "diffuse.B"}) {
    const auto place = std::size_t(std::ranges::find(channels, channel) - channels.begin());
    for (std::size_t p = 0; p < result.translucent.size(); ++p)
      if (result.translucent[p] == 0) result.image.pixels[p * channels.size() + place] = 0;
  }
}

double error_of(const Differences& d) {
  const double t = std::exp2(error_slope(d.second, d.first)), step = (t - 1) * (t - 1);
  // With pattern s and noise n of a, squared: first_square = s (t - 1)^2 + n (1 + t^2), product = s t (t -
  // 1)^2 - n t^2.
  const double pattern =
      std::max(0.0, (t * t * d.first_square + (1 + t * t) * d.product) / (step * t * (1 + t + t * t)));
  const double noise = std::max(0.0, (d.first_square - pattern * step) / (1 + t * t));
  return std::sqrt((pattern + noise) / d.first_square) * d.first / d.count;
}

}  // namespace

Scene probe_scene(const Scene& scene, double most_pixels) {
  Scene probe = scene;
  Film& film = probe.film;
  film.samples_per_pixel = 1;
  film.filter = PixelFilter::box;
  // Opaque surfaces are ignored, hence black, unless they illuminate others.
  if (bounces_of(scene) == 0)
    for (Shape& shape : probe.shapes) shape.reflectance = {};
  const std::array<int, 4> part =
      film.crop.value_or(std::array<int, 4>{0, 0, film.resolution[0], film.resolution[1]});
  const double pixels = double(part[2] - part[0]) * double(part[3] - part[1]),
               scale = std::sqrt(most_pixels / pixels);
  if (scale >= 1) return probe;
  const auto scaled = [scale](int side) { return std::max(1, int(double(side) * scale)); };
  film.resolution = {scaled(film.resolution[0]), scaled(film.resolution[1])};
  if (!film.crop) return probe;
  for (std::size_t i = 0; i < 2; ++i) {
    const int side = film.resolution[i], low = std::min(int(part[i] * scale), side - 1);
    (*film.crop)[i] = low;
    (*film.crop)[i + 2] = std::clamp(int(part[i + 2] * scale), low + 1, side);
  }
  return probe;
}

RenderResult probe_picture(const Session& session, Scene probe, std::uint64_t noise, Monitor* monitor,
                           std::shared_ptr<const BouncedPlaces> bounced) {
  probe.settings.seed = hash_bits(probe.settings.seed, noise);
  RenderInput input{probe, session.world(), session.rays(), session.bodies(), monitor};
  input.bounced = std::move(bounced);
  RenderResult result = render(input);
  blacken_opaque(result);
  return result;
}

std::vector<std::uint8_t> translucent_pixels(const Image& picture) {
  const Layer diffuse = extract_layer(picture, "diffuse");
  std::vector<std::uint8_t> lit(diffuse.channels.at(0).size());
  for (const std::vector<float>& channel : diffuse.channels)
    for (std::size_t i = 0; i < lit.size(); ++i) lit[i] |= channel[i] > 0 ? 1 : 0;
  return lit;
}

double probe_difference(const Image& a, const Image& b) {
  const RelativeErrors errors =
      relative_errors(extract_layer(a, "diffuse"), extract_layer(b, "diffuse"), translucent_pixels(b));
  double worst = 0;
  for (const std::vector<double>& channel : errors.channels)
    worst = std::max(worst, error_statistics(channel).mean);
  return worst;
}

double probe_error(const Image& a, const Image& b, const Image& c) {
  const Layer best = extract_layer(a, "diffuse");
  const std::vector<std::uint8_t> lit = translucent_pixels(a);
  const RelativeErrors from_b = relative_errors(extract_layer(b, "diffuse"), best, lit),
                       from_c = relative_errors(extract_layer(c, "diffuse"), best, lit);
  double worst = 0;
  for (std::size_t k = 0; k < best.channels.size(); ++k) {
    Differences sums;
    for (std::size_t i = 0; i < lit.size(); ++i) {
      const double ab = from_b.channels[k][i], bc = from_c.channels[k][i] - ab;
      if (std::isfinite(bc)) sums.add(ab, bc);
    }
    if (sums.first_square > 0) worst = std::max(worst, error_of(sums));
  }
  return worst;
}

double error_slope(double before, double now) {
  constexpr double kUsual = 0.8, kLeast = 0.5, kMost = 1.2;
  if (!(before > 0) || !(now > 0)) return kUsual;
  return std::clamp((kUsual + std::log2(before / now)) / 2, kLeast, kMost);
}

}  // namespace opaline
