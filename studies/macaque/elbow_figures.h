// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "kinemark/core/result.h"
#include "studies/common/study_figure.h"
#include "studies/macaque/study_macaque_job.h"

namespace kinemark::studies {

/// Figure 5 of the macaque report: the simulated arm, its true elbow and where the report's method and ours
/// find it, in the frame whose error by the report's method is the median of all.
[[nodiscard]] Result<StudyFigure> simulated_arm(const MacaqueStudy& study, std::uint64_t seed);

/// Figure 6: error of the elbow against noise and against the missing share, with the report's own numbers.
/// staggered: the same of markers beside the bone, which the report does not have.
[[nodiscard]] StudyFigure elbow_errors(const MacaqueStudy& study, bool staggered);

/// Figure 6 by the report's own reading: mean errors of its method and of ours.
[[nodiscard]] StudyFigure published_errors(const MacaqueStudy& study);

/// Share of frames that each method answers, against the missing share.
[[nodiscard]] StudyFigure frames_answered(const MacaqueStudy& study);

}  // namespace kinemark::studies
