// SPDX-License-Identifier: GPL-3.0-or-later
// Exitance across the edge of a shadow on a translucent floor, `hierarchical` beside `direct`: an edge
// narrower and one wider than the mean free path, both profiles. usage: bench_shadow_edge [ENTRIES A PIXEL]
#include <fmt/format.h>
#include <tbb/global_control.h>

#include <algorithm>
#include <cstdlib>
#include <exception>
#include <fstream>
#include <string>

#include "core/stopwatch.h"
#include "support/shadow_edge_line.h"

namespace {

using namespace opaline;
using namespace opaline::test;

std::string processor() {
  std::ifstream file("/proc/cpuinfo");
  for (std::string line; std::getline(file, line);)
    if (line.starts_with("model name")) return line.substr(line.find(':') + 2);
  return "unknown processor";
}

// A row of the plot: x where both fall on one column, h and d where they do not.
std::string plot_row(double hierarchical, double direct, double brightest) {
  constexpr double kColumns = 40;
  std::string row(std::size_t(kColumns * 1.05) + 1, ' ');
  const auto column = [&](double value) {
    return std::clamp<std::size_t>(std::size_t(kColumns * value / brightest + 0.5), 0, row.size() - 1);
  };
  row[column(direct)] = 'd';
  row[column(hierarchical)] = column(hierarchical) == column(direct) ? 'x' : 'h';
  return row;
}

void print_edge(bool wide, ProfileKind profile, std::size_t entries) {
  const Stopwatch watch;
  const Scene scene = shadow_edge_scene(wide, profile);
  const EdgeLine line = shadow_edge_line(scene);
  const auto [direct, noise] = direct_edge_line(scene, line, entries);
  const double brightest = std::ranges::max(direct);
  fmt::print("\n{} edge, {}; {:.1f} s CPU\n", wide ? "wide (4.2 mm)" : "narrow (0 mm)",
             profile == ProfileKind::dipole ? "dipole" : "normalized diffusion", watch.cost({}).cpu_seconds);
  fmt::print("{:>6} {:>12} {:>10} {:>7} {:>8} {:>10}  |0{:>39}\n", "mm", "hierarchical", "direct", "noise",
             "error", "of local", "brightest");
  double mean = 0, largest = 0;
  for (std::size_t i = 0; i < line.x.size(); ++i) {
    const double h = line.hierarchical[i], d = direct[i], error = (h - d) / brightest;
    mean += std::abs(error) / double(line.x.size());
    largest = std::max(largest, std::abs(error));
    fmt::print("{:6.2f} {:12.5f} {:10.5f} {:6.2f}% {:+7.2f}% {:+9.2f}%  |{}\n", line.x[i], h, d,
               100 * noise[i] / brightest, 100 * error, d > 0 ? 100 * (h - d) / d : 0.0,
               plot_row(h, d, brightest));
  }
  fmt::print("error over the brightest: mean {:.2f} %, largest {:.2f} %\n", 100 * mean, 100 * largest);
}

}  // namespace

int main(int argc, char** argv) try {
  const std::size_t entries = argc > 1 ? std::strtoul(argv[1], nullptr, 10) : 1 << 20;
  const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, 1);
  fmt::print("{}, one thread\n", processor());
  fmt::print(
      "floor of mean free path {} mm, eta 1.3, 2 % absorbed, samples one mean free path apart; classic "
      "traversal at the\n"
      "default angle; direct: {} entries a pixel. Exitance in W/mm^2 at mm from the lid's edge; noise, "
      "error: of the\n"
      "brightest.\n",
      kEdgeFreePath, entries);
  for (const bool wide : {false, true})
    for (const ProfileKind profile : {ProfileKind::dipole, ProfileKind::normalized_diffusion})
      print_edge(wide, profile, entries);
  return 0;
} catch (const std::exception& error) {
  fmt::print(stderr, "bench_shadow_edge: {}\n", error.what());
  return 3;
}
