// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// Parts that tables of groups share.
#pragma once

#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "kinemark/core/result.h"
#include "kinemark/data/measure.h"
#include "kinemark/pipeline/files/job_settings.h"
#include "kinemark/pipeline/files/table_cell.h"

namespace kinemark::pipeline {

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
