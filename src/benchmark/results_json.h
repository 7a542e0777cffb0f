// SPDX-License-Identifier: GPL-3.0-or-later
// Benchmark results as JSON, and the part compared with later ones.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <string_view>
#include <vector>

#include "benchmark/bench_row.h"
#include "benchmark/csv.h"

namespace opaline {

/// {"schema": "opaline bench", "version": kBenchSchema, "notes": [[key, value], ...],
///  "scenes": [{"scene", "key", ...}], "units": {column: unit}, "rows": [{column: value}],
///  "budget": [{column: value}]}: the columns and values of the CSVs; null: not measured.
std::string to_json(const BenchReport& report);
nlohmann::ordered_json results_json(const BenchReport& report);

/// Rows of a table as objects: numbers where the column has a unit, null where such a cell is empty or not
/// finite.
nlohmann::ordered_json rows_json(const CsvTable& table);

/// Compared data of a rung.
struct WatchedRung {
  std::string key;  ///< key of its scene: BenchSubject
  std::string title, rung;
  Spread job_ratio, shading_ratio;
  double error = 0, error_floor = 0;  ///< relative, worst channel
  bool has_error = false;
};

std::vector<WatchedRung> watched_rungs(const BenchReport& report);

/// The same from the text of a results.json; failed rungs are left out.
/// error Error{bad_input} naming `file`: no such JSON, or of another version
std::vector<WatchedRung> parse_results(std::string_view text, const std::string& file);

}  // namespace opaline
