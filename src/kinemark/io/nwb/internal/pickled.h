// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "kinemark/core/result.h"

namespace kinemark::io::internal {

/// A list of tuples of texts in Python's pickle protocol 0, as PyTables keeps the labels of columns:
/// `[("net", "wrist", "x"), ...]`. Lists, tuples, texts and what is remembered of them are understood,
/// nothing is ever called or made; everything else, and more than 100,000 texts in all, is Code::bad_input.
[[nodiscard]] Result<std::vector<std::vector<std::string>>> parse_pickled_labels(std::string_view pickle);

}  // namespace kinemark::io::internal
