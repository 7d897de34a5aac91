// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// Words for units of length, as files of every format use them.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace kinemark {

/// Metres per unit of length ("mm", "m", "cm", "in", "feet", ... in any case); nothing when unknown.
[[nodiscard]] std::optional<double> metres_per_unit(std::string_view unit);

/// A unit by its usual name.
struct LengthUnitName {
  std::string name;  ///< in full, "meter"
  double metres;     ///< per unit
};

/// What an unknown word was probably meant to be ("mete": meter), nearest first, each unit once; empty when
/// it is like none.
[[nodiscard]] std::vector<LengthUnitName> units_like(std::string_view word);

/// The only one of these units that makes a recording of a body of what reaches over `extent` units: 0.1 to
/// 20 m. Nothing when several do, or none.
[[nodiscard]] std::optional<LengthUnitName> unit_of_body_size(std::span<const LengthUnitName> units,
                                                              double extent);

}  // namespace kinemark
