// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
//
// What is wrong with a command line, in a sentence that says what was probably meant.
#pragma once

#include <CLI/CLI.hpp>
#include <span>
#include <string>

namespace kinemark::cli {

/// The sentence about a command line that could not be parsed: unknown commands and options with the nearest
/// names, words that other programs of the field use, options with one dash; else what the parser says.
/// `words` is what was typed after the program's name.
[[nodiscard]] std::string explain_usage(const CLI::App& app, const CLI::ParseError& error,
                                        std::span<const std::string> words);

/// The command that was reached, the innermost one: of `simulate rig` that of `rig`.
[[nodiscard]] const CLI::App& reached(const CLI::App& app);

/// The sentence about `word` where a command of `at` was expected.
[[nodiscard]] std::string unknown_command(const CLI::App& at, const std::string& word);

}  // namespace kinemark::cli
