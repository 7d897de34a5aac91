// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/skeleton/functional/skin_slide.h"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "kinemark/core/index.h"
#include "kinemark/data/joint_choice.h"
#include "kinemark/stages/skeleton/functional/internal/posture.h"

namespace kinemark::skeleton {
namespace {

constexpr std::int64_t kLeastSlideFrames = 40;
constexpr int kTerms = 9;               ///< three linear, six quadratic functions of the posture
constexpr int kSlide = 2 * 3 * kTerms;  ///< coefficients: both sides, three axes
/// Gaps and noise of no more than this are rounding: no marker is known so well.
constexpr double kRounding_m = 1e-7;
constexpr double kLeastPosture_rad = 0.01;  ///< components of the posture that move less are not blown up
/// A component of the posture that hardly moves is mostly crosstalk and slides less than in proportion to its
/// SD: it counts as having this SD in quadrature.
constexpr double kCrosstalk_rad = 0.14;
constexpr double kQuadratic = 0.15;   ///< variance of quadratic coefficients over that of linear ones
constexpr double kPriorMedian = 0.5;  ///< of a ball joint's amplitude, over the RMS gap per axis
constexpr double kLeveragePower = 0.5, kLeastLeft = 0.05;
constexpr double kPriorLog = 1.0;  ///< SD of its logarithm
constexpr int kGrid = 24;
constexpr double kGridFrom = 0.04, kGridTo = 6.0;  ///< of the amplitude, over its median

using internal::Posture;
using Row = Eigen::Matrix<double, 3, Eigen::Dynamic>;

/// Functions of the posture, F x 9, each of the size that its coefficients are expected to have alike.
Eigen::MatrixXd terms_of(const Posture& posture) {
  const auto n = posture.component.rows();
  Eigen::MatrixX3d z(n, 3);
  for (int k = 0; k < 3; ++k) {
    const double sd = posture.sd_rad(k);
    const double size = std::sqrt((sd * sd + kCrosstalk_rad * kCrosstalk_rad) /
                                  (posture.sd_rad(0) * posture.sd_rad(0) + kCrosstalk_rad * kCrosstalk_rad));
    z.col(k) = posture.component.col(k) * (size / std::max(sd, kLeastPosture_rad));
  }
  Eigen::MatrixXd out(n, kTerms);
  out.leftCols<3>() = z;
  int column = 3;
  for (int a = 0; a < 3; ++a)
    for (int b = a; b < 3; ++b, ++column) {
      out.col(column) = z.col(a).cwiseProduct(z.col(b)) * std::sqrt(kQuadratic * (a == b ? 0.5 : 1.0));
      out.col(column).array() -= out.col(column).mean();
    }
  return out;
}

/// One frame's rows of p_a - R p_b + slide = y, in the parent's axes.
Row row_of(const SegmentPoses& parent, const SegmentPoses& child, std::int64_t frame,
           const Eigen::Ref<const Eigen::RowVectorXd>& terms) {
  const auto f = at(frame);
  const Eigen::Matrix3d to_parent = parent.world_from_segment[f].transpose();
  const Eigen::Matrix3d rotation = to_parent * child.world_from_segment[f];
  Row out(3, 6 + kSlide + 1);
  out.leftCols<3>().setIdentity();
  out.middleCols<3>(3) = -rotation;
  for (int k = 0; k < kTerms; ++k) {
    // Two sides share the amplitude's square.
    out.middleCols<3>(6 + 3 * k) = terms(k) * std::sqrt(0.5) * Eigen::Matrix3d::Identity();
    out.middleCols<3>(6 + 3 * kTerms + 3 * k) = terms(k) * std::sqrt(0.5) * rotation;
  }
  out.col(6 + kSlide) = to_parent * (child.origin[f] - parent.origin[f]);
  return out;
}

/// Frames that count as one: 1 + 2 sum of autocorrelations while pairs of them are positive (Geyer 1992).
double frames_alike(const Eigen::MatrixX3d& residual) {
  const auto n = residual.rows();
  const double variance = residual.squaredNorm();
  if (!(variance > 0.0)) return 1.0;
  const auto correlation = [&](Eigen::Index lag) {
    return residual.topRows(n - lag).cwiseProduct(residual.bottomRows(n - lag)).sum() / variance;
  };
  double sum = 1.0;
  for (Eigen::Index lag = 1; lag + 1 < n / 2; lag += 2) {
    const double pair = correlation(lag) + correlation(lag + 1);
    if (!(pair > 0.0)) break;
    sum += 2.0 * pair;
  }
  return std::clamp(sum, 1.0, static_cast<double>(n) / 4.0);
}

/// Sums of the regression: what the slide's size is inferred from.
struct SlideProblem {
  Eigen::MatrixXd normal;  ///< of joint, slide and gap together
  double variance = 0.0;   ///< of the noise of a frame that counts as one

