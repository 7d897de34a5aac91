// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/skeleton/functional/internal/own_slide.h"

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "kinemark/core/index.h"
#include "kinemark/stages/skeleton/functional/internal/alike.h"

namespace kinemark::skeleton::internal {
namespace {

constexpr double kSmallest_m = 0.15e-3, kLargest_m = 80e-3;
constexpr double kNone = 0.5;  ///< probability of no slide before the recording is seen
constexpr int kSteps = 40;     ///< of expectation and maximisation: the variances have settled by then
constexpr double kFirst_m = 5e-3;
constexpr double kRounding_m = 1e-7;
/// Variances are told by at least so much, in numbers of which each is so small (m): none runs to zero.
constexpr double kLeastNumbers = 2.0, kLeastSize_m2 = 1e-9;
constexpr double kQuadraticFrom = 0.7, kQuadraticTo = 3.0, kLagFrom = 0.05, kLagTo = 1.0;
constexpr double kRatioFrom = 0.02, kRatioTo = 3.0, kDampedTo = 100.0;
constexpr int kKinds = 4;

/// SDs of coefficients of each kind of term, found by expectation and maximisation.
std::array<double, kKinds> sizes_by_kind(const Eigen::MatrixXd& H, const Eigen::MatrixXd& h,
                                         const Posture& posture, double freedom) {
  std::array<double, kKinds> variance;
  variance.fill(kFirst_m * kFirst_m);
  for (int round = 0; round < kSteps; ++round) {
    Eigen::MatrixXd information = H;
    for (int k = 0; k < kPostureTerms; ++k)
      information(k, k) += 1.0 / variance[at(static_cast<int>(posture.kind[at(k)]))];
    const Eigen::MatrixXd covariance =
        information.llt().solve(Eigen::MatrixXd::Identity(kPostureTerms, kPostureTerms));
    const Eigen::MatrixXd mean = covariance * h;
    std::array<double, kKinds> squares{}, terms{};
    for (int k = 0; k < kPostureTerms; ++k) {
      const auto kind = at(static_cast<int>(posture.kind[at(k)]));
      squares[kind] += mean.row(k).squaredNorm() + freedom * covariance(k, k);
      terms[kind] += 1.0;
    }
    for (std::size_t g = 0; g < kKinds; ++g)
      variance[g] = (squares[g] + kLeastNumbers * kLeastSize_m2) / (freedom * terms[g] + kLeastNumbers);
  }
  std::array<double, kKinds> out{};
  for (std::size_t g = 0; g < kKinds; ++g) out[g] = std::sqrt(variance[g]);
  return out;
}

/// Log evidence of a slide of a size over none.
double log_evidence(const Eigen::MatrixXd& H, const Eigen::MatrixXd& h, const Eigen::VectorXd& scale,
                    double size, double freedom) {
  const Eigen::VectorXd by = size * scale;
  Eigen::MatrixXd inner = by.asDiagonal() * H * by.asDiagonal();
  inner.diagonal().array() += 1.0;
  const Eigen::LLT<Eigen::MatrixXd> llt(inner);
  const Eigen::MatrixXd u = llt.matrixL().solve(Eigen::MatrixXd(by.asDiagonal() * h));
  return 0.5 * u.squaredNorm() - freedom * llt.matrixLLT().diagonal().array().log().sum();
}

}  // namespace

const std::array<double, kSlideSizes>& slide_sizes() {
  static const auto sizes = [] {
    std::array<double, kSlideSizes> out{};
    for (int i = 1; i < kSlideSizes; ++i)
      out[at(i)] = kSmallest_m * std::pow(kLargest_m / kSmallest_m, (i - 1) / (kSlideSizes - 2.0));
    return out;
  }();
  return sizes;
}

OwnSlide find_own_slide(const Eigen::MatrixXd& deformation, const Posture& posture, double freedom) {
  OwnSlide out;
  const auto F = static_cast<double>(deformation.rows());
  const Eigen::MatrixXd normal = posture.terms.transpose() * posture.terms;
  const Eigen::MatrixXd right = posture.terms.transpose() * deformation;
  Eigen::MatrixXd firm = normal;
  firm.diagonal().array() += 1e-12 * normal.trace() + 1e-30;
  const Eigen::MatrixXd left = deformation - posture.terms * firm.ldlt().solve(right);
  const double alike = frames_alike(left, posture.terms.leftCols<kLinearTerms>());
  const double effective = F / alike;
  out.noise_variance = std::max(
      left.squaredNorm() / (F * freedom) * effective / std::max(effective - kPostureTerms, 0.4 * effective),
      kRounding_m * kRounding_m);
  const double information = 1.0 / (out.noise_variance * alike);
  const Eigen::MatrixXd H = normal * information, h = right * information;
  const auto size = sizes_by_kind(H, h, posture, freedom);
  const auto ratio = [&](TermKind kind, double to) {
    const double linear = std::sqrt(std::max(size[0] * size[0], kLeastSize_m2));
    return std::clamp(size[at(static_cast<int>(kind))] / linear, kRatioFrom, to);
  };
  const std::array<double, kKinds> over = {1.0, ratio(TermKind::quadratic, kRatioTo),
                                           ratio(TermKind::lag, kRatioTo),
                                           ratio(TermKind::damped, kDampedTo)};
  out.quadratic = std::clamp(over[1], kQuadraticFrom, kQuadraticTo);
  out.lag = std::clamp(over[2], kLagFrom, kLagTo);
  Eigen::VectorXd scale(kPostureTerms);
  for (int k = 0; k < kPostureTerms; ++k) scale(k) = over[at(static_cast<int>(posture.kind[at(k)]))];
  const auto& sizes = slide_sizes();
  std::array<double, kSlideSizes> log_weight{};
  for (std::size_t i = 0; i < kSlideSizes; ++i)
    log_weight[i] =
        i == 0 ? std::log(kNone)
               : std::log((1.0 - kNone) / (kSlideSizes - 1)) + log_evidence(H, h, scale, sizes[i], freedom);
  const double best = *std::ranges::max_element(log_weight);
  double sum = 0.0, squares = 0.0, below = 0.0;
  for (std::size_t i = 0; i < kSlideSizes; ++i) sum += out.weight[i] = std::exp(log_weight[i] - best);
  for (std::size_t i = 0; i < kSlideSizes; ++i) {
    out.weight[i] /= sum;
    squares += out.weight[i] * sizes[i] * sizes[i];
    if (below < 0.95) out.limit_m = sizes[i];
    below += out.weight[i];
  }
  out.size_m = std::sqrt(squares);
  out.limit_m = std::max(out.limit_m, out.size_m);
  return out;
}

}  // namespace kinemark::skeleton::internal
