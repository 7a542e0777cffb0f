// SPDX-License-Identifier: GPL-3.0-or-later
// Tables as CSV: notes, names, units, rows.
#pragma once

#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "benchmark/bench_row.h"

namespace opaline {

/// Text format: "# key: value" per note, quoted if it has a comma, a line of names, a line of units, a line
/// per row; cells quoted where necessary (RFC 4180), lines end in \n.
struct CsvTable {
  std::vector<std::pair<std::string, std::string>> notes;  ///< no line breaks; no ": " in a key
  std::vector<std::string> names, units;                   ///< a column each
  std::vector<std::vector<std::string>> rows;              ///< as many cells as names
};

std::string to_csv(const CsvTable& table);
/// True if a cell is written behind an apostrophe: a formula, or one that already begins with apostrophes before a formula.
bool needs_apostrophe(std::string_view cell);

/// Increases with each change of a column's name, unit or meaning, and with each removed column.
inline constexpr int kBenchSchema = 2;

/// The schema is the first note. Empty cells were not measured; a failed rung has the reason in `failure`.
CsvTable bench_table(const BenchReport& report);

/// Components of the error, one per row.
CsvTable budget_table(const BenchReport& report);

}  // namespace opaline
