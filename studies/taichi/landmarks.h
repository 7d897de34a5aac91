// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <string>
#include <string_view>
#include <vector>

#include "kinemark/core/result.h"
#include "kinemark/data/model_description.h"
#include "kinemark/data/trajectories.h"

namespace kinemark::studies {

/// The landmarks of the tai chi recording: joint centres and points of head, trunk, hands and feet.
inline constexpr std::array<std::string_view, 21> kTaiChiLandmarks{
    "FHead",  "BHead",  "Neck",   "Thorax", "LShoulder", "RShoulder", "LElbow",
    "RElbow", "LWrist", "RWrist", "LHand",  "RHand",     "Pelvis",    "LHip",
    "RHip",   "LKnee",  "RKnee",  "LAnkle", "RAnkle",    "LFoot",     "RFoot"};

/// Attachment of a landmark to kinemark's human.
struct LandmarkAttachment {
  std::string landmark, body;
  std::string joint;  ///< whose centre the landmark is, a child joint of the body; empty: a point of its own
};
/// One per landmark, in the order of kTaiChiLandmarks. Shoulders hang on the clavicles.
[[nodiscard]] std::vector<LandmarkAttachment> landmark_attachments();

/// The landmarks of a recording, ready for the human model: y up, in the order of kTaiChiLandmarks, at
/// `rate_hz` by natural cubic splines through each run of samples. Where the recording has z up (the head
/// lies above the feet along z) it is turned about x: (x, z, -y).
///
/// Code::bad_input when a landmark is not there or hardly seen, the body lies, or the
/// result would have more than a million frames.
[[nodiscard]] Result<data::Trajectories> prepare_landmarks(const data::Trajectories& recorded,
                                                           double rate_hz = 60.0);

/// Median distance of two landmarks over the frames that hold both, m; NaN when none does.
[[nodiscard]] double median_distance(const data::Trajectories& landmarks, std::string_view a,
                                     std::string_view b);

}  // namespace kinemark::studies
