// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/workflow/motion/internal/calibration_note.h"

#include <fmt/core.h>

#include "kinemark/data/calibration_error.h"
#include "kinemark/data/trial.h"

namespace kinemark::workflow::internal {

std::string note_on_calibration(const data::Trial& trial, bool error_bars) {
  if (!error_bars || !trial.calibration_error.known()) return {};
  return fmt::format(
      "Deviations of coordinates hold what the calibration leaves unknown of all positions: {:.2g} mm (RMS)",
      1e3 * data::rms_of(trial.calibration_error, trial.markers));
}

}  // namespace kinemark::workflow::internal
