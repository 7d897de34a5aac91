// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <string>
#include <vector>

#include "kinemark/core/result.h"

namespace kinemark::io::internal {

/// A list of points of a person.
struct OpenPosePart {
  const char* key;   ///< in the file
  const char* name;  ///< for people
};

/// What OpenPose writes of a person, in the order in which we keep it.
inline constexpr std::array<OpenPosePart, 4> kOpenPoseParts = {{
    {"pose_keypoints_2d", "body"},
    {"hand_left_keypoints_2d", "left hand"},
    {"hand_right_keypoints_2d", "right hand"},
    {"face_keypoints_2d", "face"},
}};

/// Number of points of each part; 0: not looked for.
using OpenPoseLayout = std::array<std::size_t, kOpenPoseParts.size()>;

/// "body 25, face 70", for messages.
[[nodiscard]] std::string describe(const OpenPoseLayout& layout);

/// Names of all points: of the body as OpenPose's documentation has them (25: BODY_25, 18: COCO, 15: MPI),
/// then LHand0 to LHand20, RHand0 to RHand20, Face0 to Face69. Other numbers of points are
/// Code::not_supported.
[[nodiscard]] Result<std::vector<std::string>> openpose_names(const OpenPoseLayout& layout);

}  // namespace kinemark::io::internal
