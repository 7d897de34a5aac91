// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "kinemark/data/trajectories.h"

namespace kinemark::trajectory {

/// Tell, with one smoothed marker, what it was smoothed by and what went in: measuring afterwards can then be
/// as good as before. The samples from before are the measured ones of `from`: what was filled, bridged or
/// upsampled is none.
///
/// Where `from` was filtered itself, both filters are named, and the samples from before are those that came
/// with it, if any: its own are none. Without a filter, what `from` tells is passed on.
///
/// @param used   filter that was used, of data::MarkerAccount
/// @param place  of the marker in `to`, which has the states of the result; its filters and unfiltered
///               samples are made on first use
void hand_on(const data::Trajectories& from, std::int64_t marker, const data::FilterUsed& used,
             data::Trajectories& to, std::int64_t place);

}  // namespace kinemark::trajectory
