// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <string_view>
#include <vector>

#include "cli/command_options.h"
#include "input/schema.h"

namespace opaline {
namespace {

std::vector<const CLI::App*> shown_commands(const CLI::App& app) {
  return app.get_subcommands([](const CLI::App* command) { return !command->get_group().empty(); });
}

/// Words of a command: its options, its own commands and their options.
std::vector<std::string> words_of(const CLI::App& command) {
  std::vector<std::string> words;
  for (const CLI::Option* option : command.get_options())
    for (const std::string& name : option->get_lnames()) words.push_back("--" + name);
  for (const CLI::App* below : shown_commands(command)) {
    words.push_back(below->get_name());
    for (const std::string& word : words_of(*below)) words.push_back(word);
  }
  return words;
}

std::string branch(const std::string& pattern, const auto& words) {
  return fmt::format("    {}) words=\"{}\" ;;\n", pattern, fmt::join(words, " "));
}

}  // namespace

std::string bash_completion(const CLI::App& app) {
  std::string commands, values;
  std::vector<std::string> first{"--help", "--version", "help"};
  for (const CLI::App* command : shown_commands(app)) {
    first.push_back(command->get_name());
    commands += branch(command->get_name(), words_of(*command));
  }
  for (const KeyInfo& info : schema())
    if (const std::string_view option = option_of_key(fmt::format("{}.{}", info.section, info.key));
        !option.empty() && !info.choices.empty())
      values += branch(std::string(option), info.choices);
  return fmt::format(R"(# bash completion of opaline, written by `opaline completion`
_opaline() {{
  local words=
  case "${{COMP_WORDS[1]}}" in
{}  esac
  [[ $2 == -* || $COMP_CWORD == 2 && ${{COMP_WORDS[1]}} == cache ]] || words=
  [[ $COMP_CWORD == 1 ]] && words="{}"
  case "$3" in
{}  esac
  COMPREPLY=($(compgen -W "$words" -- "$2"))
}}
complete -o default -F _opaline opaline)",
                     commands, fmt::join(first, " "), values);
}

}  // namespace opaline
