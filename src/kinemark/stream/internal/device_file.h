// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// Files of /dev: why one cannot be opened, and who has it.
#pragma once

#include <string>

namespace kinemark::stream {

/// Why a device cannot be opened, from errno, and what to do: plug it in, join the group named, end the
/// program named.
[[nodiscard]] std::string cannot_open(const std::string& path, int error);
/// The program that has a file open, "kinemark (process 4711)"; "another program" when it cannot be seen.
[[nodiscard]] std::string who_has(const std::string& path);

}  // namespace kinemark::stream
