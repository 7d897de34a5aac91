// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// The arithmetic of one force plate.
#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "kinemark/core/result.h"
#include "kinemark/data/trial.h"

namespace kinemark::io::internal {

/// Force and moment.
using Vector6 = Eigen::Matrix<double, 6, 1>;
using PlateChannels = Eigen::Matrix<double, Eigen::Dynamic, 1, Eigen::ColMajor, 12, 1>;  ///< 6, 8 or 12

/// Whether forces are read from plates of that type of C3D, and how many channels they have: 0 where not.
[[nodiscard]] std::size_t channels_needed(int type);

/// What one sample of a plate's channels gives: force (N) and moment (N m) about the centre of its surface,
/// in the plate's axes and with the sign of the file.
class PlateWrench {
 public:
  /// `units` of all analog channels. A plate that cannot be computed: Code::not_supported or bad_input, with
  /// the reason as half a sentence.
  static Result<PlateWrench> create(const data::ForcePlate& plate, const std::vector<std::string>& units);

  /// Force and moment of a sample.
  [[nodiscard]] Vector6 operator()(const PlateChannels& channels) const;
  /// Channels whose baseline is a force or moment that was there before anybody stepped on the plate.
  [[nodiscard]] bool has_baseline(std::size_t channel) const {
    return !is_pressure_point_ || channel < 3 || channel > 4;
  }
  /// Whether the point of the force comes from channels whose unit a word gives: moments, or the point itself
  /// (type 1); of four sensors it comes from where these are.
  [[nodiscard]] bool has_moment_unit() const { return has_moment_unit_; }
  /// Take these channels for `factor` times what their unit says.
  void scale_moments(double factor);
  /// Whether ORIGIN lay above the surface, and was reversed.
  [[nodiscard]] bool origin_flipped() const { return origin_flipped_; }
  /// Channels whose unit is no word of their quantity, "channel 4 in 'furlong'": taken as N, and N times the
  /// file's unit of length.
  [[nodiscard]] const std::vector<std::string>& unknown_units() const { return unknown_units_; }

 private:
  bool is_pressure_point_ = false;  ///< type 1: channels 3 and 4 are the centre of pressure
  bool origin_flipped_ = false;
  bool has_moment_unit_ = false;
  std::vector<std::string> unknown_units_;
  PlateChannels scale_;  ///< of each channel, to N, N m and m
  Eigen::Matrix<double, 6, Eigen::Dynamic, Eigen::ColMajor, 6, 12> matrix_;
  Eigen::Vector3d centre_ =
      Eigen::Vector3d::Zero();  ///< of the surface, in the axes and from the origin of the plate
};

/// Where a plate lies: origin at the centre of its surface, x from corner 2 to 1, y from corner 4 to 1.
struct PlatePose {
  Eigen::Vector3d centre;            ///< m, in the laboratory
  Eigen::Matrix3d world_from_plate;  ///< a rotation
  Eigen::Vector2d half_size;         ///< m
};

/// Corners that are not plausible or span no rectangle are Code::bad_input.
[[nodiscard]] Result<PlatePose> plate_pose(const data::ForcePlate& plate);

}  // namespace kinemark::io::internal
