// SPDX-License-Identifier: GPL-3.0-or-later
// `opaline profile`: figures, files, answers to mistakes.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "../benchmark/page_data.h"
#include "opaline/enumerations.h"
#include "run_program.h"
#include "support/read_csv.h"
#include "transport/fresnel.h"

namespace opaline {
namespace {

nlohmann::json totals_of(const std::vector<std::string>& more) {
  std::vector<std::string> line{"profile", "--json"};
  line.insert(line.end(), more.begin(), more.end());
  const Outcome outcome = run_program(line);
  EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_EQ(events_of(outcome.out).size(), 1u) << outcome.out;
  return event_of(events_of(outcome.out), "profile");
}

std::vector<std::string> cells_of(const CsvTable& table, const std::string& name) {
  const auto at = std::size_t(std::ranges::find(table.names, name) - table.names.begin());
  EXPECT_LT(at, table.names.size()) << name;
  std::vector<std::string> cells;
  for (const auto& row : table.rows) cells.push_back(row.at(at));
  return cells;
}

// Claim: a medium given by its coefficients has the reflectance of the published tables, per entered flux, and stands
// beside every model there is. Source: albedo .9, eta 1.3, .2857857 of a beam along the normal and .2883414 of diffuse
// light, per incident flux (tests/volume/test_half_space.cpp). Tolerance: five standard errors. Fails if: the two ways
// of entry are mixed up, or g stretches sigma_s twice (sigma_s' would be .09).
TEST(CliProfile, TotalsOfGivenCoefficients) {
  const nlohmann::json event =
      totals_of({R"({"sigma_a": 0.1, "sigma_s_prime": 0.9, "eta": 1.3})", "--walks", "50000"});
  const nlohmann::json& back = event["channels"]["all"]["back"];
  const auto expect = [&](const char* row, double truth) {
    EXPECT_NEAR(back[row]["share"].get<double>(), truth, 5 * back[row]["error"].get<double>()) << row;
    EXPECT_LT(back[row]["error"].get<double>(), 1e-3) << row;
  };
  expect("walks_normal", .2857857 / fresnel_transmittance(1., 1.3));
  expect("walks_diffuse", .2883414 / (1 - average_reflectance_outside(1.3)));
  for (const std::string_view model : kProfileNames)
    EXPECT_TRUE(back[std::string(model)]["share"].is_number()) << model;
  EXPECT_FALSE(event["channels"]["all"].contains("through"));
}

// Claim: --g keeps the reduced scattering, and a medium's own g is walked with. Source: similarity; Jensen et al. 2001.
// By hand: sigma_s 9 with g .9 is sigma_s' .9. Fails if: g is taken into sigma_s twice, or dropped.
TEST(CliProfile, ScatteringWithDirection) {
  const nlohmann::json given =
      totals_of({R"({"sigma_a": 0.1, "sigma_s": 9, "g": 0.9, "eta": 1.3})", "--walks", "20000"});
  const nlohmann::json option =
      totals_of({R"({"sigma_a": 0.1, "sigma_s_prime": 0.9, "eta": 1.3})", "--g", "0.9", "--walks", "20000"});
  EXPECT_EQ(given["g"], .9);
  EXPECT_EQ(option["g"], .9);
  const auto share = [](const nlohmann::json& event, const char* row) {
    return event["channels"]["all"]["back"][row]["share"].get<double>();
  };
  EXPECT_NEAR(share(given, "walks_diffuse"), share(option, "walks_diffuse"), .01);
  EXPECT_NEAR(share(given, "dipole"), share(option, "dipole"), 1e-9);
}

// Claim: the folder holds a page with the data of each channel and no address, and the tables; figures in the tables are
// those printed and those of the page; a second run with another number of threads writes the same
// figures. Source: the help of profile. Fails if: the page needs a network, a slab has no far face, or a seed depends
// on the thread.
TEST(CliProfile, Report) {
  const ScratchFolder folder;
  const auto run = [&](const std::string& name, const std::string& threads) {
    const Outcome outcome = run_program({"profile", "skin1", "--thickness", "2mm", "--walks", "2000", "-o",
                                         folder.file(name), "--threads", threads});
    EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
    return outcome;
  };
  const Outcome outcome = run("one", "1");
  run("three", "3");
  for (const char* file : {"profile.csv", "totals.csv", "angles.csv"}) {
    const CsvTable one = parse_csv(bytes_of(folder.file("one/" + std::string(file))), file);
    EXPECT_EQ(one.rows, parse_csv(bytes_of(folder.file("three/" + std::string(file))), file).rows) << file;
    EXPECT_GT(one.rows.size(), 10u) << file;
  }
  const std::string page = bytes_of(folder.file("one/index.html"));
  const Json data = page_data(page);
  ASSERT_EQ(data.at("channels").size(), 3u);
  EXPECT_EQ(data.at("channels")[2].at("name"), "B");
  EXPECT_GT(data.at("channels")[0].at("classical").size(), 50u);
  EXPECT_EQ(data.at("models").size(), kProfileNames.size());
  EXPECT_EQ(data.at("is_slab"), true);
  const std::string shown = page_without_scripts(page);
  for (const char* part : {"http://", "https://", "nan", "{{"}) EXPECT_FALSE(contains(shown, part)) << part;
  const CsvTable totals = parse_csv(bytes_of(folder.file("one/totals.csv")), "totals.csv");
  EXPECT_EQ(totals.rows.size(), 3 * 2 * (2 + kProfileNames.size()));
  EXPECT_EQ(data.at("totals").size(), totals.rows.size());
  EXPECT_EQ(data.at("totals")[0].at("share"), std::stod(cells_of(totals, "share")[0]));
  const std::string first = fmt::format("{:.4f} +- ", std::stod(cells_of(totals, "share")[0]));
  const std::string row =
      outcome.out.substr(std::min(outcome.out.find("walks, diffuse "), outcome.out.size()));
  EXPECT_TRUE(contains(row.substr(0, row.find(" +- ") + 4), " " + first)) << first << " in " << outcome.out;
}

// Claim: a scene's layered medium is walked as a stack, and its wavelengths are the channels. Source: adding-doubling of skin:
// .24525781 in diffuse light with 3 mm of fat. Tolerance: five standard errors; diffusion along the normal within 5 %. Fails if: the
// equivalent medium is walked, or the last layer is as thick as the whole slab.
TEST(CliProfile, MediaOfScenes) {
  const ScratchFolder folder;
  put_bytes(folder.file("a.json"), R"({"media": {
      "epidermis": {"sigma_a": 0.8, "sigma_s_prime": 4, "specular_ior": 1.4}, "dermis": {"sigma_a": 0.2, "sigma_s_prime": 2},
      "fat": {"sigma_a": 0.01, "sigma_s_prime": 1.2}, "blood": {"sigma_a": {"nm": [400, 700], "values": [2, 1]}, "sigma_s_prime": 1},
      "skin": {"layers": [{"medium": "epidermis", "thickness": 0.1}, {"medium": "dermis", "thickness": 2}, {"medium": "fat"}]}},
    "shapes": [{"sphere": {"radius": 9}, "medium": "skin"}], "lights": []})");
  const std::string scene = folder.file("a.json");
  const nlohmann::json event =
      totals_of({"skin", "--scene", scene, "--thickness", "5.1mm", "--walks", "50000"});
  const nlohmann::json& back = event["channels"]["all"]["back"];
  EXPECT_NEAR(back["walks_diffuse"]["share"].get<double>(), .24525781,
              5 * back["walks_diffuse"]["error"].get<double>());
  EXPECT_NEAR(back["layers_normal"]["share"].get<double>() / back["walks_normal"]["share"].get<double>(), 1,
              .05);
  const nlohmann::json blood = totals_of({"blood", "--scene", scene, "--walks", "5000"});
  EXPECT_GT(blood["channels"]["627 nm"]["back"]["walks_diffuse"]["share"],
            blood["channels"]["443 nm"]["back"]["walks_diffuse"]["share"]);
  EXPECT_EQ(
      run_program({"profile", "skin", "--scene", scene, "--thickness", "1mm", "--walks", "10"}).exit_code, 2);
  const Outcome unknown = run_program({"profile", "bone", "--scene", scene});
  EXPECT_EQ(unknown.exit_code, 2);
  EXPECT_TRUE(contains(unknown.err, "has no medium 'bone'")) << unknown.err;
}

