// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "cli/settings_options.h"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <optional>
#include <string_view>
#include <system_error>
#include <utility>

#include "cli/files_read.h"

#include "cli/hints.h"
#include "kinemark/core/nearest_name.h"
#include "kinemark/core/text.h"
#include "kinemark/io/file.h"
#include "kinemark/pipeline/files/output_check.h"
#include "kinemark/pipeline/files/settings_file.h"

namespace kinemark::cli {
namespace {

constexpr std::string_view kConfig = "--config";
constexpr std::array<std::string_view, 6> kNotInFiles = {"config", "save-config", "reads",
                                                         "force",  "help",        "version"};

bool is_in_files(std::string_view name) { return std::ranges::find(kNotInFiles, name) == kNotInFiles.end(); }

/// The value of --config, taken out of the words; nothing where it is not there.
Result<std::optional<std::string>> take_config(std::vector<std::string>& words) {
  for (auto word = words.begin(); word != words.end() && *word != "--"; ++word) {
    if (word->starts_with(std::string(kConfig) + "=")) {
      std::string file = word->substr(kConfig.size() + 1);
      words.erase(word);
      return file;
    }
    if (*word != kConfig) continue;
    if (word + 1 == words.end()) return fail(Code::usage, "--config needs a file");
    std::string file = *(word + 1);
    words.erase(word, word + 2);
    return file;
  }
  return std::nullopt;
}

/// A command and where the words behind it begin.
struct Place {
  const CLI::App* command;
  std::string name;
  std::size_t after = 0;
};

Place find_command(const CLI::App& app, const std::vector<std::string>& words) {
  Place place{.command = &app, .name = ""};
  for (std::size_t i = 0; i < words.size(); ++i) {
    const auto below =
        place.command->get_subcommands([&](const CLI::App* c) { return c->get_name() == words[i]; });
    if (below.empty()) continue;
    place = {.command = below.front(),
             .name = place.name + (place.name.empty() ? "" : " ") + words[i],
             .after = i + 1};
  }
  return place;
}

std::vector<const CLI::Option*> options_of(const CLI::App& command) {
  std::vector<const CLI::Option*> options;
  for (const CLI::App* at = &command; at != nullptr; at = at->get_parent())
    for (const CLI::Option* option : at->get_options())
      if (!option->get_lnames().empty() && is_in_files(option->get_lnames().front()))
        options.push_back(option);
  return options;
}

bool is_typed(const CLI::Option& option, const std::vector<std::string>& words) {
  return std::ranges::any_of(words, [&](const std::string& word) {
    return std::ranges::any_of(option.get_lnames(),
                               [&](const auto& name) {
                                 return word == "--" + name || word.starts_with("--" + name + "=");
                               }) ||
           std::ranges::any_of(option.get_snames(), [&](const auto& name) {
             return word.starts_with("-" + name) && !word.starts_with("--");
           });
  });
}

Result<std::vector<std::string>> words_of(const pipeline::Setting& setting, const CLI::App& command,
                                          const std::vector<std::string>& typed) {
  const auto options = options_of(command);
  const auto found = std::ranges::find_if(options, [&](const CLI::Option* option) {
    return std::ranges::find(option->get_lnames(), setting.name) != option->get_lnames().end();
  });
  if (found == options.end()) {
    std::vector<std::string> names;
    for (const auto* option : options) names.push_back(option->get_lnames().front());
    const auto near = nearest_names(setting.name, names);
    return fail(Code::bad_input,
                fmt::format("'{}' is no option of it{}", setting.name,
                            near.empty() ? "" : fmt::format("; did you mean {}?", join(near))));
  }
  const bool takes_value = (*found)->get_items_expected_max() > 0;
  if (takes_value == setting.is_switch)
    return fail(Code::bad_input,
                fmt::format("'{}' needs {}", setting.name, takes_value ? "a value" : "true or false"));
  std::vector<std::string> words;
  if (is_typed(**found, typed)) return words;
  if (setting.is_switch && setting.on) words.push_back("--" + setting.name);
  for (const auto& value : setting.values) words.push_back(fmt::format("--{}={}", setting.name, value));
  return words;
}

}  // namespace

Result<WordsGiven> with_settings(const CLI::App& app, std::vector<std::string> words) {
  const auto file = take_config(words);
  if (!file) return std::unexpected(file.error());
  if (!*file) return WordsGiven{.words = std::move(words), .config = {}};
  const Place place = find_command(app, words);
  if (place.name.empty()) return fail(Code::usage, "--config: no command; give it before the options");
  const auto settings = pipeline::read_settings(**file);
  if (!settings) return std::unexpected(settings.error());
  if (!settings->command.empty() && settings->command != place.name)
    return fail(Code::bad_input,
                fmt::format("{}: holds options of '{}', not of '{}'", **file, settings->command, place.name));
  std::vector<std::string> inserted;
  for (const auto& setting : settings->list) {
    const auto more = words_of(setting, *place.command, words);
    if (!more)
      return fail(more.error().code,
                  fmt::format("{}: line {}: {}", **file, setting.line, more.error().message));
    inserted.insert(inserted.end(), more->begin(), more->end());
  }
  words.insert(words.begin() + static_cast<std::ptrdiff_t>(place.after), inserted.begin(), inserted.end());
  return WordsGiven{.words = std::move(words), .config = **file};
}

namespace {

/// The job may read files that others name, which nobody knows yet. They do not end in .toml, but a link may
/// lead to one.
Status check_link(const std::filesystem::path& path) {
  std::error_code absent;
  const bool is_link =
      std::filesystem::is_symlink(path, absent) ||
      (std::filesystem::is_regular_file(path, absent) && std::filesystem::hard_link_count(path, absent) > 1);
  if (!is_link || !std::filesystem::exists(path, absent)) return {};
  const auto there = pipeline::read_settings(path);
  if (there && !there->command.empty()) return {};
  return fail(Code::usage,
              fmt::format("{}: is a link to a file that holds no options of a command; name another file",
                          path.string()));
}

}  // namespace

Status save_settings(const CLI::App& app, const CommonOptions& common) {
  const CLI::App& command = reached(app);
  const std::filesystem::path path = common.save_config;
  if (auto s = pipeline::check_ending(path, {".toml"}, "options"); !s) return s;
  if (auto s = pipeline::check_apart({path}, common.kept); !s) return s;
  const auto written = files_written(app);
  if (std::ranges::count(written, path) > 1)  // itself is among them
    return fail(Code::usage, fmt::format("{}: would be written twice; name another file", path.string()));
  if (auto s = common.force ? check_link(path) : Status(); !s) return s;
  pipeline::Settings settings;
  for (const CLI::App* at = &command; at->get_parent() != nullptr; at = at->get_parent())
    settings.command = at->get_name() + (settings.command.empty() ? "" : " ") + settings.command;
  for (const CLI::Option* option : options_of(command)) {
    if (option->count() == 0) continue;
    pipeline::Setting setting{.name = option->get_lnames().front()};
    setting.is_switch = option->get_items_expected_max() == 0;
    if (!setting.is_switch) setting.values = option->results();
    settings.list.push_back(std::move(setting));
  }
  return io::write_text(path, pipeline::settings_text(settings), common.force);
}

}  // namespace kinemark::cli
