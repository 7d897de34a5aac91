// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// Goals in the images of calibrated cameras: the image of a point of the body shall agree with the measured
// one. One camera fixes two directions of the point, the third follows from the body; two cameras fix its
// position.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "kinemark/core/result.h"
#include "kinemark/data/image_tracks.h"
#include "kinemark/model/model.h"
#include "kinemark/stages/motion/control/task.h"
#include "kinemark/stages/motion/control/tasks.h"

namespace kinemark::motion {

/// Options of camera_task(). cutoff_hz and fade_s have the same meaning as for markers, see TrackOptions.
struct CameraTaskOptions {
  double weight = 1.0;  ///< > 0; with 1, a row counts like a coordinate of a marker
  double cutoff_hz =
      6.0;              ///< of the images, zero phase, -3 dB; 0: goals are the samples; else >= rate / 1000
  double fade_s = 0.1;  ///< > 0; the weight of a camera grows and shrinks over this time beside its gaps
};

/// Move a point of a body to where the cameras see one of the tracks: 2 rows per camera, in the units of its
/// images.
///
/// Image errors are scaled to metres at the present depth of the point, so that weights are comparable with
/// those of markers. A camera has weight 0 when it does not see the point in this frame and the next, and
/// when the point is behind it or more than 84 degrees off its axis. The ends of the tracks
/// are no gaps; beyond them the nearest goal stays and fades. A track of a single frame is a constant goal.
/// `sd` is the noise of the camera, as much of it as the low-pass leaves.
///
/// Errors in tracks, point or options are reported by bind(). Copies what it needs of `tracks`.
/// evaluate() costs three projections per camera.
///
/// LockMode::automatic evaluates tasks at nine instants of the recording to find which coordinates they move.
/// When no camera sees the point at any of these, use LockMode::off.
/// @param point  x_in_body in m, finite; the body must be able to move
/// @param name   of the track
[[nodiscard]] std::shared_ptr<Task> camera_task(BodyPoint point, const data::ImageTracks& tracks,
                                                std::string name, const CameraTaskOptions& options = {});

/// One task for every marker of the model that the tracks name, in the order of the model. Markers that are
/// fixed to the ground, or that no camera sees in two frames in a row, are left out; fails when none is left.
[[nodiscard]] Result<std::vector<std::shared_ptr<Task>>> camera_tasks(const model::Model& model,
                                                                      const data::ImageTracks& tracks,
                                                                      const CameraTaskOptions& options = {});

}  // namespace kinemark::motion
