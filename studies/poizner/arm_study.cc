// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "studies/poizner/arm_study.h"

#include <cmath>

#include "kinemark/stages/reconstruction/reconstruct.h"
#include "kinemark/stages/simulation/rig_recording.h"
#include "kinemark/stages/simulation/rig_scene.h"
#include "kinemark/stages/trajectory/from_counts/smooth_counts.h"
#include "studies/poizner/classic_paths.h"

namespace kinemark::studies {
namespace {

using Eigen::Matrix3Xd;

constexpr std::int64_t kFrames = 400, kEnds = 10;  // frames at both ends that errors leave out
constexpr std::uint64_t kStream = 420;             // of the noise

Matrix3Xd columns(const Array<double>& values, std::int64_t led, std::int64_t leds) {
  return Eigen::Map<const Matrix3Xd, 0, Eigen::OuterStride<>>(values.data() + 3 * led, 3, kFrames,
                                                              Eigen::OuterStride<>(3 * leds));
}

struct Extremes {
  double slowest = 0.0, fastest = 0.0;
  explicit Extremes(const Matrix3Xd& velocity) {
    const Eigen::RowVectorXd speed = velocity.middleCols(kEnds, kFrames - 2 * kEnds).colwise().norm();
    slowest = speed.minCoeff();
    fastest = speed.maxCoeff();
  }
};

double length_sd(const Matrix3Xd& a, const Matrix3Xd& b) {
  const Eigen::RowVectorXd length = (a - b).middleCols(kEnds, kFrames - 2 * kEnds).colwise().norm();
  return std::sqrt((length.array() - length.mean()).square().mean());
}

double gap_rms(const Matrix3Xd& ours, const Matrix3Xd& truth, const Array<std::uint8_t>& hidden,
               std::int64_t led, std::int64_t leds) {
  double squares = 0.0;
  int count = 0;
  for (std::int64_t f = 0; f < kFrames; ++f) {
    bool gap = false;
    for (std::int64_t c = 0; c < 2; ++c)
      gap = gap || hidden[static_cast<std::size_t>((f * leds + led) * 2 + c)] != 0;
    if (!gap) continue;
    squares += (ours.col(f) - truth.col(f)).squaredNorm();
    ++count;
  }
  return count > 0 ? std::sqrt(squares / count) : 0.0;
}

}  // namespace

Result<ArmOutcome> study_arm(const CalibratedRig& rig) {
  simulation::RigRecordingOptions how;
  how.frames = kFrames;
  how.seed = rig.physical.seed;
  how.stream = kStream;
  const auto recorded = simulation::record(rig.physical, simulation::signing_arm(), how);
  if (!recorded) return std::unexpected(recorded.error());
  const auto& counts = recorded->counts;
  const auto start = reconstruction::reconstruct(counts, rig.bundle.rig);
  if (!start) return std::unexpected(start.error());
  const auto smooth = trajectory::smooth_counts(counts, start->rigs, start->points);
  if (!smooth) return std::unexpected(smooth.error());
  const auto classic = classic_paths(counts, rig.classic, {start->used.begin(), start->used.end()});

  ArmOutcome out;
  const std::int64_t leds = counts.led_count(), first = kEnds, last = kFrames - kEnds;
  const math::SE3& align = rig.truth_from_classic;
  for (std::int64_t led = 0; led < leds; ++led) {
    const auto l = static_cast<std::size_t>(led);
    const Matrix3Xd truth = columns(recorded->truth.x_in_world, led, leds);
    const Matrix3Xd velocity = columns(recorded->derivatives.velocity, led, leds);
    auto path = aligned_path(smooth->points, smooth->derivatives, led, rig.truth_from_ours);
    const Matrix3Xd old = (align.rotation * classic[l].filtered).colwise() + align.translation;
    const Matrix3Xd old_velocity = align.rotation * classic[l].velocity;
    const Extremes real(velocity), ours(path.velocity), theirs(old_velocity);
    ArmLed one;
    one.name = counts.leds[l];
    one.classic = motion_errors(old, old_velocity, align.rotation * classic[l].acceleration, recorded->truth,
                                recorded->derivatives, led, first, last);
    one.ours = motion_errors(path.position, path.velocity, path.acceleration, recorded->truth,
                             recorded->derivatives, led, first, last);
    one.predicted = predicted_errors(path, first, last);
    one.gap_rms_m = gap_rms(path.position, truth, recorded->hidden, led, leds);
    one.fastest_error_m_s = ours.fastest - real.fastest;
    one.slowest_error_m_s = ours.slowest - real.slowest;
    one.classic_fastest_error_m_s = theirs.fastest - real.fastest;
    one.classic_slowest_error_m_s = theirs.slowest - real.slowest;
    one.order = smooth->leds[l].bandwidth.order;
    one.cutoff_hz = smooth->leds[l].bandwidth.cutoff_hz;
    out.leds.push_back(one);
    add_coverage(path, recorded->truth, recorded->derivatives, led, first, last, out.positions, out.rates);
    out.classic_paths.push_back(old);
    out.our_paths.push_back(std::move(path));
    out.true_paths.push_back(truth);
    out.true_velocity.push_back(velocity);
    out.true_acceleration.push_back(columns(recorded->derivatives.acceleration, led, leds));
  }
  for (std::size_t s = 0; s < 3; ++s) {
    out.classic_length_sd_m[s] = length_sd(out.classic_paths[s], out.classic_paths[s + 1]);
    out.our_length_sd_m[s] = length_sd(out.our_paths[s].position, out.our_paths[s + 1].position);
  }
  return out;
}

}  // namespace kinemark::studies
