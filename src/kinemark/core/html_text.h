// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>

namespace kinemark {

/// Text with `&`, `<`, `>` and `"` escaped for HTML and SVG.
[[nodiscard]] std::string html_text(std::string_view text);

}  // namespace kinemark
