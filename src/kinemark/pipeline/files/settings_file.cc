// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/pipeline/files/settings_file.h"

#include <fmt/core.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstdint>
#include <optional>
#include <string_view>
#include <utility>

#include "kinemark/core/number.h"
#include "kinemark/core/text.h"
#include "kinemark/core/version.h"
#include "kinemark/io/rig/toml_text.h"

namespace kinemark::pipeline {
namespace {

constexpr const char* kCommand = "command";

/// A number or a text as it would be typed; nothing for anything else.
std::optional<std::string> typed(const toml::node& node) {
  if (const auto* text = node.as_string()) return text->get();
  if (const auto* whole = node.as_integer()) return std::to_string(whole->get());
  if (const auto* number = node.as_floating_point()) return format_number(number->get());
  return std::nullopt;
}

/// Whether TOML reads the text as a number without quotes that is typed the same again.
bool is_plain_number(std::string_view text) {
  const auto digits = text.substr(text.starts_with('-') ? 1 : 0);
  if (digits.empty() || digits.find_first_not_of("0123456789.") != std::string_view::npos) return false;
  const auto number = parse_number(text);
  if (!number || std::abs(*number) > 1e15) return false;
  const bool is_whole = text.find('.') == std::string_view::npos;
  return is_whole ? std::to_string(static_cast<std::int64_t>(*number)) == text
                  : format_number(*number) == text;
}

std::string in_toml_quotes(std::string_view text) {
  std::string out = "\"";
  for (const char c : text) {
    const auto byte = static_cast<unsigned char>(c);
    if (c == '"' || c == '\\')
      out += fmt::format("\\{}", c);
    else if (byte < 0x20 || byte == 0x7F)
      out += fmt::format("\\u{:04X}", byte);
    else
      out += c;
  }
  return out + "\"";
}

std::string value_text(const std::string& value) {
  return is_plain_number(value) ? value : in_toml_quotes(value);
}

/// A key of TOML, in quotes where it needs them.
std::string key_text(const std::string& name) {
  const bool is_bare = !name.empty() && std::ranges::all_of(name, [](unsigned char c) {
    return std::isalnum(c) != 0 || c == '-' || c == '_';
  });
  return is_bare ? name : in_toml_quotes(name);
}

}  // namespace

Result<Settings> settings_of(const toml::table& table, const std::string& name) {
  Settings settings;
  for (const auto& [key, node] : table) {
    Setting setting{.name = std::string(key.str()), .line = static_cast<int>(node.source().begin.line)};
    const auto wrong = [&](const char* need) {
      return fail(Code::bad_input,
                  fmt::format("{}: line {}: '{}' is {}; need {}", name, setting.line, setting.name,
                              node.is_table() ? "a table" : "of another kind", need));
    };
    if (setting.name == kCommand) {
      if (!node.is_string()) return wrong("the name of a command, \"ik\"");
      settings.command = node.as_string()->get();
      continue;
    }
    if (const auto* on = node.as_boolean()) {
      setting.is_switch = true;
      setting.on = on->get();
    } else if (const auto* list = node.as_array()) {
      for (const auto& item : *list) {
        auto value = typed(item);
        if (!value) return wrong("numbers and texts in the list");
        setting.values.push_back(std::move(*value));
      }
    } else if (auto value = typed(node)) {
      setting.values.push_back(std::move(*value));
    } else {
      return wrong("a number, a text, true, false, or a list of numbers and texts");
    }
    settings.list.push_back(std::move(setting));
  }
  std::ranges::stable_sort(settings.list, {}, &Setting::line);
  return settings;
}

Result<Settings> read_settings(const std::filesystem::path& path) {
  const auto table = io::read_toml(path);
  if (!table) return std::unexpected(table.error());
  return settings_of(*table, path.string());
}

Result<Settings> parse_settings(std::string_view text, const std::string& name) {
  const auto table = io::parse_toml(text, name);
  if (!table) return std::unexpected(table.error());
  return settings_of(*table, name);
}

std::string settings_text(const Settings& settings) {
  std::string out = fmt::format("# Options for --config, written by kinemark {}\n", kVersion);
  if (!settings.command.empty()) out += fmt::format("{} = {}\n", kCommand, in_toml_quotes(settings.command));
  for (const auto& setting : settings.list) {
    std::vector<std::string> values;
    for (const auto& value : setting.values) values.push_back(value_text(value));
    out += fmt::format("{} = {}\n", key_text(setting.name),
                       setting.is_switch    ? (setting.on ? "true" : "false")
                       : values.size() == 1 ? values.front()
                                            : "[" + join(values) + "]");
  }
  return out;
}

}  // namespace kinemark::pipeline
