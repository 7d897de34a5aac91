// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// Options of a command in a TOML file: docs/formats/settings.md.
#pragma once

#include <toml++/toml.h>

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "kinemark/core/result.h"

namespace kinemark::pipeline {

/// One option.
struct Setting {
  std::string name;                 ///< long, without dashes: "max-rms"
  std::vector<std::string> values;  ///< as they would be typed; empty for a switch
  bool is_switch = false;           ///< it is true or false
  bool on = true;                   ///< of a switch
  int line = 0;                     ///< in the file, from 1
};

/// Options of one command.
struct Settings {
  std::string command;        ///< "simulate rig"; empty: the file does not say
  std::vector<Setting> list;  ///< in the order of the file
};

/// Code::bad_input, naming file and line, for what is no TOML, a table, a date, or an array of anything but
/// numbers and texts; else as read_toml().
[[nodiscard]] Result<Settings> read_settings(const std::filesystem::path& path);
/// The same of a text. @param name  of the file, for the messages
[[nodiscard]] Result<Settings> parse_settings(std::string_view text, const std::string& name);

/// The text that read_settings() reads back as the same, lines aside. Numbers stand without quotes.
[[nodiscard]] std::string settings_text(const Settings& settings);

/// The options in a table, in the order of the file; as parse_settings(). @param name  of the file
[[nodiscard]] Result<Settings> settings_of(const toml::table& table, const std::string& name);

}  // namespace kinemark::pipeline
