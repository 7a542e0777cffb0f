// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <csignal>
#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "cli/arguments.h"
#include "cli/commands.h"
#include "cli/report.h"
#include "core/units.h"
#include "image/error_picture.h"
#include "opaline/compare.h"
#include "opaline/error.h"
#include "values/nearest_name.h"

namespace opaline {
namespace {

/// FLIP over the object's pixels.
struct FlipReport {
  ErrorStatistics statistics;
  double exposure = 0;  ///< stops
};

/// Counts of non-finite values.
struct NonFiniteReport {
  std::string path;
  NonFinite count;
};

struct CompareReport {
  int width = 0, height = 0;
  std::size_t object_pixels = 0;
  std::vector<std::string> channels;
  std::vector<double> floors;               ///< floors of the relative error; none with halves
  std::vector<ErrorStatistics> errors;      ///< a channel each, then over all; none with halves
  std::vector<HalvesEstimate> halves;       ///< a channel each, then over all; none without halves
  std::optional<FlipReport> flip;           ///< FLIP of R, G, B against one reference
  std::vector<NonFiniteReport> not_finite;  ///< the image, then its references
  std::vector<std::string> failures;        ///< why the comparison failed
};

std::string percent(double share) {
  return fmt::format("{:.3g} %", 100 * share);
}

/// The name of a row: a channel, or all of them.
std::string row_name(const CompareReport& report, std::size_t row) {
  return row < report.channels.size() ? report.channels[row] : "all";
}

void print_errors(const CompareReport& report) {
  const auto row = [](const std::string& name, const auto&... cells) {
    print_row(name, fmt::format("{:>10}{:>12}{:>11}{:>11}{:>12}", cells...));
  };
  row("error", "mean", "relMSE", "p99", "max", "signed");
  for (std::size_t i = 0; i < report.errors.size(); ++i) {
    const ErrorStatistics& e = report.errors[i];
    row(row_name(report, i), percent(e.mean), fmt::format("{:.3g}", e.mean_square), percent(e.p99),
        percent(e.largest), fmt::format("{:+.3g} %", 100 * e.signed_mean));
  }
}

void print_halves(const CompareReport& report) {
  const auto row = [](const std::string& name, const auto&... cells) {
    print_row(name, fmt::format("{:>10}{:>12}{:>12}{:>12}{:>14}", cells...));
  };
  row("error", "err", "err^2", "std. error", "signed", "noise of half");
  for (std::size_t i = 0; i < report.halves.size(); ++i) {
    const HalvesEstimate& e = report.halves[i];
    row(row_name(report, i), percent(e.error), fmt::format("{:.3g}", e.squared_error),
        fmt::format("{:.2g}", e.standard_error), fmt::format("{:+.3g} %", 100 * e.signed_mean),
        percent(e.half_noise));
  }
  for (std::size_t i = 0; i < report.halves.size(); ++i)
    if (report.halves[i].squared_error < 0)
      print_row("",
                fmt::format("{}: below noise ({})", row_name(report, i), percent(report.halves[i].error)));
}

void print_text(const CompareArguments& arguments, const CompareReport& report) {
  print_row("picture", fmt::format("{}: {} x {} pixels, {}", arguments.picture, report.width, report.height,
                                   fmt::join(report.channels, " ")));
  print_row("reference", arguments.halves.empty() ? arguments.reference
                                                  : arguments.halves[0] + ", " + arguments.halves[1]);
  const auto all = std::uint64_t(report.width) * std::uint64_t(report.height);
  print_row("object", fmt::format("{} of {} pixels", grouped(report.object_pixels), grouped(all)));
  report.halves.empty() ? print_errors(report) : print_halves(report);
  if (report.flip)
    print_row("FLIP", fmt::format("mean {:.4f}, p99 {:.4f}, max {:.4f} at {:+.2f} stops",
                                  report.flip->statistics.mean, report.flip->statistics.p99,
                                  report.flip->statistics.largest, report.flip->exposure));
  for (const auto& [path, count] : report.not_finite)
    if (count.nan + count.infinite > 0)
      print_row("not finite", fmt::format("{} NaN and {} infinite values in {}", grouped(count.nan),
                                          grouped(count.infinite), path));
  if (!arguments.error_picture.empty()) print_row("wrote", arguments.error_picture);
  for (const std::string& failure : report.failures) write_line(stderr, "opaline: failed: " + failure);
}

Json statistics_json(const ErrorStatistics& e) {
  return {{"values", e.values},          {"mean_relative_error", e.mean},   {"relmse", e.mean_square},
          {"p99_relative_error", e.p99}, {"max_relative_error", e.largest}, {"signed_mean", e.signed_mean}};
}

Json halves_json(const HalvesEstimate& e) {
  return {
      {"pixels", e.pixels},        {"squared_error", e.squared_error},   {"standard_error", e.standard_error},
      {"error", e.error},          {"below_noise", e.squared_error < 0}, {"signed_mean", e.signed_mean},
      {"half_noise", e.half_noise}};
}

/// Each channel's object by name, then "all".
Json rows_json(const CompareReport& report) {
  Json rows = Json::object();
  for (std::size_t i = 0; i < report.errors.size(); ++i) {
    Json& row = rows[row_name(report, i)] = statistics_json(report.errors[i]);
    if (i < report.floors.size()) row["floor"] = report.floors[i];
  }
  for (std::size_t i = 0; i < report.halves.size(); ++i)
    rows[row_name(report, i)] = halves_json(report.halves[i]);
  return rows;
}

Json comparison_json(const CompareArguments& arguments, const CompareReport& report) {
  Json json{{"picture", arguments.picture}};
  if (arguments.halves.empty())
    json["reference"] = arguments.reference;
  else
    json["halves"] = arguments.halves;
  json["resolution"] = {report.width, report.height};
  json["object_pixels"] = report.object_pixels;
  json["channels"] = report.channels;
  json["errors"] = rows_json(report);
  if (report.flip)
    json["flip"] = {{"mean", report.flip->statistics.mean},
                    {"p99", report.flip->statistics.p99},
                    {"max", report.flip->statistics.largest},
                    {"exposure", report.flip->exposure}};
  for (const auto& [path, count] : report.not_finite)
    json["not_finite"].push_back({{"file", path}, {"nan", count.nan}, {"infinite", count.infinite}});
  if (!arguments.error_picture.empty()) json["error_picture"] = arguments.error_picture;
  if (arguments.fail_above) json["fail_above"] = *arguments.fail_above;
  json["passed"] = report.failures.empty();
  json["failures"] = report.failures;
  return json;
}

void print_comparison(const CompareArguments& arguments, const CompareReport& report) {
  if (arguments.log.format == LogFormat::text) print_text(arguments, report);
  if (arguments.log.format == LogFormat::json)
    print_event(arguments.log, "comparison", comparison_json(arguments, report));
}

/// One layer of a file.
struct Picture {
  std::string path;
  Image frame;  ///< the file without its pixels
  Layer layer;
  std::vector<std::uint8_t> object;
};

Picture load(const std::string& path, const std::string& layer) {
  Picture picture{path, read_image(path), {}, {}};
  picture.layer = extract_layer(picture.frame, layer);
  if (picture.layer.channels.empty()) {
    const std::vector<std::string> layers = layers_of(picture.frame);
    const std::vector<std::string_view> names(layers.begin(), layers.end());
    throw bad_file(path, "no such layer" + did_you_mean(layer, names),
                   fmt::format("one of {}", fmt::join(layers, "; ")), layer.empty() ? "R,G,B" : layer);
  }
  picture.object = object_pixels(picture.frame);
  picture.frame.pixels = {};
  return picture;
}

bool is_png(const std::string& path) {
  return output_format(path) == OutputFormat::png;
}

/// PNG files do not store their crop.
void check_comparable(const Picture& picture, const Picture& reference) {
  const auto size = [](const Image& i) { return fmt::format("{} x {} pixels", i.width, i.height); };
  const auto crop = [](const Image& i) {
    return fmt::format("{} x {} pixels at {},{} of {} x {}", i.width, i.height, i.crop_x, i.crop_y,
                       i.full_width, i.full_height);
  };
  const auto check = [&](const auto& text, const char* what) {
    const std::string expected = text(reference.frame), got = text(picture.frame);
    if (got != expected)
      throw bad_file(picture.path, what, fmt::format("{} as in {}", expected, reference.path), got);
  };
  check(size, "the images differ in size");
  if (!is_png(picture.path) && !is_png(reference.path)) check(crop, "the images have different crops");
  if (picture.layer.names != reference.layer.names)
    throw bad_file(picture.path, "the layers differ in their channels",
                   fmt::format("{} as in {}", fmt::join(reference.layer.names, " "), reference.path),
                   fmt::format("{}", fmt::join(picture.layer.names, " ")));
}

/// Images of one run: the tested one, then the reference or its halves.
std::vector<Picture> load_all(const CompareArguments& arguments) {
  std::vector<std::string> paths{arguments.picture};
  if (arguments.halves.empty())
    paths.push_back(arguments.reference);
  else
    paths.insert(paths.end(), arguments.halves.begin(), arguments.halves.end());
  std::error_code missing;
  for (const std::string& path : paths)
    if (std::filesystem::equivalent(path, arguments.error_picture, missing))
      throw bad_file(arguments.error_picture, "is an input of the comparison and would be overwritten",
                     "another output name");
  std::vector<Picture> pictures;
  for (const std::string& path : paths) {
    pictures.push_back(load(path, arguments.layer));
    if (pictures.size() > 1) check_comparable(pictures[0], pictures.back());
  }
  return pictures;
}

/// Pixels covered in any of the references.
std::vector<std::uint8_t> object_of(const std::vector<Picture>& pictures) {
  std::vector<std::uint8_t> object = pictures[1].object;
  for (const Picture& reference : pictures)
    if (&reference != &pictures[0])
      for (std::size_t i = 0; i < object.size(); ++i) object[i] |= reference.object[i];
  if (std::ranges::count(object, 1) == 0)
    throw bad_file(pictures[1].path, "no pixel shows an object", "coverage A above 0 somewhere");
  return object;
}

void warn_of_uncovered(const CompareArguments& arguments, const Picture& picture,
                       const std::vector<std::uint8_t>& object) {
  if (std::ranges::find(picture.frame.channels, "A") == picture.frame.channels.end()) return;
  std::size_t uncovered = 0;
  for (std::size_t i = 0; i < object.size(); ++i) uncovered += picture.object[i] > object[i] ? 1 : 0;
  if (uncovered > 0)
    print_warning(arguments.log,
                  fmt::format("{} pixels show an object in {} but not in the reference; they are excluded",
                              grouped(uncovered), picture.path));
}

CompareReport describe(const std::vector<Picture>& pictures, const std::vector<std::uint8_t>& object) {
  CompareReport report;
  report.width = pictures[0].layer.width;
  report.height = pictures[0].layer.height;
  report.object_pixels = std::size_t(std::ranges::count(object, 1));
  report.channels = pictures[0].layer.names;
  for (const Picture& picture : pictures)
    report.not_finite.push_back({picture.path, count_non_finite(picture.layer)});
  return report;
}

bool is_colour(const Layer& layer) {
  return layer.names.size() == 3 && layer.names[0].ends_with('R');
}

FlipReport flip_of(const CompareArguments& arguments, const std::vector<Picture>& pictures,
                   const std::vector<std::uint8_t>& object) {
  const double automatic = is_png(arguments.reference) ? 0.0 : display_exposure(pictures[1].layer, object);
  FlipReport report{{}, arguments.exposure.value_or(automatic)};
  const std::vector<float> map = flip(pictures[0].layer, pictures[1].layer, report.exposure);
  std::vector<double> values;
  for (std::size_t i = 0; i < map.size(); ++i)
    if (object[i]) values.push_back(map[i]);
  report.statistics = error_statistics(values);
  return report;
}

void note_errors(const RelativeErrors& errors, CompareReport& report) {
  for (const std::vector<double>& channel : errors.channels)
    report.errors.push_back(error_statistics(channel));
  report.errors.push_back(error_statistics(errors));
  report.floors = errors.floors;
}

void note_halves(const HalvesComparison& estimate, CompareReport& report) {
  report.halves = estimate.channels;
  report.halves.push_back(estimate.all);
}

void note_failures(const CompareArguments& arguments, CompareReport& report) {
  const NonFinite& count = report.not_finite[0].count;
  if (count.nan + count.infinite > 0)
    report.failures.push_back(fmt::format("{} has {} values that are not finite", arguments.picture,
                                          grouped(count.nan + count.infinite)));
  if (!arguments.fail_above) return;
  for (std::size_t c = 0; c < report.channels.size(); ++c) {
    const double error = report.halves.empty() ? report.errors[c].mean : report.halves[c].error;
    if (!(error <= *arguments.fail_above))
      report.failures.push_back(fmt::format("the mean relative error of {} is {:.3g} %, above {:.3g} %",
                                            report.channels[c], 100 * error, 100 * *arguments.fail_above));
  }
}

void write_error_picture(const std::string& path, const RelativeErrors& errors, const Picture& picture,
                         const std::vector<std::uint8_t>& object) {
  if (output_format(path) == OutputFormat::png)
    return write_png(path, error_colours(errors, picture.layer, object), 0);
  Image image = signed_errors(errors, picture.layer);
  image.crop_x = picture.frame.crop_x;
  image.crop_y = picture.frame.crop_y;
  image.full_width = picture.frame.full_width;
  image.full_height = picture.frame.full_height;
  write_exr(path, image, /*half=*/false);
}

/// Rejects defects of the reference, which could appear as a small error.
void check_values(const CompareReport& report, const Picture& reference) {
  if (!report.failures.empty()) return;
  for (std::size_t c = 0; c < report.channels.size(); ++c)
    if (report.halves.empty() ? report.errors[c].values == 0 : report.halves[c].pixels == 0)
      throw bad_file(reference.path, "no finite value of the object in channel " + report.channels[c]);
}

}  // namespace

int compare_command(const CompareArguments& arguments) {
  std::signal(SIGPIPE, SIG_IGN);  // a closed pipe must not prevent the error image
  const std::vector<Picture> pictures = load_all(arguments);
  const Layer& layer = pictures[0].layer;
  const std::vector<std::uint8_t> object = object_of(pictures);
  warn_of_uncovered(arguments, pictures[0], object);

  CompareReport report = describe(pictures, object);
  const bool halves = !arguments.halves.empty();
  const RelativeErrors errors = relative_errors(
      layer, halves ? mean_of(pictures[1].layer, pictures[2].layer) : pictures[1].layer, object);
  if (halves) {
    note_halves(compare_with_halves(layer, pictures[1].layer, pictures[2].layer, object), report);
  } else {
    note_errors(errors, report);
    if (is_colour(layer)) report.flip = flip_of(arguments, pictures, object);
  }
  note_failures(arguments, report);
  check_values(report, pictures[1]);
  if (!arguments.error_picture.empty())
    write_error_picture(arguments.error_picture, errors, pictures[0], object);
  print_comparison(arguments, report);
  return report.failures.empty() ? 0 : 1;
}
}  // namespace opaline
