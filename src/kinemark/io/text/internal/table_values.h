// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "kinemark/data/table.h"

namespace kinemark::io::internal {

/// Adds a warning that names rows and columns of values which nothing measured can be: infinite, beyond 1e12,
/// or alone more than 1e4 (degrees, metres, newtons alike) and 100 times the usual step of their column away
/// from the values before and after. O(values), and more only for columns that reach so far.
///
/// @param line_of_row  R line numbers, for the message
void note_absurd_values(const data::Table& table, std::span<const std::int64_t> line_of_row,
                        std::vector<std::string>& warnings);

}  // namespace kinemark::io::internal
