// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/pipeline/groups/groups_tables.h"

#include <fmt/core.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "kinemark/core/missing.h"
#include "kinemark/pipeline/files/job_settings.h"
#include "kinemark/pipeline/files/result_files.h"

namespace kinemark::pipeline {

nlohmann::ordered_json json_numbers(const std::vector<double>& values) {
  auto out = nlohmann::ordered_json::array();
  for (const double value : values) out.push_back(json_number(value));
  return out;
}

PointMeans point_means(const data::CycleCurves& curves) {
  PointMeans out;
  for (std::int64_t p = 0; p < curves.points; ++p) {
    double sum = 0.0, squares = 0.0;
    std::int64_t n = 0;
    for (std::int64_t c = 0; c < curves.count(); ++c)
      if (const double value = curves(c, p); !std::isnan(value)) {
        sum += value;
        ++n;
      }
    const double mean = n > 0 ? sum / static_cast<double>(n) : kNaN;
    for (std::int64_t c = 0; c < curves.count(); ++c)
      if (const double value = curves(c, p); !std::isnan(value)) squares += (value - mean) * (value - mean);
    out.mean.push_back(mean);
    out.sd.push_back(n > 1 ? std::sqrt(squares / static_cast<double>(n - 1)) : kNaN);
  }
  return out;
}

Status check_table_name(const std::filesystem::path& output, std::string_view what) {
  const auto ending = ending_of(output);
  if (output.empty() || ending == ".csv" || ending == ".json") return {};
  return fail(Code::usage, fmt::format("{}: {} are written as .csv or .json", output.string(), what));
}

Result<std::vector<std::filesystem::path>> write_table_of_groups(
    const std::filesystem::path& output, const std::vector<std::filesystem::path>& inputs,
    const JobSettings& job, const std::string& csv, const nlohmann::ordered_json& json,
    std::string_view what) {
  if (output.empty()) return std::vector<std::filesystem::path>{};
  auto staging = Staging::create({output}, job, inputs);
  if (!staging) return std::unexpected(staging.error());
  const auto file = ending_of(output) == ".csv" ? text_file(output, [&] { return csv; })
                                                : json_file(output, [&] { return json; });
  return write_results(*staging, {file}, {}, what);
}

}  // namespace kinemark::pipeline
