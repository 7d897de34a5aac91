// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// What was seen of the markers, as the smoother takes it: for every frame and marker the information about
// its place (an inverse covariance) and the pull of the residual. Points in space, images of calibrated
// cameras and anything else that is a function of marker places fit in.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "kinemark/core/array.h"
#include "kinemark/data/trajectories.h"

namespace kinemark::motion {

/// One frame's sightings, linear about the places that were asked for. M markers.
struct MarkerInformation {
  Eigen::Matrix3Xd pull;              ///< 3 x M, minus the gradient of `cost` by each marker's place, 1/m
  Eigen::VectorXd weight;             ///< M, information common to the three axes, 1/m^2; 0 where not seen
  std::vector<Eigen::Matrix3d> full;  ///< M, information besides `weight`, 1/m^2; or empty
  double cost = 0.0;                  ///< half the sum of squares, each over its variance (or a robust loss)

  /// M markers, nothing seen.
  void clear(Eigen::Index markers, bool with_full);
};

class Sightings {
 public:
  Sightings() = default;
  Sightings(const Sightings&) = delete;
  Sightings& operator=(const Sightings&) = delete;
  virtual ~Sightings() = default;

  /// What frame f says when the markers are at p (3 x M, m). Sizes `out`; allocates only then.
  virtual void look(std::int64_t f, const Eigen::Matrix3Xd& p, MarkerInformation& out) const = 0;
};

/// How much is known of one marker.
struct MarkerTrust {
  double information = 1e6;  ///< 1/m^2 per axis: the inverse variance of its noise
  double bend_m = 1e300;     ///< residuals beyond it count linearly (Huber)
};

/// Cost and pull of a point seen at distance r: isotropic, with Huber's loss.
[[nodiscard]] double add_point(const MarkerTrust& trust, const Eigen::Vector3d& residual, Eigen::Index m,
                               MarkerInformation& out);

/// Markers measured in space. `column` gives each model marker its place in the recording, frame 0 is
/// `first_frame` of it. Both must outlive this.
class MarkerSightings final : public Sightings {
 public:
  MarkerSightings(const data::Trajectories& markers, std::vector<int> column, std::int64_t first_frame,
                  std::vector<MarkerTrust> trust);
  void look(std::int64_t f, const Eigen::Matrix3Xd& p, MarkerInformation& out) const override;

 private:
  const data::Trajectories& markers_;
  std::vector<int> column_;
  std::int64_t first_frame_;
  std::vector<MarkerTrust> trust_;
};

}  // namespace kinemark::motion
