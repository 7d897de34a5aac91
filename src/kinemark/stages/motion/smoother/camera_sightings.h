// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// Markers seen in the images of calibrated cameras: a marker that one camera sees says two things about its
// place, and the body says the third.
#pragma once

#include "kinemark/data/image_tracks.h"
#include "kinemark/stages/motion/smoother/smoother.h"

namespace kinemark::motion {

/// Images as information about marker places: sum over the cameras of D'D / noise^2, D the slope of the
/// image by the place. `column` gives each model marker its place in the tracks (-1: none); frame 0 is
/// `first_frame` of them, which must outlive this. Points behind a camera say nothing. Residuals beyond
/// bend_sd count linearly (0: never).
class CameraSightings final : public Sightings {
 public:
  CameraSightings(const data::ImageTracks& tracks, std::vector<int> column, std::int64_t first_frame,
                  double bend_sd);
  void look(std::int64_t f, const Eigen::Matrix3Xd& p, MarkerInformation& out) const override;

 private:
  const data::ImageTracks& tracks_;
  std::vector<int> column_;
  std::int64_t first_frame_;
  double bend_sd_;
};

/// smooth_motion() on images. `markers` holds what could be triangulated (places of markers that two cameras
/// or more saw; as many frames as the tracks): the start comes from it, and names that the tracks lack are
/// left out. The noise of the images is what the tracks say; soft tissue is not in the bars.
[[nodiscard]] Result<SmootherResult> smooth_images(const model::Model& model, const data::ImageTracks& tracks,
                                                   const data::Trajectories& markers,
                                                   const SmootherOptions& options = {},
                                                   const Progress& progress = {});

}  // namespace kinemark::motion
