// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/data/orientations.h"

#include <fmt/core.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <set>

namespace kinemark::data {

bool Orientations::present(std::int64_t frame, std::int64_t sensor) const {
  return std::isfinite(quaternion[index(frame, sensor)]);
}

Eigen::Matrix3d Orientations::rotation(std::int64_t frame, std::int64_t sensor) const {
  const double* q = quaternion.data() + index(frame, sensor);
  return Eigen::Quaterniond(q[0], q[1], q[2], q[3]).toRotationMatrix();
}

Status Orientations::validate() const {
  if (!(time.rate_hz > 0.0) || !std::isfinite(time.rate_hz))
    return fail(Code::bad_input, fmt::format("orientations have a rate of {} Hz", time.rate_hz));
  const auto numbers = 4 * static_cast<std::size_t>(std::max<std::int64_t>(0, frames())) * names.size();
  if (quaternion.size() != numbers)
    return fail(Code::bad_input,
                fmt::format("orientations hold {} numbers; need {}", quaternion.size(), numbers));
  std::set<std::string_view> seen;
  for (const auto& name : names)
    if (name.empty() || !seen.insert(name).second)
      return fail(Code::bad_input, name.empty() ? std::string("a sensor has no name")
                                                : fmt::format("sensor '{}' occurs twice", name));
  for (std::size_t i = 0; i < numbers; i += 4) {
    const double* q = quaternion.data() + i;
    const double length = std::sqrt(q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3]);
    if (std::isnan(q[0]) ? !std::isnan(length) : !(std::abs(length - 1.0) < 1e-6))
      return fail(Code::bad_input,
                  fmt::format("sensor '{}', frame {}: a quaternion of length {}", names[i / 4 % names.size()],
                              time.number(static_cast<std::int64_t>(i / 4 / names.size())), length));
  }
  return {};
}

}  // namespace kinemark::data
