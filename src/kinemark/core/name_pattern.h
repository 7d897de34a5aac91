// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string_view>

namespace kinemark {

/// Whether a name given by a user holds * or ?.
[[nodiscard]] bool is_name_pattern(std::string_view text);

/// Whether all of `name` is as `pattern` says: * any text, also none, ? any byte, other bytes themselves.
/// O(pattern x name) at worst; allocates nothing.
[[nodiscard]] bool matches_name_pattern(std::string_view pattern, std::string_view name);

}  // namespace kinemark
