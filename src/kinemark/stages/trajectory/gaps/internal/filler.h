// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "kinemark/stages/trajectory/gaps/gap_options.h"
#include "kinemark/stages/trajectory/gaps/internal/combine.h"
#include "kinemark/stages/trajectory/gaps/internal/fills.h"
#include "kinemark/stages/trajectory/gaps/internal/label_check.h"

namespace kinemark::trajectory::internal {

/// A stretch as it was filled.
struct Filled {
  GapProblem problem;
  std::vector<Fill> fills;  ///< empty when nothing could be made
  Combination combination;  ///< SD with the noise of a sample
};

/// A recording made ready for filling. Filling one stretch does not change it.
class Filler {
 public:
  Filler(const data::Trajectories& in, const GapOptions& options);

  [[nodiscard]] const Recording& recording() const { return recording_; }
  [[nodiscard]] const std::vector<Swap>& swaps() const { return swaps_; }
  /// SD of a sample of a marker, m per axis.
  [[nodiscard]] double noise_m(Index marker) const { return noise_m_[static_cast<std::size_t>(marker)]; }
  /// The stretch with the usable samples beside it, 0.3 s of them at most.
  [[nodiscard]] GapSpan span(Index marker, Index first, Index end) const;
  /// The method takes other markers into account.
  [[nodiscard]] bool uses_neighbours() const;
  /// Safe from several threads at once.
  [[nodiscard]] Filled fill(const GapSpan& span, const std::vector<Neighbour>& neighbours) const;

 private:
  GapOptions options_;
  Recording recording_;
  std::vector<double> noise_m_;
  std::vector<Swap> swaps_;
  mutable WalkCache cache_;  // remembers matrices; never changes a result
};

}  // namespace kinemark::trajectory::internal
