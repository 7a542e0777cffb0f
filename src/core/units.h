// SPDX-License-Identifier: GPL-3.0-or-later
// Human-readable quantities.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>

namespace opaline {

std::string grouped(std::uint64_t count);    ///< 1234567 -> "1,234,567"
std::string short_bytes(std::size_t bytes);  ///< decimal: 1500000 -> "1.5 MB"
std::string short_time(double seconds);      ///< "0.3 s", "12 s", "3 min 20 s", "2 h 05 min"
std::string short_percent(double fraction);  ///< two digits, whole from 100 on: "0.25 %", "12 %", "140 %"

}  // namespace opaline
