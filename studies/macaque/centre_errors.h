// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "kinemark/data/skeleton.h"
#include "kinemark/stages/simulation/limb.h"
#include "kinemark/stages/skeleton/articulated/bound.h"

namespace kinemark::studies {

/// Errors of joint centres in simulated frames, as sums that add up over joints, recordings and seeds. A
/// frame is flagged when it has a centre that is not called determined.
struct CentreErrors {
  std::int64_t frames = 0, answered = 0, determined = 0;
  std::int64_t bridged = 0, ambiguous = 0;  ///< the two kinds of flagged frames
  double squares_answered = 0.0, squares_determined = 0.0, squares_bridged = 0.0;  ///< m^2
  /// Frames called determined that have a bound: errors there, and the bound's variance, m^2.
  std::int64_t bounded = 0;
  double squares_bounded = 0.0, bound_squares = 0.0;
  /// Frames called determined that the bound does not: left out of `bounded`.
  std::int64_t determined_without_bound = 0;
  /// Of `bounded`, frames near a fold, where the bound grows without limit: the deviation that came with the
  /// centre stands for it.
  std::int64_t folded = 0;
  std::int64_t beyond_5sd = 0, beyond_5sd_determined = 0;  ///< frames; one without a covariance is beyond
  std::int64_t coordinates = 0, within_1sd = 0, within_2sd = 0;  ///< of frames called determined

  CentreErrors& operator+=(const CentreErrors& other);
  [[nodiscard]] double rms_answered_m() const;  ///< NaN without a frame, as all below
  [[nodiscard]] double rms_determined_m() const;
  [[nodiscard]] double rms_bridged_m() const;
  [[nodiscard]] double bound_m() const;     ///< root mean square of the bound, frames as `bounded`
  [[nodiscard]] double over_bound() const;  ///< error over bound in those frames
  [[nodiscard]] double share_answered() const;
  [[nodiscard]] double share_decided() const;  ///< answered and not ambiguous
  [[nodiscard]] double share_determined() const;
  [[nodiscard]] double share_within_1sd() const;
  [[nodiscard]] double share_within_2sd() const;
};

/// Compare a skeleton with the recording that it was found in. bound: may be null. Frames and joints agree.
[[nodiscard]] CentreErrors judge_centres(const data::Skeleton& skeleton,
                                         const simulation::LimbRecording& limb,
                                         const skeleton::CentreBound* bound);

}  // namespace kinemark::studies
