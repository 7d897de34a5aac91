// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "studies/poizner/study_poizner_job.h"

namespace kinemark::studies {

/// The table of the study, each line with its bound. Empty without seeds.
[[nodiscard]] std::vector<StudyRow> study_rows(const std::vector<PoiznerSeed>& seeds);

}  // namespace kinemark::studies
