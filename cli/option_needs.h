// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <CLI/CLI.hpp>
#include <string_view>

#include "kinemark/core/result.h"

namespace kinemark::cli {

/// Whether every option that was given counts beside the others: one that is for another choice (the cut-off
/// of a filter that is off) is refused, not passed over. Code::usage names it, what it is for, and the choice
/// that was made.
/// @param command  that was reached, parsed
[[nodiscard]] Status check_needs(const CLI::App& command);

/// The same by the needs of another command, which `command` stands for: `analyze` for `segments`.
[[nodiscard]] Status check_needs_of(std::string_view words, const CLI::App& command);

}  // namespace kinemark::cli
