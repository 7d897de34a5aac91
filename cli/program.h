// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
//
// The program as a parser of command lines, with all its commands.
#pragma once

#include <CLI/CLI.hpp>
#include <string>
#include <vector>

#include "cli/command.h"
#include "kinemark/core/result.h"

namespace kinemark::cli {

/// Add what every command takes, and all commands. Of what it fills, `common` and `run` must live as long.
void add_everything(CLI::App& app, CommonOptions& common, Run& run);

/// Code::usage, with the sentence that the program would say, for words that are no command of it. Nothing
/// runs.
[[nodiscard]] Status check_words(const std::vector<std::string>& words);

}  // namespace kinemark::cli
