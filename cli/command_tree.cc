// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "cli/command_tree.h"

#include <fmt/format.h>

namespace kinemark::cli {
namespace {

OptionText text_of(const CLI::Option& option) {
  OptionText text{.group = option.get_group(), .description = option.get_description()};
  for (const auto& name : option.get_snames()) text.names.push_back("-" + name);
  for (const auto& name : option.get_lnames()) text.names.push_back("--" + name);
  if (text.names.empty()) text.names.push_back(option.get_name());
  if (option.get_items_expected_max() > 0) text.value = option.get_type_name();
  return text;
}

void add_options(const CLI::App& app, CommandText& text) {
  for (const CLI::Option* option : app.get_options()) {
    if (option->get_group().empty() || option->get_group() == kExplainedElsewhere) continue;
    if (option->get_positional()) {
      const bool needed = option->get_required();
      text.usage += fmt::format("{}{}{}{}", text.usage.empty() ? "" : " ", needed ? "" : "[",
                                option->get_name(), needed ? "" : "]");
      text.arguments.push_back(text_of(*option));
    } else {
      text.options.push_back(text_of(*option));
    }
  }
}

CommandText text_of(const CLI::App& app, std::vector<std::string> words) {
  CommandText text{
      .words = std::move(words), .description = app.get_description(), .footer = app.get_footer()};
  for (const CLI::App* at = &app; at != nullptr; at = at->get_parent())
    if (at == &app || at->get_parent() == nullptr) add_options(*at, text);
  for (const CLI::App* command : app.get_subcommands([](const CLI::App*) { return true; })) {
    auto below = text.words;
    below.push_back(command->get_name());
    text.commands.push_back(text_of(*command, std::move(below)));
  }
  return text;
}

void append(const CommandText& text, std::vector<const CommandText*>& list) {
  list.push_back(&text);
  for (const auto& command : text.commands) append(command, list);
}

}  // namespace

void hide_for_help(CLI::App& app) {
  for (CLI::Option* option : app.get_options([](const CLI::Option*) { return true; }))
    if (option->get_group() == kExplainedElsewhere) option->group("");
  for (CLI::App* command : app.get_subcommands([](const CLI::App*) { return true; })) hide_for_help(*command);
}

CommandText command_tree(const CLI::App& app) { return text_of(app, {}); }

std::vector<const CommandText*> all_commands(const CommandText& top) {
  std::vector<const CommandText*> list;
  append(top, list);
  return list;
}

}  // namespace kinemark::cli
