// SPDX-License-Identifier: GPL-3.0-or-later
// The cells of a report's tables, by their columns' names.
#pragma once

#include <algorithm>
#include <string>

#include "support/read_csv.h"

namespace opaline {

/// As it is written.
inline std::string cell(const CsvTable& table, std::size_t row, const std::string& name) {
  const auto at = std::size_t(std::ranges::find(table.names, name) - table.names.begin());
  return row < table.rows.size() && at < table.names.size() ? table.rows[row][at] : "no such cell " + name;
}

}  // namespace opaline
