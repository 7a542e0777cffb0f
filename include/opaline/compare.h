// SPDX-License-Identifier: GPL-3.0-or-later
// Error of an image against a reference: relative errors, their statistics, an estimate from two halves, and
// LDR-FLIP.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "opaline/image.h"

namespace opaline {

/// Channels of one layer of an image, one plane each.
struct Layer {
  int width = 0, height = 0;
  std::vector<std::string> names;            ///< names of the channels in the file: "R" or "diffuse.R"
  std::vector<std::vector<float>> channels;  ///< as many as names, width * height values each
};

/// The layer of that name: "<name>.R", G, B or "<name>.X", Y, Z, or the one channel `name`; "" is R, G, B.
/// out   without channels if the image has no such layer
Layer extract_layer(const Image& image, const std::string& name);

/// Names of the layers for extract_layer, with "R,G,B" for the empty one.
std::vector<std::string> layers_of(const Image& image);

/// 1 for each covered pixel: coverage (channel A) above 0, or NaN, so a defect is not lost; 1 everywhere
/// without a channel A.
std::vector<std::uint8_t> object_pixels(const Image& image);

struct NonFinite {
  std::size_t nan = 0, infinite = 0;  ///< values, over all channels and the whole image
};
/// Number of infinite and NaN values of a layer.
NonFinite count_non_finite(const Layer& layer);

/// (a - b) / max(|b|, floor), one plane per channel. NaN in pixels not compared: not covered, or a or b is
/// not finite.
struct RelativeErrors {
  std::vector<std::vector<double>> channels;
  std::vector<double> floors;  ///< per channel, > 0
};

/// Relative errors of an image against its reference. The floor is 1e-3 of the p99 of |b| over the compared
/// pixels of the channel; if that is 0, 1e-3 of the largest |b|, or of the largest |a| if all b are 0.
/// in    two layers of the same size and number of channels, linear; object: a flag per pixel
RelativeErrors relative_errors(const Layer& picture, const Layer& reference,
                               const std::vector<std::uint8_t>& object);

/// Statistics of the values other than NaN; all 0 if there are none.
struct ErrorStatistics {
  std::size_t values = 0;
  double mean = 0;         ///< mean of |e|
  double mean_square = 0;  ///< mean of e^2: relMSE
  double p99 = 0;          ///< 99th percentile of |e|
  double largest = 0;      ///< largest of |e|
  double signed_mean = 0;  ///< signed mean of e
};
/// Statistics of one error per pixel, in any order.
ErrorStatistics error_statistics(std::span<const double> errors);

/// The same over all channels as one set of values.
ErrorStatistics error_statistics(const RelativeErrors& errors);

/// Percentile by nearest rank: the smallest value not exceeded by a fraction of the values; 0 for none.
/// in    share in (0, 1]; no NaN
double percentile(std::vector<double> values, double share);

/// An error estimate not raised by the reference's noise.
struct HalvesEstimate {
  std::size_t pixels = 0;     ///< compared: finite in all three images
  double squared_error = 0;   ///< below 0: the error is below the noise
  double standard_error = 0;  ///< standard error of squared_error, for independent pixels
  double error = 0;           ///< sqrt|squared_error| with its sign
  double signed_mean = 0;     ///< mean of (h - d) / mean(d)
  double half_noise = 0;      ///< relative noise of one half, rms
};
struct HalvesComparison {
  std::vector<HalvesEstimate> channels;
  HalvesEstimate all;  ///< mean over the compared channels of each pixel
};

/// Error of h against the mean d of two references with independent noise, d1 and d2: the mean of (h - d1)(h
/// - d2) / (d^2 + (0.01 m)^2) over the covered pixels, m the largest d of the channel there. The expectation
/// of the product is the squared error without noise. Noise n (half_noise) biases the quotient by a relative
/// part of the order of n^2, and by 1.5 n^4 (Gaussian n): at n = 5 % the latter alone appears as an error of
/// 0.3 %.
/// in    three layers of the same size and number of channels, linear; object: a flag per pixel
/// out   if all d are 0, m and mean(d) are those of |h|: large, not infinite
HalvesComparison compare_with_halves(const Layer& h, const Layer& d1, const Layer& d2,
                                     const std::vector<std::uint8_t>& object);

/// Error estimate against one noisy reference d of known variance v, for the worst channel: the root of the
/// mean of ((h - d)^2 - v) / (r^2 + (0.01 m)^2) over the covered pixels, m the largest d of the channel
/// there. r^2 is d^2 for v = 0; in pixels with noise of 5 % or more it is the mean of d^2 - v over the
/// neighbours, as the pixel's own noise would bias the quotient. 0 if the noise explains the whole
/// difference.
/// in    three layers of the same size and number of channels, linear; object: a flag per pixel. Pixels not
///       finite in all three are ignored
double error_beyond_noise(const Layer& h, const Layer& d, const Layer& variance,
                          const std::vector<std::uint8_t>& object);

/// (d1 + d2) / 2.
/// in    two layers of the same size and number of channels
Layer mean_of(const Layer& d1, const Layer& d2);

// ---- LDR-FLIP: the visible difference when flipping between two images ------------------------------------

/// At 0.7 m from a screen 0.7 m wide with 3840 pixels, as in the paper: 0.7 x 3840 / 0.7 x pi / 180.
constexpr double flip_pixels_per_degree = 67.02064327658226;

/// LDR-FLIP of each pixel, 0 (equal) to 1, after multiplication by 2^exposure and clamping to [0, 1].
/// in    two layers of three channels, R, G, B, linear Rec.709, of the same size; pixels_per_degree > 0.
///       Non-finite values count as 0; border pixels extend beyond the border
/// out   width * height values, finite; the same for any number of threads
/// from  Andersson et al. 2020, FLIP: A Difference Evaluator for Alternating Images, sections 4.1 to 4.3;
///       within 5e-5 of its authors' program (test_flip)
std::vector<float> flip(const Layer& picture, const Layer& reference, double exposure,
                        double pixels_per_degree = flip_pixels_per_degree);

/// Exposure in stops scaling the p99 of the brightest channel over the covered pixels to 1, a typical choice
/// for viewing the reference. 0 if the p99 is not positive.
double display_exposure(const Layer& reference, const std::vector<std::uint8_t>& object);

}  // namespace opaline
