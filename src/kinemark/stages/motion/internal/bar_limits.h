// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// From where on a coordinate is determined and its error bar valid: one rule, whatever observes the bodies.
#pragma once

#include <cstdint>

namespace kinemark::motion::internal {

inline constexpr std::int64_t kSampledFrames = 300;  ///< that noise is estimated from, at most
inline constexpr double kBlindRotation =
    1.0 / 0.003;  ///< rad of error per m of marker error beyond which a coordinate is not determined
inline constexpr double kBlindTranslation = 20.0;  ///< m per m
inline constexpr double kLargestSd = 0.5;          ///< rad or m; beyond it a linear error bar is not valid
inline constexpr double kVague = 0.03;  ///< rad or m; of what is known better a linear error bar is enough
inline constexpr double kBarFloor = 1e-10;  ///< of the total weight: as in the solver
inline constexpr double kBlindFloor =
    1e-13;  ///< lower: even a small share of an undetermined direction must show

}  // namespace kinemark::motion::internal
