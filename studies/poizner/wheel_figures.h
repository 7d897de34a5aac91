// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "studies/common/study_figure.h"
#include "studies/poizner/study_poizner_job.h"

namespace kinemark::studies {

/// Figures 4 and 5 of Poizner, Wooten & Salot (1986), of the study's first rig and wheel: displacement of the
/// wheel's LED along each axis, and its path in a box with the plane that fits best, axes of 100 mm and a
/// summary. Numbers are rows of the table.
[[nodiscard]] std::vector<StudyFigure> wheel_figures(const PoiznerStudy& study);

}  // namespace kinemark::studies
