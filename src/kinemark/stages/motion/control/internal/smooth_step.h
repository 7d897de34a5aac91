// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>

namespace kinemark::motion::internal {

/// 0 up to u = 0, 1 from u = 1 on, a cubic with level ends between.
inline double smooth_step(double u) {
  const double s = std::clamp(u, 0.0, 1.0);
  return s * s * (3.0 - 2.0 * s);
}

}  // namespace kinemark::motion::internal
