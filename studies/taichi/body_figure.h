// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "studies/common/study_figure.h"
#include "studies/taichi/study_taichi.h"

namespace kinemark::studies {

inline constexpr const char* kDemircan = "Demircan 2008";  ///< of the figures' titles

/// Landmarks of a tracked body, goals less what is left of them: frames x landmarks, columns of x, y, z (m, y
/// up). Landmarks that the track does not have are NaN.
[[nodiscard]] data::Trajectories tracked_landmarks(const data::Trajectories& goals,
                                                   const data::JointMotion& motion, std::int64_t first_frame);

/// Figure 1 of Demircan, Sentis, De Sapio & Khatib (2008): the body that control moves, in three postures of
/// the form, with the landmarks of the first subset dark and those of the second light.
[[nodiscard]] StudyFigure controlled_body(const TaiChiDrawing& drawing);

}  // namespace kinemark::studies
