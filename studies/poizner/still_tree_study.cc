// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "studies/poizner/still_tree_study.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

#include "kinemark/math/statistics.h"
#include "kinemark/math/symmetric3.h"
#include "kinemark/stages/reconstruction/locate.h"
#include "kinemark/stages/reconstruction/reconstruct.h"
#include "kinemark/stages/simulation/rig_recording.h"
#include "kinemark/stages/simulation/rig_scene.h"
#include "studies/poizner/still_cloud.h"

namespace kinemark::studies {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

Matrix3d covariance_of(const data::Trajectories& points, std::int64_t f, std::int64_t led) {
  return math::unpack_symmetric3(points.covariance.data() + 6 * points.index(f, led));
}

double distance_error(const StillCloud& cloud, std::size_t side) {
  return cloud.distance(kTreeSides[side]) - simulation::tree_sides_m()[side];
}

/// Whether an LED was located in every frame, and in none flagged at the edge of a detector.
bool in_the_field(const reconstruction::Reconstruction& seen, std::int64_t led) {
  for (std::int64_t f = 0; f < seen.points.frames(); ++f)
    if (!seen.points.present(f, led) || seen.near_edge[seen.points.index(f, led)] != 0) return false;
  return true;
}

/// Standard deviation of a distance between mean positions: the rig's covariance propagated to both ends, and
/// the noise of `frames` frames.
double predict(const data::Rig& rig, const data::Counts& counts, const StillCloud& cloud,
               const std::vector<Matrix3d>& frame_noise, const std::array<int, 2>& side) {
  const auto a = static_cast<std::size_t>(side[0]), b = static_cast<std::size_t>(side[1]);
  const Vector3d along = (cloud.mean[a] - cloud.mean[b]).normalized();
  Eigen::RowVectorXd by = Eigen::RowVectorXd::Zero(rig.parameter_count());
  double variance = 0.0;
  for (const auto led : {a, b}) {
    std::vector<double> strength, weight;
    for (int c = 0; c < rig.camera_count(); ++c) {
      double light = -rig.cameras[static_cast<std::size_t>(c)].detector.offset_counts.sum();
      for (std::int64_t f = 0; f < counts.frames(); ++f)
        light += counts.at(f, static_cast<std::int64_t>(led), c).sum() / static_cast<double>(counts.frames());
      strength.push_back(light);
      weight.push_back(light * light);
    }
    by += (led == a ? 1.0 : -1.0) * along.transpose() *
          reconstruction::by_parameters(rig, cloud.mean[led], strength, weight);
    variance += along.dot(frame_noise[led] * along) / static_cast<double>(counts.frames());
  }
  return std::sqrt(variance + (by * rig.covariance).dot(by));
}

}  // namespace

double StillMeasures::mean_error_m() const {
  double sum = 0.0;
  for (const double e : distance_error_m) sum += std::abs(e);
  return sum / static_cast<double>(distance_error_m.size());
}

double StillMeasures::max_error_m() const {
  double most = 0.0;
  for (const double e : distance_error_m) most = std::max(most, std::abs(e));
  return most;
}

