// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/simulation/upsample.h"

#include <fmt/core.h>

namespace kinemark::simulation {
namespace {

using Eigen::Vector3d;

/// Position of marker m between frames f and f + 1, both seen; t in (0, 1).
Vector3d between(const data::Trajectories& in, std::int64_t f, std::int64_t m, double t, Upsampling how) {
  const Vector3d a = in.x(f, m), b = in.x(f + 1, m);
  if (how == Upsampling::linear) return a + t * (b - a);
  const bool before = f > 0 && in.present(f - 1, m);
  const bool after = f + 2 < in.frames() && in.present(f + 2, m);
  const Vector3d slope_a = before ? Vector3d(0.5 * (b - in.x(f - 1, m))) : Vector3d(b - a);
  const Vector3d slope_b = after ? Vector3d(0.5 * (in.x(f + 2, m) - a)) : Vector3d(b - a);
  const double u = 1.0 - t;
  return (1.0 + 2.0 * t) * u * u * a + t * u * u * slope_a + t * t * (3.0 - 2.0 * t) * b -
         t * t * u * slope_b;
}

}  // namespace

Result<data::Trajectories> upsample(const data::Trajectories& recorded, const UpsampleOptions& options) {
  if (options.factor < 1 || options.factor > 100)
    return fail(Code::usage, fmt::format("factor is {}; expected 1 to 100", options.factor));
  if (recorded.frames() < 1) return fail(Code::bad_input, "a recording without frames cannot be upsampled");
  const TimeBase time{recorded.time.rate_hz * options.factor, recorded.time.t0_s,
                      (recorded.frames() - 1) * options.factor + 1};
  auto out = data::Trajectories::all_missing(recorded.names, time);
  for (std::int64_t f = 0; f < recorded.frames(); ++f)
    for (std::int64_t m = 0; m < recorded.markers(); ++m) {
      const std::int64_t at = f * options.factor;
      out.x(at, m) = recorded.x(f, m);
      out.state[out.index(at, m)] = recorded.state[recorded.index(f, m)];
      if (f + 1 == recorded.frames() || !recorded.present(f, m) || !recorded.present(f + 1, m)) continue;
      for (int step = 1; step < options.factor; ++step) {
        out.x(at + step, m) =
            between(recorded, f, m, static_cast<double>(step) / options.factor, options.how);
        out.state[out.index(at + step, m)] =
            options.tell ? data::SampleState::upsampled : data::SampleState::measured;
      }
    }
  return out;
}

}  // namespace kinemark::simulation
