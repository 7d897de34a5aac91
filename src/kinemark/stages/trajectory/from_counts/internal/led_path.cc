// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/trajectory/from_counts/internal/led_path.h"

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <span>

#include "kinemark/camera/noise.h"
#include "kinemark/camera/response.h"
#include "kinemark/camera/usable.h"
#include "kinemark/math/scale_free.h"
#include "kinemark/math/wiener_smoother.h"

namespace kinemark::trajectory::internal {

using Eigen::Matrix3d;
using Eigen::Vector2d;
using Eigen::Vector3d;
using Eigen::Vector4d;

LedPath::LedPath(const data::Counts& counts, const data::Rig& rig, std::int64_t led, std::int64_t first,
                 std::int64_t last, const std::vector<Vector3d>& start,
                 const std::vector<std::uint8_t>& usable, const SmoothCountsOptions& options)
    : rig_(rig),
      options_(options),
      frames_(static_cast<std::size_t>(last - first)),
      cameras_(static_cast<std::size_t>(counts.camera_count())),
      views_(frames_ * cameras_),
      now_(frames_),
      observations_(frames_),
      flicker_(cameras_, Vector2d::Zero()) {
  const double delay = rig.electronics.time_constant_s;
  for (std::size_t c = 0; c < cameras_; ++c)
    epoch_s_ += counts.offset_s(led, static_cast<std::int64_t>(c)).mean() - delay;
  epoch_s_ /= static_cast<double>(cameras_);
  for (std::size_t k = 0; k < frames_; ++k) {
    const auto frame = first + static_cast<std::int64_t>(k);
    time_s_.push_back(counts.time.time_s(frame));
    now_[k] = {start[static_cast<std::size_t>(frame)], Vector3d::Zero(), Vector3d::Zero()};
    for (std::size_t c = 0; c < cameras_; ++c) {
      const auto camera = static_cast<std::int64_t>(c);
      View& v = view(k, c);
      v.usable = usable[counts.index(frame, led, camera)] != 0;
      const Vector4d read = counts.at(frame, led, camera);
      v.keep = camera::kept_channels(read, counts.highest_code);
      v.readings = v.keep.cwiseProduct(read - rig.cameras[c].detector.offset_counts);
      v.dt = counts.offset_s(led, camera).array() - delay - epoch_s_;
      v.variance = camera::conversion_variance(rig.electronics, std::max(0.0, v.readings.mean()));
    }
  }
  fit_.name = counts.leds[static_cast<std::size_t>(led)];
  fit_.flicker_counts.assign(cameras_, 0.0);
}

void LedPath::remove_flicker(int camera, const Vector2d& cos_sin) {
  const double omega = 2.0 * std::numbers::pi * options_.flicker_hz, delay = rig_.electronics.time_constant_s;
  const auto c = static_cast<std::size_t>(camera);
  for (std::size_t k = 0; k < frames_; ++k) {
    View& v = view(k, c);
    for (int i = 0; i < 4; ++i) {
      const double phase = omega * (time_s_[k] + epoch_s_ + v.dt[i] + delay);
      v.readings[i] -= v.keep[i] * (cos_sin.x() * std::cos(phase) + cos_sin.y() * std::sin(phase));
    }
  }
  flicker_[c] += cos_sin;
  fit_.flicker_counts[c] = flicker_[c].norm();
}

void LedPath::linearize(const data::Camera& camera, View& v, const Vector3d& x) const {
  // The response curves over decimetres: within a millimetre its linearization is accurate to a hundredth of
  // a count.
  constexpr double kStraight_m = 1e-3;
  if (v.linear && (x - v.at).squaredNorm() < kStraight_m * kStraight_m) return;
  const auto response = camera::respond(camera, x);
  v.phi = v.keep.cwiseProduct(response.phi);
  v.d_point = v.keep.asDiagonal() * response.d_point;
  v.at = x;
  v.linear = response.in_front;
}

void LedPath::gather(bool weigh) {
  const double nu = options_.student_freedom;
  for (std::size_t k = 0; k < frames_; ++k) {
    const Motion& m = now_[k];
    Matrix3d h = Matrix3d::Zero();
    Vector3d g = Vector3d::Zero();
    for (std::size_t c = 0; c < cameras_; ++c) {
      View& v = view(k, c);
      if (!v.usable) continue;
      linearize(rig_.cameras[c], v, m.position);
      if (!v.linear) {
        v.usable = false;
        continue;
      }
      const Vector4d shares = v.phi + v.d_point * (m.position - v.at) +
                              (v.d_point * m.velocity).cwiseProduct(v.dt) +
                              0.5 * (v.d_point * m.acceleration).cwiseProduct(v.dt.cwiseAbs2());
      const auto left = math::eliminate_scale(v.readings, shares);
      v.chi2 = left.residual.squaredNorm() / v.variance;
      if (weigh) v.weight = v.chi2 > options_.reject_chi2 ? 0.0 : std::min(1.0, (nu + 3.0) / (nu + v.chi2));
      const Matrix3d j = -left.scale * (left.basis * v.d_point);
      const double w = v.weight / v.variance;
      h += w * j.transpose() * j;
      g += w * j.transpose() * left.residual;
    }
    auto& s = observations_[k];
    s.time_s = time_s_[k] + epoch_s_;
    s.information = h;
    // The ridge, 1 / (10 m)^2, only bounds the step in directions that this frame does not determine.
    s.position = m.position - (h + 1e-2 * Matrix3d::Identity()).ldlt().solve(g);
  }
}

void LedPath::regress_flicker() {
  const double omega = 2.0 * std::numbers::pi * options_.flicker_hz, delay = rig_.electronics.time_constant_s;
  constexpr double kFewest = 40, kLargest = 6.0;  // observations; counts: more is no flicker
  for (std::size_t c = 0; c < cameras_; ++c) {
    Eigen::Matrix2d square = Eigen::Matrix2d::Zero();
    Vector2d right = Vector2d::Zero();
    int count = 0;
    for (std::size_t k = 0; k < frames_; ++k) {
      View& v = view(k, c);
      if (!v.usable || v.weight <= 0.0) continue;
      const Motion& m = now_[k];
      const Vector4d shares =
          v.phi + v.d_point * (m.position - v.at) + (v.d_point * m.velocity).cwiseProduct(v.dt);
      const auto left = math::eliminate_scale(v.readings, shares);
      Eigen::Matrix<double, 4, 2> waves;
      for (int i = 0; i < 4; ++i) {
        const double phase = omega * (time_s_[k] + epoch_s_ + v.dt[i] + delay);
        waves.row(i) << v.keep[i] * std::cos(phase), v.keep[i] * std::sin(phase);
      }
      const Eigen::Matrix<double, 3, 2> seen = left.basis * waves;
      square += v.weight * seen.transpose() * seen;
      right += v.weight * seen.transpose() * left.residual;
      ++count;
    }
    if (count < kFewest || square.determinant() < 1e-3 * square.trace() * square.trace()) continue;
    const Vector2d found = square.ldlt().solve(right);
    if ((flicker_[c] + found).norm() < kLargest) remove_flicker(static_cast<int>(c), found);
  }
}

/// Time constants that a gap may last: in longer ones the middle is known to metres only, and the filter
/// loses its precision.
constexpr double kLongestGap = 10.0;

void LedPath::smooth(bool last) {
  const math::WienerProcess process{.order = bandwidth_.order,
                                    .spectral_density = bandwidth_.spectral_density,
                                    .time_scale_s = bandwidth_.time_constant_s};
  math::WienerOptions<3> options;
  options.covariance = math::WienerCovariance::none;
  if (last) {
    options.covariance = math::WienerCovariance::all;
    options.shift_s = -epoch_s_;  // from the epoch of the states to the frame's own time
    constexpr double kUnknown = std::numeric_limits<double>::infinity();
    result_.assign(frames_,
                   Sample{.motion = {}, .sd = {Vector3d::Constant(kUnknown), {}, {}}, .covariance = {}});
  }
  const std::span<const LedObservation> observations(observations_);
  for (const auto& [first, count] :
       math::runs_between_gaps(observations, kLongestGap * bandwidth_.time_constant_s))
    math::smooth_wiener<3>(process, observations.subspan(first, count), options,
                           [&, first](std::size_t index, const math::WienerEstimate<3>& at) {
                             const Motion motion{at.derivative(0), at.derivative(1), at.derivative(2)};
                             if (!last) {
                               now_[first + index] = motion;
                               return;
                             }
                             const auto sd = [&](int derivative) -> Vector3d {
                               return at.covariance_of(derivative).diagonal().cwiseMax(0.0).cwiseSqrt();
                             };
                             Sample& s = result_[first + index];
                             s.motion = motion;
                             s.covariance = at.covariance_of(0);
                             s.sd = {sd(0), sd(1), sd(2)};
                           });
}

namespace {

// A mirror that flashes shifts what all cameras see by centimetres for some milliseconds. One such frame
// weighs as much in the risk as all others together, and makes a path wide enough to follow it.
constexpr double kMostSquares = 9.0;      // on one axis
constexpr double kClearlyNarrower = 0.7;  // of the bandwidth
constexpr double kFlash_s = 0.025;        // longer is movement: no limb stops within it
constexpr double kMostFlashes = 0.1;      // share of the frames

}  // namespace

/// Frames that the path leaves out are few, and in short runs.
bool LedPath::only_flashes() {
  std::size_t out = 0;
  double begun_s = 0.0, longest_s = 0.0;
  bool inside = false;
  for (std::size_t k = 0; k < frames_; ++k) {
    bool left_out = false;
    for (std::size_t c = 0; c < cameras_; ++c) left_out |= view(k, c).usable && view(k, c).weight == 0.0;
    if (left_out && !inside) begun_s = time_s_[k];
    inside = left_out;
    if (!left_out) continue;
    ++out;
    longest_s = std::max(longest_s, time_s_[k] - begun_s);
  }
  return longest_s <= kFlash_s && static_cast<double>(out) <= kMostFlashes * static_cast<double>(frames_);
}

/// A narrower bandwidth, if outliers alone made the chosen one wide. After the first gather().
void LedPath::try_without_outliers() {
  BandwidthOptions how{.order = options_.order, .half_gain_hz = options_.half_gain_hz};
  how.most_squares = kMostSquares;
  how.max_observations /= 2;
  const Bandwidth wide = bandwidth_, narrow = choose_bandwidth(observations_, how);
  if (narrow.time_constant_s * kClearlyNarrower < wide.time_constant_s) return;
  const auto now = now_;
  bandwidth_ = narrow;
  for (int pass = 0; pass < 4; ++pass) {
    smooth(false);
    gather(true);
  }
  flashes_ = only_flashes();
  if (flashes_) return;
  bandwidth_ = wide;
  now_ = now;
  for (auto& v : views_) v.weight = 1.0;
  gather(false);
}

void LedPath::run() {
  const bool regress = options_.flicker == Flicker::regress || options_.flicker == Flicker::dark_slot;
  const bool known = flicker_[0].norm() > 0.0;  // from the dark slot
  for (int pass = 0; pass < options_.passes; ++pass) {
    const bool last = pass + 1 == options_.passes;
    gather(pass > 0);
    if (regress && !known && pass >= 1 && pass <= 3) {
      regress_flicker();
      gather(true);
    }
    if (pass == 0 || pass == 2) {
      // The first choice evaluates a rough path from fewer observations; the second searches near the first.
      BandwidthOptions how{.order = options_.order, .half_gain_hz = options_.half_gain_hz};
      if (pass == 0)
        how.max_observations /= 2;
      else
        how.around_hz = 0.5 / (std::numbers::pi * bandwidth_.time_constant_s);
      if (flashes_) how.most_squares = kMostSquares;
      bandwidth_ = choose_bandwidth(observations_, how);
      if (pass == 0) try_without_outliers();
    }
    smooth(last);
  }
  conclude();
}

void LedPath::conclude() {
  double sum = 0.0, freedom = 0.0;
  for (std::size_t k = 0; k < frames_; ++k)
    for (std::size_t c = 0; c < cameras_; ++c) {
      const View& v = view(k, c);
      if (!v.usable) continue;
      fit_.rejected += v.weight == 0.0;
      fit_.held_down += v.weight < 0.5;
      if (v.weight == 0.0) continue;
      result_[k].seen = true;
      ++fit_.observations;
      sum += v.chi2;
      freedom += v.keep.sum() - 1.0;
    }
  // Estimating each frame's point separately uses two of six residuals; the path uses far fewer degrees of
  // freedom.
  fit_.chi2_per_dof = fit_.observations > 0 ? sum / freedom : 0.0;
  fit_.bandwidth = bandwidth_;
}

}  // namespace kinemark::trajectory::internal
