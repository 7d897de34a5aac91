// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>

namespace kinemark {

/// Text with `&`, `<`, `>` and `"` escaped for HTML and SVG.
[[nodiscard]] std::string html_text(std::string_view text);

/// JSON text that may stand inside a <script> element: it holds no '<', so it cannot end the element or open
/// a comment.
[[nodiscard]] std::string json_in_html(std::string_view json);

}  // namespace kinemark
