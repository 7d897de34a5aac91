// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "kinemark/data/trajectories.h"
#include "kinemark/stream/stream.h"

namespace kinemark::stream {

/// Gives the frames of a recording that is in memory, from the first to the last.
class RecordedSource final : public Source {
 public:
  /// @param facts  name and vertical; markers, rate, times, count of frames and extent are those of the
  /// recording
  RecordedSource(data::Trajectories markers, SourceFacts facts);
  /// Never fails. O(M).
  [[nodiscard]] Result<bool> next(Frame& frame) override;

 private:
  data::Trajectories markers_;
  std::int64_t next_ = 0;
};

}  // namespace kinemark::stream
