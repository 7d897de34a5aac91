// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "kinemark/core/result.h"
#include "studies/common/study_figure.h"

namespace kinemark::studies {

/// Figures 1 to 3 of Poizner, Wooten & Salot (1986) from the rig that `seed` draws: its components with the
/// LEDs on the arm of the simulated signer, the control signals of a frame, and the timing of one LED's slot,
/// both from the conversion times of a recording.
[[nodiscard]] Result<std::vector<StudyFigure>> rig_figures(std::uint64_t seed);

}  // namespace kinemark::studies
