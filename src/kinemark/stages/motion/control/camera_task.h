// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// Goals in the images of calibrated cameras: a point of the body is to be seen where the cameras saw it. One
// camera fixes two directions of a point and leaves the third to the body; two cameras fix its place.
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

/// Options of camera_task(). The last two mean what they mean for markers, see TrackOptions.
struct CameraTaskOptions {
  double weight = 1.0;  ///< > 0; with 1, a row counts like a coordinate of a marker
  double cutoff_hz =
      6.0;              ///< of the images, zero phase, -3 dB; 0: goals are the samples; else >= rate / 1000
  double fade_s = 0.1;  ///< > 0; the weight of a camera grows and shrinks over this time beside its gaps
};

/// Bring a point of a body to where cameras see one of the tracks: 2 rows per camera, in the units of its
/// images.
///
/// A pixel counts as much as what it covers at the present depth of the point, so that weights compare with
/// those of markers. A camera that does not see the point in this frame and the next says nothing; nor does
/// one that would have to see it behind itself or more than 84 degrees off its axis. The ends of the tracks
/// are no gaps; beyond them the nearest goal stays and fades. Tracks of a single frame stay for ever. `sd` is
/// the noise of the camera, as much of it as the low-pass leaves.
///
/// What is wrong with tracks, point or options is said by bind(). Copies what it needs of `tracks`.
/// evaluate() costs three projections per camera.
///
/// LockMode::automatic asks tasks what they move at nine instants of the recording: where no camera sees the
/// point at any of them, lock nothing (LockMode::off).
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
