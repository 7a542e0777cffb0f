// SPDX-License-Identifier: GPL-3.0-or-later
// Pieces that the parts of the page share.
#pragma once

#include <cstddef>
#include <string>
#include <utility>
#include <vector>

#include "benchmark/csv.h"
#include "benchmark/trade_off.h"

namespace opaline {

/// Text as HTML shows it, also in an attribute.
std::string escaped(const std::string& text);

/// A path as the address of a file: the bytes that an address gives a meaning, such as # ? %, as %xx.
std::string url_of(const std::string& path);

/// The style sheet, the script and the frame of the page, from the files of those names, and the base64 of the script
/// element's SHA-256.
extern const char* const kPageStyle;
extern const char* const kPageScript;
extern const char* const kPageScriptHash;
extern const char* const kPageFrame;

/// What stands around a page's body; all but `intro` and `body` is text, not HTML.
struct PageFrame {
  std::string command;  ///< of opaline, that made it
  std::string title, heading, lead, intro, body;
};

/// A whole page, which needs no network.
std::string framed(const PageFrame& frame);

/// Notes as a list of terms.
std::string notes_list(const std::vector<std::pair<std::string, std::string>>& notes);

/// The text of the note with this key; empty without one.
std::string note_of(const std::vector<std::pair<std::string, std::string>>& notes, const std::string& key);

/// "version, cpu, N threads, date" from the notes.
std::string lead_of(const std::vector<std::pair<std::string, std::string>>& notes);

/// A scene of the report, with what is drawn and tabled of it.
struct PageScene {
  const BenchReport* report;
  const CsvTable* table;  ///< of the report
  const BenchSubject* subject;
  std::size_t number;  ///< of the scene on the page
  std::vector<TradeSeries> series;
};

/// Row indices of the scene.
std::vector<std::size_t> rows_of(const PageScene& scene);

/// What a CSV cell holds; empty: not measured.
const std::string& csv_cell(const CsvTable& table, std::size_t row, const std::string& column);

/// A table cell that shows a CSV cell: three digits, the whole text on hover.
std::string measured_cell(const CsvTable& table, std::size_t row, const std::string& column);

/// Class of a rung's colour and mark: "series-2", or "series-none".
std::string series_class(const PageScene& scene, std::size_t row);

/// A drawing of its own, for a README.
std::string chart_svg(const PageScene& scene);
std::string chart_html(const PageScene& scene);
std::string viewer_html(const PageScene& scene);
std::string trade_tables_html(const PageScene& scene);
std::string frames_html(const PageScene& scene);
std::string budget_html(const PageScene& scene);
std::string settings_html(const PageScene& scene);

}  // namespace opaline
