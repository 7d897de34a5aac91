// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "kinemark/core/result.h"
#include "kinemark/data/skeleton.h"
#include "kinemark/data/trajectories.h"

namespace kinemark::skeleton {

/// A marker or joint whose position on its segment changed during a recording.
struct Slip {
  int segment = 0;  ///< of the layout
  int marker = -1;  ///< of the recording; -1: all markers of the segment together, seen by a joint
  int joint = -1;   ///< that shows it when marker is -1
  double shift_m = 0.0, sd_m = 0.0;  ///< how far, and its standard deviation
  std::int64_t frame = 0;            ///< about when
  std::string sentence;              ///< the same in words
};

/// Options of find_slips().
struct SlipOptions {
  double sure_sd = 5.0;    ///< > 0; shifts below so many of their SDs are not reported
  double least_m = 0.002;  ///< >= 0; smaller ones do not matter

  /// Ranges hold.
  [[nodiscard]] Status check() const;
};

/// Compares the shape of every segment, and the position of every ball joint in it, before and after. A
/// marker's position in its segment is compared across the frame of the largest cumulative deviation; joints
/// between the first and the second half. SDs are of blocks of frames, so slow soft-tissue motion counts as
/// noise.
/// Code::bad_input when the layout does not fit. O(F M).
[[nodiscard]] Result<std::vector<Slip>> find_slips(const data::Trajectories& trajectories,
                                                   const data::SegmentLayout& layout,
                                                   const SlipOptions& options = {});

}  // namespace kinemark::skeleton
