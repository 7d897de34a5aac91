// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/pipeline/groups/band_job.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <utility>

#include "kinemark/pipeline/groups/groups_tables.h"

namespace kinemark::pipeline {
namespace {

// The widest half of a band, and where it is.
struct Widest {
  double half = 0.0;
  std::size_t point = 0;
};

template <class Half>
Widest widest(const analysis::MeanBand& band, const Half& half) {
  Widest out;
  for (std::size_t p = 0; p < band.mean.size(); ++p)
    if (const double h = half(p); h > out.half) out = {h, p};
  return out;
}

}  // namespace

Result<BandOutcome> run_band(const BandJob& job) {
  if (auto s = check_table_name(job.output, "bands"); !s) return std::unexpected(s.error());
  auto groups = read_curve_groups(job.inputs, job.columns);
  if (!groups) return std::unexpected(groups.error());
  BandOutcome outcome;
  for (std::size_t g = 0; g < groups->names.size(); ++g) {
    auto band = analysis::mean_band(groups->curves[g], job.level);
    if (!band)
      return fail(band.error().code, fmt::format("group '{}': {}", groups->names[g], band.error().message));
    outcome.bands.push_back(std::move(*band));
  }
  outcome.groups = std::move(*groups);
  outcome.warnings = outcome.groups.warnings;
  auto written =
      write_table_of_groups(job.output, job.inputs, job, band_csv(outcome), band_json(outcome), "the bands");
  if (!written) return std::unexpected(written.error());
  outcome.written = std::move(*written);
  return outcome;
}

std::string band_text(const BandOutcome& outcome) {
  std::string out;
  const auto& groups = outcome.groups;
  const std::string unit = groups.unit.empty() ? "" : " " + groups.unit;
  for (std::size_t g = 0; g < outcome.bands.size(); ++g) {
    const auto& band = outcome.bands[g];
    if (band.not_tested == std::ssize(groups.at)) {
      out += fmt::format("{}: {} curves have no band: at each of the {} points a curve is missing\n",
                         groups.names[g], band.curves, groups.at.size());
      continue;
    }
    const auto mean = widest(band, [&](std::size_t p) { return band.of_mean(p); });
    const auto one = widest(band, [&](std::size_t p) { return band.of_one(p); });
    out += fmt::format(
        "{}: {} curves, {} points; at all points at once with {:g} %: the mean curve within {:.3g}{}, "
        "a further curve within {:.3g}{} (widest at {} {:g})\n",
        groups.names[g], band.curves, groups.at.size(), 100.0 * band.level, mean.half, unit, one.half, unit,
        groups.at_name, groups.at[one.point]);
    if (band.not_tested > 0)
      out += fmt::format("  {} points have no band: a curve is missing there\n", band.not_tested);
  }
  return out;
}

std::string band_csv(const BandOutcome& outcome) {
  const auto& groups = outcome.groups;
  std::string out = fmt::format("group,{},mean,sd,curves,low,high,one_low,one_high,unit\n", groups.at_name);
  for (std::size_t g = 0; g < outcome.bands.size(); ++g) {
    const auto& band = outcome.bands[g];
    for (std::size_t p = 0; p < groups.at.size(); ++p) {
      const double mean = band.mean[p], of_mean = band.of_mean(p), of_one = band.of_one(p);
      out += fmt::format("{},{},{},{},{},{},{},{},{},{}\n", table_cell(groups.names[g]),
                         table_cell(groups.at[p]), table_cell(mean), table_cell(band.sd[p]), band.curves,
                         table_cell(mean - of_mean), table_cell(mean + of_mean), table_cell(mean - of_one),
                         table_cell(mean + of_one), table_cell(groups.unit));
    }
  }
  return out;
}

nlohmann::ordered_json band_json(const BandOutcome& outcome) {
  const auto& groups = outcome.groups;
  nlohmann::ordered_json out{
      {"unit", groups.unit}, {"at_name", groups.at_name}, {"at", json_numbers(groups.at)}};
  out["groups"] = nlohmann::ordered_json::array();
  for (std::size_t g = 0; g < outcome.bands.size(); ++g) {
    const auto& band = outcome.bands[g];
    std::vector<double> of_mean, of_one;
    for (std::size_t p = 0; p < groups.at.size(); ++p) {
      of_mean.push_back(band.of_mean(p));
      of_one.push_back(band.of_one(p));
    }
    out["groups"].push_back({{"name", groups.names[g]},
                             {"curves", groups.curves[g].cycles},
                             {"level", band.level},
                             {"factor", json_number(band.factor)},
                             {"mean", json_numbers(band.mean)},
                             {"sd", json_numbers(band.sd)},
                             {"half_width_of_mean", json_numbers(of_mean)},
                             {"half_width_of_one", json_numbers(of_one)},
                             {"not_tested", band.not_tested}});
  }
  out["warnings"] = outcome.warnings;
  return out;
}

}  // namespace kinemark::pipeline
