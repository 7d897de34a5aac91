// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/io/text/body_orientations.h"

#include <fmt/core.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <string>

#include "kinemark/core/index.h"
#include "kinemark/core/missing.h"
#include "kinemark/math/rotation_fit.h"

namespace kinemark::io {
namespace {

constexpr std::string_view kFirst = "_axis_x";
constexpr std::ptrdiff_t kAxes = 3;
constexpr double kTolerance = 0.01;

/// Whether the three channels from `c` on are the axes of one body.
bool begins_axes(const data::Channels& channels, std::int64_t c) {
  const auto& name = channels.names[at(c)];
  if (!name.ends_with(kFirst) || c + kAxes > std::ssize(channels.names)) return false;
  const auto stem = name.substr(0, name.size() - 1);
  return channels.names[at(c + 1)] == stem + "y" && channels.names[at(c + 2)] == stem + "z";
}

}  // namespace

bool has_body_axes(const data::Trial& trial) {
  for (std::int64_t c = 0; c < std::ssize(trial.channels.names); ++c)
    if (begins_axes(trial.channels, c)) return true;
  return false;
}

Result<data::Orientations> orientations_of_bodies(const data::Trial& trial) {
  const auto& channels = trial.channels;
  const auto C = std::ssize(channels.names);
  data::Orientations out;
  out.time = trial.markers.time;
  out.time.first_number = trial.first_frame;
  std::vector<std::int64_t> first;
  for (std::int64_t c = 0; c < C; ++c) {
    if (!begins_axes(channels, c)) continue;
    const auto& name = channels.names[at(c)];
    out.names.push_back(name.substr(0, name.size() - kFirst.size()));
    first.push_back(c);
  }
  if (first.empty()) return fail(Code::bad_input, "holds no axes of rigid bodies");
  for (std::int64_t f = 0; f < out.frames(); ++f)
    for (std::size_t b = 0; b < first.size(); ++b) {
      const Eigen::Matrix3d axes =
          Eigen::Map<const Eigen::Matrix3d>(channels.values.data() + 3 * (f * C + first[b]));
      if (!axes.allFinite()) {
        out.quaternion.insert(out.quaternion.end(), 4, kNaN);
        continue;
      }
      if ((axes.transpose() * axes - Eigen::Matrix3d::Identity()).cwiseAbs().maxCoeff() > kTolerance ||
          axes.determinant() < 0.0)
        return fail(Code::bad_input,
                    fmt::format("'{}', frame {}: its axes are not of length 1 and at right angles",
                                out.names[b], out.time.number(f)));
      const Eigen::Quaterniond q(math::fit_rotation(axes).rotation);
      out.quaternion.insert(out.quaternion.end(), {q.w(), q.x(), q.y(), q.z()});
    }
  if (auto s = out.validate(); !s) return std::unexpected(s.error());
  return out;
}

}  // namespace kinemark::io
