// SPDX-License-Identifier: GPL-3.0-or-later
// The options of each command.
#pragma once

#include <CLI/CLI.hpp>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "cli/arguments.h"

namespace opaline {

/// Raw texts of options before conversion.
struct Options {
  std::string method, evaluator, resolution, crop, environment, view;
  std::string until_error, target_error;
  std::optional<std::uint64_t> entry_samples;
  std::optional<std::uint64_t> spp;
  std::optional<std::uint64_t> seed;
  std::optional<double> exposure, time_budget;
  std::vector<std::string> sets, media;
  std::optional<double> size;  // mm
  std::string log = "text";
  std::string fail_above;
  bool json = false, denoise = false;
  std::string reference_error;
  std::vector<std::string> rungs;
  std::optional<std::string> frames;
  int turn_frames = 48;
  std::string layers, part;
};

/// Option for a key of a scene: "film.crop" -> "--crop"; empty if there is none.
std::string_view option_of_key(std::string_view key);
/// Key of an option: "--crop" -> "film.crop"; empty if there is none.
std::string_view key_of_option(std::string_view option);

/// --medium and --size.
void add_asset_options(CLI::App& app, Options& options);
void add_common_options(CLI::App& app, std::string& scene, Options& options);
void add_picture_options(CLI::App& app, Options& options);
void add_render_options(CLI::App& app, RenderArguments& render, Options& options);
void add_turntable_options(CLI::App& app, RenderArguments& render, Options& options);
void add_merge_options(CLI::App& app, MergeArguments& merge, Options& options);
void add_precompute_options(CLI::App& app, PrecomputeArguments& precompute, Options& options);
void add_import_options(CLI::App& app, ImportArguments& import, Options& options);
void add_view_options(CLI::App& app, ViewArguments& view, Options& options);
void add_compare_options(CLI::App& app, CompareArguments& compare, Options& options);
void add_bench_options(CLI::App& app, BenchArguments& bench, Options& options);
void add_profile_options(CLI::App& app, ProfileArguments& profile, Options& options);
void add_cache_commands(CLI::App& app, CacheArguments& cache, Options& options);

/// Completion script for bash: commands, their options, and the values of choices.
std::string bash_completion(const CLI::App& app);

}  // namespace opaline
