// SPDX-License-Identifier: GPL-3.0-or-later
#include "opaline/compare.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "opaline/error.h"

namespace opaline {
namespace {

constexpr double nothing = std::numeric_limits<double>::quiet_NaN();

const std::array<std::vector<std::string>, 2> triples{{{"R", "G", "B"}, {"X", "Y", "Z"}}};

bool has_channel(const Image& image, const std::string& name) {
  return std::ranges::find(image.channels, name) != image.channels.end();
}

std::vector<std::string> channels_of(const Image& image, const std::string& layer) {
  for (const std::vector<std::string>& triple : triples) {
    std::vector<std::string> names;
    for (const std::string& component : triple)
      names.push_back(layer.empty() ? component : layer + "." + component);
    if (std::ranges::all_of(names, [&](const std::string& name) { return has_channel(image, name); }))
      return names;
    if (layer.empty()) break;  // X, Y, Z alone are not colours
  }
  if (!layer.empty() && has_channel(image, layer)) return {layer};
  return {};
}

std::vector<float> plane_of(const Image& image, const std::string& name) {
  const std::size_t stride = image.channels.size();
  const auto first =
      static_cast<std::size_t>(std::ranges::find(image.channels, name) - image.channels.begin());
  std::vector<float> plane(image.pixels.size() / stride);
  for (std::size_t i = 0; i < plane.size(); ++i) plane[i] = image.pixels[i * stride + first];
  return plane;
}

void require_alike(const Layer& a, const Layer& b, const std::vector<std::uint8_t>& object) {
  require(a.width == b.width && a.height == b.height && a.channels.size() == b.channels.size(),
          "images with the same size and channels");
  require(object.size() == static_cast<std::size_t>(a.width) * static_cast<std::size_t>(a.height),
          "a flag for each pixel");
}

double largest_of(const std::vector<double>& values) {
  return values.empty() ? 0.0 : *std::ranges::max_element(values);
}

/// |a| and |b| of the compared pixels.
struct Magnitudes {
  std::vector<double> a, b;
};

double floor_of(const Magnitudes& compared) {
  constexpr double share = 1e-3;
  for (const double scale : {percentile(compared.b, .99), largest_of(compared.b), largest_of(compared.a)})
    if (scale > 0) return share * scale;
  return 1;  // both images are black: every error is 0
}

/// Running mean and variance.
class Moments {
 public:
  void add(double value) {
    ++count_;
    const double before = value - mean_;
    mean_ += before / static_cast<double>(count_);
    squares_ += before * (value - mean_);
  }
  std::size_t count() const { return count_; }
  double mean() const { return mean_; }
  double standard_error() const {
    const auto n = static_cast<double>(count_);
    return count_ > 1 ? std::sqrt(squares_ / (n * (n - 1))) : 0.0;
  }

 private:
  std::size_t count_ = 0;
  double mean_ = 0, squares_ = 0;
};

/// Contribution of a pixel to the means of HalvesEstimate.
struct Terms {
  double squared_error = 0, relative_error = 0, squared_noise = 0;
};

struct HalvesSums {
  Moments squared_error, relative_error, squared_noise;

  void add(const Terms& terms) {
    squared_error.add(terms.squared_error);
    relative_error.add(terms.relative_error);
    squared_noise.add(terms.squared_noise);
  }
  HalvesEstimate estimate() const {
    HalvesEstimate result;
    result.pixels = squared_error.count();
    result.squared_error = squared_error.mean();
    result.standard_error = squared_error.standard_error();
    result.error = std::copysign(std::sqrt(std::abs(result.squared_error)), result.squared_error);
    result.signed_mean = relative_error.mean();
    result.half_noise = std::sqrt(squared_noise.mean());
    return result;
  }
};

/// Values of one channel in the three images, pixel by pixel.
struct HalvesChannel {
  const std::vector<float>&h, &d1, &d2;
  double largest = 0, mean = 0;  ///< largest and mean of d over the compared pixels, > 0

