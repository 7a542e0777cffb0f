// SPDX-License-Identifier: GPL-3.0-or-later
// `opaline bench` on a small ball: rows, ratios, references, a rung that fails, an interruption.
#include <gtest/gtest.h>

#include <algorithm>
#include <map>

#include "csv_cell.h"
#include "opaline/image.h"
#include "run_program.h"

namespace opaline {
namespace {

/// A test failure where the cell is empty.
double number(const CsvTable& table, std::size_t row, const std::string& name) {
  const std::string text = cell(table, row, name);
  EXPECT_FALSE(text.empty()) << name << " of row " << row;
  return text.empty() ? -1 : std::stod(text);
}

std::vector<std::string> bench_line(const SceneFolder& folder, const std::vector<std::string>& more) {
  std::vector<std::string> line{"bench",   folder.scene,   "--csv", folder.file("out.csv"),
                                "--quick", "--resolution", "16x16"};
  line.insert(line.end(), more.begin(), more.end());
  return line;
}

CsvTable table_of(const SceneFolder& folder) {
  return parse_csv(bytes_of(folder.file("out.csv")), "out.csv");
}

// Claim: a quick run makes a row a rung with three runs each, costs of the whole job and of its stages that
// fit together, ratios to lambert, errors; a rung that fails is a row with its reason and exit code 3;
// references are kept and used again: no new file, no new pass. Source: the help of bench. By hand: lambert
// is 1 of itself; a stage's wall time and peak are within the job's. Tolerance: CPU of the shading against
// the job's 10 ms, a tick of the clock. Fails if: a failing rung ends the run or exits 0, the job's peak is
// in kB, or the references' names change from run to run.
TEST(CliBench, QuickEndToEnd) {
  const SceneFolder folder;
  const std::vector<std::string> line =
      bench_line(folder, {"--repeats", "3", "--reference-error", "30%", "--set",
                          "settings.max_samples=1000000000", "--rung", "samples=1000000000"});
#ifdef __SANITIZE_ADDRESS__  // which needs more address space than the limit
  const Limits limits;
#else
  const Limits limits{{}, rlim_t(4) << 30};
#endif
  const Outcome outcome = run_program(line, ".", limits);
  EXPECT_EQ(outcome.exit_code, 3) << outcome.err;
  EXPECT_TRUE(contains(outcome.err, "1 of 11 runs failed")) << outcome.err;
  EXPECT_TRUE(contains(outcome.out, "x lambert")) << outcome.out;
  const CsvTable table = table_of(folder);
  ASSERT_EQ(table.rows.size(), 11u);
  EXPECT_EQ(cell(table, 0, "rung"), "lambert");
  EXPECT_NEAR(number(table, 8, "samples"), 125, 12);  // a quarter of the plan's 500; placement is random
  for (const char* column : {"job_ratio_median", "job_ratio_min", "shading_ratio_max"})
    EXPECT_EQ(number(table, 0, column), 1) << column;
  for (std::size_t row = 0; row < 10; ++row) {
    EXPECT_EQ(cell(table, row, "runs"), "3");
    EXPECT_EQ(cell(table, row, "failure"), "");
    EXPECT_GT(number(table, row, "job_ratio_min"), 0);
    EXPECT_GT(number(table, row, "shading_ratio_median"), 0);
    EXPECT_GE(number(table, row, "job_cpu_max"), number(table, row, "job_cpu_median"));
    EXPECT_GE(number(table, row, "job_cpu_median"), number(table, row, "shading_cpu_median") - .01);
    EXPECT_GE(number(table, row, "job_wall_median"), number(table, row, "loading_wall_min"));
    EXPECT_GE(number(table, row, "job_memory_max"), number(table, row, "shading_memory_max"));
    EXPECT_GT(number(table, row, "shading_memory_min"), 10);
    EXPECT_LT(number(table, row, "job_memory_max"), 10000);
    EXPECT_LT(std::abs(number(table, row, "signed_worst")), 100);
    EXPECT_EQ(cell(table, row, "octree_cpu_median").empty(), cell(table, row, "method") != "hierarchical");
  }
  EXPECT_TRUE(contains(cell(table, 10, "failure"), "out of memory")) << cell(table, 10, "failure");
  EXPECT_EQ(cell(table, 10, "job_ratio_median"), "");

  // Again, from the references that are there: two pictures and their sums.
  const auto references = folder.path / "references";
  const auto files = [&] { return std::distance(std::filesystem::directory_iterator(references), {}); };
  std::map<std::filesystem::path, std::filesystem::file_time_type> sums;
  for (const auto& entry : std::filesystem::directory_iterator(references))
    if (entry.path().string().ends_with(".sums.exr")) sums[entry.path()] = entry.last_write_time();
  EXPECT_EQ(sums.size(), 2u);
  EXPECT_EQ(files(), 4);
  Child second(line);
  EXPECT_TRUE(second.complains("round 1"));
  second.send(SIGINT);
  EXPECT_EQ(second.wait().exit_code, 130);
  EXPECT_EQ(files(), 4);
  for (const auto& [path, time] : sums) EXPECT_EQ(std::filesystem::last_write_time(path), time) << path;
}

// Claim: with --halves nothing is rendered as a reference, and a direct rung's seed is none of theirs: else
// its error would be that of the reference with itself. An opaque scene has no hierarchical rung. Source:
// bench_scene.h, ladder.h. Fails if: the scene's seed is taken without a look at the halves (the note then
// says direct 0).
TEST(CliBench, GivenHalves) {
  const SceneFolder folder;
  const std::vector<std::string> opaque{"--set", "shapes.ball={\"sphere\": {\"radius\": 10}}"};
  std::vector<std::string> halves, line;
  for (const char* seed : {"0", "1"}) {
    halves.push_back(folder.file(std::string("half") + seed + ".exr"));
    line = {"render", folder.scene, "--method", "direct",      "--resolution", "16x16",
            "--seed", seed,         "-o",       halves.back(), "--quiet"};
    line.insert(line.end(), opaque.begin(), opaque.end());
    EXPECT_EQ(run_program(line).exit_code, 0);
  }
  line = bench_line(folder, {"--halves", halves[0], halves[1]});
  line.insert(line.end(), opaque.begin(), opaque.end());
  const Outcome outcome = run_program(line);
  EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_TRUE(contains(outcome.err, "the scene has no translucent shape")) << outcome.err;
  EXPECT_FALSE(std::filesystem::exists(folder.path / "references"));
  const CsvTable table = table_of(folder);
  EXPECT_EQ(table.rows.size(), 2u);
  const auto note = std::ranges::find(table.notes, "scene", [](const auto& n) { return n.first; });
  ASSERT_NE(note, table.notes.end());
  EXPECT_TRUE(contains(note->second, "seed 0, of direct 2")) << note->second;
}

// Claim: --profiles measures a translucent scene twice in one report, each profile against a reference of its
// own, with the whole ladder; an opaque one once. By hand: the profiles' references differ by more than their
// noise, so that against the other's no setting would be near. Tolerance: 10 % for a picture of the scene's
// own settings; the profiles are 100 % apart here. Fails if: both have one reference, or one profile is
// measured twice.
TEST(LongCliBench, EachProfileHasItsReference) {
  const SceneFolder folder;
  const Outcome outcome = run_program(bench_line(folder, {"--profiles", "--reference-error", "5%"}));
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  const CsvTable table = table_of(folder);
  ASSERT_EQ(table.rows.size(), 20u);
  std::map<std::string, double> errors;
  for (std::size_t row = 0; row < table.rows.size(); ++row) {
    const std::string scene = cell(table, row, "scene");
    EXPECT_EQ(scene, folder.scene + (row < 10 ? " (dipole)" : " (normalized_diffusion)"));
    if (cell(table, row, "rung") == "hierarchical") errors[scene] = number(table, row, "error_worst");
  }
  ASSERT_EQ(errors.size(), 2u);
  for (const auto& [scene, error] : errors) EXPECT_LT(error, 10) << scene;
  const auto files = std::distance(std::filesystem::directory_iterator(folder.path / "references"), {});
  EXPECT_EQ(files, 8);  // two halves each, and their sums

  const Outcome opaque = run_program(bench_line(folder, {"--profiles", "--reference-error", "30%", "--set",
                                                         R"(shapes.ball={"sphere": {"radius": 10}})"}));
  ASSERT_EQ(opaque.exit_code, 0) << opaque.err;
  EXPECT_EQ(table_of(folder).rows.size(), 2u);
}

// Claim: what cannot be measured is said before any run: exit 2 and one line for bad input, 3 for a folder
// that is not there, no CSV. Source: commands.h. Fails if: a check comes after the runs, or is left out.
TEST(CliBench, MistakesComeFirst) {
  const SceneFolder folder;
  const std::string half = folder.file("half.exr"), csv = folder.file("out.csv");
  run_program({"render", folder.scene, "--method", "lambert", "-o", half, "--quiet"});
  const struct {
    std::vector<std::string> arguments;
    int exit_code;
    std::string named;
  } cases[] = {
      {{"--csv", csv}, 2, "SCENE"},
      {{folder.scene}, 2, "--csv"},
      {{folder.scene, "--csv", csv, "--repeats", "2"},
       2,
       "--repeats: expected a whole number from 3 to 1000"},
      {{folder.scene, "--csv", csv, "--reference-error", "0"}, 2, "2% or 0.02, got 0"},
      {{folder.scene, "--csv", csv, "--rung", "near_field"}, 2, "near_field=false"},
      {{folder.scene, "--csv", csv, "--rung", "near_feild=false"},
       2,
       "did you mean 'settings.laboratory.near_field'"},
      {{folder.scene, "--csv", csv, "--rung", "tolerance=5"}, 2, "--rung tolerance=5: 'settings.tolerance'"},
      {{folder.scene, folder.scene, "--csv", csv, "--halves", half, half}, 2, "a single scene"},
      {{folder.scene, folder.scene, "--csv", csv}, 2, "given twice"},
      {{folder.scene, "--csv", csv, "--halves", half, half, "--profiles"},
       2,
       "cannot be combined with --profiles"},
      {{folder.scene, "--csv", csv, "--halves", half, half, "--reference-error", "2%"},
       2,
       "cannot be combined with --reference-error"},
      {{folder.scene, "--csv", csv, "--halves", half, half, "--resolution", "16x16"}, 2, "16 x 16"},
      {{folder.scene, "--csv", csv, "--set", "media.marbel.eta=2"}, 2, "did you mean 'marble'"},
      {{folder.file("none.json"), "--csv", csv}, 2, "none.json"},
      {{folder.scene, "--csv", folder.file("none/out.csv")}, 3, "none/out.csv"},
  };
  for (const auto& c : cases) {
    std::vector<std::string> arguments{"bench"};
    arguments.insert(arguments.end(), c.arguments.begin(), c.arguments.end());
    const Outcome outcome = run_program(arguments);
    EXPECT_EQ(outcome.exit_code, c.exit_code) << outcome.err;
    EXPECT_TRUE(contains(outcome.err, c.named)) << "no \"" << c.named << "\" in: " << outcome.err;
    EXPECT_EQ(std::ranges::count(outcome.err, '\n'), 1) << outcome.err;
    EXPECT_TRUE(outcome.out.empty()) << outcome.out;
  }
  EXPECT_EQ(folder.entries(), 2u);
}

// Claim: an interruption ends the child too, leaves the old CSV, and keeps what the reference has so far.
// Source: the design exit codes. The noise asked for takes hours, so the interruption comes first; it comes
// later and later until the child has had time for a pass (.1 s of it on an idle machine). Fails if: the
// child goes on (its sums then grow), or the CSV is opened for writing at the start.
TEST(CliBench, InterruptLeavesTheOldCsv) {
  const SceneFolder folder;
  put_bytes(folder.file("out.csv"), "old");
  const auto references = folder.path / "references";
  const auto kept_files = [&] { return std::distance(std::filesystem::directory_iterator(references), {}); };
  for (const int milliseconds : {700, 4000, 20000}) {
    Child bench(bench_line(folder, {"--reference-error", "0.01%"}));
    ASSERT_TRUE(bench.complains("seed 101"));
    std::this_thread::sleep_for(std::chrono::milliseconds(milliseconds));
    bench.send(SIGINT);
    const Outcome outcome = bench.wait(20);
    EXPECT_EQ(outcome.exit_code, 130) << outcome.err;
    EXPECT_EQ(bytes_of(folder.file("out.csv")), "old");
    if (kept_files() > 0) break;
  }
  ASSERT_EQ(kept_files(), 1);
  const std::string sums = std::filesystem::directory_iterator(references)->path().string(),
                    kept = bytes_of(sums);
  EXPECT_TRUE(sums.ends_with("seed101.sums.exr")) << sums;
  std::this_thread::sleep_for(std::chrono::milliseconds(100));
  EXPECT_EQ(bytes_of(sums), kept);
}

}  // namespace
}  // namespace opaline
