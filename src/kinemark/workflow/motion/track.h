// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// Joint angles by direct control of markers, frame by frame, with the torques that the control takes.
#pragma once

#include <optional>

#include "kinemark/core/progress.h"
#include "kinemark/core/result.h"
#include "kinemark/data/image_tracks.h"
#include "kinemark/data/recording.h"
#include "kinemark/data/trajectories.h"
#include "kinemark/model/model.h"
#include "kinemark/stages/motion/control/track.h"
#include "kinemark/workflow/motion/gates.h"
#include "kinemark/workflow/motion/torques.h"
#include "kinemark/workflow/remarks.h"

namespace kinemark::workflow {

/// What is asked of track().
struct TrackOptions {
  motion::TrackOptions track;                 ///< levels of priority, gains, step
  MarkerBounds bounds;                        ///< of the gates
  const data::ImageTracks* images = nullptr;  ///< on the markers' frames: they join the lowest level
  Progress progress;                          ///< frames
};

/// A motion that followed markers.
struct TrackFound {
  motion::TrackResult result;              ///< motion and fit
  TorqueAccount torques;                   ///< with forces; else empty
  std::optional<data::Trajectories> used;  ///< markers as they were used, where each frame of the motion is
                                           ///< one of the recording
  Remarks remarks;  ///< of the fit, of the torques; gates on distances, frames, samples
};

/// Follow the markers of a recording, which is in the model's axes (bring_into_axes()). What the controller
/// pushes with knows nothing of the ground: where the recording has forces the torques are made anew from the
/// motion and these. Fails as motion::track_markers(), motion::camera_tasks() and add_torques().
/// Source: Demircan et al. 2008.
[[nodiscard]] Result<TrackFound> track(const model::Model& model, const data::Recording& recording,
                                       const TrackOptions& options = {});

}  // namespace kinemark::workflow
