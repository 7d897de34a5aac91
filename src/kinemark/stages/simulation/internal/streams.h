// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "kinemark/core/random.h"

namespace kinemark::simulation::internal {

/// Purpose of each stream of random numbers. The values determine the results and must never change.
enum class Draw : std::uint64_t {
  motion = 1,
  root = 2,
  noise = 3,
  tissue_marker = 4,
  tissue_segment = 5,
  impacts = 6,
  gaps = 7,
  cameras = 8,
};

inline Random stream(std::uint64_t seed, Draw what, std::size_t which = 0) {
  return {seed, (static_cast<std::uint64_t>(what) << 32) + which};
}

}  // namespace kinemark::simulation::internal
