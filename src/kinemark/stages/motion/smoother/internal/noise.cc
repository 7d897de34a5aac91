// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/motion/smoother/internal/noise.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>

#include "kinemark/core/index.h"
#include "kinemark/math/statistics.h"
#include "kinemark/model/state.h"
#include "kinemark/stages/motion/internal/error_bars.h"
#include "kinemark/stages/motion/internal/marker_account.h"

namespace kinemark::motion::internal {
namespace {

using Eigen::Index;
using Eigen::Vector3d;
using Eigen::VectorXd;

constexpr double kSmallestVariance = 1e-10;  // 10 um, a lower bound of marker noise
constexpr double kWidest = 10.0;             // a marker's variance over the usual one, and its inverse
constexpr double kChance = 2.5;              // standard errors that a slow share must exceed

double usual_of(const VectorXd& values) { return math::upper_median({values.data(), at(values.size())}); }

/// Share of a marker's residual variance that is not white, beyond chance.
double slow_share(const data::JointMotion& motion, Index m) {
  const auto M = static_cast<std::int64_t>(motion.markers.size());
  double second = 0.0, plain = 0.0;
  std::int64_t count = 0;
  for (std::int64_t f = 1; f + 1 < motion.frames(); ++f) {
    const auto error = [&](std::int64_t frame) {
      return Eigen::Map<const Vector3d>(motion.marker_error.data() + (frame * M + m) * 3);
    };
    const Vector3d second_difference = error(f - 1) - 2.0 * error(f) + error(f + 1);
    if (!second_difference.allFinite()) continue;
    second += second_difference.squaredNorm() / 6.0;
    plain += error(f).squaredNorm();
    ++count;
  }
  if (count < 30 || plain <= 0.0) return 0.0;
  const double chance = kChance * std::sqrt(2.0 / (3.0 * static_cast<double>(count)));
  const double share = 1.0 - second / plain;
  return share > chance ? std::min(share, 1.0) : 0.0;
}

struct Spread {
  double usual = 0.0;  ///< m^2, robust variance per axis; 0 with few frames
  double share = 1.0;  ///< of the variance over all frames, at most 1: small where single frames make the sum
};

/// Spread of a marker's residuals.
Spread spread(const data::JointMotion& motion, Index m) {
  constexpr double kMedianOfChiSquare3 = 2.366;
  constexpr Index kFewest = 30;
  const auto M = static_cast<std::int64_t>(motion.markers.size());
  VectorXd squares(motion.frames());
  Index count = 0;
  for (std::int64_t f = 0; f < motion.frames(); ++f) {
    const Eigen::Map<const Vector3d> error(motion.marker_error.data() + (f * M + m) * 3);
    if (error.allFinite()) squares[count++] = error.squaredNorm();
  }
  if (count < kFewest) return {};
  const double all = squares.head(count).mean() / 3.0;
  if (!(all > 0.0)) return {};
  const double usual = usual_of(squares.head(count)) / kMedianOfChiSquare3;
  return {.usual = usual, .share = std::min(1.0, usual / all)};
}

}  // namespace

void leave_out_outliers(const Problem& problem, const data::Trajectories& markers, double huber_sd,
                        int threads, IkResult& start) {
  constexpr std::int64_t kRare = 10;  // one frame in so many
  auto& motion = start.motion;
  const std::int64_t F = motion.frames();
  const auto M = static_cast<std::int64_t>(motion.markers.size());
  std::vector<std::uint8_t> wild(at(F), 0);
  for (std::int64_t m = 0; m < M; ++m) {
    const double usual = spread(motion, m).usual;
    if (usual <= 0.0) continue;
    const double huber_m = huber_sd * std::sqrt(3.0 * std::max(kSmallestVariance, usual));
    for (std::int64_t f = 0; f < F; ++f)
      if (Eigen::Map<const Vector3d>(motion.marker_error.data() + (f * M + m) * 3).norm() > huber_m)
        wild[at(f)] = 1;
  }
  const auto count = std::ranges::count(wild, 1);
  if (count == 0 || count * kRare > F) return;
  data::Trajectories calm = markers;
  Eigen::MatrixXd states(problem.model.state_count(), F);
  VectorXd q(static_cast<Index>(motion.size()));
  for (std::int64_t f = 0; f < F; ++f) {
    std::copy_n(motion.q.data() + motion.index(f, 0), q.size(), q.data());
    states.col(f) = model::state_from_coordinates(problem.model, q);
    if (wild[at(f)] == 0) continue;
    for (std::int64_t m = 0; m < calm.markers(); ++m) calm.set_missing(problem.first_frame + f, m);
    std::fill_n(motion.marker_error.begin() + f * M * 3, M * 3, std::numeric_limits<double>::quiet_NaN());
  }
  add_marker_noise(problem.model, estimate_variances(problem, calm, states, threads), start.fit);
}

NoiseSplit split_noise(const Problem& problem, const IkResult& start, double given_sd_m, double huber_sd) {
  const auto M = static_cast<Index>(problem.model.marker_count());
  const auto bodies = static_cast<Index>(problem.model.bodies().size());
  NoiseSplit split;
  VectorXd own(M), common = VectorXd::Zero(M), share = VectorXd::Zero(M), count = VectorXd::Zero(bodies);
  split.common_slow.setZero(bodies);
  for (Index m = 0; m < M; ++m) {
    const auto& marker = start.fit.markers[at(m)];
    own[m] = given_sd_m > 0.0 ? given_sd_m * given_sd_m : marker.noise_sd_m * marker.noise_sd_m;
    if (!std::isfinite(own[m])) own[m] = 0.0;
    if (given_sd_m > 0.0) continue;
    if (std::isfinite(marker.common_sd_m)) common[m] = marker.common_sd_m * marker.common_sd_m;
    share[m] = slow_share(start.motion, m);
  }
  const double usual = std::max(kSmallestVariance, usual_of(own));
  split.raised = std::sqrt(usual / usual_of(own));
  own = own.cwiseMax(usual / kWidest).cwiseMin(usual * kWidest);
  split.white = own.cwiseProduct((1.0 - share.array()).matrix()).cwiseMax(kSmallestVariance);
  split.slow = own.cwiseProduct(share);
  for (Index m = 0; m < M; ++m) {
    const int body = problem.model.markers()[at(m)].body;
    if (body < 0) continue;
    split.common_slow[body] += share[m] * common[m];
    count[body] += 1.0;
  }
  split.common_slow.array() /= count.array().max(1.0);

  // Weights follow from the whole variance of a marker, shrunk half way towards equal weights: a marker with
  // small residuals would otherwise attract the pose and obtain even smaller residuals.
  const VectorXd total = own + common;
  const double usual_total = usual_of(total), usual_white = usual_of(split.white);
  const double usual_weight = usual_of(problem.weight);
  split.beyond_white = std::max(1.0, usual_total / usual_white);
  for (Index m = 0; m < M; ++m) {
    MarkerTrust trust;
    trust.information = problem.weight[m] / usual_weight * std::sqrt(usual_total / total[m]) / usual_white;
    // Outliers are judged by the other frames, not by a variance that they have raised themselves.
    if (huber_sd > 0.0) {
      const double usual_frames = given_sd_m > 0.0 ? 1.0 : spread(start.motion, m).share;
      trust.huber_m = huber_sd * std::sqrt(3.0 * std::max(kSmallestVariance, usual_frames * total[m]));
    }
    split.trust.push_back(trust);
  }
  return split;
}

}  // namespace kinemark::motion::internal
