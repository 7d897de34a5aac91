// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// Mean curves of groups with bands that hold over the whole curve.
#pragma once

#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "kinemark/core/result.h"
#include "kinemark/pipeline/files/job_settings.h"
#include "kinemark/pipeline/groups/curve_groups.h"
#include "kinemark/stages/analysis/groups/mean_band.h"

namespace kinemark::pipeline {

/// What `kinemark groups band` is asked to do.
struct BandJob : JobSettings {
  std::vector<std::filesystem::path> inputs;  ///< tables of curves
  CurveColumns columns;                       ///< of tables with names
  double level = 0.95;                        ///< as mean_band()
  std::filesystem::path output;               ///< .csv or .json; empty: none
};

/// A band for each group.
struct BandOutcome : JobOutcome {
  CurveGroups groups;                     ///< as read
  std::vector<analysis::MeanBand> bands;  ///< of each group
};

/// Read, average, write. Code::usage and Code::bad_input as read_curve_groups() and mean_band(), with the
/// group's name.
[[nodiscard]] Result<BandOutcome> run_band(const BandJob& job);

/// For people, a line a group.
[[nodiscard]] std::string band_text(const BandOutcome& outcome);
/// A line for each group and point: group, where, mean, sd, curves, low and high of the mean curve's band,
/// one_low and one_high of the band of one further curve, which `groups norm` reads.
[[nodiscard]] std::string band_csv(const BandOutcome& outcome);
/// All of it.
[[nodiscard]] nlohmann::ordered_json band_json(const BandOutcome& outcome);

}  // namespace kinemark::pipeline
