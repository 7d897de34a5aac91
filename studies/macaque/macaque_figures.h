// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "kinemark/core/result.h"
#include "studies/common/study_page.h"
#include "studies/macaque/study_macaque_job.h"

namespace kinemark::studies {

/// The report's figures 1 to 7 from our own data, then errors of staggered markers and the share of frames
/// with an answer, which it has not; of the report's own reading, figure 6 alone. Single recordings are of
/// the first seed. The study needs one seed or more.
[[nodiscard]] Result<StudyPage> macaque_page(const MacaqueStudy& study);

}  // namespace kinemark::studies
