// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>

namespace kinemark::skeleton::internal {

/// How many frames count as one in a regression on `regressors` (F x k) whose errors (F x m) are alike from
/// frame to frame: 1 + 2 sum of the products of their autocorrelations, with Bartlett's weights, over up to
/// F / 4 and 200 frames; 1 at least. Where either repeats nothing, frames are independent.
[[nodiscard]] double frames_alike(const Eigen::MatrixXd& errors, const Eigen::MatrixXd& regressors);

}  // namespace kinemark::skeleton::internal
