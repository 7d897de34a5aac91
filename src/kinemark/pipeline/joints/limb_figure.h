// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// The picture of `kinemark joints --figures`: the limb as it was recorded, drawn from its markers alone.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <string>
#include <vector>

#include "kinemark/data/skeleton.h"
#include "kinemark/data/trajectories.h"
#include "kinemark/stages/report/figures/figure.h"

namespace kinemark::pipeline {

/// Frames whose postures differ most, up to `poses` of them in order of time, among those that place every
/// joint and end and show three markers of every segment (the most that any frame shows, where none shows as
/// many).
[[nodiscard]] std::vector<std::int64_t> choose_poses(const data::Trajectories& markers,
                                                     const data::Skeleton& skeleton, int poses);

/// What a picture of a limb shows.
struct LimbPicture {
  report::Figure figure;             ///< one panel
  std::vector<std::int64_t> frames;  ///< of its postures
};

/// Some postures of a limb: its markers as dots, the line through its joints in black, a grey shadow on a
/// floor. A segment without an end is drawn as far as its markers reach.
/// @param up  axis of the recording that points up, unit length
[[nodiscard]] LimbPicture limb_picture(const data::Trajectories& markers, const data::Skeleton& skeleton,
                                       const Eigen::Vector3d& up, int poses = 4);

/// The same as a file of SVG.
[[nodiscard]] std::string limb_figure(const data::Trajectories& markers, const data::Skeleton& skeleton,
                                      const Eigen::Vector3d& up, int poses = 4);

}  // namespace kinemark::pipeline
