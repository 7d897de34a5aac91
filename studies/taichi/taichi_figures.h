// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "studies/common/study_page.h"
#include "studies/taichi/study_taichi.h"

namespace kinemark::studies {

/// The paper's figures 1 to 4 from the first subject, and the table: the controlled body with both subsets of
/// landmarks, angles of both arms, the four landmarks beside their goals along all axes, margins of landmark
/// error and the largest and smallest joint error of equation 17. The study needs one subject or more.
[[nodiscard]] StudyPage taichi_page(const TaiChiStudy& study);

}  // namespace kinemark::studies
