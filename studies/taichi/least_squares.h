// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string>

#include "kinemark/data/model_description.h"
#include "kinemark/data/trajectories.h"
#include "kinemark/model/model.h"
#include "kinemark/stages/motion/ik.h"

namespace kinemark::studies {

/// Options of inverse kinematics for the landmarks: no limits, weak coordinate tasks towards zero for what
/// the landmarks do not determine (1e-6 m^2/rad^2; clavicles 1e-3, because both landmarks of the trunk lie on
/// one axis and the rotation about it would otherwise be free).
/// @param landmarks  only these count; all when empty
[[nodiscard]] motion::IkOptions landmark_ik_options(const data::ModelDescription& model,
                                                    std::span<const std::string> landmarks = {});

/// The same to stand beside direct marker control: within the limits of clamped coordinates, and with tasks so
/// weak (a thousandth of those) that they move nothing that the landmarks determine.
[[nodiscard]] motion::IkOptions reference_ik_options(const data::ModelDescription& model,
                                                     std::span<const std::string> landmarks = {});

/// Positions of the model's landmarks in every frame of a motion, which are reachable goals. Named and timed
/// as the motion.
[[nodiscard]] data::Trajectories carried_landmarks(const model::Model& model,
                                                   const data::JointMotion& motion);

/// Root mean square distance (three-dimensional, m) of measured and model landmarks over frames [first,
/// last).
[[nodiscard]] double landmark_rms(const data::JointMotion& motion, std::int64_t first, std::int64_t last);
[[nodiscard]] double landmark_max(const data::JointMotion& motion);

}  // namespace kinemark::studies
