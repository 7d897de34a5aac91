// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// The least error that joint centres can have, for judging methods on simulated limbs. Theory:
// docs/theory/joint-centres-continuity.md
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "kinemark/core/array.h"
#include "kinemark/core/result.h"
#include "kinemark/data/skeleton.h"
#include "kinemark/data/trajectories.h"
#include "kinemark/math/symmetric3.h"

namespace kinemark::skeleton {

/// Cramer-Rao bounds of J joint centres in F frames.
struct CentreBound {
  Array<double> covariance;        ///< F x J x 6 (xx xy xz yy yz zz), m^2; NaN where not determined
  Array<double> known_geometry;    ///< the same if the markers' positions in their segments were known
  Array<std::uint8_t> determined;  ///< F x J, 1 where the frame's information holds the joint
  std::vector<int> length_joint_a, length_joint_b;  ///< pairs of joints that meet on a segment
  std::vector<double> length_sd_m;                  ///< smallest standard deviation of their distance, m

  /// Variance of a centre, summed over x, y and z, m^2.
  [[nodiscard]] double variance(std::size_t index) const {
    return math::symmetric3_trace(covariance.data() + 6 * index);
  }
};

/// What is known of a simulated limb: F frames, M markers, J joints of the layout.
struct LimbTruth {
  std::span<const double> x_in_world;       ///< F x M x 3, m, without noise, none missing
  std::span<const double> centre_in_world;  ///< F x J x 3, m
};

/// Bound of every centre when the markers seen are those present in `markers`, noise is isotropic and normal,
/// the markers' positions in their segments are unknown, and all frames inform them. Segments of kind line or
/// plane are known to be such, their markers and joints lying on that line or in that plane. No estimate
/// without other knowledge (time, joint limits) errs less on average. Fails when shapes disagree, a segment
/// is not rigid in the truth, or its points do not span what its kind needs. O(F) time and memory.
[[nodiscard]] Result<CentreBound> calc_centre_bound(const data::Trajectories& markers,
                                                    const data::SegmentLayout& layout,
                                                    std::span<const data::SegmentKind> kinds,
                                                    const LimbTruth& truth, double noise_sd_m);

}  // namespace kinemark::skeleton
