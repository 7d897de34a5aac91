// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "kinemark/core/time_base.h"
#include "kinemark/data/orientations.h"

namespace kinemark::motion::internal {

/// The orientations at other instants of the same clock, by spherical interpolation between the two samples
/// beside. An instant within a tenth of a sample from one takes that one. Missing before the first and after
/// the last sample, and where one of the two beside is missing.
[[nodiscard]] data::Orientations at_times(const data::Orientations& recording, const TimeBase& time);

}  // namespace kinemark::motion::internal
