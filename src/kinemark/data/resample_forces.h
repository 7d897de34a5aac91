// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// Forces on the frames of a recording.
#pragma once

#include "kinemark/core/time_base.h"
#include "kinemark/data/wrenches.h"

namespace kinemark::data {

/// The same forces at other instants, linear in force and in moment about one point; NaN outside. Instants
/// that meet a frame to 1 % of a frame are copied.
[[nodiscard]] Wrenches resample(const Wrenches& wrenches, const TimeBase& time);

}  // namespace kinemark::data
