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

/// The members of results.json (to_json) and "error_colours", CSS colours of the error images from dark to bright. Each
/// scene also has "series", whose points are settings with their row, CPU time and relative error; "equal_error" and
/// "equal_time", "targets" and for each series "estimates" at them; and "cpu_to_one_percent", an estimate a series.
nlohmann::ordered_json bench_page_data(const BenchReport& report);

/// HTML for the folder of the report: it needs the images there, and no network. A figure of a measured row has its place
/// in results.csv: data-row (from 0) and data-column; its title is the whole number.
std::string to_page(const BenchReport& report);

}  // namespace opaline
