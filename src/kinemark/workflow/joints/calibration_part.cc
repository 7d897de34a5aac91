// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/workflow/joints/internal/calibration_part.h"

#include <cmath>
#include <cstdint>
#include <vector>

#include "kinemark/core/index.h"
#include "kinemark/data/calibration_error.h"

namespace kinemark::workflow::internal {
namespace {

using data::Points;

/// One point's way (F x 3, NaN where it is not placed) with its displacement by each field.
struct Way {
  Points x;
  std::vector<Points> displacement;
};

Way way_of(const data::CalibrationError& error, Points x) {
  auto displacement = data::displacements(error, x);
  return {.x = std::move(x), .displacement = std::move(displacement)};
}

Way way_of_joint(const data::CalibrationError& error, const data::Skeleton& skeleton, std::int64_t joint) {
  Points x(skeleton.frames(), 3);
  for (std::int64_t f = 0; f < skeleton.frames(); ++f) x.row(f) = skeleton.centre(f, joint).transpose();
  return way_of(error, std::move(x));
}

Way way_of_end(const data::CalibrationError& error, const data::SkeletonEnd& end, std::int64_t frames) {
  using Rows = Eigen::Matrix<double, Eigen::Dynamic, 3, Eigen::RowMajor>;
  return way_of(error, Eigen::Map<const Rows>(end.centre_in_world.data(), frames, 3));
}

/// Squares of all displacements, and how many frames they are of.
struct Spread {
  double squares = 0.0;
  std::int64_t frames = 0;
};

/// One way's share of a F x stride array of covariances (xx xy xz yy yz zz).
void widen(const Way& way, double* covariance, std::size_t stride, Spread& spread) {
  for (Eigen::Index f = 0; f < way.x.rows(); ++f) {
    if (!way.x.row(f).allFinite()) continue;
    double* c = covariance + static_cast<std::size_t>(f) * stride;
    for (const auto& field : way.displacement) {
      const auto d = field.row(f);
      spread.squares += d.squaredNorm();
      c[0] += d[0] * d[0];
      c[1] += d[0] * d[1];
      c[2] += d[0] * d[2];
      c[3] += d[1] * d[1];
      c[4] += d[1] * d[2];
      c[5] += d[2] * d[2];
    }
    ++spread.frames;
  }
}

/// Variance of the mean distance of two points: each field lengthens it by its mean over the frames.
double variance_of_distance(const Way& a, const Way& b) {
  std::vector<double> longer(a.displacement.size(), 0.0);
  double frames = 0.0;
  for (Eigen::Index f = 0; f < a.x.rows(); ++f) {
    const Eigen::RowVector3d apart = b.x.row(f) - a.x.row(f);
    const double distance = apart.norm();
    if (!(distance > 0.0)) continue;
    frames += 1.0;
    for (std::size_t k = 0; k < longer.size(); ++k)
      longer[k] += (b.displacement[k].row(f) - a.displacement[k].row(f)).dot(apart) / distance;
  }
  double variance = 0.0;
  for (const double sum : longer)
    if (frames > 0.0) variance += (sum / frames) * (sum / frames);
  return variance;
}

}  // namespace

double add_calibration_error(const data::CalibrationError& error, data::Skeleton& skeleton) {
  if (!error.known()) return 0.0;
  Spread spread;
  std::vector<Way> joints;
  for (std::size_t j = 0; j < skeleton.joints.size(); ++j) {
    joints.push_back(way_of_joint(error, skeleton, static_cast<std::int64_t>(j)));
    widen(joints.back(), skeleton.covariance.data() + 6 * j, 6 * skeleton.joints.size(), spread);
  }
  for (auto& length : skeleton.lengths)
    length.sd_m = std::hypot(
        length.sd_m, std::sqrt(variance_of_distance(joints[at(length.joint_a)], joints[at(length.joint_b)])));
  for (auto& end : skeleton.ends) {
    const Way way = way_of_end(error, end, skeleton.frames());
    widen(way, end.covariance_in_world.data(), 6, spread);
    if (end.joint >= 0)
      end.length_sd_m =
          std::hypot(end.length_sd_m, std::sqrt(variance_of_distance(joints[at(end.joint)], way)));
  }
  return spread.frames > 0 ? std::sqrt(spread.squares / static_cast<double>(spread.frames)) : 0.0;
}

}  // namespace kinemark::workflow::internal
