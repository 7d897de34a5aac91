// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// Curves beside a normative band from a file.
#pragma once

#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "kinemark/core/missing.h"
#include "kinemark/core/result.h"
#include "kinemark/pipeline/files/job_settings.h"
#include "kinemark/pipeline/groups/curve_groups.h"

namespace kinemark::pipeline {

/// What `kinemark groups norm` is asked to do.
struct NormJob : JobSettings {
  std::filesystem::path norm;                 ///< the band: see read_norm()
  std::vector<std::string> norm_where;        ///< rows_where() of the band's table
  std::vector<std::filesystem::path> inputs;  ///< tables of curves
  CurveColumns columns;                       ///< of tables with names
  std::filesystem::path output;               ///< .csv or .json; empty: none
};

/// A band at points.
struct NormBand {
  std::vector<double> at;         ///< P, rising
  std::vector<double> low, high;  ///< P
  std::string unit;               ///< empty: not told
  std::string meaning;            ///< what the ends are, for people: "mean +- 2 SD at each point"
};

/// A curve beside the band.
struct BesideNorm {
  std::string group, curve;  ///< whose it is
  std::int64_t points = 0;   ///< compared
  std::int64_t outside = 0;  ///< of them, beyond the band
  double largest = kNaN;     ///< beyond an end, with its sign: above +, below -; NaN: nowhere
  double largest_at = kNaN;  ///< where
  std::vector<std::pair<double, double>> spans;  ///< outside, from and to the points' places
};

/// What was compared with what.
struct NormOutcome : JobOutcome {
  NormBand norm;                   ///< as read
  std::string unit;                ///< of the curves
  std::vector<BesideNorm> curves;  ///< in the order of the groups
};

/// A band: columns percent (or `at`) and one_low, one_high as `groups band` writes them; or low, high; or
/// mean, sd, whose band is two deviations wide to each side. Code::bad_input where none of these is there,
/// numbers are missing, a point comes twice, or low is above high.
[[nodiscard]] Result<NormBand> read_norm(const std::filesystem::path& path, const std::string& at,
                                         const std::vector<std::string>& where);

/// Read, compare at the curves' points within the band's (ends interpolated linearly), write. Code::bad_input
/// as the readers, where units differ, and where no point is within the band's.
[[nodiscard]] Result<NormOutcome> run_norm(const NormJob& job);

/// For people, a line a curve.
[[nodiscard]] std::string norm_text(const NormOutcome& outcome);
/// A line a curve.
[[nodiscard]] std::string norm_csv(const NormOutcome& outcome);
/// All of it.
[[nodiscard]] nlohmann::ordered_json norm_json(const NormOutcome& outcome);

}  // namespace kinemark::pipeline
