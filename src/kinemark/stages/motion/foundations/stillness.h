// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// Is a still recording still? Bodies sway as a whole; distances between markers tell whether the posture
// changed.
#pragma once

#include <optional>
#include <span>
#include <string>

#include "kinemark/data/trajectories.h"

namespace kinemark::motion {

/// Two markers whose distance changes within a recording.
struct Unrest {
  std::string marker;                  ///< as in the recording
  std::string partner;                 ///< as in the recording
  double least_m = 0.0, most_m = 0.0;  ///< apart, in 5 and 95 % of the frames that have both
};

/// The pair of these markers whose distance changes most, where that is more than `bound_m`; pairs seen
/// together in fewer than ten frames are not asked. Up to 400 frames are looked at, evenly picked; O(M^2)
/// time.
[[nodiscard]] std::optional<Unrest> find_unrest(const data::Trajectories& still,
                                                std::span<const std::string> names, double bound_m = 0.08);

/// "cal.c3d is not still: LASI and LANK are 512 mm apart in some of its frames, 843 mm in others"
[[nodiscard]] std::string describe(const Unrest& unrest, const std::string& recording);

}  // namespace kinemark::motion
