// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/skeleton/topology/internal/drawn.h"

#include <algorithm>

namespace kinemark::skeleton::internal {

std::vector<std::int64_t> draw_evenly(std::int64_t frames, std::int64_t n) {
  n = std::min(frames, n);
  std::vector<std::int64_t> out;
  for (std::int64_t i = 0; i < n; ++i) out.push_back(i * frames / n);
  return out;
}

data::Trajectories cut(const data::Trajectories& t, const std::vector<std::int64_t>& frames,
                       const Array<std::uint8_t>& mask) {
  auto out = data::Trajectories::all_missing(
      t.names, {.rate_hz = t.time.rate_hz, .t0_s = 0.0, .frames = static_cast<std::int64_t>(frames.size())});
  for (std::size_t i = 0; i < frames.size(); ++i)
    for (std::int64_t m = 0; m < t.markers(); ++m) {
      if (!t.present(frames[i], m) || (!mask.empty() && !mask[t.index(frames[i], m)])) continue;
      out.x(static_cast<std::int64_t>(i), m) = t.x(frames[i], m);
      out.state[out.index(static_cast<std::int64_t>(i), m)] = data::SampleState::measured;
    }
  return out;
}

}  // namespace kinemark::skeleton::internal
