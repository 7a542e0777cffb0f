// SPDX-License-Identifier: GPL-3.0-or-later
// The report of `opaline profile` as a page and tables.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

#include "benchmark/csv.h"
#include "benchmark/profile_report.h"

namespace opaline {

/// HTML that needs no network, nor any other file but for its links to the tables.
std::string to_page(const ProfileReport& report);

/// The rows of the three tables below, "models" with their sources, and "channels": the medium, the curve of "fresnel", and
/// "classical" and "grosjean" around a point source.
nlohmann::ordered_json profile_page_data(const ProfileReport& report);

/// Shares of the transmitted flux: a row a channel, way of entry or model, and face.
CsvTable totals_table(const ProfileReport& report);
/// R_d by rings: a row a channel, face and ring; walks by both ways of entry, and each model's mean over the ring.
CsvTable rings_table(const ProfileReport& report);
/// Albedo by cosine of entry and radiance by cosine of exit: a row a channel and bin.
CsvTable angles_table(const ProfileReport& report);

/// "half space", or "slab of 2 mm".
std::string shape_words(const ProfileReport& report);

/// A share in digits that its error leaves: ".8299 ± .0001"; `between` stands between the two.
std::string walked_text(const WalkedValue& value, const char* between);

}  // namespace opaline
