// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/skeleton/articulated/recording/findings.h"

#include <fmt/core.h>

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <utility>

#include "kinemark/core/index.h"
#include "kinemark/core/units.h"
#include "kinemark/math/euler.h"
#include "kinemark/stages/skeleton/articulated/frame/chain_solver.h"

namespace kinemark::skeleton::articulated {
namespace {

using data::SegmentKind;

constexpr std::size_t kSwapFrames = 12;  // frames that are examined for exchanged names
constexpr std::size_t kStretches = 20;   // of a series, to see how it scatters beside a step
constexpr double kAtOnce = 0.5;          // share of a step that must happen from one sample to the next
constexpr double kApart = 5.0;           // standard errors by these that make a step
constexpr double kKnown_m = 0.01;        // a centre with a larger SD is not known
constexpr double kSwapFar = 4.0;         // SDs from its predicted position that make a marker suspect

double angle_of(const Matrix3d& R) { return Eigen::AngleAxisd(R).angle(); }

double angle_between_z(const Matrix3d& R) { return std::acos(std::clamp(R(2, 2), -1.0, 1.0)); }

/// Rotation of child in parent in the frames that determine the joint.
std::vector<Matrix3d> relative_rotations(const FittedChain& fit, const RecordingPass& pass, int joint) {
  std::vector<Matrix3d> rotations;
  const int parent = fit.chain.layout.parent[at(joint)];
  for (const SampledPose& s : pass.sampled)
    if (s.known[at(joint)])
      rotations.push_back(s.pose.rotation[at(parent)].transpose() * s.pose.rotation[at(joint + 1)]);
  return rotations;
}

/// Largest angle between any two of many rotations, by going three times to the one farthest from the last.
template <class Angle>
double largest_angle(std::size_t count, const Angle& angle) {
  std::size_t from = 0;
  double largest = 0.0;
  for (int sweep = 0; sweep < 3; ++sweep) {
    std::size_t farthest = from;
    for (std::size_t i = 0; i < count; ++i)
      if (const double a = angle(from, i); a > largest) largest = a, farthest = i;
    from = farthest;
  }
  return largest;
}

/// Variance of a segment's tilt in one frame that shows all its markers, about the axis known worst, rad^2.
double tilt_variance(const FittedChain& fit, int segment) {
  auto markers = fit.chain.layout.markers_of(segment);
  std::erase_if(markers, [&](int m) { return !(fit.marker_weight[at(m)] > 0.0); });
  Vector3d mean = Vector3d::Zero();
  for (const int m : markers) mean += fit.chain.marker.col(m) / static_cast<double>(markers.size());
  Matrix3d S = Matrix3d::Zero();
  for (const int m : markers)
    S += (fit.chain.marker.col(m) - mean) * (fit.chain.marker.col(m) - mean).transpose();
  const Vector3d w = Eigen::SelfAdjointEigenSolver<Matrix3d>(S, Eigen::EigenvaluesOnly).eigenvalues();
  return fit.noise_sd_m * fit.noise_sd_m / std::max(w[0] + w[1], 1e-12);
}

/// Residual of a marker in its segment's axes.
Vector3d residual(const FittedChain& fit, const ChainSamples& samples, const SampledPose& s, int marker) {
  const double* x = samples.frame(s.frame) + std::ptrdiff_t{3} * marker;
  const Matrix3d& R = s.pose.rotation[at(fit.chain.layout.segment_of_marker[at(marker)])];
  return R.transpose() * (Vector3d{x[0], x[1], x[2]} - fit.chain.predict(s.pose, marker));
}

/// All its residuals in time: frame and value.
std::vector<std::pair<std::int64_t, Vector3d>> residuals(const FittedChain& fit, const ChainSamples& samples,
                                                         const RecordingPass& pass, int marker) {
  std::vector<std::pair<std::int64_t, Vector3d>> out;
  if (!(fit.marker_weight[at(marker)] > 0.0)) return out;  // its position is not known
  for (const SampledPose& s : pass.sampled)
    if (samples.seen(s.frame, marker)) out.emplace_back(s.frame, residual(fit, samples, s, marker));
  return out;
}

/// Markers that lie far from their predicted positions in the best pose of a frame.
std::vector<bool> far_off(const FittedChain& fit, const ChainSamples& samples, std::int64_t f,
                          const ChainFrame& frame) {
  std::vector<bool> far(at(samples.markers), false);
  for (int m = 0; m < samples.markers; ++m) {
    const double weight = fit.marker_weight[at(m)];
    if (!(weight > 0.0) || !samples.seen(f, m)) continue;
    const Eigen::Map<const Vector3d> x(samples.frame(f) + std::ptrdiff_t{3} * m);
    const double distance_m = (x - fit.chain.predict(frame.modes.front().pose, m)).norm();
    far[at(m)] = distance_m > kSwapFar * fit.noise_sd_m / std::sqrt(weight);
  }
  return far;
}

struct Step {
  double size_m = 0.0, significance = 0.0;
  std::int64_t frame = 0;
};

/// The split in time that explains most of a series.
Step largest_step(const std::vector<std::pair<std::int64_t, Vector3d>>& series) {
  Step best;
  const auto n = static_cast<double>(series.size());
  Vector3d all = Vector3d::Zero();
  double squares = 0.0;
  for (const auto& [frame, r] : series) all += r, squares += r.squaredNorm();
  Vector3d before = Vector3d::Zero();
  double m = 0.0;
  for (std::size_t i = 0; i + 1 < series.size(); ++i) {
    before += series[i].second;
    m += 1.0;
    if (m < 0.05 * n || m > 0.95 * n) continue;
    const Vector3d step = (all - before) / (n - m) - before / m;
    const double explained = step.squaredNorm() * m * (n - m) / n;
    const double within = std::max(squares - explained - all.squaredNorm() / n, 1e-30) / (3.0 * n);
    if (const double z = std::sqrt(explained / within); z > best.significance)
      best = {.size_m = step.norm(), .significance = z, .frame = series[i + 1].first};
  }
  return best;
}

/// How much of a step happens at once: the means next to it on either side, over the step's size.
double at_once(const std::vector<std::pair<std::int64_t, Vector3d>>& series, const Step& step) {
  const auto first =
      std::ranges::find_if(series, [&](const auto& sample) { return sample.first >= step.frame; });
  const auto near = static_cast<std::ptrdiff_t>(std::max<std::size_t>(3, series.size() / 30));
  if (first - series.begin() < near || series.end() - first < near) return 0.0;
  Vector3d change = Vector3d::Zero();
  for (std::ptrdiff_t i = 0; i < near; ++i) change += first[i].second - first[-1 - i].second;
  return (change / static_cast<double>(near)).norm() / step.size_m;
}

/// A step in standard errors, these from how the means of stretches of the series scatter on either side:
/// what drifts or swings by as much all the time is no step.
double stretches_apart(const std::vector<std::pair<std::int64_t, Vector3d>>& series, const Step& step) {
  const auto side = [&](std::size_t i) { return series[i].first < step.frame ? 0 : 1; };
  Vector3d mean[2] = {Vector3d::Zero(), Vector3d::Zero()};
  double count[2] = {0.0, 0.0};
  for (std::size_t i = 0; i < series.size(); ++i) mean[side(i)] += series[i].second, count[side(i)] += 1.0;
  for (const int k : {0, 1}) mean[k] /= std::max(count[k], 1.0);
  double scatter = 0.0;
  for (std::size_t block = 0; block < kStretches; ++block) {
    Vector3d sum = Vector3d::Zero();
    const std::size_t from = block * series.size() / kStretches,
                      to = (block + 1) * series.size() / kStretches;
    for (std::size_t i = from; i < to; ++i) sum += series[i].second - mean[side(i)];
    scatter += (sum / static_cast<double>(to - from)).squaredNorm() / (kStretches - 2.0);
  }
  const double n = static_cast<double>(series.size()) / kStretches;
  return (mean[1] - mean[0]).norm() / std::sqrt(std::max(scatter * (n / count[0] + n / count[1]), 1e-30));
}

}  // namespace

ObservedMotion observe_motion(const FittedChain& fit, const RecordingPass& pass, int joint) {
  ObservedMotion seen;
  const auto rotations = relative_rotations(fit, pass, joint);
  seen.frames = static_cast<std::int64_t>(rotations.size());
  if (rotations.empty()) return seen;
  const int parent = fit.chain.layout.parent[at(joint)];
  // The rotation of a line about itself cannot be seen: only directions remain.
  const bool line_above = fit.chain.kind[at(parent)] == SegmentKind::line,
             line_below = fit.chain.kind[at(joint + 1)] == SegmentKind::line;
  if (line_above || line_below) {
    seen.range_rad = largest_angle(rotations.size(), [&](std::size_t i, std::size_t k) {
      if (line_above && line_below)
        return std::abs(angle_between_z(rotations[i]) - angle_between_z(rotations[k]));
      const double c = line_below ? rotations[i].col(2).dot(rotations[k].col(2))
                                  : rotations[i].row(2).dot(rotations[k].row(2));
      return std::acos(std::clamp(c, -1.0, 1.0));
    });
    return seen;
  }
  seen.range_rad = largest_angle(rotations.size(), [&](std::size_t i, std::size_t k) {
    return angle_of(rotations[i] * rotations[k].transpose());
  });
  Matrix3d sum = Matrix3d::Zero();
  for (const Matrix3d& R : rotations) sum += R;
  const Matrix3d mean = nearest_rotation(sum);
  Matrix3d spread = Matrix3d::Zero();
  for (const Matrix3d& R : rotations) {
    const Vector3d v = math::log_so3(R * mean.transpose());
    spread += v * v.transpose() / static_cast<double>(rotations.size());
  }
  const Eigen::SelfAdjointEigenSolver<Matrix3d> eigen(spread);
  seen.second_rad = std::sqrt(std::max(eigen.eigenvalues()[1], 0.0));
  seen.second_noise_rad = std::sqrt(tilt_variance(fit, parent) + tilt_variance(fit, joint + 1));
  seen.axis_in_parent = eigen.eigenvectors().col(2);
  seen.axis_in_child = mean.transpose() * seen.axis_in_parent;
  const double first = std::sqrt(std::max(eigen.eigenvalues()[2], 0.0));
  seen.still = first < 2.0 * seen.second_noise_rad;
  seen.one_axis = fit.chain.kind[at(parent)] == SegmentKind::solid &&
                  fit.chain.kind[at(joint + 1)] == SegmentKind::solid &&
                  seen.second_rad < 2.0 * seen.second_noise_rad && first > 3.0 * seen.second_noise_rad;
  seen.axis_sd_rad = std::max(seen.second_rad, seen.second_noise_rad) /
                     (std::max(first, 1e-12) * std::sqrt(static_cast<double>(rotations.size())));
  return seen;
}

std::string describe_motion(const ObservedMotion& seen, bool hinge, double common_sd_m) {
  const double deg = seen.range_rad * kDegPerRad;
  if (seen.frames == 0) return "no frame determines it by its own markers";
  if (seen.still)
    return fmt::format("{:.1f} deg of motion, no more than noise: neither axis nor centre known", deg);
  if (hinge)
    return fmt::format("{:.0f} deg of motion: axis direction known to {:.1f} deg, position along it not", deg,
                       seen.axis_sd_rad * kDegPerRad);
  if (common_sd_m >= kKnown_m)
    return fmt::format("{:.0f} deg of motion: centre not known in its segments ({:.0f} mm)", deg,
                       1e3 * common_sd_m);
  return fmt::format("{:.0f} deg of motion: centre known to {:.1f} mm in its segments", deg,
                     1e3 * common_sd_m);
}

std::vector<SlippedMarker> find_slipped_markers(const FittedChain& fit, const ChainSamples& samples,
                                                const RecordingPass& pass) {
  std::vector<SlippedMarker> slips;
  for (int s = 0; s < fit.chain.segments(); ++s) {
    // The others of a segment follow the one that lies wrong most: it alone can be named.
    Step worst;
    int marker = -1;
    std::vector<std::pair<std::int64_t, Vector3d>> of_worst;
    for (const int m : fit.chain.layout.markers_of(s)) {
      auto series = residuals(fit, samples, pass, m);
      if (series.size() < 40) continue;
      const Step step = largest_step(series);
      if (!(step.significance > 12.0 && step.size_m > worst.size_m)) continue;
      worst = step;
      marker = m;
      of_worst = std::move(series);
    }
    if (marker >= 0 && worst.size_m > 2.0 * fit.noise_sd_m && at_once(of_worst, worst) > kAtOnce &&
        stretches_apart(of_worst, worst) > kApart)
      slips.push_back({.marker = marker, .frame = worst.frame, .distance_m = worst.size_m});
  }
  return slips;
}

std::vector<SwappedMarkers> find_swapped_markers(const FittedChain& fit, const ChainSamples& samples,
                                                 const RecordingPass& pass) {
  std::map<std::pair<int, int>, SwappedMarkers> found;
  ChainSolver solver(fit);
  PoseSolver nearby(fit.chain);
  ChainPose pose;
  const auto cost_near = [&](const double* markers, const ChainPose& near) {
    pose = near;
    nearby.set(markers, fit.marker_weight);
    return nearby.refine(pose);
  };
  ChainFrame frame;
  const int K = samples.markers;
  std::vector<double> x(at(3 * K));
  const std::size_t stride = std::max<std::size_t>(1, (pass.misfits.size() + kSwapFrames - 1) / kSwapFrames);
  for (std::size_t i = 0; i < pass.misfits.size(); i += stride) {
    const std::int64_t f = pass.misfits[i];
    double least = std::numeric_limits<double>::infinity();
    std::pair<int, int> best{-1, -1};
    solver.solve(samples.frame(f), nullptr, frame);
    if (frame.mode_count == 0) continue;
    const std::vector<bool> far = far_off(fit, samples, f, frame);
    const ChainPose near = frame.modes.front().pose;  // two names hardly move it
    const double as_named = cost_near(samples.frame(f), near);
    for (int a = 0; a < K; ++a)
      for (int b = a + 1; b < K; ++b) {
        if (!far[at(a)] && !far[at(b)]) continue;
        std::copy_n(samples.frame(f), 3 * K, x.begin());
        std::swap_ranges(x.begin() + 3 * a, x.begin() + 3 * a + 3, x.begin() + 3 * b);
        if (!(cost_near(x.data(), near) < as_named)) continue;
        solver.solve(x.data(), &near, frame);
        if (frame.mode_count == 0) continue;
        const double cost = frame.modes.front().cost;
        if (cost < least && !is_misfit(fit.chain, cost, fit.noise_sd_m, frame.seen))
          least = cost, best = {a, b};
      }
    if (best.first < 0) continue;
    SwappedMarkers& swap = found[best];
    if (swap.frames == 0) swap = {.marker_a = best.first, .marker_b = best.second, .first_frame = f};
    swap.frames += static_cast<std::int64_t>(stride);
  }
  std::vector<SwappedMarkers> out;
  out.reserve(found.size());
  for (const auto& [pair, swap] : found) out.push_back(swap);
  return out;
}

std::vector<LooseMarker> find_loose_markers(const FittedChain& fit, const ChainSamples& samples,
                                            const RecordingPass& pass) {
  std::vector<LooseMarker> loose;
  std::vector<double> rms(at(fit.chain.markers()), 0.0);
  for (int m = 0; m < fit.chain.markers(); ++m) {
    const auto series = residuals(fit, samples, pass, m);
    if (series.size() < 40) continue;
    for (const auto& [frame, r] : series)
      rms[at(m)] += r.squaredNorm() / (3.0 * static_cast<double>(series.size()));
    rms[at(m)] = std::sqrt(rms[at(m)]);
  }
  for (int m = 0; m < fit.chain.markers(); ++m)
    if (rms[at(m)] > 1.5 * fit.noise_sd_m) loose.push_back({.marker = m, .rms_m = rms[at(m)]});
  return loose;
}

}  // namespace kinemark::skeleton::articulated
