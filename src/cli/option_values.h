// SPDX-License-Identifier: GPL-3.0-or-later
// Conversion and validation of option texts.
#pragma once

#include <CLI/CLI.hpp>
#include <optional>
#include <string>
#include <string_view>

#include "core/image_part.h"
#include "image/picture_layers.h"
#include "input/schema.h"

namespace opaline {

inline constexpr Range kThreads{1, 4096}, kPorts{0, 65535}, kRepeats{3, 1000}, kWalks{1, 1e9};

/// "640x480" -> "[640,480]", "0,0,16,16" -> "[0,0,16,16]"; empty if it is neither.
std::string resolution_json(std::string_view text);
std::string crop_json(std::string_view text);

/// "1%" or "0.01" -> 0.01; empty for other texts and negative numbers.
std::optional<double> share_of(std::string_view text);

CLI::Validator resolution_check();
CLI::Validator crop_check();
/// CLI11 would wrap or clamp numbers beyond 64 bits, and read 010 as 8.
CLI::Validator whole_number(const Range& range);
/// Fraction of 0 or more. A number without % must be below 1, because "1" usually means 1 %.
CLI::Validator share_check();
/// The same in (0, 1].
CLI::Validator positive_share_check();
/// "2s", "500ms", "1.5min", "1h" or seconds alone, to seconds.
CLI::Validator seconds_of();
/// "2mm", "500um", "0.5cm", "1m" or millimetres alone, to millimetres.
CLI::Validator millimetres_of();
/// "500MB", "8GB" or 0, to bytes; kB is 1000.
CLI::Validator bytes_of();
/// Finite.
CLI::Validator number_check();
CLI::Validator log_check();
/// Checks the extension of a file name.
CLI::Validator extension_check(const std::string& extension);
/// "diffuse,N", "all" or "none"; empty if a name is not a layer's.
std::optional<LayerChoice> layers_of(const std::string& text);
CLI::Validator layers_check();
/// "2/8"; empty unless 1 <= K <= N <= 4096.
std::optional<ImagePart> part_of(std::string_view text);
CLI::Validator part_check();
/// NAME=VALUE.
CLI::Validator rung_check();

}  // namespace opaline
