// SPDX-License-Identifier: GPL-3.0-or-later
// The report of `opaline profile` as a page and tables.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

#include "benchmark/csv.h"
#include "benchmark/profile_report.h"

namespace opaline {

/// HTML without network access, and without other files except linked tables.
std::string to_page(const ProfileReport& report);

/// The rows of the three tables below, "models" with their sources, and "channels": the medium, the curve of
/// "fresnel", and "classical" and "grosjean" around a point source.
nlohmann::ordered_json profile_page_data(const ProfileReport& report);

/// Fractions of the transmitted flux: one row per channel, angle of incidence or model, and face.
CsvTable totals_table(const ProfileReport& report);
/// R_d by rings: one row per channel, face and ring; walks for both angles of incidence, and each model's
/// mean over the ring.
CsvTable rings_table(const ProfileReport& report);
/// Albedo by cosine of incidence and radiance by cosine of exit: one row per channel and bin.
CsvTable angles_table(const ProfileReport& report);

/// "half space", or "slab of 2 mm".
std::string shape_words(const ProfileReport& report);

/// A fraction with the digits justified by its error: "0.8299 ± 0.0001"; `between` is the separator.
std::string walked_text(const WalkedValue& value, const char* between);

}  // namespace opaline
