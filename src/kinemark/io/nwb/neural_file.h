// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

#include "kinemark/core/result.h"
#include "kinemark/data/neural.h"

namespace kinemark::io {

/// Read what an NWB file holds beside movement: `units` with their spike times and columns of texts and
/// numbers, and every TimeIntervals of `intervals`. A file without any of it gives an empty result. In a
/// process of its own, with the limits of read_nwb(). Code::bad_input: no NWB file, spike times that do not
/// ascend or are no numbers, an index that does not fit, intervals that end before they begin.
[[nodiscard]] Result<data::Neural> read_neural(const std::filesystem::path& path);

/// The same with the course of each LFP, or of each ElectricalSeries of `acquisition` where there is no LFP,
/// as an envelope in its unit (`conversion`, `channel_conversion` and `offset` applied): every sample is
/// read, but of series of more than 500 million numbers, which are left out with a warning. Also
/// Code::bad_input: a series without a clock.
[[nodiscard]] Result<data::Neural> read_neural_lanes(const std::filesystem::path& path);

}  // namespace kinemark::io
