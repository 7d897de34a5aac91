// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string_view>

namespace kinemark::io {

/// Whether a name says that its x, y and z are no position: "acc", "wrist_force", "Angular velocity".
[[nodiscard]] bool names_no_position(std::string_view name);

}  // namespace kinemark::io
