// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <CLI/CLI.hpp>
#include <filesystem>
#include <vector>

namespace kinemark::cli {

/// Every value of the command that was typed that may name a file to read, also
/// behind NAME= and replay:. Options of which it is known that they name what
/// is written are left out; those of all others are kept from being replaced,
/// so that an option that is new is safe before anybody thinks of it. Values
/// that name no file are among them.
[[nodiscard]] std::vector<std::filesystem::path> files_read(const CLI::App& app);

/// Every value that names what is written: files and folders.
[[nodiscard]] std::vector<std::filesystem::path> files_written(const CLI::App& app);

}  // namespace kinemark::cli
