// SPDX-License-Identifier: GPL-3.0-or-later
// Numbers of formulas and all constants are those of Andersson et al. 2020.
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "core/parallel.h"
#include "opaline/compare.h"
#include "opaline/error.h"
#include "opaline/vec3.h"

namespace opaline {
namespace {

using Plane = std::vector<float>;
using Taps = std::vector<float>;  // 2 radius + 1

/// An image in an opponent colour space, or filter responses of one plane.
struct Planes {
  int width = 0, height = 0;
  std::array<Plane, 3> channels;
};

constexpr std::size_t rows_at_once = 16;

template <class Body>
void for_rows(int height, const Body& body) {
  parallel_chunks(static_cast<std::size_t>(height), rows_at_once,
                  [&](std::size_t begin, std::size_t end, std::size_t) {
                    for (std::size_t y = begin; y < end; ++y) body(static_cast<std::ptrdiff_t>(y));
                  });
}

void filter_rows(const Plane& in, int width, int height, const Taps& taps, Plane& out) {
  const auto radius = std::ssize(taps) / 2;
  for_rows(height, [&](std::ptrdiff_t y) {
    std::vector<float> padded(static_cast<std::size_t>(width + 2 * radius));
    const float* row = in.data() + y * width;
    for (std::ptrdiff_t i = 0; i < std::ssize(padded); ++i)
      padded[static_cast<std::size_t>(i)] = row[std::clamp<std::ptrdiff_t>(i - radius, 0, width - 1)];
    float* result = out.data() + y * width;
    std::fill_n(result, width, 0.0f);
    for (std::size_t k = 0; k < taps.size(); ++k)
      for (std::ptrdiff_t x = 0; x < width; ++x) result[x] += taps[k] * padded[k + std::size_t(x)];
  });
}

void filter_columns(const Plane& in, int width, int height, const Taps& taps, Plane& out) {
  const auto radius = std::ssize(taps) / 2;
  for_rows(height, [&](std::ptrdiff_t y) {
    float* result = out.data() + y * width;
    std::fill_n(result, width, 0.0f);
    for (std::ptrdiff_t k = 0; k < std::ssize(taps); ++k) {
      const float* row = in.data() + std::clamp<std::ptrdiff_t>(y + k - radius, 0, height - 1) * width;
      for (std::ptrdiff_t x = 0; x < width; ++x) result[x] += taps[std::size_t(k)] * row[x];
    }
  });
}

Plane filtered(const Plane& in, int width, int height, const Taps& across, const Taps& down) {
  Plane half(in.size()), out(in.size());
  filter_rows(in, width, height, across, half);
  filter_columns(half, width, height, down, out);
  return out;
}

/// weight(i) for i = -radius ... radius; its positive values sum to 1, its negative ones to -1.
template <class Weight>
Taps normalized_taps(int radius, const Weight& weight) {
  std::vector<double> weights;
  double positive = 0, negative = 0;
  for (int i = -radius; i <= radius; ++i) {
    const double w = weights.emplace_back(weight(double(i)));
    (w > 0 ? positive : negative) += std::abs(w);
  }
  Taps taps;
  for (const double w : weights)
    taps.push_back(w == 0 ? 0.0f : static_cast<float>(w / (w > 0 ? positive : negative)));
  return taps;
}

// Colours. XYZ is relative to white (Rec.709 primaries, D65 at x = 0.3127, y = 0.3290), so rows sum to 1.

constexpr float to_xyz[3][3] = {{.43388735f, .37622401f, .18988865f},
                                {.21263901f, .71516868f, .07219232f},
                                {.01775004f, .10944762f, .87280234f}};
constexpr float to_rgb[3][3] = {{3.08039909f, -1.53738318f, -.54301591f},
                                {-.92122336f, 1.87596750f, .04525586f},
                                {.05287394f, -.20397696f, 1.15110302f}};

Vec3f transform(const float (&m)[3][3], const Vec3f& v) {
  return {m[0][0] * v.x + m[0][1] * v.y + m[0][2] * v.z, m[1][0] * v.x + m[1][1] * v.y + m[1][2] * v.z,
          m[2][0] * v.x + m[2][1] * v.y + m[2][2] * v.z};
}

/// YyCxCz, linear in light: luminance, red against green, blue against yellow.
Vec3f opponent_of(const Vec3f& xyz) {
  return {116 * xyz.y - 16, 500 * (xyz.x - xyz.y), 200 * (xyz.y - xyz.z)};
}

Vec3f xyz_of_opponent(const Vec3f& opponent) {
  const float y = (opponent.x + 16) / 116;
  return {y + opponent.y / 500, y, y - opponent.z / 200};
}

/// CIELAB with a and b scaled by 0.01 L, for the Hunt effect: colours fade in the dark.
Vec3f hunt_lab_of(const Vec3f& xyz) {
  constexpr float delta = 6.0f / 29.0f;
  const auto f = [](float t) {
    return t > delta * delta * delta ? std::cbrt(t) : t / (3 * delta * delta) + 4.0f / 29.0f;
  };
  const float x = f(xyz.x), y = f(xyz.y), z = f(xyz.z), lightness = 116 * y - 16;
  return {lightness, .01f * lightness * 500 * (x - y), .01f * lightness * 200 * (y - z)};
}

float hyab(const Vec3f& a, const Vec3f& b) {
  return std::abs(a.x - b.x) + std::hypot(a.y - b.y, a.z - b.z);
}

Planes opponent_planes(const Layer& layer, double exposure) {
  Planes planes{layer.width, layer.height, {}};
  const std::size_t count = layer.channels[0].size();
  for (Plane& plane : planes.channels) plane.resize(count);
  const double gain = std::exp2(exposure);
  for_rows(layer.height, [&](std::ptrdiff_t y) {
    for (std::ptrdiff_t x = 0; x < layer.width; ++x) {
      const auto i = static_cast<std::size_t>(y * layer.width + x);
      Vec3f rgb;
      for (std::size_t c = 0; c < 3; ++c) {
        const double value = layer.channels[c][i];
        rgb[c] = std::isfinite(value) && value > 0 ? float(std::min(value * gain, 1.0)) : 0.0f;
      }
      const Vec3f opponent = opponent_of(transform(to_xyz, rgb));
      for (std::size_t c = 0; c < 3; ++c) planes.channels[c][i] = opponent[c];
    }
  });
  return planes;
}

// The colour pipeline, section 4.1: contrast-sensitivity filtering, in CIELAB.

/// a sqrt(pi / b) exp(-pi^2 x^2 / b) at x degrees, the transform of a term of a sensitivity function (table
/// 1).
struct Sensitivity {
  double a, b;
};
constexpr Sensitivity achromatic{1, .0047}, red_green{1, .0053};
constexpr std::array<Sensitivity, 2> blue_yellow{{{34.1, .04}, {13.5, .025}}};

/// One term as a filter; `weight` is its integral before normalization.
struct SensitivityFilter {
  Taps taps;
  double weight = 0;
};

SensitivityFilter make_filter(const Sensitivity& term, double pixels_per_degree) {
  constexpr double pi = std::numbers::pi;
  // Three standard deviations of the widest of all terms.
  const int radius =
      static_cast<int>(std::ceil(3 * std::sqrt(blue_yellow[0].b / (2 * pi * pi)) * pixels_per_degree));
  double sum = 0;
  const auto gaussian = [&](double i) {
    const double degrees = i / pixels_per_degree;
    return std::exp(-pi * pi * degrees * degrees / term.b);
  };
  for (int i = -radius; i <= radius; ++i) sum += gaussian(i);
  return {normalized_taps(radius, gaussian), term.a * std::sqrt(pi / term.b) * sum * sum};
}

/// Two Gaussians in one filter: each is separable, their sum is not.
Plane filtered_blue_yellow(const Planes& opponent, double pixels_per_degree) {
  const SensitivityFilter first = make_filter(blue_yellow[0], pixels_per_degree);
  const SensitivityFilter second = make_filter(blue_yellow[1], pixels_per_degree);
  const auto share = static_cast<float>(first.weight / (first.weight + second.weight));
  Plane sum = filtered(opponent.channels[2], opponent.width, opponent.height, first.taps, first.taps);
  const Plane other =
      filtered(opponent.channels[2], opponent.width, opponent.height, second.taps, second.taps);
  for (std::size_t i = 0; i < sum.size(); ++i) sum[i] = share * sum[i] + (1 - share) * other[i];
  return sum;
}

Planes seen_colours(const Planes& opponent, double pixels_per_degree) {
  Planes seen{opponent.width, opponent.height, {}};
  for (const std::size_t c : {0, 1}) {
    const Taps taps = make_filter(c == 0 ? achromatic : red_green, pixels_per_degree).taps;
    seen.channels[c] = filtered(opponent.channels[c], opponent.width, opponent.height, taps, taps);
  }
  seen.channels[2] = filtered_blue_yellow(opponent, pixels_per_degree);
  for_rows(seen.height, [&](std::ptrdiff_t y) {
    for (std::ptrdiff_t x = 0; x < seen.width; ++x) {
      const auto i = static_cast<std::size_t>(y * seen.width + x);
      const Vec3f filter{seen.channels[0][i], seen.channels[1][i], seen.channels[2][i]};
      const Vec3f rgb = transform(to_rgb, xyz_of_opponent(filter));
      const Vec3f lab =
          hunt_lab_of(transform(to_xyz, component_min(component_max(rgb, Vec3f(0.0f)), Vec3f(1.0f))));
      for (std::size_t c = 0; c < 3; ++c) seen.channels[c][i] = lab[c];
    }
  });
  return seen;
}

/// Compresses large differences: up to 0.4 of the largest maps to [0, 0.95], the rest to the rest (section
/// 4.1.4).
float colour_difference(const Vec3f& a, const Vec3f& b) {
  constexpr float power = .7f, knee = .4f, height = .95f;
  static const float largest = std::pow(
      hyab(hunt_lab_of(transform(to_xyz, {0, 1, 0})), hunt_lab_of(transform(to_xyz, {0, 0, 1}))), power);
  const float difference = std::pow(hyab(a, b), power);
  if (difference < knee * largest) return height / (knee * largest) * difference;
  return height + (difference - knee * largest) / (largest - knee * largest) * (1 - height);
}

// The feature pipeline, section 4.2: edges and points in the luminance.

/// Lengths of the first and second derivatives.
struct Features {
  Plane edges, points;
};

Plane lengths(const Plane& x, const Plane& y) {
  Plane length(x.size());
  for (std::size_t i = 0; i < x.size(); ++i) length[i] = std::sqrt(x[i] * x[i] + y[i] * y[i]);
  return length;
}

Features features_of(const Planes& opponent, double pixels_per_degree) {
  const double deviation = .5 * .082 * pixels_per_degree;  // an edge is 0.082 degrees wide
  const int radius = static_cast<int>(std::ceil(3 * deviation));
  const auto gaussian = [&](double i) { return std::exp(-i * i / (2 * deviation * deviation)); };
  const Taps smooth = normalized_taps(radius, gaussian);
  const Taps first = normalized_taps(radius, [&](double i) { return -i * gaussian(i); });
  const Taps second =
      normalized_taps(radius, [&](double i) { return (i * i / (deviation * deviation) - 1) * gaussian(i); });

  Plane luminance = opponent.channels[0];
  for (float& value : luminance) value = (value + 16) / 116;
  const auto filter = [&](const Taps& across, const Taps& down) {
    return filtered(luminance, opponent.width, opponent.height, across, down);
  };
  return {lengths(filter(first, smooth), filter(smooth, first)),
          lengths(filter(second, smooth), filter(smooth, second))};
}

struct Perceived {
  Planes colours;
  Features features;
};

Perceived perceive(const Layer& layer, double exposure, double pixels_per_degree) {
  require(layer.channels.size() == 3, "FLIP is of the channels R, G and B");
  const Planes opponent = opponent_planes(layer, exposure);
  return {seen_colours(opponent, pixels_per_degree), features_of(opponent, pixels_per_degree)};
}

Vec3f pixel_of(const Planes& planes, std::size_t i) {
  return {planes.channels[0][i], planes.channels[1][i], planes.channels[2][i]};
}

}  // namespace

std::vector<float> flip(const Layer& picture, const Layer& reference, double exposure,
                        double pixels_per_degree) {
  require(picture.width == reference.width && picture.height == reference.height,
          "images with the same size");
  const Perceived a = perceive(picture, exposure, pixels_per_degree);
  const Perceived b = perceive(reference, exposure, pixels_per_degree);
  std::vector<float> difference(picture.channels[0].size());
  for_rows(picture.height, [&](std::ptrdiff_t y) {
    for (std::ptrdiff_t x = 0; x < picture.width; ++x) {
      const auto i = static_cast<std::size_t>(y * picture.width + x);
      const float feature = std::max(std::abs(a.features.edges[i] - b.features.edges[i]),
                                     std::abs(a.features.points[i] - b.features.points[i]));
      const float feature_difference = std::sqrt(feature / std::numbers::sqrt2_v<float>);
      const float colour = colour_difference(pixel_of(a.colours, i), pixel_of(b.colours, i));
      difference[i] = std::pow(colour, 1 - feature_difference);  // section 4.3
    }
  });
  return difference;
}

double display_exposure(const Layer& reference, const std::vector<std::uint8_t>& object) {
  std::vector<double> brightest;
  for (std::size_t i = 0; i < object.size(); ++i) {
    double value = 0;
    for (const std::vector<float>& channel : reference.channels)
      if (std::isfinite(channel[i])) value = std::max(value, double(channel[i]));
    if (object[i]) brightest.push_back(value);
  }
  const double p99 = percentile(std::move(brightest), .99);
  return p99 > 0 ? -std::log2(p99) : 0.0;
}

}  // namespace opaline
