// SPDX-License-Identifier: GPL-3.0-or-later
#include "benchmark/csv.h"

#include <algorithm>
#include <charconv>

namespace opaline {
namespace {

/// True if a spreadsheet would read the cell as a formula. Signed numbers are not formulas.
bool is_formula(std::string_view cell) {
  if (cell.empty() || std::string_view("=+-@\t\r").find(cell[0]) == std::string_view::npos) return false;
  double number = 0;
  const auto [end, error] = std::from_chars(cell.data(), cell.data() + cell.size(), number);
  return error != std::errc{} || end != cell.data() + cell.size();
}

std::string quoted(const std::string& text) {
  const std::string cell = needs_apostrophe(text) ? '\'' + text : text;
  if (cell.find_first_of(",\"\r\n#") == std::string::npos) return cell;
  std::string between;
  for (const char c : cell) between += c == '"' ? std::string("\"\"") : std::string(1, c);
  return '"' + between + '"';
}

/// Quotes a note with commas as one cell: the text after a comma might be read as a formula.
std::string note_line(const std::string& key, const std::string& value) {
  const std::string note = "# " + key + ": " + value;
  return (note.find_first_of(",\"") == std::string::npos ? note : quoted(note)) + '\n';
}

std::string line_of(const std::vector<std::string>& cells) {
  std::string line;
  for (std::size_t i = 0; i < cells.size(); ++i) line += (i > 0 ? "," : "") + quoted(cells[i]);
  return line + '\n';
}

}  // namespace

bool needs_apostrophe(std::string_view cell) {
  return is_formula(cell.substr(std::min(cell.find_first_not_of('\''), cell.size())));
}

std::string to_csv(const CsvTable& table) {
  std::string text;
  for (const auto& [key, value] : table.notes) text += note_line(key, value);
  text += line_of(table.names) + line_of(table.units);
  for (const std::vector<std::string>& row : table.rows) text += line_of(row);
  return text;
}

}  // namespace opaline
