// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// Do markers slide on their segment with the posture? Theory: docs/theory/joint-centres-skin.md
#pragma once

#include <cstdint>

#include "kinemark/core/missing.h"
#include "kinemark/data/skeleton.h"
#include "kinemark/stages/skeleton/functional/joint_fit.h"
#include "kinemark/stages/skeleton/functional/relative_motion.h"
#include "kinemark/stages/skeleton/functional/segment_poses.h"
#include "kinemark/stages/skeleton/functional/skin_slide.h"

namespace kinemark::skeleton {

/// How well the posture of one movement predicts what the others' taught: one number a movement.
struct Prediction {
  double p_value =
      kNaN;  ///< that the share explained is no more than nothing; NaN with fewer than 4 movements
  double explained = kNaN;  ///< share of a movement's variance, mean over movements
  std::int64_t alike = 0;   ///< movements in which it is more than nothing
};

/// What the movements of a recording show.
struct SkinEvidence {
  std::int64_t movements = 0;  ///< to and fro, of 11 frames or more
  Prediction shape;        ///< of the segment whose shape follows more surely; p for both segments together
  Prediction gap;          ///< of the gap between the two places of the joint
  double gap_rms_m = 0.0;  ///< of the gap that the posture predicts, m
};

/// Predicts the markers' shape on either segment, movement by movement, from linear and quadratic functions
/// of the posture that were learnt on the other movements (ridge). Frames are no samples here: errors of
/// neighbours are alike, and slow ones imitate anything within one movement but not in the next.
[[nodiscard]] SkinEvidence find_skin(const Samples& samples, const SegmentPoses& parent,
                                     const SegmentPoses& child, const RelativeMotion& motion,
                                     const JointFit& score);

/// How likely the markers slide with the posture, by the movements that predict each other: even before they
/// are seen. 1 where skin is named, and where no test says anything (fewer than eight movements).
[[nodiscard]] double calc_skin_probability(const SkinEvidence& evidence);

/// What may be said of a joint: verdict, numbers and sentences, from the evidence, the slides' size and the
/// joint's covariance (for a hinge: across its axis).
[[nodiscard]] data::SkinAccount account_of_skin(const SkinEvidence& evidence, const SkinSlide& slide);

}  // namespace kinemark::skeleton
