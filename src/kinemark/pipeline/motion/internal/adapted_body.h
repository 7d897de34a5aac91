// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// The body that follows a recording, with the sizes that the recording shows.
#pragma once

#include <string>
#include <vector>

#include "kinemark/core/result.h"
#include "kinemark/pipeline/motion/internal/motion_run.h"
#include "kinemark/pipeline/motion/track_job.h"
#include "kinemark/stages/motion/scaling/adapt.h"

namespace kinemark::pipeline::internal {

inline constexpr const char* kAdaptedModel = "_model.osim";  ///< its suffix

/// A body whose sizes were adapted.
struct AdaptedBody {
  motion::AdaptResult result;     ///< sizes, lengths, positions of markers, with their deviations
  std::string text;               ///< the model with them, XML
  std::vector<std::string> lost;  ///< what the job's model holds and the text does not, one sentence each
  workflow::Remarks remarks;      ///< of the sizes
};

/// Find sizes of segments and positions of markers at which the recording fits best (workflow::scale), and
/// put the model that has them in the place of that of `inputs`. Weights, noise and the range of time are the
/// job's. Fails as io::OsimDocument and workflow::scale().
[[nodiscard]] Result<AdaptedBody> adapt_body(const TrackJob& job, MotionInputs& inputs);

}  // namespace kinemark::pipeline::internal
