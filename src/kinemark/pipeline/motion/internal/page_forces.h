// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// Forces of plates on pages of recordings.
#pragma once

#include <fmt/core.h>

#include <string>
#include <string_view>

namespace kinemark::pipeline::internal {

inline constexpr double kContact_n = 20.0;  ///< below which a plate is drawn empty

/// Why a page shows no forces of the plates that are there.
[[nodiscard]] inline std::string no_forces(std::string_view why) {
  return fmt::format("no forces are shown: {}", why);
}

}  // namespace kinemark::pipeline::internal
