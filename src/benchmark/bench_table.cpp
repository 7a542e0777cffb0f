// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include <cmath>
#include <functional>

#include "benchmark/csv.h"

namespace opaline {
namespace {

struct Column {
  std::string name, unit;
  std::function<std::string(const BenchRow&)> cell;
};

std::string number(double value) {
  return std::isfinite(value) ? fmt::format("{:.7g}", value) : std::string();
}

/// Text of a count; empty for 0, not applicable.
std::string count(double value) {
  return value > 0 ? number(value) : std::string();
}

class Columns {
 public:
  void add(const std::string& name, const std::string& unit,
           std::function<std::string(const BenchRow&)> cell) {
    all_.push_back({name, unit, std::move(cell)});
  }

  /// Three columns: _median, _min, _max.
  template <class Find>
  void add_spread(const std::string& name, const std::string& unit, double scale, const Find& find) {
    const auto part = [&](const char* suffix, double Spread::*value) {
      add(name + suffix, unit, [=](const BenchRow& row) {
        const Spread& spread = std::invoke(find, row);
        return spread.runs > 0 ? number(scale * spread.*value) : std::string();
      });
    };
    part("_median", &Spread::median);
    part("_min", &Spread::low);
    part("_max", &Spread::high);
  }

  template <class Find>
  void add_cost(const std::string& name, const Find& find) {
    const auto part = [&](const char* suffix, const char* unit, double scale, Spread CostSpread::*value) {
      add_spread(name + suffix, unit, scale,
                 [=](const BenchRow& row) -> const Spread& { return std::invoke(find, row).*value; });
    };
    part("_user", "s", 1, &CostSpread::user);
    part("_system", "s", 1, &CostSpread::system);
    part("_cpu", "s", 1, &CostSpread::cpu);
    part("_wall", "s", 1, &CostSpread::wall);
    part("_memory", "MB", 1e-6, &CostSpread::memory);
  }

  /// Four columns: _R, _G, _B, _worst; in %.
  void add_error(const std::string& name, double ErrorFigures::*figure) {
    const auto part = [&](const std::string& suffix, auto figures) {
      add(name + suffix, "%", [=](const BenchRow& row) {
        return row.error ? number(100 * figures(*row.error).*figure) : std::string();
      });
    };
    for (const std::size_t c : {0u, 1u, 2u})
      part(std::string("_") + "RGB"[c], [=](const PictureError& e) { return e.channels[c]; });
    part("_worst", [](const PictureError& e) { return e.worst; });
  }

  const std::vector<Column>& all() const { return all_; }

 private:
  std::vector<Column> all_;
};

void add_names(Columns& columns) {
  columns.add("scene", "", &BenchRow::scene);
  columns.add("rung", "", [](const BenchRow& row) { return name_of(row.rung); });
  columns.add("method", "", [](const BenchRow& row) { return row.rung.method; });
  columns.add("evaluator", "", [](const BenchRow& row) { return row.rung.evaluator; });
  columns.add("knob", "", [](const BenchRow& row) { return row.rung.knob; });
  columns.add("value", "", [](const BenchRow& row) { return row.rung.value; });
  columns.add("failure", "", &BenchRow::failure);
  columns.add("runs", "1", [](const BenchRow& row) { return std::to_string(row.job.wall.runs); });
  columns.add("samples", "1", [](const BenchRow& row) { return count(row.samples); });
  columns.add("queries", "1", [](const BenchRow& row) { return count(row.queries); });
  columns.add("entry_samples", "1/pixel", [](const BenchRow& row) { return count(row.entry_samples); });
  columns.add("rays", "1", [](const BenchRow& row) { return count(row.rays); });
  columns.add("picture", "", &BenchRow::picture);
}

Columns all_columns() {
  Columns columns;
  add_names(columns);
  columns.add_spread("job_ratio", "lambert", 1, &BenchRow::job_ratio);
  columns.add_spread("shading_ratio", "lambert", 1, &BenchRow::shading_ratio);
  columns.add_spread("shading_rate", "Mray/s", 1e-6, &BenchRow::shading_rate);
  columns.add_spread("embree_rate", "Mray/s", 1e-6, &BenchRow::embree_rate);
  columns.add_spread("once_cpu", "s", 1, &BenchRow::once_cpu);
  columns.add_spread("frame_cpu", "s", 1, &BenchRow::frame_cpu);
  columns.add_error("error", &ErrorFigures::error);
  columns.add_error("error_floor", &ErrorFigures::error_floor);
  columns.add_error("signed", &ErrorFigures::signed_mean);
  columns.add_error("p99", &ErrorFigures::p99);
  columns.add_error("p99_noise", &ErrorFigures::p99_noise);
  columns.add_error("half_noise", &ErrorFigures::half_noise);
  columns.add_cost("job", &BenchRow::job);
  for (std::size_t s = 0; s < kBenchStages.size(); ++s)
    columns.add_cost(
        std::string(kBenchStages[s]), [s](const BenchRow& row) -> auto& { return row.stages[s]; });
  return columns;
}

/// Summary figures of an error component, %.
std::vector<std::string> budget_cells(const BudgetRow& row) {
  std::vector<std::string> cells{row.scene, row.part.name, row.part.setting};
  if (!row.error) {
    cells.insert(cells.end(), 6, "");
  } else {
    const auto& [channels, worst] = *row.error;
    for (const double part :
         {channels[0].error, channels[1].error, channels[2].error, worst.error, worst.signed_mean, worst.p99})
      cells.push_back(number(100 * part));
  }
  cells.push_back(row.failure);
  return cells;
}

}  // namespace

CsvTable budget_table(const BenchReport& report) {
  CsvTable table;
  table.notes = {{"schema", fmt::format("opaline bench budget {}", kBenchSchema)}};
  table.names = {"scene",   "part",        "setting",      "error_R",   "error_G",
                 "error_B", "error_worst", "signed_worst", "p99_worst", "failure"};
  table.units = {"", "", "", "%", "%", "%", "%", "%", "%", ""};
  for (const BudgetRow& row : report.budget) table.rows.push_back(budget_cells(row));
  return table;
}

CsvTable bench_table(const BenchReport& report) {
  CsvTable table;
  table.notes = {{"schema", fmt::format("opaline bench {}", kBenchSchema)}};
  table.notes.insert(table.notes.end(), report.notes.begin(), report.notes.end());
  const Columns columns = all_columns();
  for (const Column& column : columns.all()) {
    table.names.push_back(column.name);
    table.units.push_back(column.unit);
  }
  for (const BenchRow& row : report.rows) {
    std::vector<std::string>& cells = table.rows.emplace_back();
    for (const Column& column : columns.all()) cells.push_back(column.cell(row));
  }
  return table;
}

}  // namespace opaline
