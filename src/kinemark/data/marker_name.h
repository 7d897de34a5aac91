// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// The side and the stem of a marker's name, whatever its spelling: "Ann:R.Heel", "right_heel" and "RHEEL" are
// the heel of the right.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace kinemark::data {

/// A name without its side.
struct MarkerStem {
  char side = ' ';   ///< 'l', 'r'; blank: none
  std::string stem;  ///< lower-case letters and digits, not empty
  /// The side is a word of its own ("R.Heel", "left_heel"), or the name has none.
  bool sure = true;
  /// A letter behind the stem ("HEELR"): a side only where the other side has the same stem.
  bool behind = false;

  auto operator<=>(const MarkerStem&) const = default;
};

/// Readings of a name, without regard to the prefix of a subject, case and separators. A side that is a word
/// of its own is the only reading; else those with a letter as the side follow the one without a side, which
/// is first. Empty for a name without letters and digits.
[[nodiscard]] std::vector<MarkerStem> read_marker_name(std::string_view name);

/// All of a name in one spelling: side first, one letter, then the stem ("rheel").
[[nodiscard]] std::string plain_marker_name(std::string_view name);

}  // namespace kinemark::data
