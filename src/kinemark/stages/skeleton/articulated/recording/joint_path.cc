// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/skeleton/articulated/recording/joint_path.h"

#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cmath>

#include "kinemark/core/missing.h"
#include "kinemark/math/symmetric3.h"
#include "kinemark/math/wiener_smoother.h"

namespace kinemark::skeleton::articulated {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

constexpr double kLongestGap_s = 1.0;  // without a frame that holds a position
// Standard deviations of the first frame: m about the first position found, m/s (limbs stay far below),
// m/s^2.
constexpr std::array<double, 5> kPriorSd{1.0, 10.0, 1000.0};

/// Frames [begin, end) without a gap too long to cross; the first position in them.
struct Piece {
  std::int64_t begin = 0, end = 0;
  Vector3d first_position = Vector3d::Zero();
};

std::vector<Piece> cut(std::span<const PathPoint> points, double rate_hz) {
  const auto F = static_cast<std::int64_t>(points.size());
  const auto longest = static_cast<std::int64_t>(kLongestGap_s * rate_hz);
  std::vector<Piece> pieces;
  std::int64_t last = 0;
  for (std::int64_t f = 0; f < F; ++f) {
    const PathPoint& point = points[static_cast<std::size_t>(f)];
    if (!holds_a_position(point)) continue;
    if (pieces.empty() || f - last > longest) {
      if (!pieces.empty()) pieces.back().end = std::min(last + longest / 2 + 1, F);
      const std::int64_t earliest = pieces.empty() ? 0 : pieces.back().end;
      pieces.push_back(
          {.begin = std::max(f - longest / 2, earliest), .end = F, .first_position = point.position});
    }
    last = f;
  }
  if (!pieces.empty()) pieces.back().end = std::min(last + longest / 2 + 1, F);
  return pieces;
}

std::vector<math::PositionObservation<3>> observe(std::span<const PathPoint> points, const Piece& piece,
                                                  double rate_hz) {
  std::vector<math::PositionObservation<3>> out;
  out.reserve(static_cast<std::size_t>(piece.end - piece.begin));
  for (std::int64_t f = piece.begin; f < piece.end; ++f) {
    const PathPoint& point = points[static_cast<std::size_t>(f)];
    out.push_back({.time_s = static_cast<double>(f - piece.begin) / rate_hz,
                   .information = point.information,
                   .position = point.position});
  }
  return out;
}

/// Log likelihood when every frame draws its position anew from one normal distribution.
double likelihood_of_unrelated(std::span<const PathPoint> points) {
  Vector3d mean = Vector3d::Zero();
  Matrix3d spread = Matrix3d::Zero();
  double n = 0.0;
  for (const PathPoint& p : points)
    if (holds_a_position(p)) mean += p.position, n += 1.0;
  if (n == 0.0) return 0.0;
  mean /= n;
  for (const PathPoint& p : points)
    if (holds_a_position(p)) spread += (p.position - mean) * (p.position - mean).transpose() / n;
  double sum = 0.0;
  for (const PathPoint& p : points) {
    if (!holds_a_position(p)) continue;
    const Matrix3d m = Matrix3d::Identity() + p.information * spread;
    const Vector3d z = p.position - mean;
    sum -= 0.5 * (z.dot(m.inverse() * p.information * z) + std::log(m.determinant()));
  }
  return sum;
}

}  // namespace

bool holds_a_position(const PathPoint& point) {
  const double mean = point.information.trace() / 3.0;
  return mean > 0.0 && point.information.determinant() > 1e-9 * mean * mean * mean;
}

Eigen::Matrix3d SmoothedPath::covariance_at(std::size_t frame) const {
  return math::unpack_symmetric3(covariance.data() + 6 * frame);
}

SmoothedPath smooth_path(std::span<const PathPoint> points, double rate_hz, double white_jerk) {
  SmoothedPath path;
  path.position.assign(points.size(), Vector3d::Constant(kNaN));
  path.covariance.assign(6 * points.size(), kNaN);
  math::WienerOptions<3> options;
  options.covariance = math::WienerCovariance::position;
  for (const Piece& piece : cut(points, rate_hz)) {
    options.prior = math::WienerPrior<3>{.position = piece.first_position, .sd = kPriorSd};
    math::smooth_wiener<3>({.order = 3, .spectral_density = white_jerk}, observe(points, piece, rate_hz),
                           options, [&](std::size_t k, const math::WienerEstimate<3>& at) {
                             const std::size_t f = static_cast<std::size_t>(piece.begin) + k;
                             path.position[f] = at.derivative(0);
                             math::pack_symmetric3(at.covariance_of(0), path.covariance.data() + 6 * f);
                           });
  }
  return path;
}

double calc_path_likelihood(std::span<const PathPoint> points, double rate_hz, double white_jerk) {
  double sum = 0.0;  // pieces are independent: each begins afresh
  for (const Piece& piece : cut(points, rate_hz))
    sum += math::wiener_log_likelihood<3>({.order = 3, .spectral_density = white_jerk},
                                          observe(points, piece, rate_hz),
                                          {.position = piece.first_position, .sd = kPriorSd});
  return sum;
}

PathPrior find_path_prior(std::span<const PathPoint> points, double rate_hz, std::int64_t max_frames) {
  // Windows over the recording: a likelihood of the whole would cost a pass for each density tried.
  const auto F = static_cast<std::int64_t>(points.size());
  std::vector<std::span<const PathPoint>> windows;
  if (F <= max_frames) windows.push_back(points);
  for (int w = 0; F > max_frames && w < 4; ++w)
    windows.push_back(points.subspan(static_cast<std::size_t>((F - max_frames / 4) * w / 3),
                                     static_cast<std::size_t>(max_frames / 4)));
  const auto total = [&](double exponent) {
    double sum = 0.0;
    for (const auto& window : windows) sum += calc_path_likelihood(window, rate_hz, std::pow(10.0, exponent));
    return sum;
  };
  double best = -4.0, best_value = total(best);
  for (double exponent = -3.0; exponent <= 12.0; exponent += 1.0)
    if (const double value = total(exponent); value > best_value) best = exponent, best_value = value;
  for (const double exponent : {best - 0.5, best + 0.5})
    if (const double value = total(exponent); value > best_value) best = exponent, best_value = value;
  double unrelated = 0.0;
  for (const auto& window : windows) unrelated += likelihood_of_unrelated(window);
  return {.white_jerk = std::pow(10.0, best), .follows = best_value > unrelated};
}

}  // namespace kinemark::skeleton::articulated
