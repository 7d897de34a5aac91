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

/// One line of a study's table. Values that are not available are absent.
struct StudyRow {
  std::string quantity, unit;
  std::optional<double> paper;    ///< as published
  std::optional<double> classic;  ///< by the paper's own method, or the field's, on our data
  double ours = 0.0;
  std::optional<double> limit;  ///< what is possible: Cramer-Rao bound, or the predicted deviation
  std::optional<double> at_least, at_most;  ///< what is asked of `ours`
  /// Within its bounds; NaN is not.
  [[nodiscard]] bool pass() const {
    return !(at_least && !(ours >= *at_least)) && !(at_most && !(ours <= *at_most));
  }
};

struct StudyTable {
  std::vector<std::uint64_t> seeds;
  std::vector<StudyRow> rows;
  [[nodiscard]] bool pass() const;  ///< every row
};

/// "3", "1-10" or "1,4,7-9"; 1000 seeds at most.
[[nodiscard]] Result<std::vector<std::uint64_t>> parse_seeds(std::string_view text);

/// {"seeds": [...], "rows": [{quantity, unit, paper, classic, ours, limit, bound, pass}], "pass": ...}; bound
/// is a number (at most) or [at least, at most]; what is absent is null.
[[nodiscard]] nlohmann::ordered_json study_json(const StudyTable& table);
/// The unit as displayed: empty for a plain number, whose unit is "1".
[[nodiscard]] std::string_view unit_text(const StudyRow& row);
/// The table as text with aligned columns, and a line that explains them.
[[nodiscard]] std::string study_text(const StudyTable& table);

}  // namespace kinemark::studies
