// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
//
// Manual pages, made of the same text as --help.
#pragma once

#include <string>

#include "cli/command_tree.h"

namespace kinemark::cli {

/// "kinemark-simulate-rig" for what is reached by both words.
[[nodiscard]] std::string manual_name(const CommandText& command);

/// The page of a command in man(7); `top` is the program, which knows the exit statuses.
[[nodiscard]] std::string manual_page(const CommandText& command, const CommandText& top);

}  // namespace kinemark::cli
