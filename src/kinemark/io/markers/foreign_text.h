// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>

namespace kinemark::io {

/// What a text holds that people give where markers are wanted, and what to do with it: "it holds ...",
/// without a full stop. Known by words in its first lines; empty: none of these. Nothing of the text is
/// quoted, as a page of `serve` may show it.
[[nodiscard]] std::string foreign_text(std::string_view begin);

}  // namespace kinemark::io