  bool compared(std::size_t i) const {
    return std::isfinite(h[i]) && std::isfinite(d1[i]) && std::isfinite(d2[i]);
  }
  Terms terms(std::size_t i) const {
    const double value = h[i], first = d1[i], second = d2[i], d = .5 * (first + second);
    const double scale = d * d + 1e-4 * largest * largest;
    const double noise =
        (first - second) * (first - second) / 2;  // its expectation: the variance of one half
    return {(value - first) * (value - second) / scale, (value - d) / mean, noise / scale};
  }
};

HalvesChannel halves_channel(const std::vector<float>& h, const std::vector<float>& d1,
                             const std::vector<float>& d2, const std::vector<std::uint8_t>& object) {
  HalvesChannel channel{h, d1, d2};
  Moments d, magnitude;
  double largest_d = 0, largest_h = 0;
  for (std::size_t i = 0; i < object.size(); ++i) {
    if (!object[i] || !channel.compared(i)) continue;
    const double mean = .5 * (double(d1[i]) + double(d2[i]));
    d.add(mean);
    magnitude.add(std::abs(double(h[i])));
    largest_d = std::max(largest_d, mean);
    largest_h = std::max(largest_h, std::abs(double(h[i])));
  }
  const auto positive = [](double first, double second) {
    return first > 0 ? first : second > 0 ? second : 1;
  };
  channel.largest = positive(largest_d, largest_h);
  channel.mean = positive(d.mean(), magnitude.mean());
  return channel;
}

/// One channel against a noisy reference, see error_beyond_noise.
class NoisyChannel {
 public:
  NoisyChannel(const Layer& h, const Layer& d, const Layer& variance, std::size_t channel,
               const std::vector<std::uint8_t>& object)
      : width_(h.width),
        height_(h.height),
        h_(h.channels[channel]),
        d_(d.channels[channel]),
        variance_(variance.channels[channel]),
        object_(object) {}

  double error() const {
    double largest = 0, sum = 0;
    std::size_t pixels = 0;
    for (std::size_t i = 0; i < object_.size(); ++i)
      if (compared(i)) largest = std::max(largest, double(d_[i]));
    for (std::size_t i = 0; i < object_.size(); ++i) {
      if (!compared(i)) continue;
      const double difference = double(h_[i]) - double(d_[i]);
      const double scale = squared_reference(i) + 1e-4 * largest * largest;
      if (scale > 0) sum += (difference * difference - double(variance_[i])) / scale;
      ++pixels;
    }
    return pixels > 0 ? std::sqrt(std::max(0.0, sum / double(pixels))) : 0;
  }

 private:
  bool compared(std::size_t i) const {
    return object_[i] != 0 && std::isfinite(h_[i]) && std::isfinite(d_[i]) && std::isfinite(variance_[i]);
  }

  /// The pixel's own value if its noise is small; otherwise the neighbours', with noise independent of the
  /// numerator.
  double squared_reference(std::size_t i) const {
    constexpr double kSmallNoise = 0.05;
    const double own = double(d_[i]) * double(d_[i]), noise = double(variance_[i]);
    if (noise <= 0) return own;
    const double around = mean_square_around(i);
    const double share = std::min(1.0, noise / (kSmallNoise * kSmallNoise * around));
    return own + (around - own) * share;
  }

  /// Mean of d^2 - v over the neighbours, or of the pixel without neighbours; at least a tenth of the pixel's
  /// variance.
  double mean_square_around(std::size_t i) const {
    constexpr int kReach = 2;
    const int x = int(i) % width_, y = int(i) / width_;
    Moments squares;
    for (int row = std::max(0, y - kReach); row <= std::min(height_ - 1, y + kReach); ++row)
      for (int column = std::max(0, x - kReach); column <= std::min(width_ - 1, x + kReach); ++column) {
        const auto k = std::size_t(row) * std::size_t(width_) + std::size_t(column);
        if (k != i && compared(k)) squares.add(double(d_[k]) * double(d_[k]) - double(variance_[k]));
      }
    const double noise = double(variance_[i]);
    const double mean = squares.count() > 0 ? squares.mean() : double(d_[i]) * double(d_[i]) - noise;
    return std::max(mean, noise / 10);
  }

