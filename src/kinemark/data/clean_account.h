// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// What was done to the markers of a recording, and why: filled in by the stages of cleaning one after the
// other, read by whoever tells people about it.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "kinemark/core/result.h"
#include "kinemark/data/finding.h"
#include "kinemark/data/gap_account.h"
#include "kinemark/data/marker_account.h"
#include "kinemark/data/upsampling.h"

namespace kinemark::data {

/// Something wrong with samples, and what was done about it.
struct Defect {
  Finding finding;       ///< tied to frames; its subject and partner are markers
  std::string done;      ///< in words: "rejected", "left as it is", ...; empty: nobody has decided
  bool handled = false;  ///< a sure one that is not handled needs attention
};

/// M markers. Frames and markers are counted from 0.
struct CleanAccount {
  std::vector<std::string> names;      ///< M
  UpsamplingAccount upsampling;        ///< whether the recorder made samples
  std::vector<Defect> defects;         ///< from screening and from the label check of the gaps
  std::vector<GapAccount> gaps;        ///< by marker and frame
  std::vector<MarkerAccount> markers;  ///< M, or the first of them while smoothing goes on

  /// Name of a marker; empty for -1, which stands for all of them.
  [[nodiscard]] std::string name_of(std::int64_t marker) const;

  /// Defects are of markers that are there and validate(), indices are in range, no gap ends before it
  /// begins, there are not more accounts of markers than names, and upsampling tells of all markers or of
  /// none. O(all).
  [[nodiscard]] Status validate() const;
};

}  // namespace kinemark::data
