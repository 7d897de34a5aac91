// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "kinemark/pipeline/poizner/study_poizner_job.h"

namespace kinemark::pipeline {

/// The table of the study, each line with its bound. Empty without seeds.
[[nodiscard]] std::vector<StudyRow> study_rows(const std::vector<PoiznerSeed>& seeds);

}  // namespace kinemark::pipeline
