// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// Positions from counts, in memory.
#pragma once

#include <cstdint>
#include <string_view>
#include <vector>

#include "kinemark/core/result.h"
#include "kinemark/data/counts.h"
#include "kinemark/data/rig.h"
#include "kinemark/data/trajectories.h"
#include "kinemark/stages/reconstruction/reconstruct.h"
#include "kinemark/stages/trajectory/from_counts/smooth_counts.h"
#include "kinemark/workflow/remarks.h"

namespace kinemark::workflow {

/// How positions come from counts.
enum class ReconstructMethod : std::uint8_t {
  smoother,  ///< every count at its own time, over the whole recording
  frames,    ///< each frame alone
  classic,   ///< look-up table and midpoint (Poizner et al. 1986)
};
[[nodiscard]] std::string_view to_string(ReconstructMethod method);  ///< "smoother", "frames", "classic"

/// Options of reconstruct().
struct ReconstructOptions {
  ReconstructMethod method = ReconstructMethod::smoother;  ///< how positions come from counts
  reconstruction::ReconstructOptions frames;               ///< of each frame; its threads are not looked at
  trajectory::SmoothCountsOptions smoother;  ///< for the smoother; its threads are not looked at
  int threads = 1;                           ///< 0: all cores. Any number gives the same bits.
};

/// What reconstruct() found.
struct Reconstructed {
  data::Trajectories
      markers;  ///< F x L with covariances, m, in the rig's world; missing where nothing was found
  data::CalibrationError
      calibration_error;  ///< of them; by the classic method with what all currents contradict
  std::vector<reconstruction::LedSummary> leds;  ///< what became of each LED's frames
  std::vector<reconstruction::LedLight> lights;  ///< of each LED; empty by the classic method
  std::vector<trajectory::LedFit> fits;          ///< how each was smoothed; empty without the smoother
  Remarks remarks;  ///< LEDs whose light is not that of the calibration, and what it changes
};

/// Positions of the LEDs of a recording. Fails as reconstruction::reconstruct(), reconstruct_classic() and
/// trajectory::smooth_counts().
[[nodiscard]] Result<Reconstructed> reconstruct(const data::Counts& counts, const data::Rig& rig,
                                                const ReconstructOptions& options = {});

}  // namespace kinemark::workflow
