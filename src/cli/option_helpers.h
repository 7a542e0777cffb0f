// SPDX-License-Identifier: GPL-3.0-or-later
// Options of several commands.
#pragma once

#include <CLI/CLI.hpp>
#include <cstdint>
#include <string>
#include <vector>

#include "asset_files/asset_file.h"
#include "cli/option_values.h"

namespace opaline {

/// CLI11 would read everything after `-o a.exr` as further outputs: takes one value per option, repeatable.
template <class T>
CLI::Option* add_repeatable(CLI::App& app, const std::string& names, std::vector<T>& values,
                            const std::string& help) {
  return app.add_option(names, values, help)->allow_extra_args(false);
}

inline CLI::Option* add_size(CLI::App& app, const std::string& name, std::uint64_t& bytes,
                             const std::string& help) {
  return app.add_option(name, bytes, help)->transform(bytes_of())->type_name("SIZE");
}

/// Option of commands reading assets.
inline void add_allow_outside(CLI::App& app) {
  app.add_flag_callback(
      "--allow-outside", allow_files_outside_assets,
      "allow assets to refer to files outside their own folder: buffers, images, libraries");
}

inline void add_threads(CLI::App& app, int& threads, const std::string& help) {
  app.add_option("--threads", threads, help)->transform(whole_number(kThreads))->type_name("N");
}

}  // namespace opaline