Result<StillOutcome> study_still_tree(const CalibratedRig& rig, const StillStudyOptions& options) {
  StillOutcome out;
  std::array<std::vector<double>, 3> classic_sd, our_sd, bound_sd;
  double squares = 0.0;
  const auto& poses = simulation::tree_test_poses();
  for (std::size_t k = 0; k < poses.size(); ++k) {
    simulation::RigRecordingOptions how;
    how.frames = options.frames;
    how.rate_hz = options.rate_hz;
    how.intensity.assign(3, options.intensity);
    how.seed = rig.physical.seed;
    how.stream = 300 + k;
    const auto recorded = simulation::record(rig.physical, simulation::still_tree(poses[k]), how);
    if (!recorded) return std::unexpected(recorded.error());
    const auto& counts = recorded->counts;
    const auto classic = reconstruction::reconstruct_classic(counts, rig.classic);
    if (!classic) return std::unexpected(classic.error());
    const auto ours = reconstruction::reconstruct(counts, rig.bundle.rig);
    if (!ours) return std::unexpected(ours.error());
    reconstruction::ReconstructOptions noise_only;
    noise_only.calibration_error = false;
    const auto bare = reconstruction::reconstruct(counts, rig.bundle.rig, noise_only);
    if (!bare) return std::unexpected(bare.error());

    const StillCloud classic_cloud(classic->points), our_cloud(ours->points);
    double classic_scatter = 0.0, our_scatter = 0.0, bound = 0.0;
    std::vector<Matrix3d> frame_noise;
    for (std::size_t led = 0; led < 3; ++led) {
      const auto l = static_cast<std::int64_t>(led);
      std::vector<double> strength(2, 0.0);
      Matrix3d noise = Matrix3d::Zero();
      for (std::int64_t f = 0; f < counts.frames(); ++f) {
        for (std::int64_t c = 0; c < 2; ++c)
          strength[static_cast<std::size_t>(c)] +=
              counts.at(f, l, c).sum() / static_cast<double>(counts.frames());
        if (bare->points.present(f, l))
          noise += covariance_of(bare->points, f, l) / static_cast<double>(counts.frames());
      }
      frame_noise.push_back(noise);
      const Vector3d truth = recorded->truth.x(0, l);
      // The bound along the axes of our world, in which our scatter is measured.
      const Matrix3d& turn = rig.truth_from_ours.rotation;
      const Matrix3d least =
          turn.transpose() * reconstruction::cramer_rao(rig.physical.rig, truth, strength) * turn;
      for (std::size_t a = 0; a < 3; ++a) {
        const auto axis = static_cast<Eigen::Index>(a);
        classic_sd[a].push_back(std::sqrt(classic_cloud.variance[led][axis]));
        our_sd[a].push_back(std::sqrt(our_cloud.variance[led][axis]));
        bound_sd[a].push_back(std::sqrt(least(axis, axis)));
      }
      classic_scatter += classic_cloud.variance[led].sum();
      our_scatter += our_cloud.variance[led].sum();
      bound += least.trace();
      for (std::int64_t f = 0; f < counts.frames(); ++f) {
        if (!ours->points.present(f, l)) continue;
        const Vector3d error = rig.truth_from_ours * ours->points.x(f, l) - truth;
        const Matrix3d predicted = rig.truth_from_ours.rotation * covariance_of(ours->points, f, l) *
                                   rig.truth_from_ours.rotation.transpose();
        for (int a = 0; a < 3; ++a) out.points.add(error[a], std::sqrt(predicted(a, a)));
      }
    }
    out.classic.over_cramer_rao += std::sqrt(classic_scatter / bound) / static_cast<double>(poses.size());
    out.ours.over_cramer_rao += std::sqrt(our_scatter / bound) / static_cast<double>(poses.size());
    for (std::size_t s = 0; s < kTreeSides.size(); ++s) {
      if (!in_the_field(*ours, kTreeSides[s][0]) || !in_the_field(*ours, kTreeSides[s][1])) {
        ++out.distances_left_out;
        continue;
      }
      const double sd = predict(rig.bundle.rig, counts, our_cloud, frame_noise, kTreeSides[s]);
      const double error = distance_error(our_cloud, s);
      out.ours.distance_error_m.push_back(error);
      out.classic.distance_error_m.push_back(distance_error(classic_cloud, s));
      out.predicted_sd_m.push_back(sd);
      out.distances.add(error, sd);
      squares += error * error / (sd * sd);
    }
  }
  for (std::size_t a = 0; a < 3; ++a) {
    const auto axis = static_cast<Eigen::Index>(a);
    out.classic.sd_m[axis] = math::median(classic_sd[a]);
    out.ours.sd_m[axis] = math::median(our_sd[a]);
    out.cramer_rao_sd_m[axis] = math::median(bound_sd[a]);
  }
  out.error_over_predicted = std::sqrt(squares / static_cast<double>(out.predicted_sd_m.size()));
  return out;
}

}  // namespace kinemark::studies
