// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// The one place where TOML is parsed.
#pragma once

#include <toml++/toml.h>

#include <cstddef>
#include <filesystem>
#include <string>
#include <string_view>

#include "kinemark/core/result.h"

namespace kinemark::io {

inline constexpr std::size_t kMostTomlBytes = 64UL
                                              << 20;  ///< a rig of 64 cameras with its covariance has less
inline constexpr int kMostKeyParts = 16;              ///< of one dotted key: a.b.c has three
inline constexpr int kMostBrackets = 16;              ///< of arrays and inline tables within each other

/// Parse TOML that is neither too long nor too deep: dotted keys and table names nest as brackets do, and a
/// parser that goes down once for each runs out of stack. Code::bad_input, one line that begins with `name`
/// and the line of the fault. Memory: about 20 times the text.
[[nodiscard]] Result<toml::table> parse_toml(std::string_view text, const std::string& name);

/// The same from a file.
[[nodiscard]] Result<toml::table> read_toml(const std::filesystem::path& path);

}  // namespace kinemark::io
