// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// Plotted curves of a page, packed: rounded to what an eye or an error bar can tell, then deflated.
#pragma once

#include <cstdint>
#include <functional>
#include <nlohmann/json.hpp>
#include <span>

#include "kinemark/stages/report/internal/plot_points.h"

namespace kinemark::report::internal {

/// To what curves are rounded at most: what is written beside them has no more decimals.
constexpr double kUsualStep_deg = 0.01, kUsualStep_m = 1e-4, kUsualStep_mm = 0.01, kUsualStep_nm = 0.01,
                 kUsualStep_m_s = 1e-3, kUsualStep_m_s2 = 0.01;

/// To what the numbers of a curve are rounded: 1, 2 or 5 times a power of ten.
///
/// The largest such step that is at most `usual` (> 0), a sixteenth of the median of `sd` where there is one
/// (which adds less than a thousandth to it), and a 2,000th of the reach of `values` (below a pixel of the
/// whole curve). Never so fine that a value takes more than 31 bits.
[[nodiscard]] double curve_step(std::span<const float> values, std::span<const float> sd, double usual);

/// The step of a curve of standard deviations: a 40th of the smallest, at least a 1,000th of the median.
[[nodiscard]] double deviation_step(std::span<const float> sd);

/// PackedCurve of docs/formats/pages.md. NaN comes back as NaN.
/// @param step  > 0, and at least a 2^31st part of the largest value
[[nodiscard]] nlohmann::ordered_json pack_curve(std::span<const float> values, double step);

/// A curve of standard deviations, rounded up to multiples of deviation_step(): never understated, and 0 only
/// where it is 0.
[[nodiscard]] nlohmann::ordered_json pack_deviations(std::span<const float> sd);

/// Codes of a curve ("kind": "codes").
[[nodiscard]] nlohmann::ordered_json pack_codes(std::span<const std::uint8_t> codes);

/// Characters that the packed blocks within `json` take in a page, about.
[[nodiscard]] std::int64_t room(const nlohmann::ordered_json& json);

/// What `pack` makes of all points, or of as many as take `most` characters and fewer; never fewer than 2.
/// @param pack  packs curves of `points` points thinned further, see PlotPoints
[[nodiscard]] nlohmann::ordered_json pack_within(
    std::int64_t points, std::int64_t most,
    const std::function<nlohmann::ordered_json(const PlotPoints&)>& pack);

}  // namespace kinemark::report::internal
