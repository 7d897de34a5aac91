// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/io/text/internal/table_values.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>

#include "kinemark/core/index.h"
#include "kinemark/core/missing.h"
#include "kinemark/core/text.h"
#include "kinemark/io/text/internal/cells.h"

namespace kinemark::io::internal {
namespace {

constexpr double kBeyondAll = 1e12;
constexpr double kFarStep = 1e4;
constexpr double kFarSteps = 100.0;
constexpr double kUsualShare = 0.9;  // of the steps are smaller than the usual one
constexpr std::size_t kNamed = 4;

/// Columns that reach so far that one of their values may be absurd.
std::vector<std::int64_t> wide_columns(const data::Table& table) {
  const auto columns = static_cast<std::int64_t>(table.columns.size());
  std::vector<double> low(table.columns.size(), 0.0), high(table.columns.size(), 0.0);
  for (std::int64_t r = 0; r < table.rows(); ++r)
    for (std::int64_t c = 0; c < columns; ++c) {
      const double value = table(r, c);
      double& least = low[at(c)];
      double& most = high[at(c)];
      least = value < least ? value : least;
      most = value > most ? value : most;
    }
  std::vector<std::int64_t> out;
  for (std::int64_t c = 0; c < columns; ++c)
    if (high[at(c)] - low[at(c)] > kFarStep || high[at(c)] > kBeyondAll || low[at(c)] < -kBeyondAll)
      out.push_back(c);
  return out;
}

/// Rows of a column that hold a number.
std::vector<std::int64_t> rows_with_value(const data::Table& table, std::int64_t column) {
  std::vector<std::int64_t> out;
  for (std::int64_t r = 0; r < table.rows(); ++r)
    if (!std::isnan(table(r, column))) out.push_back(r);
  return out;
}

/// The step between neighbours that most do not exceed; with few steps one that an absurd value has no part
/// in.
double usual_step(const data::Table& table, std::int64_t column, std::span<const std::int64_t> rows) {
  std::vector<double> steps;
  for (std::size_t i = 1; i < rows.size(); ++i)
    if (const double step = std::abs(table(rows[i], column) - table(rows[i - 1], column));
        std::isfinite(step))
      steps.push_back(step);
  if (steps.size() < 4) return 0.0;
  const auto share = steps.size() < 20 ? 0.25 : kUsualShare;
  const auto k = static_cast<std::ptrdiff_t>(share * static_cast<double>(steps.size() - 1));
  std::ranges::nth_element(steps, steps.begin() + k);
  return steps[static_cast<std::size_t>(k)];
}

}  // namespace

void note_absurd_values(const data::Table& table, std::span<const std::int64_t> line_of_row,
                        std::vector<std::string>& warnings) {
  std::vector<std::string> named;
  std::size_t count = 0;
  for (const std::int64_t column : wide_columns(table)) {
    const auto rows = rows_with_value(table, column);
    const double far = std::max(kFarStep, kFarSteps * usual_step(table, column, rows));
    for (std::size_t i = 0; i < rows.size(); ++i) {
      const double value = table(rows[i], column);
      const auto is_far_from = [&](std::size_t j) {
        return !(std::abs(value - table(rows[j], column)) <= far);
      };
      const bool has_neighbour = rows.size() > 1;
      const bool alone =
          has_neighbour && (i == 0 || is_far_from(i - 1)) && (i + 1 == rows.size() || is_far_from(i + 1));
      if (!alone && std::abs(value) <= kBeyondAll) continue;
      if (++count > kNamed) continue;
      named.push_back(fmt::format("'{}' in line {} (row {}) is {:.4g}", excerpt(table.columns[at(column)]),
                                  line_of_row[at(rows[i])], rows[i] + 1, value));
    }
  }
  if (count == 0) return;
  std::string sentence = join(named);
  if (count > kNamed) sentence += fmt::format(" and {} more", count - kNamed);
  warnings.push_back(fmt::format("{} {} far from all around {}, which nothing measured can be: {}", count,
                                 count == 1 ? "value is" : "values are", count == 1 ? "it" : "them",
                                 sentence));
}

}  // namespace kinemark::io::internal
