// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>
#include <tbb/global_control.h>

#include <algorithm>
#include <array>
#include <csignal>
#include <filesystem>

#include "benchmark/machine.h"
#include "benchmark/page.h"
#include "benchmark/profile_page.h"
#include "benchmark/profile_request.h"
#include "cli/commands.h"
#include "core/atomic_file.h"
#include "core/interrupt.h"
#include "core/progress.h"
#include "core/stopwatch.h"
#include "core/units.h"
#include "opaline/enumerations.h"
#include "opaline/error.h"

namespace opaline {
namespace {

/// Creates the folder or checks that it is writable, before the work.
void prepare_folder(const std::string& folder) {
  std::error_code failure;
  std::filesystem::create_directories(folder, failure);
  if (failure) throw run_failed(folder, "cannot create the folder: " + failure.message());
  check_page_file(folder + "/index.html");
}

/// Writes the page last, after the files it links to.
void write_report(const std::string& folder, const ProfileReport& report) {
  write_file(folder + "/totals.csv", to_csv(totals_table(report)));
  write_file(folder + "/profile.csv", to_csv(rings_table(report)));
  write_file(folder + "/angles.csv", to_csv(angles_table(report)));
  write_file(folder + "/index.html", to_page(report));
}

void print_row(const std::string& label, const std::vector<std::string>& cells) {
  static const std::size_t width = 2 + std::ranges::max(kProfileNames, {}, &std::string_view::size).size();
  std::string line = fmt::format("{:<{}}", label, width);
  for (const std::string& cell : cells) line += fmt::format("{:<30}", cell);
  write_line(stdout, line.substr(0, line.find_last_not_of(' ') + 1));
}

template <class Cell>
void print_channels(const ProfileReport& report, const std::string& label, const Cell& cell) {
  std::vector<std::string> cells;
  for (const ProfiledChannel& channel : report.channels) cells.push_back(cell(channel));
  print_row(label, cells);
}

void print_face(const ProfileReport& report, const char* title, WalkedFace SlabWalks::*face, double height) {
  print_channels(report, title, [](const ProfiledChannel& channel) { return channel.name; });
  for (const bool is_diffuse : {true, false})
    print_channels(
        report, is_diffuse ? "walks, diffuse" : "walks, normal", [&](const ProfiledChannel& channel) {
          return walked_text(((is_diffuse ? channel.diffuse : channel.normal).*face).total, " +- ");
        });
  if (height == 0 && report.channels[0].layered_diffusion)
    print_channels(report, "layers, normal", [](const ProfiledChannel& channel) {
      return fmt::format("{:.4f} {:+.1f} %", *channel.layered_diffusion,
                         100 * (*channel.layered_diffusion / channel.normal.back.total.value - 1));
    });
  for (std::size_t kind = 0; kind < kProfileNames.size(); ++kind)
    print_channels(report, std::string(kProfileNames[kind]), [&](const ProfiledChannel& channel) {
      const ModelFace model{&channel.models[kind], height};
      const WalkedFace& walked = channel.diffuse.*face;
      std::string text = fmt::format("{:.4f}", model.total());
      if (walked.total.value > 0)
        text += fmt::format(" {:+.1f} %, shape {:.1f} %", 100 * (model.total() / walked.total.value - 1),
                            100 * shape_difference(model, walked));
      return text;
    });
}

void print_text(const ProfileReport& report) {
  const ProfileRequest& request = report.request;
  print_row("medium", {fmt::format("{}, {}, eta {:.4g}, g {:.4g}", request.name, shape_words(report),
                                   request.eta, request.g)});
  print_channels(report, "walks",
                 [](const ProfiledChannel& c) { return fmt::format("2 x {}", grouped(c.diffuse.walks)); });
  print_face(report, "reflected", &SlabWalks::back, 0);
  if (report.is_slab()) print_face(report, "transmitted", &SlabWalks::through, request.thickness);
  const auto is_unfinished = [](const ProfiledChannel& c) { return c.diffuse.unfinished.value > 0; };
  if (std::ranges::any_of(report.channels, is_unfinished))
    print_channels(report, "unfinished, diffuse",
                   [](const ProfiledChannel& c) { return walked_text(c.diffuse.unfinished, " +- "); });
}

Json walked_json(const WalkedValue& value) {
  return {{"share", value.value}, {"error", value.error}};
}

Json report_json(const ProfileReport& report) {
  Json channels = Json::object();
  for (const ProfiledChannel& channel : report.channels) {
    Json& json = channels[channel.name];
    for (const bool is_far : {false, true}) {
      if (is_far && !report.is_slab()) continue;
      const auto face = is_far ? &SlabWalks::through : &SlabWalks::back;
      Json& totals = json[is_far ? "through" : "back"];
      totals["walks_diffuse"] = walked_json((channel.diffuse.*face).total);
      totals["walks_normal"] = walked_json((channel.normal.*face).total);
      for (std::size_t kind = 0; kind < kProfileNames.size(); ++kind) {
        const ModelFace model{&channel.models[kind], is_far ? report.request.thickness : 0};
        totals[std::string(kProfileNames[kind])] = {
            {"share", model.total()}, {"shape_difference", shape_difference(model, channel.diffuse.*face)}};
      }
    }
    if (channel.layered_diffusion) json["back"]["layers_normal"] = {{"share", *channel.layered_diffusion}};
    json["unfinished"] = walked_json(channel.diffuse.unfinished);
    json["walks"] = channel.diffuse.walks;
  }
  Json json{{"medium", report.request.name}, {"eta", report.request.eta}, {"g", report.request.g}};
  if (report.is_slab()) json["thickness"] = report.request.thickness;
  json["channels"] = std::move(channels);
  return json;
}

}  // namespace

void profile_command(const ProfileArguments& arguments) {
  std::signal(SIGPIPE, SIG_IGN);  // a reader leaving must not cost the report
  const ProfileRequest request = profile_request(arguments.given);
  if (!arguments.report.empty()) prepare_folder(arguments.report);
  std::optional<tbb::global_control> threads;
  if (arguments.threads > 0)
    threads.emplace(tbb::global_control::max_allowed_parallelism, std::size_t(arguments.threads));
  Monitor monitor;
  const InterruptHandler interrupt(monitor);
  const Stopwatch watch;
  ProfileReport report = [&] {
    Log log = arguments.log;
    log.quiet = log.format == LogFormat::json;  // one object and nothing else
    const Progress progress(log, monitor, "walks");
    return measure_profiles(request, monitor);
  }();
  advance(&monitor, 0);
  if (!arguments.report.empty()) {
    report.notes = machine_notes();
    report.notes.emplace_back("command", "opaline" + arguments.command_line);
    report.notes.emplace_back(
        "threads",
        std::to_string(tbb::global_control::active_value(tbb::global_control::max_allowed_parallelism)));
    for (const ProfiledChannel& channel : report.channels)
      report.notes.emplace_back(
          "walks " + channel.name,
          fmt::format("{0} in diffuse light and {0} along the normal", channel.diffuse.walks));
    report.notes.emplace_back("seed", std::to_string(request.seed));
    report.notes.emplace_back("cost", fmt::format("{:.1f} s of CPU", watch.cost("walks").cpu_seconds));
    for (auto& [key, value] : report.notes) std::ranges::replace(value, '\n', ' ');
    write_report(arguments.report, report);
  }
  if (arguments.log.format == LogFormat::json)
    print_event(arguments.log, "profile", report_json(report));
  else
    print_text(report);
  if (!arguments.report.empty() && arguments.log.format == LogFormat::text)
    print_row("wrote", {arguments.report + "/index.html"});
}

}  // namespace opaline
