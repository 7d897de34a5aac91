// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// Words for units of length, as files of every format use them.
#pragma once

#include <optional>
#include <string_view>

namespace kinemark::io {

/// Metres per unit of length ("mm", "m", "cm", "in", "feet", ... in any case); nothing when unknown.
[[nodiscard]] std::optional<double> metres_per_unit(std::string_view unit);

}  // namespace kinemark::io
