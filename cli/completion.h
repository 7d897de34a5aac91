// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
//
// Scripts that let a shell complete commands and options; files complete as the shell does it by itself.
#pragma once

#include <string>

#include "cli/command_tree.h"

namespace kinemark::cli {

[[nodiscard]] std::string bash_completion(const CommandText& top);
[[nodiscard]] std::string zsh_completion(const CommandText& top);
[[nodiscard]] std::string fish_completion(const CommandText& top);

}  // namespace kinemark::cli
