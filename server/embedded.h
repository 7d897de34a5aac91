// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
//
// Files that are part of the program; CMake writes the functions.
#pragma once

#include <string_view>

namespace kinemark::server {

[[nodiscard]] std::string_view style_css();  ///< of viewer/
[[nodiscard]] std::string_view list_css();   ///< what a list needs besides
[[nodiscard]] std::string_view list_js();    ///< renews the list while trials are being read

}  // namespace kinemark::server
