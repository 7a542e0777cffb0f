// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/units.h"

#include <fmt/format.h>

#include <cmath>

namespace opaline {

std::string grouped(std::uint64_t count) {
  std::string digits = std::to_string(count);
  for (std::ptrdiff_t at = std::ssize(digits) - 3; at > 0; at -= 3) digits.insert(std::size_t(at), 1, ',');
  return digits;
}

std::string short_bytes(std::size_t bytes) {
  const double megabytes = double(bytes) / 1e6;
  if (bytes > 0 && megabytes < .0995) return fmt::format("{:.1f} kB", 1000 * megabytes);
  const bool giga = megabytes >= 999.5;
  const double value = giga ? megabytes / 1000 : megabytes;
  return fmt::format("{:.{}f} {}", value, value < 9.95 ? 1 : 0, giga ? "GB" : "MB");
}

std::string short_time(double seconds) {
  if (seconds < 9.95) return fmt::format("{:.1f} s", seconds);
  if (seconds < 120) return fmt::format("{:.0f} s", seconds);
  if (!(seconds < 1e9)) return "a long time";
  const auto whole = std::int64_t(std::lround(seconds));
  if (whole < 7200) return fmt::format("{} min {:02} s", whole / 60, whole % 60);
  return fmt::format("{} h {:02} min", whole / 3600, whole / 60 % 60);
}

std::string short_percent(double fraction) {
  const double percent = 100 * fraction;
  return percent < 99.5 ? fmt::format("{:.2g} %", percent) : fmt::format("{:.0f} %", percent);
}

}  // namespace opaline
