// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "studies/macaque/study_macaque_job.h"

namespace kinemark::studies {

/// The report's figures 6 and 7 redrawn: the elbow's error against noise and against the missing share, by
/// every method with the bound; the share of frames determined; the arm and the sleeve in three dimensions,
/// black with a grey shadow, markers coloured; and the table. Pictures of single frames are of the first
/// seed. The study needs one seed or more.
[[nodiscard]] Result<StudyPage> macaque_page(const MacaqueStudy& study);

}  // namespace kinemark::studies
