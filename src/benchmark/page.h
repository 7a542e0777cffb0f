// SPDX-License-Identifier: GPL-3.0-or-later
// A benchmark as a page to read in a browser.
#pragma once

#include <string>
#include <vector>

#include "benchmark/bench_row.h"

namespace opaline {

/// Names of the pictures beside a row's EXR: as shown, and where it is off.
std::string shown_picture(const std::string& exr);
std::string error_picture_of(const std::string& exr);

/// Says before the work what cannot be written after it.
/// error Error{bad_input}: a file is there that is no page of opaline's; Error{run_failed}
void check_page_file(const std::string& path);

/// HTML for the folder of the report: it needs the pictures there, and no network. Every number of a measured
/// row carries its place in the CSV: data-row (from 0) and data-column; its title is the CSV's text.
std::string to_page(const BenchReport& report);

/// The charts of the page as SVG files of their own, one a scene of the report; empty where nothing has an
/// error.
std::vector<std::string> to_charts(const BenchReport& report);

}  // namespace opaline
