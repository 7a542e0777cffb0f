// SPDX-License-Identifier: GPL-3.0-or-later
#include "benchmark/results_json.h"

#include <algorithm>
#include <map>

#include "core/log.h"
#include "opaline/error.h"

namespace opaline {
namespace {

constexpr const char* kSchemaName = "opaline bench";

Json cell_json(const std::string& cell, const std::string& unit) {
  if (unit.empty()) return cell;
  const Json number = Json::parse(cell, nullptr, /*allow_exceptions=*/false);
  return number.is_number() ? number : Json();
}

Json subject_json(const BenchSubject& subject) {
  return {{"scene", subject.scene},
          {"key", subject.key},
          {"title", subject.title},
          {"resolution", subject.resolution},
          {"reference", subject.reference},
          {"truth", subject.is_truth},
          {"reference_half_noise", 100 * subject.half_noise},
          {"reference_picture", subject.picture}};
}

Spread spread_from(const Json& row, const std::string& name) {
  const Json &median = row.at(name + "_median"), &low = row.at(name + "_min"), &high = row.at(name + "_max");
  if (median.is_null()) return {};
  const auto runs = std::size_t(row.at("runs").get<double>());
  return {runs, median.get<double>(), low.get<double>(), high.get<double>()};
}

WatchedRung rung_from(const Json& row, const Json& subject) {
  WatchedRung rung;
  rung.key = subject.at("key").get<std::string>();
  rung.title = subject.at("title").get<std::string>();
  rung.rung = row.at("rung").get<std::string>();
  rung.job_ratio = spread_from(row, "job_ratio");
  rung.shading_ratio = spread_from(row, "shading_ratio");
  rung.has_error = !row.at("error_worst").is_null();
  if (rung.has_error) {
    rung.error = row.at("error_worst").get<double>() / 100;
    rung.error_floor = row.at("error_floor_worst").get<double>() / 100;
  }
  return rung;
}

}  // namespace

Json rows_json(const CsvTable& table) {
  Json rows = Json::array();
  for (const std::vector<std::string>& cells : table.rows) {
    Json row = Json::object();
    for (std::size_t c = 0; c < cells.size(); ++c) row[table.names[c]] = cell_json(cells[c], table.units[c]);
    rows.push_back(std::move(row));
  }
  return rows;
}

Json results_json(const BenchReport& report) {
  const CsvTable table = bench_table(report);
  Json json{{"schema", kSchemaName}, {"version", kBenchSchema}, {"notes", Json::array()}};
  for (const auto& [key, value] : report.notes) json["notes"].push_back(Json::array({key, value}));
  json["scenes"] = Json::array();
  for (const BenchSubject& subject : report.subjects) json["scenes"].push_back(subject_json(subject));
  json["units"] = Json::object();
  for (std::size_t c = 0; c < table.names.size(); ++c) json["units"][table.names[c]] = table.units[c];
  json["rows"] = rows_json(table);
  json["budget"] = rows_json(budget_table(report));
  return json;
}

std::string to_json(const BenchReport& report) {
  return results_json(report).dump(1, ' ', false, Json::error_handler_t::replace) + '\n';
}

std::vector<WatchedRung> watched_rungs(const BenchReport& report) {
  std::vector<WatchedRung> rungs;
  for (const BenchRow& row : report.rows) {
    if (!row.failure.empty()) continue;
    const auto subject = std::ranges::find(report.subjects, row.scene, &BenchSubject::scene);
    require(subject != report.subjects.end(), "a benchmark's row has no scene");
    const bool has_error = row.error.has_value();
    rungs.push_back({subject->key, subject->title, name_of(row.rung), row.job_ratio, row.shading_ratio,
                     has_error ? row.error->worst.error : 0, has_error ? row.error->worst.error_floor : 0,
                     has_error});
  }
  return rungs;
}

std::vector<WatchedRung> parse_results(std::string_view text, const std::string& file) {
  const Json json = Json::parse(text, nullptr, /*allow_exceptions=*/false);
  if (!json.is_object() || json.value("schema", Json()) != kSchemaName)
    throw bad_file(file, "not the results of a benchmark", "results.json of opaline bench -o");
  if (const Json version = json.value("version", Json()); version != kBenchSchema)
    throw bad_file(file, "results of another version", std::to_string(kBenchSchema), version.dump());
  std::vector<WatchedRung> rungs;
  try {
    std::map<std::string, Json> subjects;
    for (const Json& subject : json.at("scenes")) subjects[subject.at("scene").get<std::string>()] = subject;
    for (const Json& row : json.at("rows"))
      if (row.at("failure") == "") rungs.push_back(rung_from(row, subjects.at(row.at("scene"))));
  } catch (const std::exception& failure) {
    throw bad_file(file, std::string("damaged results: ") + failure.what());
  }
  return rungs;
}

}  // namespace opaline
