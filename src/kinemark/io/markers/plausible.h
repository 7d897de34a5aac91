// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// Positions that cannot be: one flipped bit, a wrong unit.
#pragma once

#include <Eigen/Geometry>

#include "kinemark/data/trial.h"

namespace kinemark::io {

inline constexpr double kLargestLaboratory_m = 100.0;  ///< from the middle of all markers
inline constexpr double kBeyondAnyMarker_m =
    1000.0;  ///< nothing is so far, whatever its marker does elsewhere
inline constexpr double kFarFromNeighbours_m = 10.0;  ///< a single sample, from those before and after
inline constexpr double kFastestMarker_m_s = 100.0;   ///< what it may have gone in the time between them
inline constexpr double kSmallestBody_m = 0.002;      ///< extent of all markers in a frame
inline constexpr double kLargestBody_m = 100.0;       ///< extent of all markers in a frame

/// Reject samples that no marker can have: their state becomes `rejected`, and one warning names marker,
/// frame and place of the first of them. Rejected is
/// - a sample more than 10 m, five times the usual step of its marker, and 100 m/s times the time between
/// from
///   the samples of that marker before and after it;
/// - a sample more than 100 m from the middle of all markers, where its marker stays within 20 m otherwise;
/// - a sample more than 1 km from the middle of all markers.
///
/// The middle is the median over markers of the median of each. Where the markers of the middle frame span
/// less than 2 mm or more than 100 m, the unit is in doubt instead: a warning says so, nothing is rejected.
/// Nothing is said of recordings that hold no such sample. O(F M); usually one pass over the positions, and
/// none where the box around all samples is known (`box_m`; empty: it is not) and below 10 m across.
void reject_implausible(data::Trial& trial, const Eigen::AlignedBox3d& box_m = {});

}  // namespace kinemark::io
