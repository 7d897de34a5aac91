// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "kinemark/core/result.h"

namespace kinemark::studies {

/// What the number is that stands beside ours as expected.
enum class Expectation : std::uint8_t {
  right_value,   ///< of an estimate whose error bars are right, or that reaches its bound: 1, 68.3 %, ...
  cramer_rao,    ///< Cramer-Rao bound of the same samples as `ours`
  frame_alone,   ///< Cramer-Rao bound of each frame alone, beside an estimate that uses other frames too
  predicted_sd,  ///< standard deviation that came with the same estimates as `ours`
};

/// "right value", "Cramer-Rao bound", "Cramer-Rao bound of a frame alone", "predicted SD".
[[nodiscard]] std::string_view to_string(Expectation expectation);

/// One line of a study's table. Values that are not available are absent. A row without a bound is a figure:
/// it cannot fail, and is called so.
struct StudyRow {
  std::string quantity, unit;
  std::optional<double> paper;    ///< as published
  std::optional<double> classic;  ///< by the paper's own method, or the field's, on our data
  double ours = 0.0;
  std::optional<double> expected;  ///< as `expected_is` says, of the same samples as `ours`
  Expectation expected_is = Expectation::right_value;
  std::optional<double> at_least, at_most;  ///< what is asked of `ours`
  /// Whether anything is asked.
  [[nodiscard]] bool has_bound() const { return at_least || at_most; }
  /// Within its bounds, of which there may be none; NaN is not.
  [[nodiscard]] bool pass() const {
    return !(at_least && !(ours >= *at_least)) && !(at_most && !(ours <= *at_most));
  }
};

struct StudyTable {
  std::vector<std::uint64_t> seeds;
  std::vector<StudyRow> rows;
  [[nodiscard]] bool has_bound() const;  ///< of one row or more
  [[nodiscard]] bool pass() const;       ///< every row that has a bound
};

/// "3", "1-10" or "1,4,7-9"; 1000 seeds at most.
[[nodiscard]] Result<std::vector<std::uint64_t>> parse_seeds(std::string_view text);

/// {"seeds": [...], "rows": [{quantity, unit, paper, classic, ours, expected, expected_is, bound, pass}],
/// "pass": ...}; bound is a number (at most) or [at least, at most]; what is absent is null, and so is `pass`
/// without a bound.
[[nodiscard]] nlohmann::ordered_json study_json(const StudyTable& table);
/// The unit as displayed: empty for a plain number, whose unit is "1".
[[nodiscard]] std::string_view unit_text(const StudyRow& row);
/// What the columns hold, in sentences; those on expectations only where a row has such a one.
[[nodiscard]] std::string column_text(const StudyTable& table);
/// The expected value as displayed: "0.41 CR", "2 SD", "68.3"; empty without one.
[[nodiscard]] std::string expected_text(const StudyRow& row);
/// "2 of 59 bounds are missed: A; B." or "None of 59 bounds is missed.", and " 12 more rows have no bound."
/// where there are such; empty without a bound.
[[nodiscard]] std::string missed_text(const StudyTable& table);
/// The table as text with aligned columns, a line that explains them, and one that counts.
[[nodiscard]] std::string study_text(const StudyTable& table);

}  // namespace kinemark::studies
