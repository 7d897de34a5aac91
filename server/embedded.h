// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
//
// Files that are part of the program; CMake writes the functions.
#pragma once

#include <string_view>

namespace kinemark::server {

// All of viewer/: pages of the server's own, without data, and what they ask for.
[[nodiscard]] std::string_view served_html();  ///< the page; "@root@" stands for where pages begin
[[nodiscard]] std::string_view style_css();    ///< of all pages
[[nodiscard]] std::string_view list_css();     ///< what these need besides
[[nodiscard]] std::string_view list_js();      ///< makes the page of its data

}  // namespace kinemark::server
