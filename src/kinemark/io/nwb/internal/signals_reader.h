// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "kinemark/core/result.h"
#include "kinemark/data/trial.h"
#include "kinemark/io/nwb/internal/input.h"

namespace kinemark::io::internal {

/// Read what write_signals() wrote, but for residuals and cameras of markers, into a trial whose markers are
/// read: points that are no markers, analog channels, events, force plates and when nobody loads them. What
/// is absent stays as it is. Code::bad_input, with the place, where sizes or numbers do not fit each other.
[[nodiscard]] Status read_signals(Input& in, data::Trial& trial);

}  // namespace kinemark::io::internal
