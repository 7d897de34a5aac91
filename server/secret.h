// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
//
// Random words that let in who knows them.
#pragma once

#include <string>
#include <string_view>

#include "kinemark/core/result.h"

namespace kinemark::server {

/// 128 bits from the system's random source as 32 lower-case hexadecimal digits. Code::io without one.
[[nodiscard]] Result<std::string> new_secret();

/// Whether both are the same, in a time that depends on the length of `given` alone. Never with an empty
/// secret.
[[nodiscard]] bool same_secret(std::string_view given, std::string_view secret);

}  // namespace kinemark::server
