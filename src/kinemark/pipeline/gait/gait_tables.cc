// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/pipeline/gait/gait_tables.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>

#include "kinemark/pipeline/files/table_cell.h"
#include "kinemark/stages/analysis/gait/spatiotemporal.h"

namespace kinemark::pipeline {
namespace {

using data::Side;

double percent_at(Eigen::Index p, Eigen::Index points) {
  return 100.0 * static_cast<double>(p) / static_cast<double>(points - 1);
}

std::string norm_cells(const SheetCurve& curve, Eigen::Index p) {
  if (curve.norm.rows() == 0) return ",,";
  return fmt::format("{},{},{}", table_cell(curve.norm(p, 0)), table_cell(curve.norm(p, 1)),
                     table_cell(curve.norm(p, 2)));
}

void add_rows(const SheetPanel& panel, const SheetCurve& curve, Side side, std::string& out) {
  const auto points = curve.mean.size();
  const std::string begin =
      fmt::format("{},{},{}", table_cell(panel.what.key), table_cell(curve.id), data::to_string(side));
  for (Eigen::Index c = 0; c < curve.values.cols(); ++c)
    for (Eigen::Index p = 0; p < points; ++p)
      out += fmt::format(
          "{},{},{:g},{},,{},,,,,{}\n", begin, c + 1, percent_at(p, points), table_cell(curve.values(p, c)),
          curve.sd.cols() > 0 ? table_cell(curve.sd(p, c)) : std::string(), table_cell(panel.unit));
  for (Eigen::Index p = 0; p < points; ++p)
    out += fmt::format("{},mean,{:g},{},{},{},{},{},{}\n", begin, percent_at(p, points),
                       table_cell(curve.mean[p]), table_cell(curve.between[p]), table_cell(curve.own[p]),
                       curve.count[p], norm_cells(curve, p), table_cell(panel.unit));
}

// Left 0, right 1, both 2.
std::size_t column_of(const data::Measure& measure) {
  for (const auto side : data::kBothSides)
    if (measure.context == data::to_string(side)) return data::index_of(side);
  return 2;
}

std::string number_text(double value) { return fmt::format("{:.4g}", value); }

std::string value_text(const data::Measure& measure, double per_si) {
  if (!std::isfinite(measure.value)) return "not determined";
  const auto& interval = measure.interval;
  std::string value = number_text(per_si * measure.value);
  if (interval.kind == data::IntervalKind::two_sided)
    return fmt::format("{} [{} to {}]", value, number_text(per_si * interval.low),
                       number_text(per_si * interval.high));
  if (interval.kind == data::IntervalKind::at_most)
    return fmt::format("{} [at most {}]", value, number_text(per_si * interval.high));
  if (interval.kind == data::IntervalKind::at_least)
    return fmt::format("{} [at least {}]", value, number_text(per_si * interval.low));
  return value;
}

// Whether the value is beyond the band, and whether its interval leaves a doubt.
std::string judged(const data::Measure& measure, double per_si, const NormMeasure& norm) {
  if (!std::isfinite(measure.value)) return {};
  const double value = per_si * measure.value;
  const auto& interval = measure.interval;
  // An end that an interval of one side does not have may lie anywhere.
  const double low = std::isfinite(interval.low)                    ? per_si * interval.low
                     : interval.kind == data::IntervalKind::at_most ? -INFINITY
                                                                    : value,
               high = std::isfinite(interval.high)                    ? per_si * interval.high
                      : interval.kind == data::IntervalKind::at_least ? INFINITY
                                                                      : value;
  if (value < norm.low) return high < norm.low ? "below" : "below, but its interval reaches the norm";
  if (value > norm.high) return low > norm.high ? "above" : "above, but its interval reaches the norm";
  return low < norm.low || high > norm.high ? "within, but its interval reaches beyond" : "within";
}

const NormMeasure* norm_of(const GaitSheet& sheet, const data::Measure& measure, std::string_view unit) {
  const auto column = column_of(measure);
  const auto fits = [&](const NormMeasure& norm) {
    return norm.id == measure.id && (norm.unit.empty() || norm.unit == unit) &&
           (!norm.side || data::index_of(*norm.side) == column);
  };
  const auto found = std::ranges::find_if(sheet.norms, fits);
  return found == sheet.norms.end() ? nullptr : &*found;
}

}  // namespace

std::string sheet_csv(const GaitSheet& sheet) {
  std::string out =
      "quantity,curve,context,cycle,percent,value,sd,own_sd,cycles,norm_low,norm_high,norm_mean,unit\n";
  for (const auto& panel : sheet.panels)
    for (const auto side : data::kBothSides)
      if (const auto& curve = panel.sides[data::index_of(side)]) add_rows(panel, *curve, side, out);
  return out;
}

std::string pairs_csv(std::span<const AnglePair> pairs) {
  std::string out = "x,y,context,percent,x_mean,y_mean,x_sd,y_sd,correlation,cycles\n";
  for (const auto& pair : pairs)
    for (const auto side : data::kBothSides) {
      const auto &x = pair.x->sides[data::index_of(side)], &y = pair.y->sides[data::index_of(side)];
      if (!x || !y) continue;
      const auto points = cyclogram(*x, *y);
      for (std::size_t p = 0; p < points.size(); ++p) {
        const auto& c = points[p].covariance;
        const double x_sd = std::sqrt(c(0, 0)), y_sd = std::sqrt(c(1, 1));
        out += fmt::format("{},{},{},{:g},{},{},{},{},{},{}\n", table_cell(pair.x->what.key),
                           table_cell(pair.y->what.key), data::to_string(side),
                           percent_at(static_cast<Eigen::Index>(p), std::ssize(points)),
                           table_cell(points[p].mean.x()), table_cell(points[p].mean.y()), table_cell(x_sd),
                           table_cell(y_sd), table_cell(c(0, 1) / (x_sd * y_sd)), points[p].cycles);
      }
    }
  return out;
}

std::vector<MeasureRow> measure_rows(const GaitSheet& sheet) {
  std::vector<MeasureRow> out;
  std::vector<std::string> ids;
  for (const auto& measure : sheet.measures) {
    const auto unit = data::shown_unit(measure.quantity);
    auto at = std::size_t{0};
    while (at < out.size() && (ids[at] != measure.id || out[at].region != measure.region)) ++at;
    if (at == out.size()) {
      const auto* definition = analysis::find_gait_definition(measure.id);
      out.push_back({.title = definition != nullptr ? std::string(definition->what.title) : measure.id,
                     .region = measure.region,
                     .unit = std::string(unit.name)});
      ids.push_back(measure.id);
    }
    const auto column = column_of(measure);
    out[at].value[column] = value_text(measure, unit.per_si);
    const auto* norm = norm_of(sheet, measure, unit.name);
    if (norm == nullptr) continue;
    out[at].judgement[column] = judged(measure, unit.per_si, *norm);
    const auto words = fmt::format("{} to {}", number_text(norm->low), number_text(norm->high));
    if (out[at].norm.empty())
      out[at].norm = words;
    else if (out[at].norm != words)
      out[at].norm += " / " + words;
  }
  return out;
}

}  // namespace kinemark::pipeline
