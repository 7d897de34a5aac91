// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// The person who does tai chi: kinemark's human with the 21 landmarks, sized to a recording or drawn.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "kinemark/core/result.h"
#include "kinemark/data/joint_motion.h"
#include "kinemark/data/model_description.h"
#include "kinemark/data/trajectories.h"

namespace kinemark::studies {

/// Coordinates that the landmarks do not move: both pro_sup and both mtp_angle.
[[nodiscard]] std::vector<std::string> unseen_coordinates();

struct TaiChiModelOptions {
  bool lock_unseen = false;  ///< lock unseen_coordinates(): 36 of 40 are left
  double mass_kg = 75.0;     ///< of the whole body, > 0; not known from the recording
};

/// The human model with the landmarks as its only markers, at the joint centres of the model as it is.
/// `human`: kinemark's own (models/human.osim). Fails when a body or joint is not there.
[[nodiscard]] Result<data::ModelDescription> with_landmarks(const data::ModelDescription& human,
                                                            const TaiChiModelOptions& options = {});

/// with_landmarks(), sized by medians of landmark distances, each side on its own: thighs, shanks, upper arms
/// and forearms keep their direction and take the median length; hips come from the triangle of pelvis and
/// hips, the trunk from pelvis, thorax and neck, shoulders from their mean position along the trunk, head,
/// hands and feet from their landmarks. Mass centres and moments of inertia grow with the segments.
///
/// @param landmarks  of prepare_landmarks(), y up
[[nodiscard]] Result<data::ModelDescription> scale_by_medians(const data::ModelDescription& human,
                                                              const data::Trajectories& landmarks,
                                                              const TaiChiModelOptions& options = {});

/// A simulated recording of the landmarks, for where the real one is absent.
struct SimulatedTaiChi {
  data::Trajectories landmarks;  ///< y up, 60 Hz, nothing missing
  data::JointMotion truth;
};
/// 16.7 s of tai chi by a subject whose segments were drawn: every length 4 % (SD) from the human model's.
/// Landmarks move against the bones by half of what skin markers do, plus 1 mm per axis.
[[nodiscard]] Result<SimulatedTaiChi> simulate_tai_chi(const data::ModelDescription& human,
                                                       std::uint64_t seed);

}  // namespace kinemark::studies
