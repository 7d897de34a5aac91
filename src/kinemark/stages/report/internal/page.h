// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <string_view>

namespace kinemark::report::internal {

/// The committed page of viewer/dist/report.html, without data. Lives as long as the program.
[[nodiscard]] std::string_view page_template();

/// JSON text that may stand inside a <script> element: it holds no '<', so it cannot end the element or open
/// a comment. Bytes that are not UTF-8 become U+FFFD.
[[nodiscard]] std::string json_for_html(const nlohmann::ordered_json& json);

/// The page with the data in the element that waits for it.
[[nodiscard]] std::string fill_page(const nlohmann::ordered_json& json);

}  // namespace kinemark::report::internal
