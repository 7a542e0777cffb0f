// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>
#include <tbb/global_control.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <csignal>
#include <filesystem>

#include "benchmark/machine.h"
#include "benchmark/page.h"
#include "benchmark/profile_page.h"
#include "cli/commands.h"
#include "core/atomic_file.h"
#include "core/interrupt.h"
#include "core/progress.h"
#include "core/stopwatch.h"
#include "core/units.h"
#include "diffusion/layered_medium.h"
#include "input/load_scene.h"
#include "input/schema.h"
#include "opaline/enumerations.h"
#include "opaline/error.h"
#include "values/json_tree.h"
#include "values/nearest_name.h"

namespace opaline {
namespace {

constexpr const char* kGiven = "MEDIUM";  // name of the argument in messages, as in --help

bool is_object(const std::string& text) {
  const std::size_t first = text.find_first_not_of(" \t\r\n");
  return first != std::string::npos && text[first] == '{';
}

Medium preset_medium(const std::string& name) {
  const std::span<const std::string_view> names = key_info("medium", "preset").choices;
  if (std::ranges::find(names, name) != names.end())
    return parse_medium("{\"preset\": \"" + name + "\"}", kGiven);
  const std::string near = did_you_mean(name, names);
  throw Error(ErrorKind::bad_input, {}, 0, 0, "unknown medium '" + printable(name) + "'" + near,
              near.empty()
                  ? "one of " + join(names) + R"(, or an object such as {"sigma_a": 0.01, "sigma_s": 2})"
                  : "");
}

/// Mean cosine of a medium given as text; a scene's medium includes it in its coefficients.
double anisotropy_of(const std::string& text) {
  if (!is_object(text)) return 0;
  const Document document{kGiven, text, {}, {}, 1, line_starts_of(text)};
  const Node root = parse_tree(document, text);
  const Node* g = find_member(root, "g");
  return g == nullptr ? 0 : g->number;
}

/// A medium with its name, at wavelengths or in red, green and blue.
struct GivenMedium {
  std::string name;
  Medium medium;
  std::optional<ThreeWavelengths> wavelengths;
};

/// A scene's medium, at three wavelengths if the scene has spectra.
GivenMedium medium_of_scene(const std::string& file, const std::string& name) {
  Scene scene = load_scene(file, {});
  if (!scene.other_wavelengths.empty())
    scene = load_scene(file, std::vector<std::string>{"film.wavelengths=3"});
  const auto found = std::ranges::find(scene.media, name, &Medium::name);
  if (found != scene.media.end()) return {name, *found, scene.wavelengths};
  std::vector<std::string_view> names;
  for (const Medium& medium : scene.media) names.push_back(medium.name);
  throw Error(ErrorKind::bad_input, file, 0, 0, "has no medium '" + printable(name) + "'",
              names.empty() ? "a scene with media" : "one of " + join(names));
}

GivenMedium given_medium(const ProfileArguments& arguments) {
  if (!arguments.scene.empty()) return medium_of_scene(arguments.scene, arguments.medium);
  if (is_object(arguments.medium)) return {"the medium", parse_medium(arguments.medium, kGiven), {}};
  return {arguments.medium, preset_medium(arguments.medium), {}};
}

/// Layers of a channel, of scattering with the mean cosine g at the same reduced scattering; the last one fills the rest of
/// the thickness.
std::vector<SlabLayer> layers_of(const Medium& medium, std::size_t channel, const ProfileRequest& request) {
  std::vector<FlatLayer> flat = flat_layers(medium, channel);
  if (flat.empty()) {
    const auto& coefficients = std::get<PhysicalMedium>(medium.coefficients);
    flat.push_back({coefficients.sigma_a[channel], coefficients.sigma_s_prime[channel]});
  }
  std::vector<SlabLayer> layers;
  double above = 0;
  for (const auto& [sigma_a, sigma_s_prime, thickness] : flat) {
    layers.push_back({{sigma_a, sigma_s_prime / (1 - request.g), request.g, request.eta}, thickness});
    above += layers.size() < flat.size() ? thickness : 0;
  }
  layers.back().thickness = request.thickness - above;
  check_value(layers.back().thickness > 0, "--thickness", "a length above that of the upper layers",
              request.thickness);
  return layers;
}

bool are_alike(const std::vector<SlabLayer>& a, const std::vector<SlabLayer>& b) {
  return std::ranges::equal(a, b, [](const SlabLayer& x, const SlabLayer& y) {
    return x.medium.sigma_a == y.medium.sigma_a && x.medium.sigma_s == y.medium.sigma_s;
  });
}

ProfileRequest request_of(const ProfileArguments& arguments) {
  const auto [name, medium, wavelengths] = given_medium(arguments);
  if (!std::holds_alternative<PhysicalMedium>(medium.coefficients))
    throw Error(ErrorKind::bad_input, {}, 0, 0,
                "subsurface_color defines a different medium for each diffusion model, so random walks have "
                "no medium",
                "sigma_a and sigma_s_prime, or sigma_a and sigma_s");
  ProfileRequest request;
  request.name = name;
  request.eta = arguments.eta.value_or(medium.eta);
  const Range& range = key_info("medium", "specular_ior").range;
  check_value(request.eta >= range.low && request.eta <= range.high, "--eta", "a number from 0.1 to 10",
              request.eta);
  const double own = arguments.scene.empty() ? anisotropy_of(arguments.medium) : medium.scatter_anisotropy;
  request.g = arguments.g.value_or(own);
  check_value(std::abs(request.g) < 1, "--g", "a number between -1 and 1", request.g);
  if (arguments.thickness) request.thickness = *arguments.thickness;
  check_value(request.thickness > 0, "--thickness", "a length above 0", request.thickness);
  if (arguments.walks) request.walks = std::size_t(*arguments.walks);
  request.seed = arguments.seed;
  constexpr std::array<const char*, 3> kNames{"R", "G", "B"};
  for (std::size_t c = 0; c < 3; ++c) {
    const std::string channel = wavelengths ? fmt::format("{:.0f} nm", wavelengths->bands[c][0]) : kNames[c];
    request.channels.push_back({channel, layers_of(medium, c, request)});
  }
  const std::vector<SlabLayer>& first = request.channels[0].layers;
  if (are_alike(first, request.channels[1].layers) && are_alike(first, request.channels[2].layers)) {
    request.channels.resize(1);
    request.channels[0].name = "all";
  }
  return request;
}

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
  const ProfileRequest request = request_of(arguments);
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
