// SPDX-License-Identifier: GPL-3.0-or-later
// Reader of a benchmark's CSV.
#pragma once

#include <algorithm>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "benchmark/csv.h"
#include "opaline/error.h"

namespace opaline {

/// Reads the text and counts its lines for messages.
class CsvReader {
 public:
  CsvReader(std::string_view text, const std::string& file) : text_(text), file_(file) {}

  bool at_end() const { return at_ >= text_.size(); }
  bool at_note() const {
    const std::string_view rest = text_.substr(std::min(at_, text_.size()));
    return rest.starts_with('#') || rest.starts_with("\"# ");
  }

  std::pair<std::string, std::string> note() {
    std::string line;
    if (text_[at_] == '"') {
      line = written_cell().substr(1);
      at_ = std::min(text_.find('\n', at_), text_.size());
    } else {
      const std::size_t end = std::min(text_.find('\n', at_), text_.size());
      line = text_.substr(at_ + 1, end - at_ - 1);
      at_ = end;
    }
    if (line.starts_with(' ')) line.erase(0, 1);
    ++at_;
    ++line_;
    const std::size_t colon = line.find(": ");
    if (colon == std::string::npos) return {line, {}};
    return {line.substr(0, colon), line.substr(colon + 2)};
  }

  std::vector<std::string> row() {
    first_line_ = line_;
    std::vector<std::string> cells{cell()};
    while (!at_end() && text_[at_] == ',') {
      ++at_;
      cells.push_back(cell());
    }
    if (!at_end()) ++at_;  // the line's end
    ++line_;
    return cells;
  }

  [[noreturn]] void fail(const std::string& what, const std::string& expected, const std::string& got) const {
    throw Error(ErrorKind::bad_input, file_, first_line_, 0, what, expected, got);
  }

 private:
  std::string cell() {
    std::string text = written_cell();
    if (text.starts_with('\'') && needs_apostrophe(text)) text.erase(0, 1);
    return text;
  }

  std::string written_cell() {
    if (at_end() || text_[at_] != '"') {
      const std::size_t end = std::min(text_.find_first_of(",\n", at_), text_.size());
      std::string plain(text_.substr(at_, end - at_));
      at_ = end;
      return plain;
    }
    std::string value;
    for (++at_;; ++at_) {
      if (at_end()) fail("a cell does not end", "a closing quote", "");
      if (text_[at_] == '"' && (++at_ >= text_.size() || text_[at_] != '"')) return value;
      if (text_[at_] == '\n') ++line_;
      value += text_[at_];
    }
  }

  std::string_view text_;
  std::string file_;
  std::size_t at_ = 0;
  int line_ = 1, first_line_ = 1;
};

/// error Error{bad_input} naming `file` and the line: an open quote, a row of another length than the names
inline CsvTable parse_csv(std::string_view text, const std::string& file) {
  CsvReader reader(text, file);
  CsvTable table;
  while (reader.at_note()) table.notes.push_back(reader.note());
  table.names = reader.row();
  const auto row = [&] {
    std::vector<std::string> cells = reader.row();
    if (cells.size() != table.names.size())
      reader.fail("a row of another length", std::to_string(table.names.size()) + " cells",
                  std::to_string(cells.size()));
    return cells;
  };
  table.units = row();
  while (!reader.at_end()) table.rows.push_back(row());
  return table;
}

}  // namespace opaline
