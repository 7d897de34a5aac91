// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/skeleton/functional/internal/gap_model.h"

#include <Eigen/Cholesky>
#include <Eigen/LU>

#include <algorithm>
#include <cmath>

#include "kinemark/core/index.h"
#include "kinemark/data/joint_choice.h"
#include "kinemark/math/euler.h"

namespace kinemark::skeleton::internal {
namespace {

using Eigen::Matrix3d;

/// Turn of a segment's markers per rad of the posture, in its own axes.
Matrix3d turn_of(const TurningSlide& side) {
  const double common = side.turn_m / side.cluster.radius_m;
  return side.own_m * side.own_m * side.cluster.inverse_inertia + common * common * Matrix3d::Identity();
}

/// Variance of each tilt by rotations about other axes that do not follow the hinge's angle.
double scatter_of(const RelativeMotion& motion, const Posture& posture, const JointFit& hinge) {
  const Eigen::Vector3d axis = motion.axes.transpose() * hinge.axis_in_child;
  const Eigen::VectorXd angle = posture.component * axis;
  const Eigen::MatrixX3d off = posture.component - angle * axis.transpose();
  const double frames = static_cast<double>(posture.component.rows()) / frames_alike(off, angle);
  const double swing = angle.squaredNorm() / static_cast<double>(angle.size());
  return off.squaredNorm() / (2.0 * static_cast<double>(angle.size())) / (frames * swing);
}

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

constexpr double kFirm = 1e-4;  ///< weight of the joint's prior beside a frame: holds what hardly moves

}  // namespace

Matrix3d axis_slide_covariance(const TurningSlide& parent, const TurningSlide& child,
                               const RelativeMotion& motion, const Posture& posture, const JointFit& hinge) {
  const Matrix3d all = turn_of(parent) + motion.mean * turn_of(child) * motion.mean.transpose() +
                       scatter_of(motion, posture, hinge) * Matrix3d::Identity();
  const Matrix3d across = Matrix3d::Identity() - hinge.axis_in_parent * hinge.axis_in_parent.transpose();
  return across * all * across;
}

double frames_alike(const Eigen::MatrixXd& errors, const Eigen::MatrixXd& regressors) {
  const Eigen::Index lags = std::min(errors.rows() / 4, kMostLags);
  if (lags < 2) return 1.0;
  const Eigen::VectorXd both = autocorrelation(errors, lags).cwiseProduct(autocorrelation(regressors, lags));
  double sum = 1.0;
  for (Eigen::Index lag = 1; lag < lags; ++lag)
    sum += 2.0 * both(lag) * (1.0 - static_cast<double>(lag) / static_cast<double>(lags));
  return std::max(1.0, sum);
}

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

Eigen::MatrixXd GapModel::residual(const Eigen::VectorXd& coefficients) const {
  const Eigen::VectorXd left = gap - design * coefficients;
  return Eigen::Map<const Eigen::Matrix3Xd>(left.data(), 3, left.size() / 3).transpose();
}

GapModel gap_model(const SegmentPoses& parent, const SegmentPoses& child, const RelativeMotion& motion,
                   const Posture& posture) {
  GapModel out{.posture = posture};
  const auto F = static_cast<Eigen::Index>(posture.frames.size());
  out.design.resize(3 * F, kGapSize);
  out.gap.resize(3 * F);
  Matrix6 normal = Matrix6::Identity() *
                   (kFirm * static_cast<double>(F) / (data::kJointPriorSd_m * data::kJointPriorSd_m));
  Vector6 right = Vector6::Zero();
  Eigen::Matrix<double, 3, 6> X;
  X.leftCols<3>().setIdentity();
  const auto measured = [&](Eigen::Index i) {
    const auto f = at(posture.frames[at(i)]);
    X.rightCols<3>() = -parent.world_from_segment[f].transpose() * child.world_from_segment[f];
    return Eigen::Vector3d(parent.world_from_segment[f].transpose() * (child.origin[f] - parent.origin[f]));
  };
  for (Eigen::Index i = 0; i < F; ++i) {
    const Eigen::Vector3d y = measured(i);
    normal += X.transpose() * X;
    right += X.transpose() * y;
  }
  out.about = normal.llt().solve(right);
  for (Eigen::Index i = 0; i < F; ++i) {
    const Eigen::Vector3d y = measured(i);
    out.gap.segment<3>(3 * i) = y - X * out.about;
    const Eigen::Matrix3d R = motion.mean * math::exp_so3(motion.axes * posture.smooth.row(i).transpose());
    auto row = out.design.middleRows<3>(3 * i);
    row.leftCols<3>().setIdentity();
    row.middleCols<3>(3) = -R;
    for (int k = 0; k < kPostureTerms; ++k)
      row.middleCols<3>(6 + 3 * k) = posture.terms(i, k) * Eigen::Matrix3d::Identity();
    for (int k = 0; k < kLinearTerms; ++k)
      row.middleCols<3>(6 + 3 * (kPostureTerms + k)) = -posture.smooth(i, k) * R;
  }
  const Eigen::Index length = posture.block, count = F / length;
  out.blocks = Eigen::MatrixXd::Zero(3 * count, kGapSize);
  out.block_gap = Eigen::VectorXd::Zero(3 * count);
  for (Eigen::Index i = 0; i < count * length; ++i) {
    out.blocks.middleRows<3>(3 * (i / length)) += out.design.middleRows<3>(3 * i);
    out.block_gap.segment<3>(3 * (i / length)) += out.gap.segment<3>(3 * i);
  }
  out.blocks /= static_cast<double>(length);
  out.block_gap /= static_cast<double>(length);
  return out;
}

}  // namespace kinemark::skeleton::internal
