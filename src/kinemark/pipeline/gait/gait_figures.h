// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// A gait sheet drawn: the grid that clinicians know.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "kinemark/data/gait_event.h"
#include "kinemark/pipeline/gait/gait_sheet.h"
#include "kinemark/stages/report/figures/figure.h"

namespace kinemark::pipeline {

/// A figure of a gait report and the stem of its file.
struct GaitFigure {
  std::string name;       ///< "gait_kinematics"
  report::Figure figure;  ///< what it shows
};

/// Left is drawn through, right dashed, so that they are told apart without colour too.
[[nodiscard]] std::string_view side_colour(data::Side side);

/// A figure for each part that has a panel: gait_kinematics, gait_other_angles, gait_kinetics. In each panel
/// of both sides: every cycle thin, their mean thick, one standard deviation between cycles as a band, the
/// 95 % of the measurement's own error about the mean as dotted lines, the mean instant at which the foot
/// leaves the ground, and the norm in grey.
[[nodiscard]] std::vector<GaitFigure> gait_figures(const GaitSheet& sheet);

/// "Left: 4 cycles, toe-off at 61.5 +- 0.8 % (0.66 s)".
[[nodiscard]] std::string sentence_of(const SheetSide& foot, data::Side side);

/// The norms that a sheet shows, each once: "Schwartz 2008 (mean +- 2 SD at each point)"; empty: none.
[[nodiscard]] std::string norms_in_words(const GaitSheet& sheet);

}  // namespace kinemark::pipeline