// Claim: R_d by rings is the share of a ring over its area, for walks and models alike: both add up to what leaves
// within the last ring. Source: profile_page.h. Tolerance: eight digits as written. Fails if: a model's value at the
// middle of a ring stands for its mean, or an area is a radius.
TEST(CliProfile, RingsAddUp) {
  const ScratchFolder folder;
  const Outcome outcome = run_program(
      {"profile", R"({"sigma_a": 0.1, "sigma_s_prime": 2})", "--walks", "2000", "-o", folder.file("out")});
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  const CsvTable rings = parse_csv(bytes_of(folder.file("out/profile.csv")), "profile.csv");
  const auto low = cells_of(rings, "r_low"), high = cells_of(rings, "r_high");
  for (const std::string by :
       {"diffuse", "normal", "dipole", "normalized_diffusion", "better_dipole", "tabulated"}) {
    const auto profile = cells_of(rings, by + "_profile"), within = cells_of(rings, by + "_within");
    double sum = 0;
    for (std::size_t i = 0; i < rings.rows.size(); ++i)
      sum +=
          std::stod(profile[i]) * M_PI * (std::pow(std::stod(high[i]), 2) - std::pow(std::stod(low[i]), 2));
    EXPECT_NEAR(sum, std::stod(within.back()), 1e-6) << by;
  }
}

