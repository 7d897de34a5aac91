// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace kinemark::io::osim {

/// XML whose first line declares Shift-JIS (Shift_JIS, SJIS, CP932, Windows-31J) in UTF-8. Nothing when it
/// declares something else, when its bytes are not of that encoding, or the system cannot convert it.
[[nodiscard]] std::optional<std::string> from_shift_jis(std::string_view xml);

}  // namespace kinemark::io::osim
