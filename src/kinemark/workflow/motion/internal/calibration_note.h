// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

namespace kinemark::data {
struct Trial;
}

namespace kinemark::workflow::internal {

/// That deviations of coordinates hold what the calibration leaves unknown; nothing where that is not known,
/// or where there are no deviations.
[[nodiscard]] std::string note_on_calibration(const data::Trial& trial, bool error_bars);

}  // namespace kinemark::workflow::internal
