// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/motion/orientation/internal/sensor_clock.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "kinemark/core/index.h"
#include "kinemark/core/missing.h"
#include "kinemark/stages/motion/ik_options.h"

namespace kinemark::motion::internal {

data::Orientations at_times(const data::Orientations& recording, const TimeBase& time) {
  data::Orientations out;
  out.names = recording.names;
  out.time = time;
  const auto S = recording.size();
  out.quaternion.assign(at(4 * time.frames * S), kNaN);
  const auto sample = [&](std::int64_t f, std::int64_t s) {
    const double* q = recording.quaternion.data() + 4 * (f * S + s);
    return Eigen::Quaterniond(q[0], q[1], q[2], q[3]);
  };
  for (std::int64_t f = 0; f < time.frames; ++f) {
    const double place = (time.time_s(f) - recording.time.t0_s) * recording.time.rate_hz;
    if (!(place > -1.0 && place < static_cast<double>(recording.frames()))) continue;
    const auto nearest = std::llround(place);
    const bool on_sample = std::abs(place - static_cast<double>(nearest)) <= kTimeSlack;
    const auto before = on_sample ? nearest : static_cast<std::int64_t>(std::floor(place));
    const auto after = on_sample ? nearest : before + 1;
    if (before < 0 || after >= recording.frames()) continue;
    for (std::int64_t s = 0; s < S; ++s) {
      if (!recording.present(before, s) || !recording.present(after, s)) continue;
      const Eigen::Quaterniond q =
          on_sample
              ? sample(before, s)
              : sample(before, s).slerp(place - static_cast<double>(before), sample(after, s)).normalized();
      double* to = out.quaternion.data() + 4 * (f * S + s);
      to[0] = q.w(), to[1] = q.x(), to[2] = q.y(), to[3] = q.z();
    }
  }
  return out;
}

}  // namespace kinemark::motion::internal
