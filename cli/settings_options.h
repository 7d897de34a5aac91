// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
//
// --config and --save-config: options of a command in a file.
#pragma once

#include <CLI/CLI.hpp>
#include <filesystem>
#include <string>
#include <vector>

#include "cli/command.h"
#include "kinemark/core/result.h"

namespace kinemark::cli {

/// A command line, and the file that was after --config; empty without.
struct WordsGiven {
  std::vector<std::string> words;
  std::filesystem::path config;
};

/// The words of a command line with what the file after --config says put behind the command; what is typed
/// takes precedence. The words as they are without --config. Nothing is parsed by `app` yet.
///
/// Code::usage: no file after --config, no command; Code::bad_input: the file is for another command, names
/// an option that the command does not have, or gives a value to a switch or none to another; else as
/// read_settings().
[[nodiscard]] Result<WordsGiven> with_settings(const CLI::App& app, std::vector<std::string> words);

/// Write the options that were given, `app` having parsed them, to the file of --save-config: no files that
/// stand without an option, and neither --force nor these two. An existing file is replaced with --force, but
/// none of `common.kept`, none that the command writes too, and through a link only options: Code::usage.
[[nodiscard]] Status save_settings(const CLI::App& app, const CommonOptions& common);

}  // namespace kinemark::cli
