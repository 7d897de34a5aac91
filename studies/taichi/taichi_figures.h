// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "studies/common/study_page.h"
#include "studies/taichi/study_taichi.h"

namespace kinemark::studies {

/// The paper's figures 2 to 4 drawn again from the first subject, and the table: joint angles by control of
/// the whole and the upper body and of four landmarks beside least squares; landmarks beside their goals;
/// margins of landmark error and of joint error with its bound. The study needs one subject or more.
[[nodiscard]] StudyPage taichi_page(const TaiChiStudy& study);

}  // namespace kinemark::studies
