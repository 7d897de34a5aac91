// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "kinemark/core/missing.h"
#include "kinemark/data/trajectories.h"

namespace kinemark::stream {

/// One frame of M markers, as it comes.
struct Frame {
  std::int64_t number = 0;               ///< from 0; a step of more than 1 says that some were lost
  double time_s = 0.0;                   ///< by the clock of its source
  std::uint64_t came_ns = 0;             ///< when it came, ns since 1970; 0: nobody has looked
  std::vector<double> x_in_world;        ///< M x 3, m; NaN where there is none
  std::vector<data::SampleState> state;  ///< M

  /// All markers missing.
  void clear(std::size_t markers) {
    x_in_world.assign(3 * markers, kNaN);
    state.assign(markers, data::SampleState::missing);
  }
};

}  // namespace kinemark::stream
