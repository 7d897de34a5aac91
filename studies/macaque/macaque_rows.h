// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <vector>

#include "studies/macaque/study_macaque_job.h"

namespace kinemark::studies {

/// The table of the study, each line with its bound; lines whose cells were not asked for are left out. With
/// three seeds or more their errors together are held against 1.1 times the Cramer-Rao bound and on the arm
/// each seed's against 1.15; with fewer, errors against 1.15 and shares of frames against nothing.
[[nodiscard]] std::vector<StudyRow> macaque_rows(const MacaqueStudy& study, std::size_t seeds);

}  // namespace kinemark::studies
