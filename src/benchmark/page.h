// SPDX-License-Identifier: GPL-3.0-or-later
// A report as one HTML file with scripts drawing it from JSON; contains Chart.js.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

namespace opaline {

/// page.html with its style, scripts and library; the data replaces "{{data}}".
extern const char* const kPage;

/// A page without network access.
/// in    data: input of bench_page.js or profile_page.js, with "command" and "notes"
std::string page_of(const nlohmann::ordered_json& data);

/// Checks before the work that the page can be written.
/// error Error{bad_input}: the file exists and is not a page of opaline; Error{run_failed}
void check_page_file(const std::string& path);

}  // namespace opaline
