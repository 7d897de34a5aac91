// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>

namespace kinemark::studies {

/// Text whose `&`, `<`, `>` and `"` HTML and SVG show as they are.
[[nodiscard]] std::string html_text(std::string_view text);

}  // namespace kinemark::studies
