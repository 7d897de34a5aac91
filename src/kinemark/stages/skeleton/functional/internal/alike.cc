// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/skeleton/functional/internal/alike.h"

#include <algorithm>

namespace kinemark::skeleton::internal {
namespace {

constexpr Eigen::Index kMostLags = 200;

/// Autocorrelation of all columns together, lags 0 to `lags` - 1; zero where there is no variance.
Eigen::VectorXd autocorrelation(const Eigen::MatrixXd& x, Eigen::Index lags) {
  const Eigen::MatrixXd centred = x.rowwise() - x.colwise().mean();
  const auto n = x.rows();
  Eigen::VectorXd out = Eigen::VectorXd::Zero(lags);
  const double variance = centred.squaredNorm();
  if (!(variance > 0.0)) return out;
  for (Eigen::Index lag = 0; lag < lags; ++lag)
    out(lag) = centred.topRows(n - lag).cwiseProduct(centred.bottomRows(n - lag)).sum() / variance;
  return out;
}

}  // namespace

double frames_alike(const Eigen::MatrixXd& errors, const Eigen::MatrixXd& regressors) {
  const Eigen::Index lags = std::min(errors.rows() / 4, kMostLags);
  if (lags < 2) return 1.0;
  const Eigen::VectorXd both = autocorrelation(errors, lags).cwiseProduct(autocorrelation(regressors, lags));
  double sum = 1.0;
  for (Eigen::Index lag = 1; lag < lags; ++lag)
    sum += 2.0 * both(lag) * (1.0 - static_cast<double>(lag) / static_cast<double>(lags));
  return std::max(1.0, sum);
}

}  // namespace kinemark::skeleton::internal
