// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "kinemark/core/result.h"
#include "kinemark/stages/motion/ik_options.h"

namespace kinemark::motion {

/// Options of smooth_motion().
struct SmootherOptions {
  /// Options of the least squares that provides the start: marker weights (relative trust), marker noise (0:
  /// estimated), limits, time range, seed, threads. The smoother takes no coordinate tasks and no other loss
  /// than its own.
  IkOptions ik;
  double huber_sd = 4.5;    ///< Huber threshold in SDs: larger residuals of a marker count linearly; 0: never
  int max_iterations = 50;  ///< Gauss-Newton steps over the whole recording, >= 1
  bool error_bars =
      true;  ///< q_sd and the covariance of q, qd and qdd; without them nothing is marked undetermined

  [[nodiscard]] Status check() const;  ///< Ranges hold and no number is NaN.
};

}  // namespace kinemark::motion
