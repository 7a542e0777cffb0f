// SPDX-License-Identifier: GPL-3.0-or-later
// A benchmark as a page to read in a browser.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

#include "benchmark/bench_row.h"

namespace opaline {

/// File names beside a row's EXR: the image as shown, and its error.
std::string shown_picture(const std::string& exr);
std::string error_picture_of(const std::string& exr);

/// Data of the page: the members of results.json (to_json), and "error_colours", CSS colours of the error
/// images from dark to bright. Each scene also has "series" of settings, with row, CPU time and relative
/// error; "equal_error" and "equal_time", "targets" with "estimates" per series; and "cpu_to_one_percent", an
/// estimate per series.
nlohmann::ordered_json bench_page_data(const BenchReport& report);

/// HTML for the folder of the report, with the images there and without network access. Each figure of a
/// measured row refers to its cell in results.csv: data-row (from 0) and data-column; its title has all
/// digits.
std::string to_page(const BenchReport& report);

}  // namespace opaline
