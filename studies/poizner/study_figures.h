// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "studies/common/study_page.h"
#include "studies/poizner/study_poizner_job.h"

namespace kinemark::studies {

/// The table, and the paper's figures 1 to 6 from the first rig; of rigs as built, errors of distances over
/// the room. The study needs one seed or more.
[[nodiscard]] Result<StudyPage> study_page(const PoiznerStudy& study);

}  // namespace kinemark::studies
