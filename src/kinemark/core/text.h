// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
//
// Names in sentences.
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <string_view>

namespace kinemark {

/// "A, B, C"; empty of no names.
[[nodiscard]] std::string join(std::span<const std::string> names, std::string_view between = ", ");

/// "A, B, C", or "A, B and 4 more" with the first `most` names where there are more.
[[nodiscard]] std::string join_some(std::span<const std::string> names, std::size_t most);

/// "A", "A and B", "A, B and C", or "A, B and 4 more" where there are more than `most`.
[[nodiscard]] std::string join_names(std::span<const std::string> names, std::size_t most);

}  // namespace kinemark
