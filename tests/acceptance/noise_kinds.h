// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// Simulated noise of many colours: white, heavy-tailed, flickering, autoregressive, and white before a filter
// that the movement goes through as well.
#pragma once

#include <string>

#include "kinemark/core/missing.h"
#include "kinemark/core/random.h"
#include "kinemark/math/smoothing_choice.h"

namespace kinemark::acceptance {

/// "butterworth", "spline" (quintic) or "smoother" (our own order) without delay, or none.
[[nodiscard]] bool is_filtered(const std::string& colour);

/// A cut-off that laboratories use, 6 to 20 Hz.
[[nodiscard]] double draw_cutoff(double rate_hz, Random& random);

/// A path through such a filter, and as 32-bit numbers.
void low_pass(const std::string& colour, double hz, double rate_hz, math::SeriesMatrix& x);

/// -3 dB of low_pass(), found by running it on cosines.
[[nodiscard]] double three_db_of(const std::string& colour, double hz, double rate_hz, std::int64_t frames);

/// A path with noise of a colour ("white", "t3", "flicker", "ar0.9", ...), not filtered yet.
/// @param sd  per axis, in the unit of the path
[[nodiscard]] math::SeriesMatrix with_noise_of_colour(const std::string& colour,
                                                      const math::SeriesMatrix& path, double sd,
                                                      Random& random);

}  // namespace kinemark::acceptance
