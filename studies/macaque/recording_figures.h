// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "kinemark/core/result.h"
#include "studies/common/study_figure.h"

namespace kinemark::studies {

/// Duration of the sleeve's recording that the figures draw, s.
inline constexpr double kSleeveFigure_s = 8.0;

/// Figures 1 to 4 of the macaque report, of a simulated sleeve: the animal among its cameras (1), the sleeve
/// and its LEDs (2), the distances from a joint to the LEDs, which stay (3), and what is recorded: which LEDs
/// are seen, and the stream of 240 Hz between the cameras' 60 (4).
[[nodiscard]] Result<std::vector<StudyFigure>> recording_figures(std::uint64_t seed);

/// Figure 7: the arm of recorded markers, as `kinemark joints --figures` draws it of what `kinemark simulate
/// macaque --tip` makes with the same seed and duration.
[[nodiscard]] Result<StudyFigure> recorded_arm(std::uint64_t seed);

}  // namespace kinemark::studies
