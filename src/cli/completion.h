// SPDX-License-Identifier: GPL-3.0-or-later
// Completion of the command line in a shell.
#pragma once

#include <CLI/CLI.hpp>
#include <string>

namespace opaline {

/// Script for bash: commands, the options of each, and the values of options that are choices.
std::string bash_completion(const CLI::App& app);

}  // namespace opaline
