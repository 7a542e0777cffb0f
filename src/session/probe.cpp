// SPDX-License-Identifier: GPL-3.0-or-later
#include "session/probe.h"

#include <algorithm>
#include <cmath>

#include "opaline/core/random.h"
#include "opaline/image/metrics.h"

namespace opaline {

Scene probe_scene(const Scene& scene, double most_pixels) {
  Scene probe = scene;
  Film& film = probe.film;
  film.samples_per_pixel = 1;
  film.filter = PixelFilter::box;
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

Image probe_picture(const Session& session, Scene probe, std::uint64_t noise, Monitor* monitor) {
  probe.settings.seed = hash_bits(probe.settings.seed, noise);
  return render({probe, session.world(), session.rays(), session.groups(), monitor}).image;
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
    const ErrorStatistics difference = error_statistics(from_b.channels[k]);
    if (!(difference.mean_square > 0)) continue;
    double product = 0;
    for (std::size_t i = 0; i < lit.size(); ++i)
      if (lit[i]) product += from_b.channels[k][i] * from_c.channels[k][i];
    product /= double(difference.values);
    const double share = std::sqrt(std::max(0.0, product / difference.mean_square));
    worst = std::max(worst, std::clamp(share, 0.5, 1.4) * difference.mean);
  }
  return worst;
}

}  // namespace opaline
