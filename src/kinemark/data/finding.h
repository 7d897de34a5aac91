// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// Something that a stage noticed in a recording or in its own result: what kind, of whom, when, how large and
// how sure. Stages give the facts; describe() is the one place that puts them into words.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "kinemark/core/missing.h"
#include "kinemark/core/result.h"
#include "kinemark/core/time_base.h"

namespace kinemark::data {

/// What was noticed. In brackets: what `size` is of it.
enum class FindingKind : std::uint8_t {
  zero,              ///< a marker exactly at (0, 0, 0): written by exporters for "not seen" [none]
  stuck,             ///< a marker holds its last value while others move [none]
  duplicated_frame,  ///< all markers repeat the frame before [none]
  clock_jump,        ///< frames are missing or repeated in time [frames]
  unit_slip,         ///< a thousand times too large or too small [times, below 1: too small]
  spike,             ///< one to three samples away from a path that goes on undisturbed [m]
  swap_within,       ///< a marker jumps to the path of its partner and back [m, of the jump]
  label_swap,        ///< two markers carry each other's label [m, between them]
  marker_slip,       ///< a marker lies elsewhere on its segment, the partner, from a frame on [m]
  joint_slip,        ///< a joint lies elsewhere in its segment, the partner, in the second half [m]
  loose_marker,      ///< a marker moves on its segment by more than its noise [m, RMS per axis]
  unexplained,       ///< frames that rigid segments and noise do not explain [frames]
  at_limit,          ///< a coordinate rests at a limit of its range [share of the frames, 0 to 1]
  not_settled,       ///< an iteration over the whole recording ended before it settled [iterations]
  flagged,           ///< frames in which a controller did not reach its goals [frames]
  outlier,  ///< samples left out: neither model nor neighbours in time explain them [m, the farthest]
};

/// "zero", "stuck", "duplicated frame", "clock jump", "unit slip", "spike", "swap within", "label swap",
/// "marker slip", "joint slip", "loose marker", "unexplained", "at limit", "not settled", "flagged",
/// "outlier".
[[nodiscard]] std::string_view to_string(FindingKind kind);

/// What screening, gaps, joints or motion noticed: who, when, how large, how sure.
struct Finding {
  FindingKind kind = FindingKind::zero;  ///< what was noticed
  std::string subject;                   ///< marker, joint, coordinate or method; empty: all markers
  std::string partner;                   ///< the other marker of a swap, the segment of a slip; empty: none
  std::int64_t first_frame = -1, last_frame = -1;  ///< both ends belong to it; -1: not tied to frames
  std::vector<std::int64_t> frames;                ///< those of them, in order; empty: all
  double size = kNaN;                              ///< as its kind says, in m, frames, ...; NaN: not known
  double size_sd = kNaN;     ///< one standard deviation of the size, same unit; NaN: not known
  double confidence = kNaN;  ///< 0 to 1; NaN: whoever found it did not doubt it
  std::string detail;        ///< further evidence, follows the sentence behind a colon; may be empty
  /// The finder's own words, as describe() words a finding, where they tell of evidence that the facts above
  /// do not hold; empty: describe() makes them from the facts.
  std::string description;

  /// How many frames it is about.
  [[nodiscard]] std::int64_t frame_count() const;
  /// Below 0.8 a person should look.
  [[nodiscard]] bool sure() const { return !(confidence < 0.8); }
  /// Frames come in order, swaps name both markers, SD and confidence are in range.
  [[nodiscard]] Status validate() const;
};

/// The finding in one sentence with numbers and units, begun in lower case and without full stop: "marker
/// 'LASI' leaves its path by 12.0 mm in frames 20 to 22 (0.2 to 0.22 s)". @param time  of the recording whose
/// frames the finding names
[[nodiscard]] std::string describe(const Finding& finding, const TimeBase& time);

/// The same as a sentence of its own, with capital letter and full stop, and without a word on how certain it
/// is, for those who show the confidence beside it.
[[nodiscard]] std::string sentence_of(const Finding& finding, const TimeBase& time);

/// All findings in sentences, in order; outliers of one marker, with one partner and detail, in one sentence
/// where the first of them stands: "marker 'LASI' was left out in 12 frames (3, 8 to 14, 20 and 3 more
/// stretches): up to 64.5 mm from where ...".
[[nodiscard]] std::vector<std::string> describe_all(std::span<const Finding> findings, const TimeBase& time);

}  // namespace kinemark::data
