// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/pipeline/groups/spm_job.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <nlohmann/json.hpp>
#include <tuple>
#include <utility>

#include "kinemark/pipeline/groups/groups_tables.h"

namespace kinemark::pipeline {
namespace {

using analysis::Design;

Design design_of(const SpmJob& job, std::size_t groups) {
  if (job.paired) return Design::paired;
  if (groups == 1) return Design::one_sample;
  return groups == 2 ? Design::two_sample : Design::one_way;
}

// What is so if nothing is to be found.
std::string_view null_of(const analysis::Mapping& mapping) {
  return mapping.options.design == Design::one_sample ? "the mean is 0 everywhere"
                                                      : "the groups do not differ";
}

// Where a place between points lies, on the scale of the curves.
double place(const CurveGroups& groups, double point) {
  const auto last = static_cast<double>(groups.at.size() - 1);
  const double at = std::clamp(point, 0.0, last);
  const auto below = static_cast<std::size_t>(std::min(at, last - 1.0));
  return groups.at[below] + (at - static_cast<double>(below)) * (groups.at[below + 1] - groups.at[below]);
}

std::string compared(const SpmOutcome& outcome) {
  const auto& groups = outcome.groups;
  std::vector<std::string> parts;
  for (std::size_t g = 0; g < groups.names.size(); ++g)
    parts.push_back(fmt::format("{} ({} curves)", groups.names[g], groups.curves[g].count()));
  const auto design = std::string(analysis::to_string(outcome.mapping.options.design));
  return fmt::format("{}{}: {}; {} points", static_cast<char>(std::toupper(design.front())), design.substr(1),
                     fmt::join(parts, ", "), groups.at.size());
}

double largest(const analysis::Mapping& mapping) {
  double out = kNaN;
  const bool magnitude = mapping.statistic == "F" || mapping.options.two_sided;
  for (const double value : mapping.values)
    if (!std::isnan(value) && !(magnitude ? std::abs(value) <= std::abs(out) : value <= out)) out = value;
  return out;
}

std::string degrees_of_freedom(const analysis::Mapping& mapping) {
  return mapping.statistic == "F" ? fmt::format("F({}, {})", mapping.effect_df, mapping.error_df)
                                  : fmt::format("t({})", mapping.error_df);
}

}  // namespace

Result<SpmOutcome> run_spm(const SpmJob& job) {
  analysis::MappingOptions options{
      .alpha = job.alpha, .two_sided = !job.one_sided, .arrangements = job.arrangements, .seed = job.seed};
  if (auto s = options.check(); !s) return std::unexpected(s.error());
  if (auto s = check_table_name(job.output, "statistics of curves"); !s) return std::unexpected(s.error());
  auto groups = read_curve_groups(job.inputs, job.columns);
  if (!groups) return std::unexpected(groups.error());
  if (job.paired)
    if (auto s = pair_curves(*groups); !s) return std::unexpected(s.error());
  options.design = design_of(job, groups->names.size());
  if (job.one_sided && options.design == Design::one_way)
    return fail(Code::usage, fmt::format("F has no sides: --one-sided takes one group or two; there are {}",
                                         groups->names.size()));
  auto mapping = analysis::map_curves(groups->curves, options);
  if (!mapping) return std::unexpected(mapping.error());
  SpmOutcome outcome;
  outcome.groups = std::move(*groups);
  outcome.mapping = std::move(*mapping);
  outcome.warnings = outcome.groups.warnings;
  auto written = write_table_of_groups(job.output, job.inputs, job, spm_csv(outcome), spm_json(outcome),
                                       "the statistics");
  if (!written) return std::unexpected(written.error());
  outcome.written = std::move(*written);
  return outcome;
}

std::string spm_text(const SpmOutcome& outcome) {
  const auto& mapping = outcome.mapping;
  std::string out = compared(outcome) + "\n";
  if (!mapping.remark.empty()) return out + fmt::format("Nothing can be found: {}.\n", mapping.remark);
  const bool magnitude = mapping.statistic == "t" && mapping.options.two_sided;
  out += fmt::format(
      "{} beyond {}{:.4g} anywhere with probability {:g} at most if {} ({} of {:.6g} arrangements, seed "
      "{})\n",
      degrees_of_freedom(mapping), magnitude ? "+-" : "", mapping.threshold, mapping.options.alpha,
      null_of(mapping), mapping.arrangements, mapping.possible, mapping.options.seed);
  for (const auto& span : mapping.spans)
    out += fmt::format("  {} {:.4g} to {:.4g}: {} up to {:.3g}, p = {:.3g}\n", outcome.groups.at_name,
                       place(outcome.groups, span.first), place(outcome.groups, span.last), mapping.statistic,
                       span.extreme, span.p);
  if (mapping.spans.empty())
    out += fmt::format("No difference{} is found: largest {} {:.3g}, p = {:.3g}\n",
                       mapping.options.design == Design::one_sample ? " from 0" : "", mapping.statistic,
                       largest(mapping), mapping.p);
  if (mapping.not_tested > 0)
    out += fmt::format("{} points are not tested: a curve is missing there, or all are equal\n",
                       mapping.not_tested);
  return out;
}

std::string spm_csv(const SpmOutcome& outcome) {
  const auto& [groups, mapping] = std::tie(outcome.groups, outcome.mapping);
  std::string out = groups.at_name;
  std::vector<PointMeans> means;
  for (std::size_t g = 0; g < groups.names.size(); ++g) {
    out += fmt::format(",{},{}", table_cell("mean " + groups.names[g]), table_cell("sd " + groups.names[g]));
    means.push_back(point_means(groups.curves[g]));
  }
  out += fmt::format(",{},threshold,beyond\n", mapping.statistic);
  for (std::size_t p = 0; p < groups.at.size(); ++p) {
    out += table_cell(groups.at[p]);
    for (const auto& mean : means)
      out += fmt::format(",{},{}", table_cell(mean.mean[p]), table_cell(mean.sd[p]));
    const bool beyond = std::ranges::any_of(mapping.spans, [&](const auto& span) {
      const auto at = static_cast<double>(p);
      return at >= span.first && at <= span.last;
    });
    out += fmt::format(",{},{},{}\n", table_cell(mapping.values[p]), table_cell(mapping.threshold),
                       std::isnan(mapping.values[p]) ? ""
                       : beyond                      ? "yes"
                                                     : "no");
  }
  return out;
}

nlohmann::ordered_json spm_json(const SpmOutcome& outcome) {
  const auto& [groups, mapping] = std::tie(outcome.groups, outcome.mapping);
  nlohmann::ordered_json out{{"design", analysis::to_string(mapping.options.design)},
                             {"statistic", mapping.statistic},
                             {"effect_df", mapping.effect_df},
                             {"error_df", mapping.error_df},
                             {"alpha", mapping.options.alpha},
                             {"two_sided", mapping.options.two_sided},
                             {"threshold", json_number(mapping.threshold)},
                             {"p", json_number(mapping.p)},
                             {"arrangements", mapping.arrangements},
                             {"possible_arrangements", json_number(mapping.possible)},
                             {"seed", mapping.options.seed},
                             {"unit", groups.unit}};
  out["spans"] = nlohmann::ordered_json::array();
  for (const auto& span : mapping.spans)
    out["spans"].push_back({{"first", place(groups, span.first)},
                            {"last", place(groups, span.last)},
                            {"extreme", json_number(span.extreme)},
                            {"integral", json_number(span.integral)},
                            {"p", json_number(span.p)}});
  out["not_tested"] = mapping.not_tested;
  if (!mapping.remark.empty()) out["remark"] = mapping.remark;
  out["at_name"] = groups.at_name;
  out["at"] = json_numbers(groups.at);
  out["values"] = json_numbers(mapping.values);
  out["groups"] = nlohmann::ordered_json::array();
  for (std::size_t g = 0; g < groups.names.size(); ++g) {
    const auto means = point_means(groups.curves[g]);
    out["groups"].push_back({{"name", groups.names[g]},
                             {"curves", groups.curves[g].cycles},
                             {"mean", json_numbers(means.mean)},
                             {"sd", json_numbers(means.sd)}});
  }
  out["warnings"] = outcome.warnings;
  return out;
}

}  // namespace kinemark::pipeline
