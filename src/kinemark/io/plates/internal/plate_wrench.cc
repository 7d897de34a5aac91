// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/io/plates/internal/plate_wrench.h"

#include <fmt/core.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <optional>
#include <utility>

#include "kinemark/core/force_unit.h"
#include "kinemark/core/length_unit.h"
#include "kinemark/core/number.h"
#include "kinemark/core/utf8.h"

namespace kinemark::io::internal {
namespace {

using Eigen::Vector3d;

/// What a channel's unit is worth; a word that is none of its quantity gives what the manual takes, and is
/// named.
struct ChannelUnits {
  const data::ForcePlate& plate;
  const std::vector<std::string>& units;
  std::vector<std::string> unknown;  ///< "channel 4 in 'furlong'"

  double newtons(std::size_t c) { return value_or(c, newtons_per_unit(word(c)), 1.0); }
  /// The manual gives moments in N x unit of length; another unit named by the channel takes precedence.
  double newton_metres(std::size_t c) {
    return value_or(c, newton_metres_per_unit(word(c)), plate.metres_per_unit);
  }
  double metres(std::size_t c) { return value_or(c, metres_per_unit(word(c)), plate.metres_per_unit); }

 private:
  [[nodiscard]] std::string word(std::size_t c) const {
    const auto idx = static_cast<std::size_t>(plate.channel_idx[c]);
    return idx < units.size() ? units[idx] : std::string();
  }
  double value_or(std::size_t c, std::optional<double> known, double usual) {
    if (!known && !trim(word(c)).empty())
      unknown.push_back(fmt::format("channel {} in '{}'", c + 1, printable(word(c), 20)));
    return known.value_or(usual);
  }
};

/// Force and moment about the plate's origin from the eight channels fx12 fx34 fy14 fy23 fz1 fz2 fz3 fz4 of
/// four sensors at (+-a, +-b).
Eigen::MatrixXd of_four_sensors(double a, double b) {
  Eigen::MatrixXd m = Eigen::MatrixXd::Zero(6, 8);
  m.row(0) << 1, 1, 0, 0, 0, 0, 0, 0;
  m.row(1) << 0, 0, 1, 1, 0, 0, 0, 0;
  m.row(2) << 0, 0, 0, 0, 1, 1, 1, 1;
  m.row(3) << 0, 0, 0, 0, b, b, -b, -b;
  m.row(4) << 0, 0, 0, 0, -a, a, a, -a;
  m.row(5) << -b, b, a, -a, 0, 0, 0, 0;
  return m;
}

/// The same from the three components of each of these four sensors in turn.
Eigen::MatrixXd of_four_triaxial_sensors(double a, double b) {
  constexpr double kSides[4][2] = {{1, 1}, {-1, 1}, {-1, -1}, {1, -1}};
  Eigen::MatrixXd m(6, 12);
  for (int sensor = 0; sensor < 4; ++sensor) {
    const double x = kSides[sensor][0] * a, y = kSides[sensor][1] * b;
    m.block<3, 3>(0, 3 * sensor).setIdentity();
    m.block<3, 3>(3, 3 * sensor) << 0, 0, y, 0, 0, -x, -y, x, 0;
  }
  return m;
}

/// CAL_MATRIX(i, j), i fastest: output i from channel j. A file with plates of several types pads the
/// smaller.
Result<Eigen::MatrixXd> calibration(const data::ForcePlate& plate, std::size_t size) {
  const auto n = static_cast<Eigen::Index>(size);
  const auto rows = static_cast<Eigen::Index>(plate.calibration_rows);
  const auto columns = rows > 0 ? std::ssize(plate.calibration) / rows : 0;
  if (rows < n || columns < n)
    return fail(Code::bad_input, fmt::format("is of type {} but has no CAL_MATRIX of {} x {} numbers",
                                             plate.type, size, size));
  Eigen::MatrixXd m =
      Eigen::Map<const Eigen::MatrixXd>(plate.calibration.data(), rows, columns).topLeftCorner(n, n);
  if (!m.allFinite() || m.isZero(0.0))
    return fail(Code::bad_input, "has a CAL_MATRIX of zeros or of values that are not numbers");
  return m;
}

}  // namespace

std::size_t channels_needed(int type) {
  switch (type) {
    case 1:
    case 2:
    case 4:
      return 6;
    case 3:
    case 7:
      return 8;
    case 6:
      return 12;
    default:
      return 0;
  }
}

Result<PlateWrench> PlateWrench::create(const data::ForcePlate& plate,
                                        const std::vector<std::string>& units) {
  const int type = plate.type;
  const std::size_t n = channels_needed(type);
  if (n == 0)
    return fail(Code::not_supported,
                fmt::format("is of type {}; forces are read from types 1, 2, 3, 4, 6 and 7", type));
  if (plate.channel_idx.size() < n)
    return fail(Code::bad_input,
                fmt::format("has {} analog channels; type {} needs {}", plate.channel_idx.size(), type, n));
  PlateWrench wrench;
  wrench.is_pressure_point_ = type == 1;
  // From the origin of the plate's axes to the centre of its surface; z points down, into the plate. Files
  // that give the opposite vector are recognised by its sign.
  wrench.centre_ = plate.origin_in_plate;
  wrench.origin_flipped_ = wrench.centre_.z() > 0.0;
  const bool sensors = type == 3 || type == 6 || type == 7, calibrated = type == 4 || type == 6 || type == 7;
  if (wrench.origin_flipped_ && sensors) wrench.centre_.z() *= -1.0;
  if (wrench.origin_flipped_ && !sensors) wrench.centre_ *= -1.0;

  wrench.has_moment_unit_ = !sensors;
  ChannelUnits of{.plate = plate, .units = units, .unknown = {}};
  wrench.scale_.setOnes(static_cast<Eigen::Index>(n));
  for (std::size_t c = 0; c < n; ++c) {
    double& scale = wrench.scale_[static_cast<Eigen::Index>(c)];
    if (sensors || c < 3)
      scale = of.newtons(c);
    else if (type == 1 && c < 5)
      scale = of.metres(c);
    else
      scale = of.newton_metres(c);
  }
  // The matrix of these turns volts, or whatever else comes in, into forces.
  if (!calibrated) wrench.unknown_units_ = std::move(of.unknown);
  const double a = wrench.centre_.x(), b = wrench.centre_.y();
  if (type == 6)
    wrench.matrix_ = of_four_triaxial_sensors(a, b);
  else if (sensors)
    wrench.matrix_ = of_four_sensors(a, b);
  else
    wrench.matrix_ = Eigen::MatrixXd::Identity(6, 6);
  if (calibrated) {
    auto matrix = calibration(plate, n);
    if (!matrix) return std::unexpected(matrix.error());
    // The matrix, not the channels, carries the units.
    if (!sensors) matrix->bottomRows(3).array().colwise() *= wrench.scale_.tail(3).array();
    wrench.scale_.setOnes();
    wrench.matrix_ = Eigen::MatrixXd(wrench.matrix_ * *matrix);
  }
  // Sensors lie evenly about the middle: the remaining component of ORIGIN is the depth.
  if (sensors) wrench.centre_.head<2>().setZero();
  return wrench;
}

void PlateWrench::scale_moments(double factor) {
  if (is_pressure_point_)
    scale_.segment<2>(3) *= factor;
  else
    matrix_.bottomRows<3>() *= factor;
}

Vector6 PlateWrench::operator()(const PlateChannels& channels) const {
  const PlateChannels v = scale_.cwiseProduct(channels.head(scale_.size()));
  if (is_pressure_point_) {
    const Vector3d force = v.head<3>();
    const Vector3d arm(v[3] - centre_.x(), v[4] - centre_.y(), 0.0);
    Vector6 out;
    out << force, arm.cross(force) + Vector3d(0.0, 0.0, v[5]);
    return out;
  }
  Vector6 out = matrix_ * v;
  out.tail<3>() -= centre_.cross(Vector3d(out.head<3>()));
  return out;
}

Result<PlatePose> plate_pose(const data::ForcePlate& plate) {
  // A corner further away than a kilometre is an invalid number.
  const auto near = [](const Vector3d& x) { return (x.array().abs() < 1000.0).all(); };
  const auto& c = plate.corners_in_world;
  const Vector3d along_x = 0.5 * (c[0] - c[1] + c[3] - c[2]), along_y = 0.5 * (c[0] - c[3] + c[1] - c[2]);
  const Vector3d normal = along_x.cross(along_y);
  constexpr double kSmallest = 1e-4;  // m^2; no foot fits on less
  if (!std::ranges::all_of(c, near) || !near(plate.origin_in_plate) || !(normal.norm() > kSmallest))
    return fail(Code::bad_input, "has corners that span no surface");
  PlatePose pose;
  pose.centre = 0.25 * (c[0] + c[1] + c[2] + c[3]);
  pose.half_size = {0.5 * along_x.norm(), 0.5 * along_y.norm()};
  pose.world_from_plate.col(0) = along_x.normalized();
  pose.world_from_plate.col(2) = normal.normalized();
  pose.world_from_plate.col(1) = pose.world_from_plate.col(2).cross(pose.world_from_plate.col(0));
  return pose;
}

}  // namespace kinemark::io::internal
