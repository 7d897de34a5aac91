// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// Words for units of force and of moment, as the channels of force plates have them.
#pragma once

#include <optional>
#include <string_view>

namespace kinemark {

/// Newtons per unit of force: "N", "Nt", "newtons", "kN", "dN", "daN", "mN", "kgf", "kp", "lbf", in any case
/// but for mN and MN; nothing when unknown, also of no word.
[[nodiscard]] std::optional<double> newtons_per_unit(std::string_view unit);

/// Newton metres per unit of moment: a force and a length in either order with or without a sign between them
/// ("Nmm", "N.m", "kN.m", "Nxm", "Newton-meters", "kgf.cm", "ft-lb", "lbf.in"), or "J", "Joule"; nothing when
/// unknown.
[[nodiscard]] std::optional<double> newton_metres_per_unit(std::string_view unit);

}  // namespace kinemark
