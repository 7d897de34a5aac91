// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "cli/hints.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <filesystem>
#include <string_view>
#include <utility>
#include <vector>

#include "kinemark/core/nearest_name.h"
#include "kinemark/core/text.h"

namespace kinemark::cli {
namespace {

/// What users of OpenSim, Nexus, QTM and Visual3D call what our commands do.
constexpr std::array<std::pair<std::string_view, std::string_view>, 51> kHabits = {{
    {"inversekinematics", "ik"},
    {"inverse-kinematics", "ik"},
    {"inverse-dynamics", "dynamics --torques"},
    {"inversedynamics", "dynamics --torques"},
    {"id", "dynamics --torques"},
    {"run-tool", "ik --setup"},
    {"opensim-cmd", "ik --setup"},
    {"solve", "ik"},
    {"kinematics", "ik"},
    {"smooth", "clean"},
    {"filter", "clean"},
    {"fill", "clean"},
    {"gapfill", "clean"},
    {"gap-fill", "clean"},
    {"gaps", "clean"},
    {"interpolate", "clean"},
    {"label", "clean"},
    {"derivatives", "clean --derivatives"},
    {"scaletool", "scale"},
    {"scaling", "scale"},
    {"functional", "joints"},
    {"score", "joints --method score"},
    {"sara", "joints --method sara"},
    {"joint-centres", "joints"},
    {"joint-centers", "joints"},
    {"export", "convert"},
    {"import", "convert"},
    {"c3d2trc", "convert"},
    {"c3dtotrc", "convert"},
    {"show", "info"},
    {"ls", "info"},
    {"cat", "info"},
    {"print", "info"},
    {"header", "info"},
    {"check", "validate"},
    {"lint", "validate"},
    {"verify", "validate"},
    {"repair", "recover"},
    {"triangulate", "reconstruct"},
    {"view", "report"},
    {"plot", "report"},
    {"browse", "serve"},
    {"workbench", "serve"},
    {"live", "track"},
    {"measures", "measure"},
    {"events", "gait"},
    {"steps", "gait"},
    {"plates", "gait"},
    {"angles", "segments --definition pig"},
    {"pig", "segments --definition pig"},
    {"bodykinematics", "dynamics"},
}};

/// Options that other words say by now.
constexpr std::array<std::pair<std::string_view, std::string_view>, 3> kFormerOptions = {{
    {"keep-defects", "--doubtful keep"},
    {"outliers", "--doubtful keep or --doubtful drop"},
    {"reject", "--doubtful drop"},
}};

bool is_option(std::string_view word) { return word.size() > 1 && word.front() == '-'; }

std::string lower(std::string word) {
  std::ranges::transform(word, word.begin(),
                         [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  std::ranges::replace(word, '_', '-');
  return word;
}

std::vector<std::string> command_names(const CLI::App& app) {
  std::vector<std::string> names;
  for (const CLI::App* command : app.get_subcommands([](const CLI::App*) { return true; }))
    names.push_back(command->get_name());
  return names;
}

/// Long names of the options that may stand where `app` was reached, without dashes.
std::vector<std::string> option_names(const CLI::App& app) {
  std::vector<std::string> names;
  for (const CLI::App* at = &app; at != nullptr; at = at->get_parent())
    for (const CLI::Option* option : at->get_options())
      for (const auto& name : option->get_lnames()) names.push_back(name);
  return names;
}

std::string did_you_mean(std::vector<std::string> names, std::string_view before) {
  if (names.empty()) return {};
  for (auto& name : names) name = fmt::format("{}{}", before, name);
  const std::string last = names.back();
  names.pop_back();
  return fmt::format("; did you mean {}?", names.empty() ? last : join(names) + " or " + last);
}

std::string unknown_option(const CLI::App& at, const std::string& word) {
  const std::string name =
      word.substr(word.find_first_not_of('-'), word.find('=') - word.find_first_not_of('-'));
  const auto former =
      std::ranges::find(kFormerOptions, name, &std::pair<std::string_view, std::string_view>::first);
  const auto here = option_names(at);
  if (former != kFormerOptions.end() && std::ranges::find(here, "doubtful") != here.end())
    return fmt::format("unknown option '{}'; {} does that", word, former->second);
  return fmt::format("unknown option '{}'{}", word,
                     did_you_mean(nearest_names(name, option_names(at)), "--"));
}

/// The word with one dash that names a long option, or an empty one.
std::string one_dash(const CLI::App& at, std::span<const std::string> words) {
  const auto names = option_names(at);
  const auto found = std::ranges::find_if(words, [&](const std::string& word) {
    return word.size() > 3 && word[0] == '-' && word[1] != '-' &&
           std::ranges::find(names, word.substr(1, word.find('=') - 1)) != names.end();
  });
  return found == words.end() ? std::string() : *found;
}

}  // namespace

const CLI::App& reached(const CLI::App& app) {
  const CLI::App* at = &app;
  while (!at->get_subcommands().empty()) at = at->get_subcommands().front();
  return *at;
}

std::string explain_usage(const CLI::App& app, const CLI::ParseError& error,
                          std::span<const std::string> words) {
  const CLI::App& at = reached(app);
  const bool needs_command = at.get_require_subcommand_min() > 0;
  if (const auto word = one_dash(at, words); !word.empty())
    return fmt::format("'{}' has one dash; write '-{}'", word, word);
  const auto left = app.remaining(true);
  const auto command = std::ranges::find_if_not(left, is_option);
  if (needs_command && command != left.end()) return unknown_command(at, *command);
  const auto option = std::ranges::find_if(left, is_option);
  if (option != left.end()) return unknown_option(at, *option);
  if (needs_command)
    return at.get_parent() == nullptr ? "no command" : fmt::format("'{}' of what?", at.get_name());
  if (!left.empty()) return fmt::format("'{}' is one argument too many", left.front());
  return error.what();
}

std::string unknown_command(const CLI::App& at, const std::string& word) {
  const bool outermost = at.get_parent() == nullptr;
  const std::string wrong = outermost ? fmt::format("there is no command '{}'", word)
                                      : fmt::format("'{}' has no '{}'", at.get_name(), word);
  const auto habit =
      std::ranges::find(kHabits, lower(word), &std::pair<std::string_view, std::string_view>::first);
  if (outermost && habit != kHabits.end())
    return fmt::format("{}; 'kinemark {}' does that", wrong, habit->second);
  std::error_code ignored;
  if (outermost && std::filesystem::exists(word, ignored))
    return fmt::format("{}; 'kinemark info {}' tells what that file holds", wrong, word);
  return wrong + did_you_mean(nearest_names(word, command_names(at)), "");
}

}  // namespace kinemark::cli
