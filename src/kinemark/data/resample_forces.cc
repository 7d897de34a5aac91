// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/data/resample_forces.h"

#include <Eigen/Geometry>
#include <cmath>
#include <limits>

namespace kinemark::data {
namespace {

using Eigen::Vector3d;

/// One frame of a wrench.
struct Push {
  Vector3d force, moment, point;

  static Push unknown() {
    const Vector3d nan = Vector3d::Constant(std::numeric_limits<double>::quiet_NaN());
    return {nan, nan, nan};
  }
  static Push of(const Wrench& wrench, std::int64_t f) {
    const auto triple = [f](const Array<double>& values) -> Vector3d {
      return Eigen::Map<const Vector3d>(values.data() + 3 * f);
    };
    return {triple(wrench.force), triple(wrench.moment), triple(wrench.point)};
  }
  [[nodiscard]] bool rests() const { return force.isZero(0.0) && moment.isZero(0.0); }
  [[nodiscard]] Vector3d moment_about(const Vector3d& x) const {
    return rests() ? Vector3d(Vector3d::Zero()) : Vector3d(moment + (point - x).cross(force));
  }
};

Push between(const Push& a, const Push& b, double later) {
  Push push;
  if (a.rests())
    push.point = b.point;
  else if (b.rests())
    push.point = a.point;
  else
    push.point = (1.0 - later) * a.point + later * b.point;
  push.force = (1.0 - later) * a.force + later * b.force;
  push.moment =
      a.rests() && b.rests()
          ? Vector3d(Vector3d::Zero())
          : Vector3d((1.0 - later) * a.moment_about(push.point) + later * b.moment_about(push.point));
  return push;
}

Push at_frame(const Wrench& wrench, std::int64_t frames, double frame) {
  constexpr double kSame = 0.01;
  const double nearest = std::round(frame);
  if (!(nearest >= 0.0 && nearest < static_cast<double>(frames)) &&
      !(frame > 0.0 && frame < static_cast<double>(frames - 1)))
    return Push::unknown();
  if (std::abs(frame - nearest) < kSame) return Push::of(wrench, static_cast<std::int64_t>(nearest));
  if (frame < 0.0 || frame > static_cast<double>(frames - 1)) return Push::unknown();
  const double before = std::floor(frame);
  const auto f = static_cast<std::int64_t>(before);
  return between(Push::of(wrench, f), Push::of(wrench, f + 1), frame - before);
}

}  // namespace

Wrenches resample(const Wrenches& wrenches, const TimeBase& time) {
  Wrenches out{.time = time, .items = {}};
  const TimeBase& from = wrenches.time;
  for (const Wrench& wrench : wrenches.items) {
    Wrench& to = out.items.emplace_back(Wrench{.name = wrench.name,
                                               .body = wrench.body,
                                               .force = {},
                                               .moment = {},
                                               .point = {},
                                               .corners_in_world = wrench.corners_in_world});
    for (std::int64_t f = 0; f < time.frames; ++f) {
      const Push push = at_frame(wrench, wrenches.frames(), (time.time_s(f) - from.t0_s) * from.rate_hz);
      to.force.insert(to.force.end(), push.force.data(), push.force.data() + 3);
      to.moment.insert(to.moment.end(), push.moment.data(), push.moment.data() + 3);
      to.point.insert(to.point.end(), push.point.data(), push.point.data() + 3);
    }
  }
  return out;
}

}  // namespace kinemark::data
