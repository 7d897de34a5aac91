// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <CLI/CLI.hpp>
#include <algorithm>
#include <string>
#include <utility>
#include <vector>

namespace kinemark::cli {

/// An option that takes one of some names. Another name is a usage error that lists them; the help shows the
/// first, which stands for the value that `out` has so far.
template <class Enum>
CLI::Option* add_choice(CLI::App& command, const std::string& option, Enum& out,
                        std::vector<std::pair<std::string, Enum>> choices, const std::string& description) {
  const std::string usual = choices.front().first;
  const auto read = [option, &out, choices = std::move(choices)](const std::string& name) {
    const auto chosen = std::ranges::find(choices, name, &std::pair<std::string, Enum>::first);
    if (chosen != choices.end()) {
      out = chosen->second;
      return;
    }
    std::string known = choices.front().first;
    for (std::size_t i = 1; i < choices.size(); ++i)
      known += (i + 1 < choices.size() ? ", " : " or ") + choices[i].first;
    throw CLI::ValidationError(option, "'" + name + "' is not " + known);
  };
  return command.add_option_function<std::string>(option, read, description)->default_str(usual);
}

}  // namespace kinemark::cli
