// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// Observations of the markers as input of the smoother: for every frame and marker the information about its
// position (an inverse covariance) and the gradient of the cost. Points in space, images of calibrated
// cameras and any other function of the marker positions can be observations.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "kinemark/core/array.h"
#include "kinemark/data/trajectories.h"

namespace kinemark::motion {

/// One frame's observations, linearized about given marker positions. M markers.
struct MarkerInformation {
  Eigen::Matrix3Xd descent;           ///< 3 x M, minus the gradient of `cost` by each marker's position, 1/m
  Eigen::VectorXd weight;             ///< M, information common to the three axes, 1/m^2; 0 where not seen
  std::vector<Eigen::Matrix3d> full;  ///< M, information besides `weight`, 1/m^2; or empty
  double cost = 0.0;                  ///< half the sum of squares, each over its variance (or a robust loss)

  /// M markers, nothing seen.
  void clear(Eigen::Index markers, bool with_full);
};

/// What cameras or markers saw of the body, frame by frame, as the smoother asks for it.
class Observations {
 public:
  Observations() = default;
  Observations(const Observations&) = delete;
  Observations& operator=(const Observations&) = delete;
  virtual ~Observations() = default;

  /// Linearize the observations of frame f about marker positions p (3 x M, m). Sizes `out`; allocates only
  /// then.
  virtual void linearize(std::int64_t f, const Eigen::Matrix3Xd& p, MarkerInformation& out) const = 0;
};

/// Noise and robust threshold of one marker.
struct MarkerTrust {
  double information = 1e6;  ///< 1/m^2 per axis: the inverse variance of its noise
  double huber_m = 1e300;    ///< Huber threshold: residuals beyond it count linearly
};

/// Markers measured in space. `column` gives each model marker its index in the recording, frame 0 is
/// `first_frame` of it. Both must outlive this.
class MarkerObservations final : public Observations {
 public:
  /// @param column  for each model marker its index in `markers`
  /// @param first_frame  of `markers`, where the motion begins
  /// @param trust  one a used marker
  MarkerObservations(const data::Trajectories& markers, std::vector<int> column, std::int64_t first_frame,
                     std::vector<MarkerTrust> trust);
  void linearize(std::int64_t f, const Eigen::Matrix3Xd& p, MarkerInformation& out) const override;

 private:
  const data::Trajectories& markers_;
  std::vector<int> column_;
  std::int64_t first_frame_;
  std::vector<MarkerTrust> trust_;
};

}  // namespace kinemark::motion