  int width_, height_;
  const std::vector<float>&h_, &d_, &variance_;
  const std::vector<std::uint8_t>& object_;
};

}  // namespace

Layer extract_layer(const Image& image, const std::string& name) {
  Layer layer{image.width, image.height, channels_of(image, name), {}};
  for (const std::string& channel : layer.names) layer.channels.push_back(plane_of(image, channel));
  return layer;
}

std::vector<std::string> layers_of(const Image& image) {
  std::vector<std::string> names;
  const bool colours = !channels_of(image, "").empty();
  if (colours) names.emplace_back("R,G,B");
  for (const std::string& channel : image.channels) {
    const std::string prefix = channel.substr(0, channel.rfind('.'));
    const bool triple = prefix != channel && !channels_of(image, prefix).empty();
    if (colours && std::ranges::find(triples[0], channel) != triples[0].end()) continue;
    const std::string& name = triple ? prefix : channel;
    if (std::ranges::find(names, name) == names.end()) names.push_back(name);
  }
  return names;
}

std::vector<std::uint8_t> object_pixels(const Image& image) {
  const std::size_t count = static_cast<std::size_t>(image.width) * static_cast<std::size_t>(image.height);
  std::vector<std::uint8_t> object(count, 1);
  if (!has_channel(image, "A")) return object;
  const std::vector<float> coverage = plane_of(image, "A");
  for (std::size_t i = 0; i < count; ++i) object[i] = coverage[i] <= 0 ? 0 : 1;
  return object;
}

NonFinite count_non_finite(const Layer& layer) {
  NonFinite count;
  for (const std::vector<float>& channel : layer.channels)
    for (const float value : channel) {
      if (std::isnan(value)) ++count.nan;
      if (std::isinf(value)) ++count.infinite;
    }
  return count;
}

double percentile(std::vector<double> values, double share) {
  if (values.empty()) return 0;
  const auto rank = static_cast<std::size_t>(std::ceil(share * static_cast<double>(values.size())));
  const auto at = values.begin() + static_cast<std::ptrdiff_t>(std::max<std::size_t>(rank, 1) - 1);
  std::nth_element(values.begin(), at, values.end());
  return *at;
}

RelativeErrors relative_errors(const Layer& picture, const Layer& reference,
                               const std::vector<std::uint8_t>& object) {
  require_alike(picture, reference, object);
  RelativeErrors errors;
  for (std::size_t c = 0; c < picture.channels.size(); ++c) {
    const std::vector<float>&a = picture.channels[c], &b = reference.channels[c];
    const auto compared = [&](std::size_t i) {
      return object[i] && std::isfinite(a[i]) && std::isfinite(b[i]);
    };
    Magnitudes magnitudes;
    for (std::size_t i = 0; i < object.size(); ++i) {
      if (!compared(i)) continue;
      magnitudes.a.push_back(std::abs(double(a[i])));
      magnitudes.b.push_back(std::abs(double(b[i])));
    }
    const double floor = floor_of(magnitudes);
    std::vector<double>& plane = errors.channels.emplace_back(object.size(), nothing);
    for (std::size_t i = 0; i < object.size(); ++i)
      if (compared(i)) plane[i] = (double(a[i]) - double(b[i])) / std::max(std::abs(double(b[i])), floor);
    errors.floors.push_back(floor);
  }
  return errors;
}

ErrorStatistics error_statistics(std::span<const double> errors) {
  ErrorStatistics result;
  std::vector<double> magnitudes;
  for (const double e : errors) {
    if (std::isnan(e)) continue;
    magnitudes.push_back(std::abs(e));
    result.mean += std::abs(e);
    result.mean_square += e * e;
    result.signed_mean += e;
  }
  result.values = magnitudes.size();
  if (result.values == 0) return result;
  const auto n = static_cast<double>(result.values);
  result.mean /= n;
  result.mean_square /= n;
  result.signed_mean /= n;
  result.largest = largest_of(magnitudes);
  result.p99 = percentile(std::move(magnitudes), .99);
  return result;
}

ErrorStatistics error_statistics(const RelativeErrors& errors) {
  std::vector<double> values;
  for (const std::vector<double>& channel : errors.channels)
    values.insert(values.end(), channel.begin(), channel.end());
  return error_statistics(values);
}

HalvesComparison compare_with_halves(const Layer& h, const Layer& d1, const Layer& d2,
                                     const std::vector<std::uint8_t>& object) {
  require_alike(h, d1, object);
  require_alike(h, d2, object);
  std::vector<HalvesChannel> channels;
  for (std::size_t c = 0; c < h.channels.size(); ++c)
    channels.push_back(halves_channel(h.channels[c], d1.channels[c], d2.channels[c], object));
  std::vector<HalvesSums> sums(channels.size());
  HalvesSums all;
  for (std::size_t i = 0; i < object.size(); ++i) {
    if (!object[i]) continue;
    Terms pixel;
    double compared = 0;
    for (std::size_t c = 0; c < channels.size(); ++c) {
      if (!channels[c].compared(i)) continue;
      const Terms terms = channels[c].terms(i);
      sums[c].add(terms);
      pixel.squared_error += terms.squared_error;
      pixel.relative_error += terms.relative_error;
      pixel.squared_noise += terms.squared_noise;
      ++compared;
    }
    if (compared > 0)
      all.add(
          {pixel.squared_error / compared, pixel.relative_error / compared, pixel.squared_noise / compared});
  }
  HalvesComparison result;
  for (const HalvesSums& channel : sums) result.channels.push_back(channel.estimate());
  result.all = all.estimate();
  return result;
}

double error_beyond_noise(const Layer& h, const Layer& d, const Layer& variance,
                          const std::vector<std::uint8_t>& object) {
  require_alike(h, d, object);
  require_alike(h, variance, object);
  double worst = 0;
  for (std::size_t c = 0; c < h.channels.size(); ++c)
    worst = std::max(worst, NoisyChannel(h, d, variance, c, object).error());
  return worst;
}

Layer mean_of(const Layer& d1, const Layer& d2) {
  Layer mean = d1;
  for (std::size_t c = 0; c < mean.channels.size(); ++c)
    for (std::size_t i = 0; i < mean.channels[c].size(); ++i)
      mean.channels[c][i] = .5f * (d1.channels[c][i] + d2.channels[c][i]);
  return mean;
}

}  // namespace opaline
