// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/motion/internal/marker_account.h"

#include <algorithm>
#include <cmath>

#include "kinemark/core/check.h"
#include "kinemark/core/index.h"

namespace kinemark::motion::internal {

void add_marker_errors(const data::JointMotion& motion, data::MarkerFit& fit) {
  check(fit.markers.size() == motion.markers.size(), "the fit must have the motion's markers");
  const auto M = std::ssize(fit.markers);
  double squares = 0.0;
  std::int64_t count = 0;
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  fit.max_error_m = 0.0;
  for (std::int64_t m = 0; m < M; ++m) {
    auto& marker = fit.markers[at(m)];
    marker.max_m = 0.0;
    std::int64_t seen = 0;
    double own = 0.0;
    for (std::int64_t f = 0; f < motion.frames(); ++f) {
      const Eigen::Map<const Eigen::Vector3d> error(motion.marker_error.data() + (f * M + m) * 3);
      if (std::isnan(error.x())) continue;
      ++seen;
      own += error.squaredNorm();
      sum += error;
      marker.max_m = std::max(marker.max_m, error.norm());
    }
    squares += own;
    count += seen;
    marker.seen = static_cast<double>(seen) / static_cast<double>(motion.frames());
    marker.rms_m = seen > 0 ? std::sqrt(own / static_cast<double>(seen)) : kNaN;
    fit.max_error_m = std::max(fit.max_error_m, marker.max_m);
  }
  // Nothing seen, nothing known: NaN passes no gate.
  fit.rms_error_m = count > 0 ? std::sqrt(squares / static_cast<double>(count)) : kNaN;
  fit.mean_error_m =
      count > 0 ? Eigen::Vector3d(sum / static_cast<double>(count)) : Eigen::Vector3d::Constant(kNaN);
}

void add_marker_noise(const model::Model& model, const MarkerVariances& variances, data::MarkerFit& fit) {
  check(std::ssize(fit.markers) == model.marker_count(), "the fit must have the model's markers");
  for (Eigen::Index m = 0; m < variances.own.size(); ++m) {
    const int body = model.markers()[at(m)].body;
    fit.markers[at(m)].noise_sd_m = std::sqrt(variances.own[m]);
    if (body >= 0) fit.markers[at(m)].common_sd_m = std::sqrt(variances.common[body]);
  }
}

}  // namespace kinemark::motion::internal
