// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "kinemark/core/array.h"
#include "kinemark/data/trajectories.h"

namespace kinemark::skeleton::internal {

/// `n` evenly spaced frames of a recording, all where it has fewer.
[[nodiscard]] std::vector<std::int64_t> draw_evenly(std::int64_t frames, std::int64_t n);

/// The recording cut to some of its frames: what fits and poses are made of. Mask: F x M, or empty.
[[nodiscard]] data::Trajectories cut(const data::Trajectories& t, const std::vector<std::int64_t>& frames,
                                     const Array<std::uint8_t>& mask = {});

}  // namespace kinemark::skeleton::internal
