// SPDX-License-Identifier: GPL-3.0-or-later
#include "benchmark/profile_page.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "benchmark/figures.h"
#include "benchmark/html.h"
#include "benchmark/profile_charts.h"
#include "opaline/scene/enumerations.h"

namespace opaline {
namespace {

std::string model_words(std::size_t kind) {
  std::string name(kProfileNames[kind]);
  std::ranges::replace(name, '_', ' ');
  return name;
}

std::string signed_percent(double value) {
  return fmt::format("{:+.1f} %", 100 * value);
}

std::string header_html(const ProfileReport& report) {
  std::string html = "<thead><tr><th></th>";
  for (const ProfiledChannel& channel : report.channels) html += "<th>" + escaped(channel.name) + "</th>";
  return html + "</tr></thead>\n";
}

struct Face {
  const char* words;
  WalkedFace SlabWalks::*walked;
  double height;
};

/// Walks, then each model with how far off it is.
std::string face_table(const ProfileReport& report, const Face& face) {
  std::string html = "<div class=\"scroll\"><table>" + header_html(report) + "<tbody>\n";
  for (const bool is_diffuse : {true, false}) {
    html += fmt::format("<tr class=\"series-0\"><th><i></i>walks, {}</th>",
                        is_diffuse ? "diffuse light" : "along the normal");
    for (const ProfiledChannel& channel : report.channels)
      html += "<td>" +
              walked_text(((is_diffuse ? channel.diffuse : channel.normal).*face.walked).total, " ± ") +
              "</td>";
    html += "</tr>\n";
  }
  for (std::size_t kind = 0; kind < kProfileNames.size(); ++kind) {
    html += fmt::format("<tr class=\"series-{}\"><th><i></i>{} <span class=\"none\">({})</span></th>",
                        kind + 1, model_words(kind), escaped(std::string(kProfileSources[kind])));
    for (const ProfiledChannel& channel : report.channels) {
      const ModelFace model{&channel.models[kind], face.height};
      const WalkedFace& walked = channel.diffuse.*face.walked;
      html +=
          fmt::format("<td>{:.4f} <span class=\"none\">{}; shape {:.1f} %</span></td>", model.total(),
                      walked.total.value > 0 ? signed_percent(model.total() / walked.total.value - 1) : "",
                      100 * shape_difference(model, walked));
    }
    html += "</tr>\n";
  }
  return fmt::format("<h3>{}</h3>\n", face.words) + html + "</tbody></table></div>\n";
}

std::string totals_html(const ProfileReport& report) {
  std::string html =
      "<section><h2>Totals</h2>\n<p>Shares of the light that entered. Behind a model: how far its total is "
      "from "
      "the walks' in diffuse light, and the largest difference, over all distances, of the shares (each of "
      "its own "
      "total) that leave within that distance.</p>\n";
  html += face_table(report, {"Comes back", &SlabWalks::back, 0});
  if (report.is_slab())
    html += face_table(report, {"Goes through", &SlabWalks::through, report.request.thickness});
  return html + "</section>\n";
}

std::string coefficients_text(const ProfiledChannel& channel) {
  const HomogeneousMedium& m = channel.medium;
  const double length = m.reduced_mean_free_path();
  std::string text = fmt::format("σa {:.4g}, σs {:.4g} per mm, g {:.4g}; mean free path {} mm", m.sigma_a,
                                 m.sigma_s, m.g, figure(length));
  if (m.sigma_a > 0)
    text += fmt::format(", diffuse mean free path {} mm", figure(std::sqrt(length / (3 * m.sigma_a))));
  return text + fmt::format("; {} collisions a walk, {} walks", figure(channel.diffuse.collisions),
                            channel.diffuse.walks);
}

std::string channel_html(const ProfileReport& report, const ProfiledChannel& channel) {
  const Plot profile = profile_plot(report, channel, false);
  std::string html = fmt::format("<section><h2>{}</h2>\n<p class=\"sub\">{}</p>\n",
                                 channel.name == "all" ? "All channels" : "Channel " + channel.name,
                                 escaped(coefficients_text(channel)));
  if (!(channel.medium.sigma_s > 0)) return html + "<p>Nothing scatters here.</p></section>\n";
  html += plot_legend(profile.series) + "<div class=\"pair\">\n" + plot_html(profile) +
          plot_html(ratio_plot(report, channel));
  if (report.is_slab()) html += plot_html(profile_plot(report, channel, true));
  html += plot_html(entry_plot(report, channel));
  html += plot_html(exit_plot(report, channel));
  html += "</div>\n";
  const Plot source = point_source_plot(channel);
  html += "<details><summary>Diffusion far from any boundary</summary>\n" + plot_legend(source.series) +
          "<div class=\"pair\">\n" + plot_html(source) +
          "<p class=\"small\">The exact fluence is that of Case's singular eigenfunctions, for scattering "
          "without "
          "direction (the reduced coefficients).</p></div></details>\n";
  return html + "</section>\n";
}

std::string notes_html(const ProfileReport& report) {
  return "<section class=\"notes\"><h2>How it was measured</h2>\n" + notes_list(report.notes) +
         "<p>All figures: <a href=\"totals.csv\">totals.csv</a>, <a href=\"profile.csv\">profile.csv</a> (by "
         "distance), <a href=\"angles.csv\">angles.csv</a>.</p>\n</section>\n";
}

/// The model whose largest figure over the channels is the least: "better dipole (at most 1.8 %)".
template <class Off>
std::string nearest_model(const ProfileReport& report, const Off& off) {
  std::size_t best = 0;
  double least = INFINITY;
  for (std::size_t kind = 0; kind < kProfileNames.size(); ++kind) {
    double worst = 0;
    for (const ProfiledChannel& channel : report.channels)
      worst = std::max(worst, off(ModelFace{&channel.models[kind], 0}, channel.diffuse.back));
    if (worst < least) best = kind, least = worst;
  }
  return fmt::format("{} (within <b>{:.1f} %</b>)", model_words(best), 100 * least);
}

/// The answer before the figures: what comes back, and which model comes nearest.
std::string answer_html(const ProfileReport& report) {
  std::string html =
      fmt::format("<p class=\"answer\">Of diffuse light that enters a {} of {}, walks bring back ",
                  shape_words(report), escaped(report.request.name));
  for (std::size_t c = 0; c < report.channels.size(); ++c)
    html += fmt::format("{}<b>{:.1f} %</b>", c > 0 ? ", " : "",
                        100 * report.channels[c].diffuse.back.total.value);
  const auto total_off = [](const ModelFace& model, const WalkedFace& walked) {
    return walked.total.value > 0 ? std::abs(model.total() / walked.total.value - 1) : 0;
  };
  return html + ". The total of the " + nearest_model(report, total_off) +
         " is nearest, and the shape of the " + nearest_model(report, shape_difference) + ".</p>\n";
}

}  // namespace

std::string shape_words(const ProfileReport& report) {
  return report.is_slab() ? fmt::format("slab of {:.4g} mm", report.request.thickness) : "half space";
}

std::string walked_text(const WalkedValue& value, const char* between) {
  const int digits = value.error > 0 ? std::clamp(1 - int(std::floor(std::log10(value.error))), 3, 7) : 4;
  return fmt::format("{:.{}f}{}{:.{}f}", value.value, digits, between, value.error, digits);
}

std::string profile_svg(const ProfileReport& report, const ProfiledChannel& channel) {
  return plot_svg(profile_plot(report, channel, false));
}

std::string to_page(const ProfileReport& report) {
  std::string body = answer_html(report) + totals_html(report);
  for (const ProfiledChannel& channel : report.channels) body += channel_html(report, channel);
  const std::string title =
      fmt::format("{}, {}, eta {:.4g}", report.request.name, shape_words(report), report.request.eta);
  return framed(
      {"profile", title, title, lead_of(report.notes),
       "How far the diffusion models are from random walks, which follow light through the medium and "
       "know no model: a beam enters a flat face, and the light that leaves is counted by distance and "
       "angle. Bars are one standard error. What the face reflects before light enters is in no figure.",
       body + notes_html(report)});
}

}  // namespace opaline
