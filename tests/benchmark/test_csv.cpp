// SPDX-License-Identifier: GPL-3.0-or-later
// The CSV of a benchmark: what is written can be read, and its columns are the promised ones.
#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <set>

#include "opaline/error.h"
#include "support/read_csv.h"

namespace opaline {
namespace {

// Claim: reading what was written gives the same table: commas, quotes, line breaks, empty cells, and a cell
// that starts like a note. Source: RFC 4180, csv.h. Tolerance: none. Fails if: quotes are not doubled, or a
// row ends at a line break inside of them.
TEST(Csv, RoundTrip) {
  const CsvTable table{
      {{"command", "opaline bench a.json --csv 'b, c.csv'"}, {"cpu", "an \"AMD\": 2"}, {"x", ""}},
      {"a", "b,c", "d"},
      {"", "s", "MB"},
      {{"", "1.5", ""}, {"#7", "two\nlines", "say \"yes\""}, {"\"", ",", "\n"}, {"", "", ""}}};
  const CsvTable read = parse_csv(to_csv(table), "test.csv");
  EXPECT_EQ(read.notes, table.notes);
  EXPECT_EQ(read.names, table.names);
  EXPECT_EQ(read.units, table.units);
  EXPECT_EQ(read.rows, table.rows);
}

// Claim: a text that a spreadsheet would run as a formula is written behind an apostrophe and read without
// it; figures with a sign stay figures; a note is one cell. Source: csv.h. Fails if: a scene named =1+1.json
// opens as 2, or -1.5 as text, or a note's comma makes two cells.
TEST(Csv, NamesAreNoFormulas) {
  const std::vector<std::string> cells{"=1+1.json", "+a",   "-a",   "@a",   "\t=a",
                                       "'=a",       "-1.5", "-inf", "it's", "'"};
  const CsvTable table{
      {{"command", "bench a,=1+1"}}, std::vector<std::string>(cells.size(), "n"), cells, {cells}};
  const std::string text = to_csv(table);
  EXPECT_TRUE(text.starts_with("\"# command: bench a,=1+1\"\n")) << text;
  EXPECT_EQ(parse_csv(text, "test.csv").notes, table.notes);
  EXPECT_TRUE(text.ends_with("'=1+1.json,'+a,'-a,'@a,'\t=a,''=a,-1.5,-inf,it's,'\n")) << text;
  EXPECT_EQ(parse_csv(text, "test.csv").rows, table.rows);
}

// Claim: a damaged file is refused, its line named. Source: read_csv.h. Fails if: short rows are filled up, or an
// open quote takes the rest of the file.
TEST(Csv, DamagedIsRefused) {
  const std::map<std::string, int> cases{
      {"# note: 1\na,b\ns,s\n1,2\n3\n", 5}, {"a,b\ns,s\n1,2,3\n", 3}, {"a\ns\n\"x\n", 3}, {"a,b\n", 2}};
  for (const auto& [text, line] : cases) try {
      parse_csv(text, "cut.csv");
      ADD_FAILURE() << text;
    } catch (const Error& error) {
      EXPECT_EQ(error.kind, ErrorKind::bad_input);
      EXPECT_EQ(error.file, "cut.csv");
      EXPECT_EQ(error.line, line) << text;
    }
}

BenchRow measured_row() {
  BenchRun run;
  run.job = {1.25, .5, 2, 160e6};
  run.stages[kShadingStage] = Cost{.5, 0, .5, 150e6};
  run.samples = 54291;
  run.rays = 3e6;
  run.embree_seconds = .25;
  const std::vector<BenchRun> runs(3, run);
  BenchRow row = summarize("bunny, marble.json", {"hierarchical", "classic", "samples", "54291"}, runs, runs);
  PictureError error;
  error.channels[1].error = .0125;
  error.worst = error.channels[1];
  row.error = error;
  row.picture = "pictures/bunny.exr";
  return row;
}

// Claim: the schema stands first and its columns have one name each and a unit; figures are in these units,
// what was not measured is empty, a failed rung keeps its reason. By hand: 160e6 bytes are 160 MB, .0125 are
// 1.25 %, 3e6 rays in .25 s are 12 Mray/s. Fails if: a unit is not converted, an empty spread prints 0, or
// kBenchSchema stays while one of these columns goes.
TEST(BenchCsv, Schema) {
  BenchRow failed;
  failed.scene = "bunny, marble.json";
  failed.rung = {"direct", "", "", ""};
  failed.failure = "killed by signal 9 (Killed)";
  const CsvTable written = bench_table({{{"threads", "1"}}, {}, {measured_row(), failed}, {}});
  const CsvTable table = parse_csv(to_csv(written), "bench.csv");
  EXPECT_EQ(kBenchSchema, 2);
  ASSERT_EQ(table.notes.size(), 2u);
  EXPECT_EQ(table.notes[0], std::make_pair(std::string("schema"), std::string("opaline bench 2")));
  EXPECT_EQ(std::set(table.names.begin(), table.names.end()).size(), table.names.size());
  ASSERT_EQ(table.rows.size(), 2u);
  const struct {
    std::string name, unit, measured, failed;
  } cases[] = {
      {"scene", "", "bunny, marble.json", "bunny, marble.json"},
      {"rung", "", "hierarchical classic samples=54291", "direct"},
      {"failure", "", "", "killed by signal 9 (Killed)"},
      {"runs", "1", "3", "0"},
      {"samples", "1", "54291", ""},
      {"job_user_median", "s", "1.25", ""},
      {"job_system_max", "s", "0.5", ""},
      {"job_cpu_min", "s", "1.75", ""},
      {"job_wall_median", "s", "2", ""},
      {"job_memory_median", "MB", "160", ""},
      {"job_ratio_median", "lambert", "1", ""},
      {"shading_ratio_max", "lambert", "1", ""},
      {"embree_rate_median", "Mray/s", "12", ""},
      {"shading_rate_median", "Mray/s", "6", ""},
      {"error_G", "%", "1.25", ""},
      {"error_worst", "%", "1.25", ""},
      {"p99_noise_R", "%", "0", ""},
      {"signed_B", "%", "0", ""},
      {"shading_memory_median", "MB", "150", ""},
      {"loading_user_median", "s", "", ""},
      {"sampling_wall_min", "s", "", ""},
      {"irradiance_memory_max", "MB", "", ""},
      {"octree_cpu_median", "s", "", ""},
      {"exitance_cpu_median", "s", "", ""},
      {"once_cpu_median", "s", "", ""},
      {"frame_cpu_max", "s", "0.5", ""},
      {"picture", "", "pictures/bunny.exr", ""},
  };
  for (const auto& c : cases) {
    const auto at = std::size_t(std::ranges::find(table.names, c.name) - table.names.begin());
    ASSERT_LT(at, table.names.size()) << c.name;
    EXPECT_EQ(table.units[at], c.unit) << c.name;
    EXPECT_EQ(table.rows[0][at], c.measured) << c.name;
    EXPECT_EQ(table.rows[1][at], c.failed) << c.name;
  }
}

}  // namespace
}  // namespace opaline
