// SPDX-License-Identifier: GPL-3.0-or-later
#include "benchmark/page.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <string>

#include "benchmark/figures.h"
#include "benchmark/html.h"
#include "opaline/core/atomic_file.h"
#include "opaline/core/error.h"
#include "opaline/core/input_file.h"
#include "opaline/image/error_picture.h"

namespace opaline {
namespace {

std::string without_extension(const std::string& exr) {
  return exr.substr(0, exr.rfind('.'));
}

/// The colours of the error pictures, dark to bright, for CSS.
std::string error_gradient() {
  constexpr int steps = 12;
  std::string stops;
  for (int i = 0; i <= steps; ++i) {
    const RgbF c = 255 * brightness_ordered_colour(double(i) / steps);
    stops += fmt::format(", rgb({:.0f} {:.0f} {:.0f})", c.x, c.y, c.z);
  }
  return "linear-gradient(to right" + stops + ")";
}

/// The setting that is shown first: the scene's own, or the first with a picture.
std::size_t first_shown(const PageScene& scene, const std::vector<std::size_t>& rows) {
  for (const std::size_t row : rows)
    if (name_of(scene.report->rows[row].rung) == "hierarchical") return row;
  return rows.front();
}

/// "11.4 %", or "less than 2 %".
std::string error_words(const BenchRow& row) {
  const ErrorFigures& worst = row.error->worst;
  return worst.error < worst.error_floor ? fmt::format("less than {} %", figure(100 * worst.error_floor))
                                         : fmt::format("{} %", figure(100 * worst.error));
}

/// How far the scene's own model is from random walks, and what the diffusion equation makes of it.
std::string truth_answer_html(const PageScene& scene) {
  std::string html;
  for (const std::size_t row : rows_of(scene)) {
    const BenchRow& r = scene.report->rows[row];
    const bool is_own = name_of(r.rung) == "hierarchical";
    if (!r.error || !(is_own || r.rung.method == "volume_diffusion")) continue;
    html += fmt::format("{}<b>{}</b> off for <b>{} s</b> CPU ({})", html.empty() ? "" : "; ", error_words(r),
                        figure(r.job.cpu.median), is_own ? "as the scene has it" : escaped(name_of(r.rung)));
  }
  return html.empty() ? html : "<p class=\"answer\">Against random walks: " + html + ".</p>\n";
}

/// The answer before the figures: what the target costs, and what it would cost by `direct`.
std::string answer_html(const PageScene& scene) {
  if (scene.subject->is_truth) return truth_answer_html(scene);
  constexpr double target = .01;
  const TradeSeries* best = nullptr;
  Estimate least, direct;
  for (const TradeSeries& series : scene.series) {
    const Estimate cpu = cpu_at_error(series, target);
    if (series.method == "direct") direct = cpu;
    if (cpu.kind == Estimate::none || series.method == "direct") continue;
    if (best == nullptr || cpu.value < least.value) {
      best = &series;
      least = cpu;
    }
  }
  if (best == nullptr) return "<p class=\"answer\">No setting here reaches an error of 1 %.</p>\n";
  std::string html = fmt::format("<p class=\"answer\">An error of 1 % costs <b>{}{} s</b> CPU ({})",
                                 least.kind == Estimate::at_most ? "at most " : "", figure(least.value),
                                 escaped(best->name));
  for (const std::size_t row : rows_of(scene))
    if (const BenchRow& r = scene.report->rows[row]; r.rung.method == "lambert" && r.job.cpu.median > 0)
      html +=
          fmt::format(", <b>{}</b> times a plain lambert picture", figure(least.value / r.job.cpu.median));
  if (direct.kind != Estimate::none)
    html += fmt::format("; direct takes {}{} s, <b>{}</b> times as long",
                        direct.kind == Estimate::extrapolated ? "about " : "", figure(direct.value),
                        figure(direct.value / least.value));
  return html + ".</p>\n";
}

std::string scene_html(const PageScene& scene) {
  const BenchSubject& subject = *scene.subject;
  return fmt::format(
             "<section class=\"scene\" id=\"scene-{}\">\n<h2>{}</h2>\n<p class=\"sub\">{} × {} pixels; "
             "reference: {}, each half with {} % of noise</p>\n",
             scene.number, escaped(subject.title), subject.resolution[0], subject.resolution[1],
             escaped(subject.reference), figure(100 * subject.half_noise)) +
         answer_html(scene) + chart_html(scene) + viewer_html(scene) + trade_tables_html(scene) +
         budget_html(scene) + frames_html(scene) + settings_html(scene) + "</section>\n";
}

std::string notes_html(const BenchReport& report) {
  return "<section class=\"notes\"><h2>How it was measured</h2>\n" + notes_list(report.notes) +
         "<p>All figures: <a href=\"results.csv\">results.csv</a>, <a "
         "href=\"budget.csv\">budget.csv</a>, <a href=\"results.json\">results.json</a>. An error is "
         "reproduced by "
         "<code>opaline compare PICTURE --halves HALF1 HALF2</code> with a picture of this folder and the "
         "two "
         "halves named above.</p>\n</section>\n";
}

}  // namespace

std::string shown_picture(const std::string& exr) {
  return without_extension(exr) + ".png";
}
std::string error_picture_of(const std::string& exr) {
  return without_extension(exr) + "-error.png";
}

std::string viewer_html(const PageScene& scene) {
  std::vector<std::size_t> rows;
  for (const std::size_t row : rows_of(scene))
    if (!scene.report->rows[row].picture.empty()) rows.push_back(row);
  if (rows.empty() || scene.subject->picture.empty()) return {};
  const std::size_t first = first_shown(scene, rows);
  const std::string picture = scene.report->rows[first].picture;
  std::string options;
  for (const std::size_t row : rows) {
    const BenchRow& r = scene.report->rows[row];
    options += fmt::format("<option value=\"{}\" data-picture=\"{}\" data-error=\"{}\"{}>{}</option>\n", row,
                           url_of(shown_picture(r.picture)), url_of(error_picture_of(r.picture)),
                           row == first ? " selected" : "", escaped(name_of(r.rung)));
  }
  const std::size_t n = scene.number;
  return fmt::format(
      R"(<h3>Picture and error</h3>
<div class="viewer" style="--shape:{}/{}">
<p class="controls"><label>Setting <select id="setting-{}">
{}</select></label>
<label>Wipe <input type="range" id="wipe-{}" min="0" max="100" value="50"></label> <output for="wipe-{}">50 %</output></p>
<div class="pair">
<figure><div class="wipe"><img class="reference" src="{}" alt="reference"><img class="picture" src="{}" alt="picture at the chosen setting"><span class="edge"></span></div>
<figcaption>left: the setting; right: the reference</figcaption></figure>
<figure><img class="errors" src="{}" alt="error of the picture at the chosen setting">
<figcaption>error against the reference (its noise is in it)<span class="scale" style="background:{}"></span><span class="scale-ends"><span>.01 %</span><span>.1 %</span><span>1 %</span><span>10 %</span><span>100 %</span></span></figcaption></figure>
</div></div>
)",
      scene.subject->resolution[0], scene.subject->resolution[1], n, options, n, n,
      url_of(scene.subject->picture), url_of(shown_picture(picture)), url_of(error_picture_of(picture)),
      error_gradient());
}

