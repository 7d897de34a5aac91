// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// Rows of a table of observations: which columns say what, which rows count.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "kinemark/core/result.h"
#include "kinemark/io/text/tidy_csv.h"

namespace kinemark::pipeline {

/// Index of a column that an option names. Code::bad_input, with the nearest and all names, where the table
/// has none of it.
/// @param option  as it is typed, for the message: "--value"
[[nodiscard]] Result<std::int64_t> column_of(const io::TidyTable& table, const std::string& column,
                                             std::string_view option);

/// Indices of several columns.
[[nodiscard]] Result<std::vector<std::int64_t>> columns_of(const io::TidyTable& table,
                                                           std::span<const std::string> columns,
                                                           std::string_view option);

/// Rows for which every condition COLUMN=VALUE holds, in their order. Code::usage for a condition without =,
/// Code::bad_input for a column that is not there and where no row is left, with the values that there are.
[[nodiscard]] Result<std::vector<std::int64_t>> rows_where(const io::TidyTable& table,
                                                           std::span<const std::string> conditions);

/// Cells of some columns in a row, joined with a blank; empty ones are passed over.
[[nodiscard]] std::string joined_cells(const io::TidyTable& table, std::int64_t row,
                                       std::span<const std::int64_t> columns);

/// What the column "unit" says of these rows; empty without such a column. Code::bad_input where they differ.
[[nodiscard]] Result<std::string> unit_of(const io::TidyTable& table, std::span<const std::int64_t> rows);

}  // namespace kinemark::pipeline
