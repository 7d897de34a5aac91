// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// The filter that markers went through, and their samples from before it, as a C3D file of ours keeps them:
// the filters in our own group, the samples as points of their own. docs/decisions/0023
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "kinemark/data/trial.h"
#include "kinemark/io/c3d/layout.h"
#include "kinemark/io/c3d/parameters.h"

namespace kinemark::io {

/// The list of POINT, paired in TYPE_GROUPS, that names the points of samples from before the filter.
inline constexpr std::string_view kC3dUnfilteredList = "UNFILTERED";

/// Markers with samples from before their filter, in order.
[[nodiscard]] std::vector<std::int64_t> unfiltered_markers(const data::Trajectories& markers);

/// What stands before a marker's name in that of its point: "unfiltered_", and more underscores until no name
/// of the trial is met.
[[nodiscard]] std::string unfiltered_prefix(const data::Trial& trial);

/// Add KINEMARK:FILTERS, a text for each marker ("kalman 5 6.4 0.00021": method, order, -3 dB in Hz, noise in
/// m; blank: none), and UNFILTERED_PREFIX where points follow. Nothing is added where nothing is known.
void add_filters(const data::Trial& trial, bool with_points, C3dParameters& parameters);

/// Read what add_filters() wrote, and move the samples of those points out of the trial's channels to their
/// markers. What does not fit the markers (another program took some out) is left with a warning.
void take_filters(const C3dParameters& parameters, const C3dLayout& layout, data::Trial& trial);

}  // namespace kinemark::io
