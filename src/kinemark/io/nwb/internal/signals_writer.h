// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "kinemark/data/trial.h"
#include "kinemark/io/nwb/internal/output.h"

namespace kinemark::io::internal {

/// Write what a trial holds besides positions: residuals and cameras of markers, points that are no markers,
/// analog channels, events, force plates and when nobody loads them. What it does not hold leaves no trace.
/// @param module            of the file
/// @param series_of_marker  of markers, as Position calls them
void write_signals(Output& out, hid_t module, const data::Trial& trial,
                   const std::vector<std::string>& series_of_marker, int compression);

}  // namespace kinemark::io::internal