std::vector<std::string> to_charts(const BenchReport& report) {
  std::vector<std::string> charts;
  for (const BenchSubject& subject : report.subjects) {
    const PageScene scene{&report, nullptr, &subject, charts.size(),
                          trade_series(report.rows, subject.scene)};
    charts.push_back(scene.series.empty() ? "" : chart_svg(scene));
  }
  return charts;
}

void check_page_file(const std::string& path) {
  const AtomicFile checked(path);
  constexpr std::uintmax_t kHead = 4096;  // has the title
  const std::string head = std::filesystem::exists(path) ? InputFile(path).read(0, kHead) : "";
  if (!head.empty() && head.find("opaline") == std::string::npos)
    throw bad_file(path, "is there already and is no page of opaline's", "another folder");
}

std::string to_page(const BenchReport& report) {
  const CsvTable table = bench_table(report);
  std::string body, titles;
  const bool has_truth = std::ranges::any_of(report.subjects, &BenchSubject::is_truth);
  for (std::size_t n = 0; n < report.subjects.size(); ++n) {
    const BenchSubject& subject = report.subjects[n];
    body += scene_html({&report, &table, &subject, n, trade_series(report.rows, subject.scene)});
    titles += (n > 0 ? ", " : "") + subject.title;
  }
  return framed(
      {"bench", titles, "Speed and error", lead_of(report.notes),
       std::string("What each setting costs, and how far its picture is from a converged one of the same "
                   "diffusion model. The error of the model itself is ") +
           (has_truth ? "in the sections against random walks."
                      : "the part of that name (--truth measures "
                        "it by random walks)."),
       body + notes_html(report)});
}

}  // namespace opaline
