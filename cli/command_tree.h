// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
//
// All commands with their options as plain text, for what is made from it: completion of shells and manual
// pages.
#pragma once

#include <CLI/CLI.hpp>
#include <string>
#include <vector>

namespace kinemark::cli {

/// The group of options that a command takes and does not show: another command explains them.
inline constexpr const char* kExplainedElsewhere = "Explained elsewhere";

/// These options hidden from the help that CLI11 prints, in all commands. To be called when it is printed:
/// what is hidden before has no name in its messages.
void hide_for_help(CLI::App& app);

struct OptionText {
  std::vector<std::string> names;  ///< as typed: "-m", "--model"
  std::string value;               ///< what it takes, "FILE"; empty: nothing
  std::string group;
  std::string description;
};

/// A command; `words` are what is typed to reach it, none for the program itself.
struct CommandText {
  std::vector<std::string> words;
  std::string description;
  std::string footer;
  std::string usage;                  ///< the positional arguments as the help shows them
  std::vector<OptionText> arguments;  ///< positional ones
  std::vector<OptionText> options;    ///< its own, then those that every command takes
  std::vector<CommandText> commands;  ///< below it
};

[[nodiscard]] CommandText command_tree(const CLI::App& app);

/// The tree as a list, each command after the one that it is of.
[[nodiscard]] std::vector<const CommandText*> all_commands(const CommandText& top);

}  // namespace kinemark::cli
