// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/pipeline/groups/groups_tables.h"

#include <fmt/core.h>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include "kinemark/core/missing.h"
#include "kinemark/core/nearest_name.h"
#include "kinemark/core/utf8.h"
#include "kinemark/pipeline/files/job_settings.h"
#include "kinemark/pipeline/files/result_files.h"

namespace kinemark::pipeline {
namespace {

constexpr std::size_t kListed = 8;
constexpr std::size_t kCellShown = 40;
constexpr std::size_t kListLength = 300;

// The first of the values that a column has, for a message.
std::string values_of(const io::TidyTable& table, std::span<const std::int64_t> rows, std::int64_t column) {
  std::vector<std::string> seen;
  for (const auto row : rows) {
    const std::string& cell = table(row, column);
    if (std::ranges::find(seen, cell) != seen.end()) continue;
    if (seen.size() == kListed) {
      seen.emplace_back("...");
      break;
    }
    seen.push_back(cell);
  }
  for (auto& cell : seen) cell = printable(cell, kCellShown);
  return fmt::format("{}", fmt::join(seen, ", "));
}

}  // namespace

Result<std::int64_t> column_of(const io::TidyTable& table, const std::string& column,
                               std::string_view option) {
  if (const auto at = table.find(column); at >= 0) return at;
  if (table.columns.empty())
    return fail(Code::bad_input,
                fmt::format("{}: {} names column '{}', but the first line holds numbers, not names",
                            table.name, option, column));
  const auto near = nearest_names(column, table.columns, 1);
  return fail(
      Code::bad_input,
      fmt::format(
          "{}: no column '{}' ({}){}; there are {}", table.name, printable(column, kCellShown), option,
          near.empty() ? "" : fmt::format("; did you mean '{}'?", printable(near.front(), kCellShown)),
          printable(fmt::format("{}", fmt::join(table.columns, ", ")), kListLength)));
}

Result<std::vector<std::int64_t>> columns_of(const io::TidyTable& table, std::span<const std::string> columns,
                                             std::string_view option) {
  std::vector<std::int64_t> out;
  for (const auto& column : columns) {
    auto at = column_of(table, column, option);
    if (!at) return std::unexpected(at.error());
    out.push_back(*at);
  }
  return out;
}

Result<std::vector<std::int64_t>> rows_where(const io::TidyTable& table,
                                             std::span<const std::string> conditions) {
  std::vector<std::int64_t> rows(static_cast<std::size_t>(table.rows()));
  std::iota(rows.begin(), rows.end(), 0);
  for (const auto& condition : conditions) {
    const auto equals = condition.find('=');
    if (equals == std::string::npos || equals == 0)
      return fail(Code::usage,
                  fmt::format("--where takes COLUMN=VALUE, not '{}'", printable(condition, kCellShown)));
    const auto column = column_of(table, condition.substr(0, equals), "--where");
    if (!column) return std::unexpected(column.error());
    const auto value = condition.substr(equals + 1);
    auto left = rows;
    std::erase_if(left, [&](std::int64_t row) { return table(row, *column) != value; });
    if (left.empty())
      return fail(Code::bad_input,
                  fmt::format("{}: no row is left where {} is '{}'; there are {}", table.name,
                              printable(condition.substr(0, equals), kCellShown),
                              printable(value, kCellShown), values_of(table, rows, *column)));
    rows = std::move(left);
  }
  return rows;
}

std::string joined_cells(const io::TidyTable& table, std::int64_t row,
                         std::span<const std::int64_t> columns) {
  std::string out;
  for (const auto column : columns) {
    const std::string& cell = table(row, column);
    if (cell.empty()) continue;
    if (!out.empty()) out += ' ';
    out += cell;
  }
  return out;
}

Result<std::string> unit_of(const io::TidyTable& table, std::span<const std::int64_t> rows) {
  const auto column = table.find("unit");
  if (column < 0 || rows.empty()) return std::string();
  const std::string& unit = table(rows.front(), column);
  for (const auto row : rows)
    if (table(row, column) != unit)
      return fail(
          Code::bad_input,
          fmt::format("{}: line {} is in '{}', line {} in '{}'; choose one quantity with --where, such as "
                      "--where measure=NAME",
                      table.name, table.line_of[static_cast<std::size_t>(rows.front())],
                      printable(unit, kCellShown), table.line_of[static_cast<std::size_t>(row)],
                      printable(table(row, column), kCellShown)));
  return unit;
}

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
