// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "studies/common/study_page.h"
#include "studies/poizner/study_poizner_job.h"

namespace kinemark::studies {

/// One self-contained page: the table, and for the first seed the wheel in its best-fit plane with its box,
/// its displacement through time, the arm's four paths, speed and acceleration of the hand; of rigs as built,
/// errors of distances over the room. The study needs one seed or more.
[[nodiscard]] StudyPage study_page(const PoiznerStudy& study);

}  // namespace kinemark::studies
