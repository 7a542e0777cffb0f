// SPDX-License-Identifier: GPL-3.0-or-later
// A report as one HTML file, which its scripts draw in a browser from JSON; Chart.js is part of the file.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

namespace opaline {

/// page.html with its style, scripts and library; the data takes the place of "{{data}}".
extern const char* const kPage;

/// A page that needs no network.
/// in    data: what bench_page.js or profile_page.js reads, with "command" and "notes"
std::string page_of(const nlohmann::ordered_json& data);

/// Reports before the work that the page cannot be written after it.
/// error Error{bad_input}: the file exists and is not a page of opaline; Error{run_failed}
void check_page_file(const std::string& path);

}  // namespace opaline
