// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "kinemark/core/result.h"
#include "kinemark/data/rig.h"

namespace kinemark::io {

/// A rig from rig.toml; valid by Rig::validate(). Failures name the file and the key, or line and column
/// where the text is no TOML. Files over 64 MB, more than 64 cameras and a covariance of more than 4096
/// parameters are refused.
[[nodiscard]] Result<data::Rig> read_rig(const std::filesystem::path& path);
/// The same from memory; `name` begins messages.
[[nodiscard]] Result<data::Rig> parse_rig(std::string_view text, std::string_view name);

/// The rig as rig.toml, which appears whole or not at all. Code::io when it exists (unless `force`) or cannot
/// be written, Code::usage when the rig is not valid. Reads back to the same bits.
[[nodiscard]] Status write_rig(const std::filesystem::path& path, const data::Rig& rig, bool force);
/// The text that write_rig() writes. The rig must be valid.
[[nodiscard]] std::string format_rig(const data::Rig& rig);

}  // namespace kinemark::io
