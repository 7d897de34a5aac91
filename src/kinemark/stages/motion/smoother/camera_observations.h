// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// Markers observed in the images of calibrated cameras. One camera determines two directions of a marker's
// position; the body model determines the third.
#pragma once

#include "kinemark/data/image_tracks.h"
#include "kinemark/stages/motion/smoother/observations.h"
#include "kinemark/stages/motion/smoother/smoother.h"

namespace kinemark::motion {

/// Images as information about marker positions: sum over the cameras of D'D / noise^2, D the derivative of
/// the image by the position. `column` gives each model marker its index in the tracks (-1: none); frame 0 is
/// `first_frame` of them, which must outlive this. Points behind a camera give no information. Residuals
/// beyond huber_sd count linearly (0: never).
class CameraObservations final : public Observations {
 public:
  /// @param column  for each model marker its index in `tracks`
  /// @param first_frame  of `tracks`, where the motion begins
  CameraObservations(const data::ImageTracks& tracks, std::vector<int> column, std::int64_t first_frame,
                     double huber_sd);
  void linearize(std::int64_t f, const Eigen::Matrix3Xd& p, MarkerInformation& out) const override;

 private:
  const data::ImageTracks& tracks_;
  std::vector<int> column_;
  std::int64_t first_frame_;
  double huber_sd_;
};

/// smooth_motion() on images. `markers` holds the triangulated points (markers seen by two cameras or more;
/// as many frames as the tracks), from which the start is computed; markers that the tracks lack are left
/// out. The noise of the images is that of the tracks; the error bars do not include soft tissue.
[[nodiscard]] Result<SmootherResult> smooth_images(const model::Model& model, const data::ImageTracks& tracks,
                                                   const data::Trajectories& markers,
                                                   const SmootherOptions& options = {},
                                                   const Progress& progress = {});

}  // namespace kinemark::motion
