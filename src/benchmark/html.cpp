// SPDX-License-Identifier: GPL-3.0-or-later
#include "benchmark/html.h"

#include <fmt/format.h>

#include <algorithm>

#include "benchmark/figures.h"
#include "opaline/core/error.h"

namespace opaline {

std::string escaped(const std::string& text) {
  std::string html;
  for (const char c : text) switch (c) {
      case '&':
        html += "&amp;";
        break;
      case '<':
        html += "&lt;";
        break;
      case '>':
        html += "&gt;";
        break;
      case '"':
        html += "&quot;";
        break;
      default:
        html += c;
    }
  return html;
}

std::string url_of(const std::string& path) {
  constexpr std::string_view plain = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789-._~/";
  std::string url;
  for (const char c : path)
    url += plain.find(c) != plain.npos ? std::string(1, c)
                                       : fmt::format("%{:02X}", static_cast<unsigned char>(c));
  return url;
}

std::string note_of(const std::vector<std::pair<std::string, std::string>>& notes, const std::string& key) {
  const auto at = std::ranges::find(notes, key, [](const auto& note) { return note.first; });
  return at == notes.end() ? std::string() : at->second;
}

std::string lead_of(const std::vector<std::pair<std::string, std::string>>& notes) {
  const std::string threads = note_of(notes, "threads");
  return fmt::format("{}, {}, {} thread{}, {}", note_of(notes, "version"), note_of(notes, "cpu"), threads,
                     threads == "1" ? "" : "s", note_of(notes, "date"));
}

std::string notes_list(const std::vector<std::pair<std::string, std::string>>& notes) {
  std::string html = "<dl>\n";
  for (const auto& [key, value] : notes)
    html += fmt::format("<dt>{}</dt><dd>{}</dd>\n", escaped(key), escaped(value));
  return html + "</dl>\n";
}

std::string framed(const PageFrame& frame) {
  std::string page = kPageFrame;
  const auto replace = [&](const std::string& mark, const std::string& with) {
    if (const std::size_t at = page.find(mark); at != std::string::npos) page.replace(at, mark.size(), with);
  };
  replace("{{script_hash}}", kPageScriptHash);
  replace("{{title}}", escaped(frame.title));
  replace("{{command}}", escaped(frame.command));
  replace("{{style}}", kPageStyle);
  replace("{{heading}}", escaped(frame.heading));
  replace("{{lead}}", escaped(frame.lead));
  replace("{{intro}}", frame.intro);
  replace("{{body}}", frame.body);
  replace("{{script}}", kPageScript);
  return page;
}

std::vector<std::size_t> rows_of(const PageScene& scene) {
  std::vector<std::size_t> rows;
  for (std::size_t i = 0; i < scene.report->rows.size(); ++i)
    if (scene.report->rows[i].scene == scene.subject->scene) rows.push_back(i);
  return rows;
}

const std::string& csv_cell(const CsvTable& table, std::size_t row, const std::string& column) {
  const auto at = std::size_t(std::ranges::find(table.names, column) - table.names.begin());
  require(at < table.names.size(), "the page asks for a column that the CSV has not");
  return table.rows[row][at];
}

std::string measured_cell(const CsvTable& table, std::size_t row, const std::string& column) {
  const std::string& cell = csv_cell(table, row, column);
  if (cell.empty()) return "<td class=\"none\">–</td>";
  return fmt::format("<td data-row=\"{}\" data-column=\"{}\" title=\"{}\">{}</td>", row, column, cell,
                     figure(std::stod(cell)));
}

std::string series_class(const PageScene& scene, std::size_t row) {
  for (std::size_t s = 0; s < scene.series.size(); ++s)
    for (const TradePoint& point : scene.series[s].points)
      if (point.row == row) return fmt::format("series-{}", s);
  return "series-none";
}

}  // namespace opaline
