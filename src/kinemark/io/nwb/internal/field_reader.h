// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// Field potentials of an NWB file, reduced while they are read.
#pragma once

#include "kinemark/core/result.h"
#include "kinemark/data/neural.h"
#include "kinemark/io/nwb/internal/input.h"

namespace kinemark::io::internal {

inline constexpr std::int64_t kFieldBins = 1500;                ///< of an envelope, at most
inline constexpr std::int64_t kMostFieldNumbers = 500'000'000;  ///< of a series that is read
inline constexpr std::size_t kMostFieldChannels = 16;  ///< of a series; others are left out with a warning

/// Add the envelope of each ElectricalSeries of an LFP, or, where there is none, of each in `acquisition`.
/// Code::bad_input for one without a clock or samples.
[[nodiscard]] Status read_fields(Input& in, data::Neural& out);

}  // namespace kinemark::io::internal
