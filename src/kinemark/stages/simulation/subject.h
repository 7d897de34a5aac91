// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// A simulated moving person: the recording of a laboratory, and the truth.
#pragma once

#include "kinemark/core/result.h"
#include "kinemark/data/joint_motion.h"
#include "kinemark/data/trajectories.h"
#include "kinemark/model/model.h"
#include "kinemark/stages/simulation/subject_options.h"

namespace kinemark::simulation {

/// A recording of a simulated subject, and the truth.
struct SimulatedSubject {
  data::Trajectories markers;       ///< as recorded: soft tissue, noise, gaps; measured or missing
  data::Trajectories true_markers;  ///< as carried by rigid bones; nothing missing
  data::JointMotion truth;  ///< coordinates; q_sd 0, all determined; marker_error = recorded minus true
};

/// Simulate one recording of all markers of a model, from time 0.
///
/// Clamped coordinates stay 5 % of their width inside their range, locked ones stay at their default value,
/// coupled ones follow; loop constraints (point constraints) are not enforced. Fails when the options do not
/// hold or the model has no markers. O(frames markers), with dropout_sight times cameras and segments: about
/// 0.1 s for 10 s of a whole body.
///
/// Random numbers: Random(seed, what * 2^32 + which), so that each part keeps its values when others change.
/// what: 1 motion (which: coordinate), 2 motion of the root, 3 noise (marker; six draws per frame), 4 soft
/// tissue of a marker, 5 of a segment, 6 instants of impact, 7 random gaps, 8 cameras.
[[nodiscard]] Result<SimulatedSubject> simulate_subject(const model::Model& model,
                                                        const SubjectOptions& options = {});

/// Root mean square displacement (m, three-dimensional) of every marker on soft tissue at scale 1.
///
/// 2 mm + 13 mm * flesh * place. flesh: mass per length of the rigid segment between its joints over 17 kg/m
/// (a thigh), at most 1; 0 for segments that carry no other joint (head, hand, toes); 0.3 where several
/// joints meet (pelvis, trunk). place: 0.45 at a joint to 1 at 0.35 segment lengths from the next joint; 1 on
/// pelvis and trunk. Orders of magnitude as reported for skin markers against bone (Leardini et al. 2005,
/// Gait & Posture 21:212; Cappozzo et al. 1996).
[[nodiscard]] Eigen::VectorXd soft_tissue_rms_m(const model::Model& model);

}  // namespace kinemark::simulation