  [[nodiscard]] Matrix6 xx() const { return normal.topLeftCorner<6, 6>(); }
  [[nodiscard]] Eigen::MatrixXd xz() const { return normal.block(0, 6, 6, kSlide); }
  /// Log likelihood of an amplitude, the joint itself integrated out.
  [[nodiscard]] double log_likelihood(double amplitude_m) const;
  /// Covariance of least squares.
  [[nodiscard]] Matrix6 covariance(const Matrix6& solve, double amplitude_m) const {
    const Eigen::MatrixXd z = solve * xz();
    return variance * solve * xx() * solve + amplitude_m * amplitude_m * z * z.transpose();
  }
};

double SlideProblem::log_likelihood(double amplitude_m) const {
  const Vector6 xy = normal.block<6, 1>(0, 6 + kSlide);
  Matrix6 M = xx() / variance;
  Vector6 right = xy / variance;
  double squares = normal(6 + kSlide, 6 + kSlide) / variance, log_det = 0.0;
  if (amplitude_m > 0.0) {
    Eigen::MatrixXd inner = normal.block(6, 6, kSlide, kSlide) * (amplitude_m * amplitude_m / variance);
    inner.diagonal().array() += 1.0;
    const Eigen::LLT<Eigen::MatrixXd> llt(inner);
    const double scale = amplitude_m / variance;
    const Eigen::MatrixXd zx = llt.matrixL().solve(Eigen::MatrixXd(scale * xz().transpose()));
    const Eigen::VectorXd zy =
        llt.matrixL().solve(Eigen::VectorXd(scale * normal.block(6, 6 + kSlide, kSlide, 1)));
    M -= zx.transpose() * zx;
    right -= zx.transpose() * zy;
    squares -= zy.squaredNorm();
    log_det = 2.0 * llt.matrixLLT().diagonal().array().log().sum();
  }
  // What the motion leaves open, as the place along a hinge, has no eigenvalue but rounding: the prior's
  // alone.
  const Eigen::SelfAdjointEigenSolver<Matrix6> eigen(M);
  const Vector6 information =
      eigen.eigenvalues().cwiseMax(0.0).array() + 1.0 / (data::kJointPriorSd_m * data::kJointPriorSd_m);
  const Vector6 along = eigen.eigenvectors().transpose() * right;
  log_det += information.array().log().sum();
  return -0.5 * (log_det + squares - along.cwiseAbs2().cwiseQuotient(information).sum());
}

/// The amplitude's grid with the weight of each value; the first is none.
struct Amplitudes {
  std::array<double, kGrid + 1> value{}, weight{};
};

Amplitudes infer_amplitude(const SlideProblem& problem, double median_m) {
  Amplitudes out;
  std::array<double, kGrid + 1> log_weight{};
  const double step = std::log(kGridTo / kGridFrom) / (kGrid - 1);
  log_weight[0] = problem.log_likelihood(0.0);
  for (int i = 1; i <= kGrid; ++i) {
    const double ratio = kGridFrom * std::exp(step * (i - 1));
    out.value[at(i)] = ratio * median_m;
    const double deviate = std::log(ratio) / kPriorLog;
    // The grid's weights sum to one, as that of "none" is one.
    log_weight[at(i)] = problem.log_likelihood(out.value[at(i)]) - 0.5 * deviate * deviate +
                        std::log(step / (kPriorLog * std::sqrt(2.0 * M_PI)));
  }
  const double best = *std::ranges::max_element(log_weight);
  double sum = 0.0;
  for (std::size_t i = 0; i < log_weight.size(); ++i) sum += out.weight[i] = std::exp(log_weight[i] - best);
  for (double& w : out.weight) w /= sum;
  return out;
}

/// One movement's share of the sums.
struct Cycle {
  Matrix6 xx = Matrix6::Zero();
  Eigen::MatrixXd xz = Eigen::MatrixXd::Zero(6, kSlide);
};

std::vector<Cycle> cycles_of(const SegmentPoses& parent, const SegmentPoses& child, const Posture& posture,
                             const Eigen::MatrixXd& terms, double alike) {
  const std::int64_t count = internal::count_cycles(posture);
  std::vector<Cycle> out(at(count));
  const Eigen::Index n = terms.rows();
  for (Eigen::Index i = 0; i < n; ++i) {
    const Row row = row_of(parent, child, posture.frames[at(i)], terms.row(i));
    Cycle& cycle = out[at(i * count / n)];
    cycle.xx.noalias() += row.leftCols<6>().transpose() * row.leftCols<6>() / alike;
    cycle.xz.noalias() += row.leftCols<6>().transpose() * row.middleCols(6, kSlide) / alike;
  }
  return out;
}

/// Covariance of the joint by slides of one metre that the movements, drawn anew, would not share: the
/// sandwich over clusters, its residuals those of the slide about the joint that absorbs it, each as large as
/// one of a movement that the joint was not fitted to (CR2: Bell & McCaffrey 2002, Survey Methodology
/// 28:169). Averaged over all slides.
Matrix6 between_cycles(const std::vector<Cycle>& cycles, const Matrix6& solve) {
  const Eigen::SelfAdjointEigenSolver<Matrix6> eigen(solve);
  // What the motion leaves open, as the place along a hinge, has no eigenvalue but rounding.
  const Matrix6 root = eigen.eigenvectors() * eigen.eigenvalues().cwiseMax(0.0).cwiseSqrt().asDiagonal() *
                       eigen.eigenvectors().transpose();
  Eigen::MatrixXd all = Eigen::MatrixXd::Zero(6, kSlide);
  for (const Cycle& cycle : cycles) all += cycle.xz;
  const Eigen::MatrixXd absorbed = solve * all;
  Matrix6 out = Matrix6::Zero();
  for (const Cycle& cycle : cycles) {
    const Eigen::SelfAdjointEigenSolver<Matrix6> leverage(root * cycle.xx * root);
    const Vector6 left =
        (1.0 - leverage.eigenvalues().array()).cwiseMax(kLeastLeft).pow(-kLeveragePower).matrix();
    const Matrix6 wider = leverage.eigenvectors() * left.asDiagonal() * leverage.eigenvectors().transpose();
    const Eigen::MatrixXd by = root * wider * root * (cycle.xz - cycle.xx * absorbed);
    out += by * by.transpose();
  }
  return out;
}

}  // namespace

SkinSlide measure_skin_slide(const SegmentPoses& parent, const SegmentPoses& child,
                             const RelativeMotion& motion, const Matrix6& solve, const Vector6& centre,
                             data::JointKind kind, const SkinPrior& prior) {
  SkinSlide out;
  if (static_cast<std::int64_t>(motion.frames.size()) < kLeastSlideFrames) return out;
  const Posture posture = internal::posture_of(parent, child, motion);
  const Eigen::MatrixXd terms = terms_of(posture);
  const auto n = terms.rows();
  constexpr int kAll = 6 + kSlide + 1;
  SlideProblem problem{.normal = Eigen::MatrixXd::Zero(kAll, kAll)};
  double gap = 0.0;
  for (Eigen::Index i = 0; i < n; ++i) {
    Row row = row_of(parent, child, posture.frames[at(i)], terms.row(i));
    // About the joint: sums of what is small beside the positions lose no digits.
    row.col(kAll - 1) -= row.leftCols<6>() * centre;
    problem.normal.noalias() += row.transpose() * row;
    gap += row.col(kAll - 1).squaredNorm();
  }
  gap = std::sqrt(gap / (3.0 * static_cast<double>(n)));
  if (!(gap > kRounding_m)) return out;
  // Noise about joint and slide together, both fitted.
  Eigen::MatrixXd both = problem.normal.topLeftCorner(kAll - 1, kAll - 1);
  both.diagonal().array() += 1e-9 * both.trace() / (kAll - 1);
  const Eigen::VectorXd fitted = both.ldlt().solve(problem.normal.topRightCorner(kAll - 1, 1));
  Eigen::MatrixX3d residual(n, 3);
  for (Eigen::Index i = 0; i < n; ++i) {
    const Row row = row_of(parent, child, posture.frames[at(i)], terms.row(i));
    residual.row(i) =
        (row.col(kAll - 1) - row.leftCols<6>() * centre - row.leftCols(kAll - 1) * fitted).transpose();
  }
  const double freedom = std::max(3.0 * static_cast<double>(n) - 6.0 - 0.5 * kSlide, 1.0);
  const double variance = std::max(residual.squaredNorm() / freedom, kRounding_m * kRounding_m);
  out.known = true;
  out.frames_alike = frames_alike(residual);
  out.noise_sd_m = std::sqrt(variance);
  problem.variance = variance;
  // Frames that are alike count as one: all sums shrink, and with them the weight of what the solution gets.
  problem.normal /= out.frames_alike;
  const Matrix6 per_frame =
      solve * (out.frames_alike * static_cast<double>(motion.frames.size()) / static_cast<double>(n));
  const double median = kind == data::JointKind::hinge ? prior.slide_m : kPriorMedian * gap;
  const Amplitudes amplitude = infer_amplitude(problem, median);
  const Matrix6 between =
      between_cycles(cycles_of(parent, child, posture, terms, out.frames_alike), per_frame);
  double squares = 0.0;
  for (std::size_t i = 0; i < amplitude.value.size(); ++i) {
    squares += amplitude.weight[i] * amplitude.value[i] * amplitude.value[i];
    out.covariance += amplitude.weight[i] * problem.covariance(per_frame, amplitude.value[i]);
    out.repeatability += amplitude.weight[i] * (problem.covariance(per_frame, 0.0) +
                                                amplitude.value[i] * amplitude.value[i] * between);
  }
  out.share = 1.0 - amplitude.weight[0];
  out.amplitude_m = std::sqrt(squares);
  return out;
}

}  // namespace kinemark::skeleton
