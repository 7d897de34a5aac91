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

/// The same to stand beside direct marker control: within the limits of clamped coordinates, and with tasks
/// so weak (a millionth of those) that they move nothing that the landmarks determine.
[[nodiscard]] motion::IkOptions reference_ik_options(const data::ModelDescription& model,
                                                     std::span<const std::string> landmarks = {});

/// Least squares with those options: from the first frame to the last, from the last to the first, and, where
/// a coordinate comes near a limit, from many starts; in each frame the pose that fits best. From its
/// neighbour alone a frame can hold to a poorer fit, where a stretched arm has turned about itself.
[[nodiscard]] Result<motion::IkResult> reference_ik(const model::Model& model,
                                                    const data::Trajectories& goals,
                                                    const motion::IkOptions& options);

/// Positions of the model's landmarks in every frame of a motion, which are reachable goals. Named and timed
/// as the motion.
[[nodiscard]] data::Trajectories carried_landmarks(const model::Model& model,
                                                   const data::JointMotion& motion);

/// Root mean square distance (three-dimensional, m) of measured and model landmarks over frames [first,
/// last).
[[nodiscard]] double landmark_rms(const data::JointMotion& motion, std::int64_t first, std::int64_t last);
[[nodiscard]] double landmark_max(const data::JointMotion& motion);

}  // namespace kinemark::studies
