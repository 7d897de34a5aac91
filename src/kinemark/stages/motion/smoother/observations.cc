// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/motion/smoother/observations.h"

#include <utility>

#include "kinemark/core/check.h"

namespace kinemark::motion {
namespace {

/// Adds an observed point with Huber's loss, isotropic.
void add_point(const MarkerTrust& trust, const Eigen::Vector3d& residual, Eigen::Index m,
               MarkerInformation& out) {
  const double r = residual.norm();
  const bool beyond = r > trust.huber_m;
  const double weight = beyond ? trust.information * trust.huber_m / r : trust.information;
  out.weight[m] += weight;
  out.descent.col(m) += weight * residual;
  out.cost += beyond ? trust.information * trust.huber_m * (r - 0.5 * trust.huber_m)
                     : 0.5 * trust.information * r * r;
}

}  // namespace

void MarkerInformation::clear(Eigen::Index markers, bool with_full) {
  descent.setZero(3, markers);
  weight.setZero(markers);
  cost = 0.0;
  full.resize(with_full ? static_cast<std::size_t>(markers) : 0);
  for (auto& information : full) information.setZero();
}

MarkerObservations::MarkerObservations(const data::Trajectories& markers, std::vector<int> column,
                                       std::int64_t first_frame, std::vector<MarkerTrust> trust)
    : markers_(markers), column_(std::move(column)), first_frame_(first_frame), trust_(std::move(trust)) {
  check(column_.size() == trust_.size(), "need one column of the recording for every marker");
}

void MarkerObservations::linearize(std::int64_t f, const Eigen::Matrix3Xd& p, MarkerInformation& out) const {
  out.clear(p.cols(), false);
  for (std::size_t m = 0; m < column_.size(); ++m) {
    if (!markers_.present(first_frame_ + f, column_[m])) continue;
    const auto i = static_cast<Eigen::Index>(m);
    add_point(trust_[m], markers_.x(first_frame_ + f, column_[m]) - p.col(i), i, out);
  }
}

}  // namespace kinemark::motion
