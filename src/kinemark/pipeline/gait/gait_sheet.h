// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// What a gait report shows, in numbers: each curve over the cycle of both feet, its mean, how cycles differ,
// how exact each is, and where the norm lies.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "kinemark/core/missing.h"
#include "kinemark/data/measure.h"
#include "kinemark/pipeline/gait/gait_norms.h"
#include "kinemark/pipeline/gait/gait_quantities.h"
#include "kinemark/stages/analysis/gait/gait.h"

namespace kinemark::pipeline {

/// A curve of one side that goes in.
struct SheetInput {
  data::CycleCurves curves;  ///< N cycles, P points
  std::string unit;          ///< that its values are in; empty: SI units, shown in those of the quantity
};

/// A curve of one side, N cycles at P points, in the panel's unit.
struct SheetCurve {
  std::string id;             ///< "LKneeAngles x"
  Eigen::MatrixXd values;     ///< P x N; NaN where not measured
  Eigen::MatrixXd sd;         ///< P x N, of each value by its measurement; no columns: not known
  Eigen::VectorXd mean;       ///< P, over the cycles that have a value there
  Eigen::VectorXd between;    ///< P, one standard deviation between cycles, N - 1; NaN of fewer than two
  Eigen::VectorXd own;        ///< P, root mean square of `sd` over the cycles; NaN where not known
  Eigen::VectorXi count;      ///< P, cycles that have a value
  Eigen::MatrixX3d norm;      ///< P x 3, low, high, mean of the norm; NaN where it has none; no rows: no norm
  std::string norm_source;    ///< who says so; empty without norm
  std::string norm_meaning;   ///< what its ends are
  double not_measured = 0.0;  ///< share of the values, 0 to 1

  [[nodiscard]] bool empty() const { return not_measured >= 1.0; }  ///< no value at all
};

/// One pair of axes.
struct SheetPanel {
  GaitQuantity what;                               ///< title and direction; its side means nothing
  std::string unit;                                ///< "deg"
  std::array<std::optional<SheetCurve>, 2> sides;  ///< left, right
  bool mirrored = false;  ///< it counts one way for both sides, which so mirror each other
};

/// What cycles of a foot have in common.
struct SheetSide {
  std::int64_t cycles = 0;  ///< from strike to strike
  double off_share = kNaN;  ///< mean share of the cycle at which it leaves the ground, 0 to 1; NaN: not seen
  double off_s = kNaN;      ///< mean time from strike to leaving, s
  double off_sd_share = kNaN;  ///< between cycles, N - 1; NaN of fewer than two
};

/// A gait report in numbers.
struct GaitSheet {
  std::string trial;                    ///< name for people
  std::vector<SheetPanel> panels;       ///< in the order in which they are drawn
  std::array<SheetSide, 2> feet;        ///< left, right
  std::vector<data::GaitEvent> events;  ///< ascending in time
  std::vector<data::Measure> measures;  ///< of walking
  std::vector<NormMeasure> norms;       ///< of measures
  bool treadmill = false;               ///< lengths are on a belt
  std::vector<std::string> remarks;     ///< what is not there, and why; one sentence each
};

/// Lay out a report. Curves of one name, left and right, share a panel; panels stand in the order of
/// the grid that clinicians know, then as they come. A curve whose name tells the other side than its cycles
/// is left out, and so are curves that are neither angles nor kinetics of the legs. Remarks tell of a foot
/// without cycles, of one cycle that has no deviation, of curves without a value, of norms that fit no curve,
/// that tell no side where one is needed, or are in other units.
[[nodiscard]] GaitSheet make_gait_sheet(const std::string& trial, const std::vector<SheetInput>& curves,
                                        const analysis::Gait& gait, const GaitNorms& norms);

/// The panel that a name stands for: key, title, or name of a curve, with or without its side; null: none.
[[nodiscard]] const SheetPanel* find_panel(const GaitSheet& sheet, const std::string& name);

}  // namespace kinemark::pipeline
