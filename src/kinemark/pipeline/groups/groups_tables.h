// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// Parts that tables of groups share.
#pragma once

#include <nlohmann/json_fwd.hpp>

#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "kinemark/core/result.h"
#include "kinemark/data/measure.h"
#include "kinemark/io/text/tidy_csv.h"
#include "kinemark/pipeline/files/job_settings.h"
#include "kinemark/pipeline/files/table_cell.h"

namespace kinemark::pipeline {

// Rows of a table of observations: which columns say what, which rows count.

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

/// json_number() of many.
[[nodiscard]] nlohmann::ordered_json json_numbers(const std::vector<double>& values);

/// Mean and standard deviation (N - 1) over the curves that are there, at each of P points; NaN where there
/// are too few of them.
struct PointMeans {
  std::vector<double> mean;  ///< P
  std::vector<double> sd;    ///< P
};
/// Cost: N P.
[[nodiscard]] PointMeans point_means(const data::CycleCurves& curves);

/// Code::usage unless the path is empty or ends in .csv or .json. @param what  "the bands"
[[nodiscard]] Status check_table_name(const std::filesystem::path& output, std::string_view what);

/// Write a table of that name, if there is a name: the text where it ends in .csv, else the object.
/// @param inputs, job  as for Staging::create()
[[nodiscard]] Result<std::vector<std::filesystem::path>> write_table_of_groups(
    const std::filesystem::path& output, const std::vector<std::filesystem::path>& inputs,
    const JobSettings& job, const std::string& csv, const nlohmann::ordered_json& json,
    std::string_view what);

}  // namespace kinemark::pipeline
