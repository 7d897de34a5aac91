// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// Values beyond which a channel was not recorded.
#pragma once

#include <Eigen/Core>

#include "kinemark/core/missing.h"

namespace kinemark::analysis {

/// Where a channel is clipped.
struct Rails {
  double low = kNaN, high = kNaN;  ///< V; NaN where it is not clipped on that side
  double share = 0.0;              ///< of the samples that stand at either
};

/// An extreme value is a rail where samples are heaped on it: the tail of a signal that was recorded whole
/// thins out towards its extreme. Values that last, as zeros before a recording or between pulses, are none.
[[nodiscard]] Rails find_rails(const Eigen::VectorXd& volts, double rate_hz);

}  // namespace kinemark::analysis
