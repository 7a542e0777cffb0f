// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include <numbers>

#include "benchmark/profile_page.h"
#include "opaline/enumerations.h"

namespace opaline {
namespace {

std::string number(double value) {
  return fmt::format("{:.8g}", value);
}

void add_walked(std::vector<std::string>& row, const WalkedValue& value) {
  row.push_back(number(value.value));
  row.push_back(number(value.error));
}

void add_columns(CsvTable& table, const std::vector<std::string>& names, const std::string& unit) {
  for (const std::string& name : names) {
    table.names.push_back(name);
    table.units.push_back(unit);
  }
}

struct Face {
  const char* name;
  WalkedFace SlabWalks::*walked;
  double height;
};

std::vector<Face> faces_of(const ProfileReport& report) {
  std::vector<Face> faces{{"back", &SlabWalks::back, 0}};
  if (report.is_slab()) faces.push_back({"through", &SlabWalks::through, report.request.thickness});
  return faces;
}

}  // namespace

CsvTable totals_table(const ProfileReport& report) {
  CsvTable table{report.notes, {}, {}, {}};
  add_columns(table, {"channel", "by", "face"}, "");
  add_columns(table, {"share", "share_error", "uncollided", "uncollided_error"}, "of transmitted flux");
  add_columns(table, {"shape_difference"}, "share");
  for (const ProfiledChannel& channel : report.channels)
    for (const Face& face : faces_of(report)) {
      for (const SlabWalks* walks : {&channel.diffuse, &channel.normal}) {
        const WalkedFace& walked = walks->*face.walked;
        table.rows.push_back(
            {channel.name, walks == &channel.diffuse ? "walks, diffuse" : "walks, normal", face.name});
        add_walked(table.rows.back(), walked.total);
        add_walked(table.rows.back(), walked.uncollided);
        table.rows.back().emplace_back();
      }
      for (std::size_t kind = 0; kind < channel.models.size(); ++kind) {
        const ModelFace model{&channel.models[kind], face.height};
        table.rows.push_back({channel.name, std::string(kProfileNames[kind]), face.name,
                              number(model.total()), "", "", "",
                              number(shape_difference(model, channel.diffuse.*face.walked))});
      }
    }
  return table;
}

CsvTable rings_table(const ProfileReport& report) {
  CsvTable table{report.notes, {}, {}, {}};
  add_columns(table, {"channel", "face"}, "");
  add_columns(table, {"r_low", "r_high"}, "mm");
  for (const std::string entry : {"diffuse", "normal"}) {
    add_columns(table, {entry + "_profile", entry + "_profile_error"}, "1/mm^2");
    add_columns(table, {entry + "_within", entry + "_within_error"}, "of transmitted flux");
  }
  for (const std::string_view model : kProfileNames) {
    add_columns(table, {std::string(model) + "_profile"}, "1/mm^2");
    add_columns(table, {std::string(model) + "_within"}, "of transmitted flux");
  }
  for (const ProfiledChannel& channel : report.channels)
    for (const Face& face : faces_of(report))
      for (std::size_t i = 0; i < (channel.diffuse.*face.walked).rings.size(); ++i) {
        const WalkedRing& diffuse = (channel.diffuse.*face.walked).rings[i];
        std::vector<std::string>& row = table.rows.emplace_back();
        row = {channel.name, face.name, number(diffuse.low), number(diffuse.high)};
        for (const WalkedRing& ring : {diffuse, (channel.normal.*face.walked).rings[i]}) {
          add_walked(row, ring.profile);
          add_walked(row, ring.within);
        }
        const double area = std::numbers::pi * (diffuse.high - diffuse.low) * (diffuse.high + diffuse.low);
        for (const ChannelProfile& profile : channel.models) {
          const ModelFace model{&profile, face.height};
          row.push_back(number((model.within(diffuse.high) - model.within(diffuse.low)) / area));
          row.push_back(number(model.within(diffuse.high)));
        }
      }
  return table;
}

CsvTable angles_table(const ProfileReport& report) {
  CsvTable table{report.notes, {}, {}, {}};
  add_columns(table, {"channel", "cosine_low", "cosine_high"}, "");
  add_columns(table, {"albedo_by_entry", "albedo_by_entry_error"}, "of flux transmitted there");
  add_columns(table, {"exit_diffuse", "exit_diffuse_error", "exit_normal", "exit_normal_error"},
              "of Lambert");
  for (const ProfiledChannel& channel : report.channels)
    for (std::size_t i = 0; i < channel.diffuse.albedo_by_entry.size(); ++i) {
      const WalkedCosine& entry = channel.diffuse.albedo_by_entry[i];
      std::vector<std::string>& row = table.rows.emplace_back();
      row = {channel.name, number(entry.low), number(entry.high)};
      add_walked(row, entry.value);
      add_walked(row, channel.diffuse.back.angular_exit[i].value);
      add_walked(row, channel.normal.back.angular_exit[i].value);
    }
  return table;
}

}  // namespace opaline
