// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// Curves over the course of walking cycles.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "kinemark/data/gait_event.h"
#include "kinemark/data/measure.h"
#include "kinemark/stages/analysis/gait/gait_facts.h"

namespace kinemark::analysis {

/// A series over a recording: R values.
struct CycleSeries {
  std::string id;                                   ///< of the curve: "knee_angle_r"
  data::Quantity quantity = data::Quantity::angle;  ///< decides the unit
  std::vector<double> time_s;                       ///< R, ascending, on the clock of the events
  std::vector<double> values;                       ///< R, SI; NaN where missing
  std::vector<double> sd;                           ///< R, one standard deviation; empty: not known
};

/// The series over each cycle of a foot, from strike (0 %) to strike (100 %), linear between samples. NaN
/// where a neighbouring sample is missing or more than twice the median step away. Cycles are named "Left 1",
/// ...
/// @param points  at least 2
[[nodiscard]] data::CycleCurves cut_into_cycles(const CycleSeries& series, std::span<const GaitCycle> cycles,
                                                data::Side side, std::int64_t points = 101);

/// The mean over cycles, point by point.
struct MeanCurve {
  std::vector<double> mean;          ///< P; NaN where no cycle has a value
  std::vector<double> sd;            ///< P, between cycles, N - 1; NaN of fewer than two
  std::vector<std::int64_t> cycles;  ///< P, that have a value there
};
/// Missing values are left out.
[[nodiscard]] MeanCurve mean_of_cycles(const data::CycleCurves& curves);

}  // namespace kinemark::analysis
