// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// Where the mean curves of groups differ.
#pragma once

#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "kinemark/core/result.h"
#include "kinemark/pipeline/files/job_settings.h"
#include "kinemark/pipeline/groups/curve_groups.h"
#include "kinemark/stages/analysis/groups/mapping.h"

namespace kinemark::pipeline {

/// What `kinemark groups spm` is asked to do. The seed is that of the arrangements that are drawn.
struct SpmJob : JobSettings {
  std::vector<std::filesystem::path> inputs;  ///< tables of curves
  CurveColumns columns;                       ///< of tables with names
  bool paired = false;                        ///< curves of two groups belong together by name or row
  double alpha = 0.05;                        ///< as MappingOptions
  bool one_sided = false;                     ///< only where the first group is larger
  std::int64_t arrangements = 10'000;         ///< as MappingOptions
  std::filesystem::path output;               ///< .csv or .json; empty: none
};

/// Where groups differ, and what they are.
struct SpmOutcome : JobOutcome {
  CurveGroups groups;         ///< as compared
  analysis::Mapping mapping;  ///< where they differ
};

/// Read, compare, write. One group: its mean against 0; two: the first less the second; more: one way.
/// Code::usage as MappingOptions::check() and read_curve_groups(); Code::bad_input as the readers,
/// pair_curves() and map_curves(). Exit status 0 whether a difference is found or not.
[[nodiscard]] Result<SpmOutcome> run_spm(const SpmJob& job);

/// For people: what was compared, the threshold, and where the curves differ.
[[nodiscard]] std::string spm_text(const SpmOutcome& outcome);
/// A line a point: where, mean and SD of each group, statistic, threshold, whether it is beyond.
[[nodiscard]] std::string spm_csv(const SpmOutcome& outcome);
/// All of it.
[[nodiscard]] nlohmann::ordered_json spm_json(const SpmOutcome& outcome);

}  // namespace kinemark::pipeline
