// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "kinemark/core/missing.h"

namespace kinemark::data {

/// What can be wrong with samples.
enum class DefectKind : std::uint8_t {
  zero,              ///< exactly (0, 0, 0): written by exporters for "not seen"
  stuck,             ///< the last value held while marker and neighbours move
  duplicated_frame,  ///< all markers repeat the frame before
  clock_jump,        ///< frames missing or repeated in time
  unit_slip,         ///< a thousand times too large or too small
  spike,             ///< one to three samples away from a path that goes on undisturbed
  swap_within,       ///< jumps to the path of another marker and back
  label_swap,        ///< two markers exchange their labels
};

/// "zero", "stuck", "duplicated frame", "clock jump", "unit slip", "spike", "swap within", "label swap".
[[nodiscard]] std::string_view to_string(DefectKind kind);

/// One defect of a recording: where, how strong the evidence is, a sentence that says it with numbers, and
/// what was done about it.
struct Defect {
  DefectKind kind = DefectKind::zero;  ///< what is wrong
  std::int64_t marker = -1;            ///< -1: all markers
  std::int64_t other_marker = -1;      ///< the partner of a swap, else -1
  std::int64_t first_frame = 0;        ///< both ends belong to it
  std::int64_t last_frame = 0;         ///< both ends belong to it
  double evidence = kNaN;    ///< the deciding ratio, larger is stronger; what it is depends on the kind;
                             ///< NaN: none was formed
  double confidence = kNaN;  ///< 0 to 1; below 0.8 a person should check; NaN: whoever found it had no doubt
  std::string sentence;      ///< the same in words
  std::string done;          ///< in words: "rejected", "left as it is", ...; empty: nobody has decided
  bool handled = false;      ///< false with a confidence of 0.8 and more: needs attention
};

}  // namespace kinemark::data