// Claim: mistakes are named in one line, with what was expected or the nearest name, before any work: exit 2, or 3
// where a folder cannot be made; nothing is written. Source: commands.h. Fails if: a check is missing.
TEST(CliProfile, Mistakes) {
  const ScratchFolder folder;
  put_bytes(folder.file("file"), "");
  const struct {
    std::vector<std::string> arguments;
    int exit_code;
    std::string named;
  } cases[] = {
      {{}, 2, "MEDIUM"},
      {{"marbel"}, 2, "did you mean 'marble'"},
      {{"gold"}, 2, "one of apple, "},
      {{R"({"sigma_a": 0.1, "sigma_s": -1})"}, 2, "MEDIUM:1:29: 'medium.sigma_s' is out of range"},
      {{R"({"sigma_a": 0.1, "sigma_t": 1})"}, 2, "unknown key 'sigma_t'"},
      {{R"({"sigma_a": 0.1)"}, 2, "MEDIUM:1:16: broken JSON"},
      {{R"({"subsurface_color": 0.5, "subsurface_radius": 1})"}, 2, "sigma_a and sigma_s_prime"},
      {{"marble", "--eta", "0"}, 2, "'--eta'"},
      {{"marble", "--g", "1"}, 2, "'--g'"},
      {{"marble", "--thickness", "0"}, 2, "--thickness: expected a length such as 2mm"},
      {{"marble", "--thickness", "2in"}, 2, "um, 0.5cm or 1m, got 2in"},
      {{"marble", "--walks", "0"}, 2, "--walks: expected a whole number from 1"},
      {{"marble", "--walk", "3"}, 2, "did you mean '--walks'"},
      {{"marble", "-o", folder.file("file/out")}, 3, "file/out"},
  };
  for (const auto& c : cases) {
    std::vector<std::string> line{"profile"};
    line.insert(line.end(), c.arguments.begin(), c.arguments.end());
    const Outcome outcome = run_program(line);
    EXPECT_EQ(outcome.exit_code, c.exit_code) << outcome.err;
    EXPECT_TRUE(contains(outcome.err, c.named)) << "no \"" << c.named << "\" in: " << outcome.err;
    EXPECT_EQ(std::ranges::count(outcome.err, '\n'), 1) << outcome.err;
    EXPECT_TRUE(outcome.out.empty()) << outcome.out;
  }
  EXPECT_EQ(folder.entries(), 1u);
}

// Claim: Ctrl-C ends the walks with exit code 130 and leaves the old report; another's page is not written over. Source:
// the help of profile. Fails if: the walks do not look at the monitor, or the page is opened for writing at the start.
TEST(CliProfile, InterruptLeavesTheOldReport) {
  const ScratchFolder folder;
  put_bytes(folder.file("index.html"), "mine");
  const Outcome refused = run_program({"profile", "spectralon", "-o", folder.path.string()});
  EXPECT_EQ(refused.exit_code, 2);
  EXPECT_TRUE(contains(refused.err, "is not a page of opaline")) << refused.err;
  put_bytes(folder.file("index.html"), "old, of opaline");
  Child child({"profile", "spectralon", "--walks", "100000000", "-o", folder.path.string()});
  std::this_thread::sleep_for(std::chrono::milliseconds(500));
  child.send(SIGINT);
  EXPECT_EQ(child.wait(60).exit_code, 130);
  EXPECT_EQ(bytes_of(folder.file("index.html")), "old, of opaline");
  EXPECT_EQ(folder.entries(), 1u);
}

}  // namespace
}  // namespace opaline
