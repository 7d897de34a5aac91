// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/motion/orientation/internal/sensor_errors.h"

#include <algorithm>
#include <cmath>

namespace kinemark::motion::internal {

void summarize_errors(const Array<double>& errors, OrientationFit& fit) {
  const auto sensors = fit.sensors.size();
  double all = 0.0;
  std::int64_t seen = 0;
  for (std::size_t s = 0; s < sensors; ++s) {
    auto& sensor = fit.sensors[s];
    double squares = 0.0;
    std::int64_t n = 0;
    for (std::size_t i = s; i < errors.size(); i += sensors) {
      if (std::isnan(errors[i])) continue;
      squares += errors[i] * errors[i];
      sensor.max_rad = std::max(sensor.max_rad, errors[i]);
      ++n;
    }
    if (n > 0) sensor.rms_rad = std::sqrt(squares / static_cast<double>(n));
    sensor.seen =
        static_cast<double>(n * static_cast<std::int64_t>(sensors)) / static_cast<double>(errors.size());
    all += squares;
    seen += n;
    fit.max_rad = std::max(fit.max_rad, sensor.max_rad);
  }
  if (seen > 0) fit.rms_rad = std::sqrt(all / static_cast<double>(seen));
}

}  // namespace kinemark::motion::internal
