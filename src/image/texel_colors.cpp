// SPDX-License-Identifier: GPL-3.0-or-later
#include "image/texel_colors.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/srgb.h"
#include "opaline/error.h"

namespace opaline {

std::optional<ColorMatrix> matrix_to_rec709(const OIIO::ImageSpec& file, const std::string& path) {
  float stated[8];
  if (!file.getattribute("chromaticities", OIIO::TypeDesc(OIIO::TypeDesc::FLOAT, 8), stated)) return {};
  const auto pair = [&](std::size_t i) {
    return std::array<double, 2>{double(stated[i]), double(stated[i + 1])};
  };
  return matrix_to_rec709({pair(0), pair(2), pair(4), pair(6)}, path);
}

namespace {

/// Cosine and sine of twice the angle of a direction by 2 c - 1; zeros: none.
std::array<double, 2> axis_of(double red, double green) {
  const double x = 2 * red - 1, y = 2 * green - 1, squares = x * x + y * y;
  if (!(squares > 1e-4)) return {};
  return {(x * x - y * y) / squares, 2 * x * y / squares};
}

}  // namespace

TexelColors::TexelColors(const OIIO::ImageSpec& file, std::string_view format, const TexelLayout& layout,
                         TextureEncoding encoding, const std::string& path)
    : is_srgb(encoding.space == ColorSpace::srgb), content(encoding.content) {
  const bool has_associated_alpha =
      layout.places[3] >= 0 && file.get_int_attribute("oiio:UnassociatedAlpha") == 0;
  // OpenImageIO multiplies a WebP's numbers by alpha, whatever it is asked for.
  is_premultiplied = has_associated_alpha && format == "webp";
  if (content != TextureContent::colors) return;
  is_premultiplied = is_premultiplied || (has_associated_alpha && (format == "exr" || format == "tiff"));
  const auto& [red, green, blue, alpha] = layout.places;
  if (std::min({red, green, blue}) >= 0 && red != green) to_rec709 = matrix_to_rec709(file, path);
}

OIIO::TypeDesc TexelColors::type_for(OIIO::TypeDesc native) const {
  if (are_plain()) return native;
  return native.is_floating_point() && !is_srgb ? OIIO::TypeFloat : OIIO::TypeHalf;
}

void TexelColors::apply(Texel& texel) const {
  auto& [red, green, blue, alpha] = texel;
  if (is_premultiplied && alpha > 0)
    for (std::size_t c = 0; c < 3; ++c) texel[c] /= alpha;
  if (is_srgb)
    for (std::size_t c = 0; c < 3; ++c) texel[c] = srgb_to_linear(texel[c]);
  if (content == TextureContent::directions) {
    const auto [cosine, sine] = axis_of(red, green);
    red = cosine, green = sine;
  } else if (are_angles()) {
    const double quarter = content == TextureContent::angle_sines ? .25 : 0;
    for (std::size_t c = 0; c < 3; ++c) texel[c] = std::cos(2 * std::numbers::pi * (2 * texel[c] - quarter));
  }
  if (!to_rec709) return;
  const bool is_above_zero = std::min({red, green, blue}) >= 0,
             is_below_one = std::max({red, green, blue}) <= 1;
  const Vec3d color = *to_rec709 * Vec3d{red, green, blue};
  for (std::size_t c = 0; c < 3; ++c) {
    texel[c] = color[c];
    if (is_above_zero) texel[c] = std::max(texel[c], 0.0);
    if (is_above_zero && is_below_one) texel[c] = std::min(texel[c], 1.0);
  }
}

}  // namespace opaline
