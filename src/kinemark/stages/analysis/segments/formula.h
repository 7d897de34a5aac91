// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "kinemark/core/result.h"

namespace kinemark::analysis {

/// A formula of a segment definition as a tree: what stands in it, not what it is worth.
///
///   sum     = product { ("+" | "-") product }
///   product = sign { ("*" | "/") sign }
///   sign    = ["-" | "+"] sign | factor
///   factor  = number | name ["." part] | name "(" [ sum { "," sum } ] ")" | "(" sum ")"
///
/// A name is letters, digits and _ that does not begin with a digit, or any text in single quotes:
/// 'L.Knee Lat'.
struct Formula {
  /// What a node is.
  enum class Kind : std::uint8_t { number, name, call };
  Kind kind = Kind::number;        ///< of this node
  double value = 0.0;              ///< number
  std::string name;                ///< name, or the function that is called; "+", "-", "*", "/", "neg"
  std::string part;                ///< what of it: "x", "y", "z" or "o" of a segment; empty: all
  std::vector<Formula> arguments;  ///< call
};

/// Read a formula; Code::bad_input with the column (from 1) and what was expected. At most 2,000 letters and
/// 64 levels of brackets.
[[nodiscard]] Result<Formula> parse_formula(std::string_view text);

}  // namespace kinemark::analysis
