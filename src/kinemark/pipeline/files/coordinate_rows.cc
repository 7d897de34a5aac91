// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/pipeline/files/coordinate_rows.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>

#include "kinemark/core/counted.h"
#include "kinemark/core/index.h"
#include "kinemark/core/text.h"
#include "kinemark/pipeline/files/motion_tables.h"

namespace kinemark::pipeline {
namespace {

constexpr std::size_t kNamed = 6;

Result<TimeBase> even_time(const data::Table& table) {
  const auto rows = table.rows();
  if (rows < 2)
    return fail(Code::bad_input, fmt::format("holds {}; a motion needs two rows", counted(rows, "row")));
  const double span_s = table.time_s.back() - table.time_s.front();
  const TimeBase time{
      .rate_hz = static_cast<double>(rows - 1) / span_s, .t0_s = table.time_s.front(), .frames = rows};
  for (std::int64_t r = 0; r < rows; ++r)
    if (std::abs(table.time_s[at(r)] - time.time_s(r)) * time.rate_hz > 0.01)
      return fail(Code::bad_input,
                  fmt::format("row {} is at {:.9g} s; rows that are evenly spaced, here by {:.6g} s, "
                              "are needed, and the first that is not is this one",
                              r + 1, table.time_s[at(r)], 1.0 / time.rate_hz));
  return time;
}

/// Cells without a number get one from those around them; how many they were, or -1 when none has one.
std::int64_t fill(std::vector<double>& column) {
  const auto is_number = [](double v) { return std::isfinite(v); };
  std::int64_t filled = 0;
  auto before = column.end();
  for (auto here = column.begin(); here != column.end();) {
    if (is_number(*here)) {
      before = here++;
      continue;
    }
    const auto after = std::find_if(here, column.end(), is_number);
    if (before == column.end() && after == column.end()) return -1;
    filled += after - here;
    for (; here != after; ++here) {
      const auto span = static_cast<double>(after - before);
      *here = before == column.end() ? *after
              : after == column.end()
                  ? *before
                  : *before + (*after - *before) * static_cast<double>(here - before) / span;
    }
  }
  return filled;
}

}  // namespace

Result<CoordinateRows> coordinate_rows(const model::Model& model, const data::Table& table) {
  const auto time = even_time(table);
  if (!time) return std::unexpected(time.error());
  const auto& description = model.description();
  CoordinateRows out{.time = *time};
  out.is_filled.assign(at(table.rows() * model.coordinate_count()), 0);
  Eigen::VectorXd q(model.coordinate_count());
  for (int c = 0; c < model.coordinate_count(); ++c) q[c] = description.coordinates[at(c)].default_value;
  out.q.assign(at(table.rows()), q);
  std::vector<std::string> absent;
  std::int64_t filled = 0;
  for (int c = 0; c < model.coordinate_count(); ++c) {
    const std::string& name = description.coordinates[at(c)].name;
    const auto column = table.find(name);
    if (model.coordinates()[at(c)].source >= 0) continue;
    if (column < 0) {
      absent.push_back(name);
      continue;
    }
    std::vector<double> values;
    for (std::int64_t r = 0; r < table.rows(); ++r) {
      values.push_back(table(r, column));
      out.is_filled[at(r * model.coordinate_count() + c)] = !std::isfinite(values.back());
    }
    const auto n = fill(values);
    if (n < 0) return fail(Code::bad_input, fmt::format("coordinate '{}' has no number in any row", name));
    filled += n;
    const double unit = column_unit(table, description, c);
    for (std::size_t r = 0; r < values.size(); ++r) out.q[r][c] = unit * values[r];
  }
  if (std::ssize(absent) == model.coordinate_count())
    return fail(Code::bad_input,
                fmt::format("none of its columns is a coordinate of model '{}'", description.name));
  if (!absent.empty())
    out.notes.push_back(fmt::format("{} of the model {} no column and {} the default value: {}",
                                    counted(std::ssize(absent), "coordinate"),
                                    absent.size() == 1 ? "has" : "have",
                                    absent.size() == 1 ? "keeps" : "keep", join_some(absent, kNamed)));
  if (filled > 0)
    out.notes.push_back(fmt::format("{} without a number {} filled from those around them",
                                    counted(filled, "cell"), filled == 1 ? "was" : "were"));
  return out;
}

}  // namespace kinemark::pipeline
