// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <cstring>
#include <string>

#include "server/live_push.h"

namespace kinemark::server::testing {

/// A push as a page sends it, on a machine with the little end first.
inline std::string push_bytes(std::uint16_t body, const Eigen::Vector3d& point,
                              const Eigen::Vector3d& force_n) {
  std::string out(kPushBytes, '\0');
  out[0] = out[1] = 1;
  std::memcpy(out.data() + 2, &body, 2);
  for (Eigen::Index i = 0; i < 3; ++i) {
    const auto x = static_cast<float>(point[i]), f = static_cast<float>(force_n[i]);
    std::memcpy(out.data() + 4 + 4 * i, &x, 4);
    std::memcpy(out.data() + 16 + 4 * i, &f, 4);
  }
  return out;
}

}  // namespace kinemark::server::testing
