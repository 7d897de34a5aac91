// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <CLI/CLI.hpp>

namespace kinemark::cli {

/// In the help of every command: what a value is, FILE, MM, HZ or S, in the place of its C++ type. Options of
/// one name mean the same in all commands; those that say it themselves are left as they are.
void name_values(CLI::App& app);

}  // namespace kinemark::cli
