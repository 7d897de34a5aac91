// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "kinemark/core/array.h"
#include "kinemark/core/result.h"
#include "kinemark/core/time_base.h"
#include "kinemark/data/rig.h"

namespace kinemark::data {

/// Labelled points in the images of calibrated cameras: F frames, C cameras, M markers. Image coordinates are
/// uncorrected: they contain the lens distortion and detector warp of the cameras.
struct ImageTracks {
  std::vector<std::string> names;  ///< M
  std::vector<Camera> cameras;     ///< C, calibrated
  std::vector<double> noise_sd;    ///< C, per axis, in the camera's image units; > 0
  TimeBase time;                   ///< F = time.frames; one clock for all cameras
  Array<double> image;  ///< F x C x M x 2, image units; NaN where the camera did not see the marker

  [[nodiscard]] std::int64_t frames() const { return time.frames; }  ///< F
  /// Index of x in `image`; y follows it.
  [[nodiscard]] std::size_t index(std::int64_t frame, std::size_t camera, std::size_t marker) const {
    return 2 * ((static_cast<std::size_t>(frame) * cameras.size() + camera) * names.size() + marker);
  }
  /// A point in a camera's image, image units; NaN where not seen.
  [[nodiscard]] Eigen::Vector2d at(std::int64_t frame, std::size_t camera, std::size_t marker) const {
    return Eigen::Map<const Eigen::Vector2d>(image.data() + index(frame, camera, marker));
  }
  /// Shapes agree, noise is positive.
  [[nodiscard]] Status validate() const;
};

}  // namespace kinemark::data
