// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// What all reports have: inputs with their hashes, quality gates, notices, and the bound on a page's size.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "kinemark/core/missing.h"
#include "kinemark/core/result.h"
#include "kinemark/data/run_record.h"

namespace kinemark::report {

using data::Gate;
using data::InputFile;

/// What a report says in a word.
enum class Verdict : std::uint8_t { good, attention };

[[nodiscard]] std::string_view to_string(Verdict verdict);  ///< "good", "attention"

/// One entry of the list "what needs your attention".
struct Notice {
  Verdict level = Verdict::good;  ///< attention: the result should be checked by a person before use
  std::string about;              ///< "gate", "frames", "coordinate", "marker", "gap", ... or "warning"
  std::string subject;            ///< name of the gate, coordinate or marker; may be empty
  std::string text;               ///< one sentence
  double time_s = kNaN;           ///< where to look first
};

/// Remarks of one kind, folded into one line.
struct NoticeGroup {
  Verdict level = Verdict::good;  ///< of the line
  std::string title;              ///< "7 markers partly missing"
  std::vector<Notice> items;      ///< one each, in the order of the file
};

/// Fold remarks of one kind into a line, "3 markers never seen"; nothing where there are none.
/// @param about  of each item, see Notice
/// @param one    the words for one of them, @param many  for several
void add_group(std::vector<NoticeGroup>& groups, Verdict level, std::string_view about, std::string_view one,
               std::string_view many, std::vector<Notice> items);

/// attention when a group has that level.
[[nodiscard]] Verdict verdict_of(const std::vector<NoticeGroup>& groups);

/// How much of the arrays goes into a page.
struct ReportOptions {
  std::int64_t max_points = 20'000;         ///< per plotted curve, at least 2
  std::int64_t max_data_bytes = 2'000'000;  ///< of all curves and the space view as they stand in the page

  [[nodiscard]] Status check() const;  ///< Ranges hold.
};

}  // namespace kinemark::report
