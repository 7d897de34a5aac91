// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "kinemark/data/trajectories.h"

namespace kinemark::trajectory::testing {

/// Rigid bodies in a chain, hinged to one another, that swing and turn; five markers on each.
struct BodiesOptions {
  std::int64_t frames = 600;
  double rate_hz = 100.0;
  int bodies = 2;
  double noise_m = 0.0;  ///< per axis and sample
  std::uint64_t seed = 1;
};

/// Marker k of body b is named "b<b>m<k>" and has the index 5 b + k; everything is measured.
[[nodiscard]] data::Trajectories moving_bodies(const BodiesOptions& options);

/// Make frames first to last, both included, of a marker missing.
void hide(data::Trajectories& t, std::int64_t marker, std::int64_t first, std::int64_t last);

/// RMS per axis of the difference of a marker over frames first to last.
[[nodiscard]] double rms_between(const data::Trajectories& a, const data::Trajectories& b,
                                 std::int64_t marker, std::int64_t first, std::int64_t last);

}  // namespace kinemark::trajectory::testing
