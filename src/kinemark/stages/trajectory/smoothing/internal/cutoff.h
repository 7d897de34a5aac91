// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "kinemark/stages/trajectory/smoothing/smooth.h"

namespace kinemark::trajectory::smoothing {

/// Input of the cut-off rules: columns (one per stretch and axis) of evenly spaced positions.
struct CutoffProblem {
  std::vector<std::vector<double>> columns;
  int order = 2;
  double rate_hz = 0.0;
};

/// One Butterworth filter forwards and backwards. `corrected`: cutoff_hz is that of both passes together and
/// the ends are continued for as long as the filter remembers; else of one pass, with the usual padding.
void butterworth(std::vector<double>& x, int order, double cutoff_hz, double rate_hz, bool corrected);

/// Residual analysis: RMS residual against cut-off; the straight line through the upper 40 % of it, where
/// only noise is left, meets zero frequency at the residual that noise alone would leave; the cut-off that
/// has it. Winter (2009), Biomechanics and Motor Control of Human Movement, section 3.4.
[[nodiscard]] double winter_cutoff_hz(const CutoffProblem& problem);

/// The cut-off whose residual has the least autocorrelation, lags 1 to 10 squared and summed.
/// Challis (1999), J. Appl. Biomech. 15(3):303-317.
[[nodiscard]] double challis_cutoff_hz(const CutoffProblem& problem);

}  // namespace kinemark::trajectory::smoothing
