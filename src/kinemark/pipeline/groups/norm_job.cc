// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/pipeline/groups/norm_job.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <nlohmann/json.hpp>
#include <tuple>
#include <utility>

#include "kinemark/core/utf8.h"
#include "kinemark/io/text/tidy_csv.h"
#include "kinemark/pipeline/groups/groups_tables.h"

namespace kinemark::pipeline {
namespace {

constexpr double kDeviations = 2.0;  // as gait laboratories draw a band of mean and SD

/// Columns that make a band.
struct Ends {
  std::string_view first, second;
  std::string_view meaning;
};
constexpr std::array kEnds = {Ends{"one_low", "one_high", "simultaneous band of one further curve"},
                              Ends{"low", "high", "band as in the file"},
                              Ends{"mean", "sd", "mean +- 2 SD at each point"}};

const Ends* ends_in(const io::TidyTable& table) {
  const auto found = std::ranges::find_if(
      kEnds, [&](const Ends& ends) { return table.find(ends.first) >= 0 && table.find(ends.second) >= 0; });
  return found == kEnds.end() ? nullptr : found;
}

// The band between its points; NaN outside, and beside a point without a value: std::lerp() would give the
// other end's.
std::pair<double, double> band_at(const NormBand& norm, double where) {
  const auto above = std::ranges::lower_bound(norm.at, where);
  if (above == norm.at.end()) return {kNaN, kNaN};
  const auto i = static_cast<std::size_t>(above - norm.at.begin());
  if (*above == where) return {norm.low[i], norm.high[i]};
  if (i == 0) return {kNaN, kNaN};
  const double part = (where - norm.at[i - 1]) / (norm.at[i] - norm.at[i - 1]);
  const auto between = [&](const auto& ends) { return ends[i - 1] + part * (ends[i] - ends[i - 1]); };
  return {between(norm.low), between(norm.high)};
}

BesideNorm compare(const NormBand& norm, const CurveGroups& groups, std::size_t group, std::int64_t curve) {
  const auto& curves = groups.curves[group];
  BesideNorm out{.group = groups.names[group], .curve = curves.cycles[static_cast<std::size_t>(curve)]};
  bool was_outside = false;
  for (std::size_t p = 0; p < groups.at.size(); ++p) {
    const auto [low, high] = band_at(norm, groups.at[p]);
    const double value = curves(curve, static_cast<std::int64_t>(p));
    if (std::isnan(low) || std::isnan(high) || std::isnan(value)) {
      was_outside = false;
      continue;
    }
    ++out.points;
    const double beyond = value > high ? value - high : value < low ? value - low : 0.0;
    if (beyond != 0.0) {
      ++out.outside;
      if (!was_outside) out.spans.emplace_back(groups.at[p], groups.at[p]);
      out.spans.back().second = groups.at[p];
      if (!(std::abs(beyond) <= std::abs(out.largest)))
        std::tie(out.largest, out.largest_at) = std::pair{beyond, groups.at[p]};
    }
    was_outside = beyond != 0.0;
  }
  return out;
}

std::string spans_text(const BesideNorm& curve) {
  std::vector<std::string> parts;
  for (const auto& [first, last] : curve.spans)
    parts.push_back(first == last ? fmt::format("{:g}", first) : fmt::format("{:g} to {:g}", first, last));
  return fmt::format("{}", fmt::join(parts, "; "));
}

}  // namespace

Result<NormBand> read_norm(const std::filesystem::path& path, const std::string& at,
                           const std::vector<std::string>& where) {
  const auto table = io::read_tidy_csv(path);
  if (!table) return std::unexpected(table.error());
  const auto column = column_of(*table, at, "--at");
  if (!column) return std::unexpected(column.error());
  const Ends* ends = ends_in(*table);
  if (ends == nullptr)
    return fail(
        Code::bad_input,
        fmt::format("{}: has no columns one_low and one_high, low and high, or mean and sd", path.string()));
  const auto rows = rows_where(*table, where);
  if (!rows) return std::unexpected(rows.error());
  auto unit = unit_of(*table, *rows);
  if (!unit) return std::unexpected(unit.error());
  const auto first = table->find(ends->first), second = table->find(ends->second);
  const bool by_deviation = ends->first == "mean";
  std::map<double, std::pair<double, double>> band;
  for (const auto row : *rows) {
    const auto place = table->number(row, *column), a = table->number(row, first),
               b = table->number(row, second);
    for (const auto* number : {&place, &a, &b})
      if (!*number) return std::unexpected(number->error());
    const auto line = table->line_of[static_cast<std::size_t>(row)];
    if (std::isnan(*place))
      return fail(Code::bad_input,
                  fmt::format("{}: line {}: {} is blank; need a number", path.string(), line, at));
    const double low = by_deviation ? *a - kDeviations * *b : *a,
                 high = by_deviation ? *a + kDeviations * *b : *b;
    if (low > high)
      return fail(Code::bad_input,
                  fmt::format("{}: line {}: the band's lower end {:g} is above its upper end {:g}",
                              path.string(), line, low, high));
    if (!band.try_emplace(*place, low, high).second)
      return fail(Code::bad_input,
                  fmt::format("{}: line {}: {} {:g} comes twice; choose one band with --norm-where, "
                              "such as --norm-where group=NAME",
                              path.string(), line, at, *place));
  }
  NormBand out{.unit = std::move(*unit), .meaning = std::string(ends->meaning)};
  for (const auto& [place, pair] : band) {
    out.at.push_back(place);
    out.low.push_back(pair.first);
    out.high.push_back(pair.second);
  }
  return out;
}

Result<NormOutcome> run_norm(const NormJob& job) {
  if (auto s = check_table_name(job.output, "comparisons with a norm"); !s) return std::unexpected(s.error());
  auto groups = read_curve_groups(job.inputs, job.columns);
  if (!groups) return std::unexpected(groups.error());
  auto norm = read_norm(job.norm, groups->at_name, job.norm_where);
  if (!norm) return std::unexpected(norm.error());
  if (!norm->unit.empty() && !groups->unit.empty() && norm->unit != groups->unit)
    return fail(Code::bad_input, fmt::format("{} is in '{}', the curves are in '{}'", job.norm.string(),
                                             norm->unit, groups->unit));
  NormOutcome outcome;
  for (std::size_t g = 0; g < groups->names.size(); ++g)
    for (std::int64_t c = 0; c < groups->curves[g].count(); ++c)
      outcome.curves.push_back(compare(*norm, *groups, g, c));
  if (std::ranges::all_of(outcome.curves, [](const BesideNorm& curve) { return curve.points == 0; }))
    return fail(Code::bad_input,
                fmt::format("no point of the curves ({} {:g} to {:g}) lies within those of {} ({:g} to {:g})",
                            groups->at_name, groups->at.front(), groups->at.back(), job.norm.string(),
                            norm->at.front(), norm->at.back()));
  outcome.norm = std::move(*norm);
  outcome.unit = groups->unit;
  outcome.warnings = groups->warnings;
  auto inputs = job.inputs;
  inputs.push_back(job.norm);
  auto written =
      write_table_of_groups(job.output, inputs, job, norm_csv(outcome), norm_json(outcome), "the comparison");
  if (!written) return std::unexpected(written.error());
  outcome.written = std::move(*written);
  return outcome;
}

std::string norm_text(const NormOutcome& outcome) {
  std::string out = fmt::format("Beside the norm ({}):\n", outcome.norm.meaning);
  const std::string unit = outcome.unit.empty() ? "" : " " + outcome.unit;
  for (const auto& curve : outcome.curves) {
    const auto name = printable(curve.group + " " + curve.curve, 60);
    if (curve.points == 0)
      out += fmt::format("  {}: not compared\n", name);
    else if (curve.outside == 0)
      out += fmt::format("  {}: within at all of {} points\n", name, curve.points);
    else
      out += fmt::format("  {}: outside at {} of {} points ({}), at most {:.3g}{} {} at {:g}\n", name,
                         curve.outside, curve.points, spans_text(curve), std::abs(curve.largest), unit,
                         curve.largest > 0 ? "above" : "below", curve.largest_at);
  }
  return out;
}

std::string norm_csv(const NormOutcome& outcome) {
  std::string out = "group,curve,points,outside,share_outside,largest,largest_at,spans,unit\n";
  for (const auto& curve : outcome.curves)
    out += fmt::format(
        "{},{},{},{},{},{},{},{},{}\n", table_cell(curve.group), table_cell(curve.curve), curve.points,
        curve.outside,
        curve.points > 0 ? table_cell(static_cast<double>(curve.outside) / static_cast<double>(curve.points))
                         : "",
        table_cell(curve.largest), table_cell(curve.largest_at), table_cell(spans_text(curve)),
        table_cell(outcome.unit));
  return out;
}

nlohmann::ordered_json norm_json(const NormOutcome& outcome) {
  nlohmann::ordered_json out{{"norm", outcome.norm.meaning}, {"unit", outcome.unit}};
  out["curves"] = nlohmann::ordered_json::array();
  for (const auto& curve : outcome.curves)
    out["curves"].push_back({{"group", curve.group},
                             {"curve", curve.curve},
                             {"points", curve.points},
                             {"outside", curve.outside},
                             {"largest", json_number(curve.largest)},
                             {"largest_at", json_number(curve.largest_at)},
                             {"spans", curve.spans}});
  out["warnings"] = outcome.warnings;
  return out;
}

}  // namespace kinemark::pipeline
