// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "studies/poizner/wheel_study.h"

#include <cmath>

#include "kinemark/math/symmetric3.h"
#include "kinemark/stages/reconstruction/reconstruct.h"
#include "kinemark/stages/simulation/rig_recording.h"
#include "kinemark/stages/trajectory/from_counts/smooth_counts.h"
#include "studies/poizner/classic_paths.h"

namespace kinemark::studies {
namespace {

constexpr std::int64_t kWheelFrames = 220, kWheelEnds = 8;  // frames at both ends that errors leave out
constexpr std::uint64_t kWheelStream = 400;  // of the noise: one more for the second orientation

Eigen::Map<const Eigen::Matrix3Xd, 0, Eigen::OuterStride<>> of_led(const Array<double>& values,
                                                                   std::int64_t led, std::int64_t leds,
                                                                   std::int64_t frames) {
  return {values.data() + 3 * led, 3, frames, Eigen::OuterStride<>(3 * leds)};
}

double rms(const Eigen::Matrix3Xd& errors) {
  return std::sqrt(errors.squaredNorm() / static_cast<double>(errors.cols()));
}

}  // namespace

MotionErrors motion_errors(const Eigen::Matrix3Xd& position, const Eigen::Matrix3Xd& velocity,
                           const Eigen::Matrix3Xd& acceleration, const data::Trajectories& truth,
                           const data::Derivatives& rates, std::int64_t led, std::int64_t first,
                           std::int64_t last) {
  const auto leds = truth.markers(), frames = truth.frames();
  const auto error = [&](const Eigen::Matrix3Xd& ours, const Array<double>& theirs) {
    const Eigen::Matrix3Xd difference = ours - of_led(theirs, led, leds, frames);
    return rms(difference.middleCols(first, last - first));
  };
  return {error(position, truth.x_in_world), error(velocity, rates.velocity),
          error(acceleration, rates.acceleration)};
}

AlignedPath aligned_path(const data::Trajectories& points, const data::Derivatives& rates, std::int64_t led,
                         const math::SE3& truth_from_world) {
  const auto leds = points.markers(), frames = points.frames();
  const Eigen::Matrix3d& rotation = truth_from_world.rotation;
  AlignedPath out;
  out.position =
      (rotation * of_led(points.x_in_world, led, leds, frames)).colwise() + truth_from_world.translation;
  out.velocity = rotation * of_led(rates.velocity, led, leds, frames);
  out.acceleration = rotation * of_led(rates.acceleration, led, leds, frames);
  out.velocity_sd = of_led(rates.velocity_sd, led, leds, frames);
  out.acceleration_sd = of_led(rates.acceleration_sd, led, leds, frames);
  out.position_sd.resize(3, frames);
  for (std::int64_t f = 0; f < frames; ++f) {
    out.position_sd.col(f) =
        math::unpack_symmetric3(points.covariance.data() + 6 * points.index(f, led)).diagonal().cwiseSqrt();
  }
  return out;
}

MotionErrors predicted_errors(const AlignedPath& path, std::int64_t first, std::int64_t last) {
  const auto of = [&](const Eigen::Matrix3Xd& sd) { return rms(sd.middleCols(first, last - first)); };
  return {of(path.position_sd), of(path.velocity_sd), of(path.acceleration_sd)};
}

void add_coverage(const AlignedPath& path, const data::Trajectories& truth, const data::Derivatives& rates,
                  std::int64_t led, std::int64_t first, std::int64_t last, Coverage& positions,
                  Coverage& derivatives) {
  const auto leds = truth.markers(), frames = truth.frames();
  const auto add = [&](const Eigen::Matrix3Xd& ours, const Eigen::Matrix3Xd& sd, const Array<double>& theirs,
                       Coverage& to) {
    const auto real = of_led(theirs, led, leds, frames);
    for (std::int64_t f = first; f < last; ++f)
      for (int a = 0; a < 3; ++a) to.add(ours(a, f) - real(a, f), sd(a, f));
  };
  add(path.position, path.position_sd, truth.x_in_world, positions);
  add(path.velocity, path.velocity_sd, rates.velocity, derivatives);
  add(path.acceleration, path.acceleration_sd, rates.acceleration, derivatives);
}

Result<WheelOutcome> study_wheel(const CalibratedRig& rig, const simulation::WheelOptions& wheel) {
  simulation::RigRecordingOptions how;
  how.frames = kWheelFrames;
  how.seed = rig.physical.seed;
  how.stream = kWheelStream + (wheel.rotation_deg > 20.0 ? 1 : 0);
  const auto recorded = simulation::record(rig.physical, simulation::rotating_wheel(wheel), how);
  if (!recorded) return std::unexpected(recorded.error());
  const auto start = reconstruction::reconstruct(recorded->counts, rig.bundle.rig);
  if (!start) return std::unexpected(start.error());
  const auto smooth = trajectory::smooth_counts(recorded->counts, start->rigs, start->points);
  if (!smooth) return std::unexpected(smooth.error());

  WheelOutcome out;
  const auto classic =
      classic_paths(recorded->counts, rig.classic, {start->used.begin(), start->used.end()}).front();
  const auto path = aligned_path(smooth->points, smooth->derivatives, 0, rig.truth_from_ours);
  out.classic_raw = measure_wheel(classic.raw, wheel.diameter_m);
  out.classic = measure_wheel(classic.filtered, wheel.diameter_m);
  out.ours = measure_wheel(path.position, wheel.diameter_m);
  const Eigen::Matrix3d& rotation = rig.truth_from_classic.rotation;
  out.classic_path = (rotation * classic.filtered).colwise() + rig.truth_from_classic.translation;
  out.our_path = path.position;
  // The old pipeline is compared with the truth in the middle of the conversions, ours at the time of the
  // frame.
  out.classic_errors =
      motion_errors(out.classic_path, rotation * classic.velocity, rotation * classic.acceleration,
                    recorded->when_lit, recorded->derivatives, 0, kWheelEnds, kWheelFrames - kWheelEnds);
  out.our_errors = motion_errors(path.position, path.velocity, path.acceleration, recorded->truth,
                                 recorded->derivatives, 0, kWheelEnds, kWheelFrames - kWheelEnds);
  out.predicted = predicted_errors(path, kWheelEnds, kWheelFrames - kWheelEnds);
  add_coverage(path, recorded->truth, recorded->derivatives, 0, kWheelEnds, kWheelFrames - kWheelEnds,
               out.positions, out.rates);
  out.order = smooth->leds.front().bandwidth.order;
  out.cutoff_hz = smooth->leds.front().bandwidth.cutoff_hz;
  return out;
}

}  // namespace kinemark::studies
