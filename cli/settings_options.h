// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
//
// --config and --save-config: options of a command in a file.
#pragma once

#include <CLI/CLI.hpp>
#include <filesystem>
#include <string>
#include <vector>

#include "kinemark/core/result.h"

namespace kinemark::cli {

/// The words of a command line with what the file after --config says put behind the command; what is typed
/// takes precedence. The words as they are without --config. Nothing is parsed by `app` yet.
///
/// Code::usage: no file after --config, no command; Code::bad_input: the file is for another command, names
/// an option that the command does not have, or gives a value to a switch or none to another; else as
/// read_settings().
[[nodiscard]] Result<std::vector<std::string>> with_settings(const CLI::App& app,
                                                             std::vector<std::string> words);

/// Write the options that were given, `app` having parsed them: no files that stand without an option, and
/// neither
/// --force nor these two. An existing file is replaced only with `force`.
[[nodiscard]] Status save_settings(const CLI::App& app, const std::filesystem::path& path, bool force);

}  // namespace kinemark::cli
