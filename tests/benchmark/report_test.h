// SPDX-License-Identifier: GPL-3.0-or-later
// A small benchmark, made up.
#pragma once

#include <string>
#include <vector>

#include "benchmark/bench_row.h"

namespace opaline {

/// Three runs of `cpu` seconds, half of them shading, beside a lambert of 1 s; `error` of every channel.
inline BenchRow row_of(const std::string& scene, const Rung& rung, double cpu, double error,
                       double floor = .001) {
  BenchRun run, lambert;
  run.job = {cpu, 0, cpu, 100e6};
  run.stages[0] = Cost{cpu / 2, 0, cpu / 2, 90e6};
  run.stages[kShadingStage] = Cost{cpu / 2, 0, cpu / 2, 100e6};
  lambert.job = {1, 0, 1, 90e6};
  lambert.stages[kShadingStage] = Cost{.5, 0, .5, 90e6};
  const std::vector<BenchRun> runs(3, run), lamberts(3, lambert);
  BenchRow row = summarize(scene, rung, runs, lamberts);
  PictureError figures;
  figures.worst.error = error;
  figures.worst.error_floor = floor;
  figures.channels.fill(figures.worst);
  row.error = figures;
  row.picture = "pictures/" + rung.method + ".exr";
  return row;
}

inline BenchReport small_report() {
  BenchReport report;
  report.notes = {{"version", "opaline 0"}, {"threads", "1"}, {"command", "opaline bench <&>\"'"}};
  report.subjects = {{"a/ball.json", "KEY", "ball", "direct", .02, {16, 8}, "pictures/ball.png", false}};
  report.rows = {row_of("a/ball.json", {"lambert", "", "", ""}, 1, .5),
                 row_of("a/ball.json", {"hierarchical", "classic", "max_solid_angle", "0.4"}, 2, .04),
                 row_of("a/ball.json", {"hierarchical", "classic", "max_solid_angle", "0.1"}, 8, .01),
                 row_of("a/ball.json", {"direct", "", "entry_samples", "16"}, 4, .08)};
  return report;
}

}  // namespace opaline
