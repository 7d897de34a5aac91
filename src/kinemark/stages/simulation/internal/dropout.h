// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "kinemark/core/random.h"
#include "kinemark/model/model.h"
#include "kinemark/stages/simulation/internal/segments.h"
#include "kinemark/stages/simulation/subject_options.h"

namespace kinemark::simulation::internal {

/// One flag per marker-frame, frame first: 1 where the marker is lost.
using Lost = std::vector<std::uint8_t>;

/// Mean of draw_gap_frames().
[[nodiscard]] double mean_gap_frames(double rate_hz);

/// Frames of one random gap: two numbers of `random`. Seven of ten gaps last 0.06 s on average, the others
/// 0.5 s, both exponentially distributed, one frame at least.
[[nodiscard]] std::int64_t draw_gap_frames(Random& random, double rate_hz);

/// Gaps at random until round(share frames markers) marker-frames are lost.
[[nodiscard]] Lost random_gaps(std::int64_t frames, std::int64_t markers, const SubjectOptions& options);

/// The round(share frames markers) marker-frames that cameras see worst.
///
/// Eight cameras stand on a ring 4 m around the subject, in turn 1 m and 2.5 m above the lowest point. A
/// camera sees a marker the better, the more the skin under it faces the camera and the farther the line of
/// sight passes by the capsules of the other segments. A marker needs two cameras: its score is the second
/// best camera's, less its own mean over the recording (a laboratory moves cameras until no marker is hidden
/// for good). states: one column per frame.
[[nodiscard]] Lost lines_of_sight(const model::Model& model, const Segments& segments,
                                  const Eigen::MatrixXd& states, const SubjectOptions& options);

}  // namespace kinemark::simulation::internal
