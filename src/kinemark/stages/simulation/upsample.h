// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "kinemark/core/result.h"
#include "kinemark/data/trajectories.h"

namespace kinemark::simulation {

/// Interpolation by a recorder between the samples of its cameras.
enum class Upsampling : std::uint8_t { linear, cubic };

/// Options of upsample().
struct UpsampleOptions {
  int factor = 4;                       ///< 1 to 100; 4 makes 240 Hz of 60
  Upsampling how = Upsampling::linear;  ///< straight lines or cubics between samples
  /// Interpolated samples get the state `upsampled`; without it `measured`, as in a stream without
  /// provenance.
  bool tell = false;
};

/// The output of a recorder whose rate is higher than that of its cameras: F frames become
/// (F - 1) factor + 1, every factor-th the camera's own. Between two samples that are there, `linear` draws a
/// line and `cubic` the cubic of Catmull & Rom (1974) through the four around (the neighbour's line continued
/// where one is missing); next to a missing sample nothing is made. Covariances are left out. O(F M).
[[nodiscard]] Result<data::Trajectories> upsample(const data::Trajectories& recorded,
                                                  const UpsampleOptions& options = {});

}  // namespace kinemark::simulation
