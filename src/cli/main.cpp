// SPDX-License-Identifier: GPL-3.0-or-later
// The only place where exceptions are caught and become exit codes.
#include <cstdio>
#include <exception>

#include "cli/commands.h"
#include "cli/process_start.h"
#include "opaline/error.h"

namespace {

int run(const opaline::Command& command) {
  if (const auto* show = std::get_if<opaline::ShowText>(&command)) opaline::write_line(stdout, show->text);
  if (const auto* render = std::get_if<opaline::RenderArguments>(&command)) opaline::render_command(*render);
  if (const auto* precompute = std::get_if<opaline::PrecomputeArguments>(&command))
    opaline::precompute_command(*precompute);
  if (const auto* info = std::get_if<opaline::InfoArguments>(&command)) opaline::info_command(*info);
  if (const auto* import = std::get_if<opaline::ImportArguments>(&command)) opaline::import_command(*import);
  if (const auto* compare = std::get_if<opaline::CompareArguments>(&command))
    return opaline::compare_command(*compare);
  if (const auto* bench = std::get_if<opaline::BenchArguments>(&command))
    return opaline::bench_command(*bench);
  if (const auto* profile = std::get_if<opaline::ProfileArguments>(&command))
    opaline::profile_command(*profile);
  if (const auto* view = std::get_if<opaline::ViewArguments>(&command)) opaline::view_command(*view);
  if (const auto* cache = std::get_if<opaline::CacheArguments>(&command))
    return opaline::cache_command(*cache);
  return 0;
}

opaline::Log log_of(const opaline::Command& command) {
  return std::visit(
      [](const auto& arguments) {
        if constexpr (requires { arguments.log; })
          return arguments.log;
        else
          return opaline::Log{};
      },
      command);
}

/// A log, of which nobody wanted to know: the program was started without standard output, and what it makes is in files or
/// on a page.
bool is_unwanted_log(const opaline::Command& command) {
  const bool is_log = std::holds_alternative<opaline::RenderArguments>(command) ||
                      std::holds_alternative<opaline::PrecomputeArguments>(command) ||
                      std::holds_alternative<opaline::ViewArguments>(command);
  return is_log && opaline::was_started_without_output();
}

}  // namespace

int main(int argc, char** argv) {
  opaline::prepare_process();
  opaline::Log log;
  if (opaline::asks_for_json(argc, argv))
    log.format = opaline::LogFormat::json;  // also for errors in the options
  try {
    const opaline::Command command = opaline::parse_arguments(argc, argv);
    log = log_of(command);
    const int code = run(command);
    if (std::ferror(stdout) != 0 && !is_unwanted_log(command))
      throw opaline::run_failed("stdout", "cannot write");
    return code;
  } catch (const opaline::Error& failure) {
    return opaline::print_failure(log, opaline::placed_at_option(failure, argc, argv));
  } catch (const std::exception& failure) {
    return opaline::print_failure(log, failure);
  }
}
