// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
//
// Scripts that let a shell complete commands and options; files complete as the shell does it by itself.
#include <fmt/format.h>

#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "cli/command.h"
#include "cli/command_tree.h"
#include "cli/console.h"
#include "kinemark/core/text.h"

namespace kinemark::cli {
namespace {

/// Text between single quotes of a POSIX shell.
std::string shell_quoted(std::string_view text) {
  std::string out = "'";
  for (const char c : text) {
    if (c == '\'')
      out += "'\\''";
    else
      out += c == '\n' ? ' ' : c;
  }
  return out + "'";
}

/// The first sentence or line: what fits beside a name.
std::string short_description(std::string_view text) {
  text = text.substr(0, text.find('\n'));
  const auto end = text.find(". ");
  if (end != std::string_view::npos) text = text.substr(0, end);
  return std::string(text);
}

std::vector<std::string> names_below(const CommandText& command) {
  std::vector<std::string> names;
  for (const auto& below : command.commands) names.push_back(below.words.back());
  return names;
}

std::vector<std::string> names_of_options(const CommandText& command) {
  std::vector<std::string> names;
  for (const auto& option : command.options)
    names.insert(names.end(), option.names.begin(), option.names.end());
  return names;
}

/// "simulate rig" for what is reached by both words; the program itself is "".
std::string path_of(const CommandText& command) { return join(command.words, " "); }

/// The lines of a shell's `case` that set `path` as words are met, shared by bash and zsh.
std::string steps(const CommandText& top) {
  std::string out;
  for (const auto* command : all_commands(top)) {
    if (command->words.empty()) continue;
    const std::vector<std::string> above(command->words.begin(), command->words.end() - 1);
    out += fmt::format("      {}) path={} ;;\n", shell_quoted(join(above, " ") + "/" + command->words.back()),
                       shell_quoted(path_of(*command)));
  }
  return out;
}

std::string bash_completion(const CommandText& top) {
  std::string cases;
  for (const auto* command : all_commands(top))
    cases += fmt::format("    {}) commands={} options={} ;;\n", shell_quoted(path_of(*command)),
                         shell_quoted(join(names_below(*command), " ")),
                         shell_quoted(join(names_of_options(*command), " ")));
  return fmt::format(R"(# Completion of kinemark for bash: source it, or put it where bash-completion looks.
_kinemark() {{
  local word path='' commands='' options='' current="${{COMP_WORDS[COMP_CWORD]}}"
  COMPREPLY=()
  for word in "${{COMP_WORDS[@]:1:COMP_CWORD-1}}"; do
    case "$path/$word" in
{}    esac
  done
  case "$path" in
{}  esac
  if [[ $current == -* ]]; then
    COMPREPLY=($(compgen -W "$options" -- "$current"))
  elif [[ -n $commands ]]; then
    COMPREPLY=($(compgen -W "$commands" -- "$current"))
  fi
}}
complete -o default -F _kinemark kinemark
)",
                     steps(top), cases);
}

std::string zsh_completion(const CommandText& top) {
  std::string cases;
  for (const auto* command : all_commands(top)) {
    std::string commands, options;
    for (const auto& below : command->commands)
      commands += " " + shell_quoted(below.words.back() + ":" + short_description(below.description));
    for (const auto& option : command->options)
      for (const auto& name : option.names)
        options += " " + shell_quoted(name + ":" + short_description(option.description));
    cases += fmt::format("    {}) commands=({} ) options=({} ) ;;\n", shell_quoted(path_of(*command)),
                         commands, options);
  }
  return fmt::format(R"(#compdef kinemark
# Completion of kinemark for zsh: put it as _kinemark into a folder of $fpath, or source it after compinit.
_kinemark() {{
  local word path=''
  local -a commands options
  for word in "${{(@)words[2,CURRENT-1]}}"; do
    case "$path/$word" in
{}    esac
  done
  case "$path" in
{}  esac
  if [[ $words[CURRENT] == -* ]]; then
    _describe -o option options
  elif (( $#commands )); then
    _describe command commands || _files
  else
    _files
  fi
}}
if [[ $zsh_eval_context[-1] == loadautofunc ]]; then
  _kinemark "$@"
else
  compdef _kinemark kinemark
fi
)",
                     steps(top), cases);
}

std::string fish_completion(const CommandText& top) {
  std::string out =
      "# Completion of kinemark for fish: put it as kinemark.fish where fish looks for completions.\n";
  for (const auto* command : all_commands(top)) {
    std::string where = command->words.empty() ? "__fish_use_subcommand" : "";
    for (const auto& word : command->words)
      where += fmt::format("{}__fish_seen_subcommand_from {}", where.empty() ? "" : "; and ", word);
    for (const auto& below : command->commands)
      where += command->words.empty()
                   ? ""
                   : fmt::format("; and not __fish_seen_subcommand_from {}", below.words.back());
    for (const auto& below : command->commands)
      out += fmt::format("complete -c kinemark -n {} -f -a {} -d {}\n", shell_quoted(where),
                         below.words.back(), shell_quoted(short_description(below.description)));
    for (const auto& option : command->options) {
      std::string names;
      for (const auto& name : option.names)
        names += name.starts_with("--") ? " -l " + name.substr(2) : " -s " + name.substr(1);
      out +=
          fmt::format("complete -c kinemark -n {}{}{} -d {}\n", shell_quoted(where), names,
                      option.value.empty() ? "" : " -r", shell_quoted(short_description(option.description)));
    }
  }
  return out;
}

}  // namespace

void add_completion(CLI::App& app, const CommonOptions&, Run& run) {
  auto* command =
      app.add_subcommand("completion", "A script with which a shell completes commands and options");
  command->footer(
      "Try it at once: source <(kinemark completion bash). 'cmake --install' puts the scripts where the "
      "shells look.");
  const auto shell = std::make_shared<std::string>();
  command->add_option("SHELL", *shell, "bash, zsh or fish")
      ->required()
      ->check(CLI::IsMember({"bash", "zsh", "fish"}));
  command->callback([&app, shell, &run] {
    run = [&app, shell] {
      const auto top = command_tree(app);
      print_result(*shell == "bash"  ? bash_completion(top)
                   : *shell == "zsh" ? zsh_completion(top)
                                     : fish_completion(top));
      return 0;
    };
  });
}

}  // namespace kinemark::cli
