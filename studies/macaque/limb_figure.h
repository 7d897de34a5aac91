// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// The macaque report's figure 7: the limb as it was recorded, drawn from its markers alone.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <string>
#include <vector>

#include "kinemark/data/skeleton.h"
#include "kinemark/data/trajectories.h"

namespace kinemark::studies {

/// Frames whose postures differ most, up to `poses` of them in order of time, among those that place every
/// joint and end and show three markers of every segment (the most that any frame shows, where none shows as
/// many).
[[nodiscard]] std::vector<std::int64_t> choose_poses(const data::Trajectories& markers,
                                                     const data::Skeleton& skeleton, int poses);

/// A file of SVG: some postures of a limb, its markers as dots, the line through its joints in black, a grey
/// shadow on a floor. A segment without an end is drawn as far as its markers reach.
/// @param up  axis of the recording that points up, unit length
[[nodiscard]] std::string limb_figure(const data::Trajectories& markers, const data::Skeleton& skeleton,
                                      const Eigen::Vector3d& up, int poses = 4);

}  // namespace kinemark::studies
