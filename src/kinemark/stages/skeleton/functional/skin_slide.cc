// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/skeleton/functional/skin_slide.h"

#include <fmt/core.h>
#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <Eigen/LU>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>
#include <vector>

#include "kinemark/core/index.h"
#include "kinemark/data/joint_choice.h"
#include "kinemark/stages/skeleton/functional/internal/gap_model.h"
#include "kinemark/stages/skeleton/functional/skin_evidence.h"

namespace kinemark::skeleton {
namespace {

using Eigen::Matrix3d;
using Eigen::MatrixXd;
using internal::Cluster;
using internal::GapModel;
using internal::kGapSize;
using internal::OwnSlide;

constexpr std::int64_t kLeastSlideFrames = 40;
/// Gaps and noise of no more than this are rounding: no marker is known so well.
constexpr double kRounding_m = 1e-7;
/// Sizes of the common slide and turn, m per rad.
constexpr int kSizes = 8;
constexpr std::array<double, kSizes> kCommon_m = {0.0, 0.5e-3, 1.5e-3, 3.5e-3, 7e-3, 12e-3, 20e-3, 35e-3};
constexpr double kAnywhereTo_m = 20e-3;  ///< published slides lie below it
constexpr double kLogFloor_m = 0.1e-3;   ///< what is smaller counts as so much where logarithms are compared
constexpr double kRatioFloor_m = 0.2e-3, kLeastRatio = 0.15;
constexpr double kLeastNoise = 0.7;  ///< of the noise's variance over that of the shape
constexpr double kSlide_m = 0.03;    ///< wide prior of coefficients, for the first residual alone
constexpr double kLeveragePower = 0.5, kLeastLeft = 0.05;
constexpr std::int64_t kLeastParts = 3, kMostParts = 12;
constexpr double kLeastMotion_rad = 0.035;  ///< SD of a posture that could tell anything

/// A segment's own slide, and what it and a common slide of unit size do to the joint's place.
struct Side {
  const Cluster& cluster;
  OwnSlide slide;
  Matrix3d own, turn;     ///< of the joint's place by a slide of one metre per rad, m^2
  double softness = 1.0;  ///< of this segment over the softer one

  Side(const Cluster& of, OwnSlide slide_, const Eigen::Vector3d& joint) : cluster(of), slide(slide_) {
    const Eigen::Vector3d l = joint - of.mean;
    Matrix3d lever;
    lever << 0.0, -l.z(), l.y(), l.z(), 0.0, -l.x(), -l.y(), l.x(), 0.0;
    own = Matrix3d::Identity() / static_cast<double>(of.columns.size()) +
          lever * of.inverse_inertia * lever.transpose();
    turn = lever * lever.transpose() / (of.radius_m * of.radius_m);
  }
  /// Covariance of a linear coefficient of the joint's place, per rad.
  [[nodiscard]] Matrix3d linear(double common_m, double turn_m) const {
    return slide.size_m * slide.size_m * own +
           softness * softness * (common_m * common_m * Matrix3d::Identity() + turn_m * turn_m * turn) +
           1e-10 * Matrix3d::Identity();
  }
};

void set_softness(Side& a, Side& b) {
  const double ratio = (a.slide.size_m + kRatioFloor_m) / (b.slide.size_m + kRatioFloor_m);
  a.softness = std::clamp(ratio, kLeastRatio, 1.0);
  b.softness = std::clamp(1.0 / ratio, kLeastRatio, 1.0);
}

/// Log prior of each size of a common slide: log-normal about the own slide, which is known with its weights.
std::array<double, kSizes> common_prior(const OwnSlide& own, double ratio, double factor, double anywhere) {
  const auto logarithm = [](double m) { return std::log(std::max(m, kLogFloor_m)); };
  const auto near = std::ranges::count_if(kCommon_m, [](double m) { return m < 1.05 * kAnywhereTo_m; });
  std::array<double, kSizes> out{};
  for (int b = 0; b < internal::kSlideSizes; ++b) {
    const double about = logarithm(internal::slide_sizes()[at(b)]) + (b > 0 ? std::log(ratio) : 0.0);
    std::array<double, kSizes> density{};
    double sum = 0.0;
    for (std::size_t i = 0; i < kSizes; ++i)
      sum += density[i] = std::exp(-0.5 * std::pow((logarithm(kCommon_m[i]) - about) / std::log(factor), 2));
    for (std::size_t i = 0; i < kSizes; ++i)
      out[i] += own.weight[at(b)] *
                ((1.0 - anywhere) * density[i] / sum +
                 (kCommon_m[i] < 1.05 * kAnywhereTo_m ? anywhere / static_cast<double>(near) : 0.0));
  }
  for (double& p : out) p = std::log(p);
  return out;
}

MatrixXd root_of(const Matrix3d& C) { return C.llt().matrixL(); }

/// Root of the prior covariance of all coefficients of the gap, joint first.
MatrixXd prior_root(const Side& a, const Side& b, const Matrix3d& mean, double common_m, double turn_m) {
  MatrixXd out = MatrixXd::Zero(kGapSize, kGapSize);
  out.topLeftCorner<6, 6>().diagonal().setConstant(data::kJointPriorSd_m);
  const Matrix3d above = a.linear(common_m, turn_m), below = b.linear(common_m, turn_m);
  const Matrix3d below_in_parent = mean * below * mean.transpose();
  const auto fill = [&](int from, int count, const MatrixXd& root) {
    for (int k = from; k < from + count; ++k) out.block<3, 3>(6 + 3 * k, 6 + 3 * k) = root;
  };
  using namespace internal;
  fill(0, kLinearTerms, root_of(above));
  const auto both = [&](double of_a, double of_b) {
    return root_of(of_a * of_a * above + of_b * of_b * below_in_parent);
  };
  fill(kLinearTerms, kQuadraticTerms, both(a.slide.quadratic, b.slide.quadratic));
  fill(kLinearTerms + kQuadraticTerms, kLagTerms, both(a.slide.lag, b.slide.lag));
  fill(kPostureTerms, kLinearTerms, root_of(below));
  return out;
}

/// The grid's result: means and covariances of the joint, weighted by their evidence.
struct Posterior {
  Vector6 mean = Vector6::Zero();
  Matrix6 covariance = Matrix6::Zero(), before = Matrix6::Zero();
  double common2 = 0.0, turn2 = 0.0;
  MatrixXd slides;  ///< root of the slides' prior covariance at the sizes found
};

class SlideFit {
 public:
  SlideFit(const GapModel& model, Side a, Side b, const Matrix3d& mean, const SkinPrior& prior, bool hinge)
      : model_(model), a_(std::move(a)), b_(std::move(b)), mean_(mean) {
    set_softness(a_, b_);
    const double ratio = hinge ? prior.hinge : prior.ball;
    prior_ = common_prior(a_.slide.size_m > b_.slide.size_m ? a_.slide : b_.slide, ratio,
                          hinge ? prior.hinge_factor : prior.ball_factor, prior.anywhere);
    const Matrix3d frame =
        a_.slide.noise_variance * a_.own + mean * (b_.slide.noise_variance * b_.own) * mean.transpose();
    const double residual = find_noise(frame);
    // Real slides are no polynomials. A misfit in proportion to the slides that are tried would drive these
    // to nothing, so it is that of the expected ones.
    const auto expected = [&](const Side& side) {
      const double m = side.slide.size_m;
      return Matrix3d(m * m * (side.own + ratio * ratio * (Matrix3d::Identity() + side.turn)));
    };
    noise_ = frame * (residual * alike_ / static_cast<double>(model.posture.block));
    all_ = noise_ + 2.0 * prior.misfit * prior.misfit * model.posture.smooth.squaredNorm() /
                        static_cast<double>(model.posture.smooth.rows()) *
                        (expected(a_) + mean * expected(b_) * mean.transpose());
    const auto rows = model.blocks.rows();
    const Eigen::LLT<Matrix3d> llt(all_);
    MatrixXd design = model.blocks;
    Eigen::VectorXd gap = model.block_gap;
    for (Eigen::Index r = 0; r < rows; r += 3) {
      design.middleRows<3>(r) = llt.matrixL().solve(design.middleRows<3>(r).eval()).eval();
      gap.segment<3>(r) = llt.matrixL().solve(gap.segment<3>(r).eval()).eval();
    }
    normal_ = design.transpose() * design;
    right_ = design.transpose() * gap;
    const auto X = model.blocks.leftCols<6>();
    Matrix6 plain = X.transpose() * X;
    const Eigen::Index blocks = rows / 3;
    plain.diagonal().array() +=
        1e-4 * static_cast<double>(blocks) / (data::kJointPriorSd_m * data::kJointPriorSd_m);
    solve_ = plain.inverse();
    carried_ = solve_ * X.transpose() * model.blocks.rightCols(kGapSize - 6);
  }

  [[nodiscard]] double alike() const { return alike_; }
  [[nodiscard]] const Side& parent() const { return a_; }
  [[nodiscard]] const Side& child() const { return b_; }

  /// Covariance of least squares by an error of each block.
  [[nodiscard]] Matrix6 by_noise(const Matrix3d& of_block) const {
    Matrix6 sum = Matrix6::Zero();
    for (Eigen::Index r = 0; r < model_.blocks.rows(); r += 3) {
      const Eigen::Matrix<double, 3, 6> X = model_.blocks.block<3, 6>(r, 0);
      sum += X.transpose() * of_block * X;
    }
    return solve_ * sum * solve_;
  }
  [[nodiscard]] Matrix6 by_noise() const { return by_noise(noise_); }

  [[nodiscard]] Posterior integrate() const {
    struct Point {
      double log_weight;
      Vector6 mean;
      Matrix6 covariance, before;
      std::size_t i, j;
    };
    std::vector<Point> points;
    const Matrix6 by_blocks = by_noise(all_);
    for (std::size_t i = 0; i < kSizes; ++i)
      for (std::size_t j = 0; j < kSizes; ++j) {
        const MatrixXd root = prior_root(a_, b_, mean_, kCommon_m[i], kCommon_m[j]);
        MatrixXd inner = root.transpose() * normal_ * root;
        inner.diagonal().array() += 1.0;
        const Eigen::LLT<MatrixXd> llt(inner);
        const Eigen::VectorXd u = llt.matrixL().solve(root.transpose() * right_);
        const MatrixXd joint = llt.matrixL().solve(MatrixXd(root.transpose()).leftCols(6));
        const MatrixXd K = carried_ * root.bottomRightCorner(kGapSize - 6, kGapSize - 6);
        points.push_back({.log_weight = 0.5 * u.squaredNorm() -
                                        llt.matrixLLT().diagonal().array().log().sum() + prior_[i] +
                                        prior_[j],
                          .mean = joint.transpose() * u,
                          .covariance = joint.transpose() * joint,
                          .before = K * K.transpose() + by_blocks,
                          .i = i,
                          .j = j});
      }
    const double best = std::ranges::max_element(points, {}, &Point::log_weight)->log_weight;
    double sum = 0.0;
    for (Point& p : points) sum += p.log_weight = std::exp(p.log_weight - best);
    Posterior out;
    for (Point& p : points) {
      p.log_weight /= sum;
      out.mean += p.log_weight * p.mean;
      out.before += p.log_weight * p.before;
      out.common2 += p.log_weight * kCommon_m[p.i] * kCommon_m[p.i];
      out.turn2 += p.log_weight * kCommon_m[p.j] * kCommon_m[p.j];
    }
    for (const Point& p : points) {
      const Vector6 d = p.mean - out.mean;
      out.covariance += p.log_weight * (p.covariance + d * d.transpose());
    }
    out.slides = prior_root(a_, b_, mean_, std::sqrt(out.common2), std::sqrt(out.turn2))
                     .bottomRightCorner(kGapSize - 6, kGapSize - 6);
    return out;
  }

  /// Covariance of the joint by slides that the movements, drawn anew, would not share: the sandwich over
  /// clusters, its residuals those of the slide about the joint that absorbs it, each as large as one of a
  /// movement that the joint was not fitted to (CR2: Bell & McCaffrey 2002, Survey Methodology 28:169).
  [[nodiscard]] Matrix6 between_movements(const MatrixXd& slides, std::int64_t parts) const {
    const Eigen::SelfAdjointEigenSolver<Matrix6> eigen(solve_);
    const Matrix6 root = eigen.eigenvectors() * eigen.eigenvalues().cwiseMax(0.0).cwiseSqrt().asDiagonal() *
                         eigen.eigenvectors().transpose();
    const auto blocks = model_.blocks.rows() / 3;
    Matrix6 out = Matrix6::Zero();
    for (std::int64_t part = 0; part < parts; ++part) {
      const auto from = part * blocks / parts, to = (part + 1) * blocks / parts;
      const auto rows = model_.blocks.middleRows(3 * from, 3 * (to - from));
      const Matrix6 xx = rows.leftCols<6>().transpose() * rows.leftCols<6>();
      const MatrixXd xz = rows.leftCols<6>().transpose() * rows.rightCols(kGapSize - 6);
      const Eigen::SelfAdjointEigenSolver<Matrix6> leverage(root * xx * root);
      const Vector6 left =
          (1.0 - leverage.eigenvalues().array()).cwiseMax(kLeastLeft).pow(-kLeveragePower).matrix();
      const Matrix6 wider = leverage.eigenvectors() * left.asDiagonal() * leverage.eigenvectors().transpose();
      const MatrixXd by = root * wider * root * (xz - xx * carried_) * slides;
      out += by * by.transpose();
    }
    return out;
  }

 private:
  /// Variance of the gap that joint and slides leave over what the shapes' noise would make of it, and how
  /// many frames of it count as one.
  double find_noise(const Matrix3d& frame) {
    const Matrix3d inverse = frame.inverse();
    const Eigen::LLT<Matrix3d> root(inverse);
    MatrixXd design = model_.blocks;
    Eigen::VectorXd gap = model_.block_gap;
    const double weight = std::sqrt(static_cast<double>(model_.posture.block));
    for (Eigen::Index r = 0; r < design.rows(); r += 3) {
      design.middleRows<3>(r) = weight * (root.matrixU() * design.middleRows<3>(r)).eval();
      gap.segment<3>(r) = weight * (root.matrixU() * gap.segment<3>(r)).eval();
    }
    MatrixXd H = design.transpose() * design;
    H.diagonal().head<6>().array() += 1.0 / (data::kJointPriorSd_m * data::kJointPriorSd_m);
    H.diagonal().tail(kGapSize - 6).array() += 1.0 / (kSlide_m * kSlide_m);
    const Eigen::VectorXd x = H.llt().solve(design.transpose() * gap);
    const MatrixXd left = model_.residual(x);
    alike_ = internal::frames_alike(left, model_.posture.smooth);
    const double squares = (left * inverse).cwiseProduct(left).sum();
    return std::max(squares / (3.0 * static_cast<double>(left.rows())), kLeastNoise);
  }

  const GapModel& model_;
  Side a_, b_;
  Matrix3d mean_;
  std::array<double, kSizes> prior_{};
  double alike_ = 1.0;
  Matrix3d noise_, all_;  ///< of a block: noise, and noise with misfit, m^2
  MatrixXd normal_;
  Eigen::VectorXd right_;
  Matrix6 solve_;
  MatrixXd carried_;  ///< the joint's change by each slide coefficient
};

/// Takes out what lies along a hinge's axis: nothing is known of it, and it is no part of the place.
Matrix6 across(const JointFit& score) {
  Matrix6 out = Matrix6::Identity();
  if (score.kind != data::JointKind::hinge) return out;
  out.topLeftCorner<3, 3>() -= score.axis_in_parent * score.axis_in_parent.transpose();
  out.bottomRightCorner<3, 3>() -= score.axis_in_child * score.axis_in_child.transpose();
  return out;
}

}  // namespace

Status SkinPrior::check() const {
  for (const double value : {ball, hinge, misfit})
    if (!(value > 0.0) || !std::isfinite(value))
      return fail(Code::usage,
                  fmt::format("skin that slides as one body by {} (ball) and {} (hinge) times its "
                              "own slide, with a misfit of {}; need more than 0",
                              ball, hinge, misfit));
  for (const double factor : {ball_factor, hinge_factor})
    if (!(factor > 1.0) || !std::isfinite(factor))
      return fail(Code::usage, fmt::format("skin that differs by a factor of {}; need more than 1", factor));
  if (!(anywhere > 0.0 && anywhere < 1.0))
    return fail(Code::usage, fmt::format("a probability of {}; need one between 0 and 1", anywhere));
  return {};
}

SkinSlide measure_skin_slide(const Samples& samples, const SegmentPoses& parent, const SegmentPoses& child,
                             const RelativeMotion& motion, const JointFit& score, const SkinPrior& prior) {
  SkinSlide out;
  if (!(score.residual_rms_m > kRounding_m)) return out;
  const auto clusters = internal::find_clusters(samples, parent, child, motion);
  if (static_cast<std::int64_t>(clusters.frames.size()) < kLeastSlideFrames) return out;
  const auto posture =
      internal::posture_of(parent, child, motion, clusters.frames, samples.trajectories.time.rate_hz);
  if (static_cast<std::int64_t>(posture.frames.size()) < kLeastSlideFrames ||
      !(posture.sd_rad(0) > kLeastMotion_rad))
    return out;
  const GapModel model = internal::gap_model(parent, child, motion, posture);
  const auto side = [&](const SegmentPoses& poses, const Cluster& cluster, const Eigen::Vector3d& joint) {
    return Side(cluster,
                internal::find_own_slide(internal::deformation(samples, poses, cluster, posture.frames),
                                         posture, cluster.freedom()),
                joint);
  };
  const bool hinge = score.kind == data::JointKind::hinge;
  const SlideFit fit(model, side(parent, clusters.parent, model.about.head<3>()),
                     side(child, clusters.child, model.about.tail<3>()), motion.mean, prior, hinge);
  const Posterior found = fit.integrate();
  const Matrix6 keep = across(score);
  const auto within = [&](const Matrix6& C) { return Matrix6(keep * C * keep.transpose()); };
  out.known = true;
  out.own_parent_m = fit.parent().slide.size_m;
  out.own_child_m = fit.child().slide.size_m;
  out.own_limit_m = std::max(fit.parent().slide.limit_m, fit.child().slide.limit_m);
  out.none = fit.parent().slide.weight[0] * fit.child().slide.weight[0];
  out.common_m = std::sqrt(found.common2);
  out.turn_m = std::sqrt(found.turn2);
  out.frames_alike = fit.alike();
  out.shift = keep * (model.about + found.mean - score.centre);
  out.covariance = within(found.covariance);
  out.noise = within(fit.by_noise());
  const auto parts =
      std::clamp<std::int64_t>(internal::movements_of(posture).back() + 1, kLeastParts, kMostParts);
  out.repeatability = out.noise + within(fit.between_movements(found.slides, parts));
  const double before = within(found.before).topLeftCorner<3, 3>().trace(),
               after = out.covariance.topLeftCorner<3, 3>().trace(),
               by_noise = out.noise.topLeftCorner<3, 3>().trace();
  out.moves_m = std::sqrt(std::max(before - by_noise, 0.0));
  out.prior_share = before > 2.0 * by_noise ? std::clamp(after / before, 0.0, 1.0) : 0.0;
  if (hinge)
    out.axis_covariance = internal::axis_slide_covariance(
        {clusters.parent, fit.parent().slide.size_m, fit.parent().softness * out.turn_m},
        {clusters.child, fit.child().slide.size_m, fit.child().softness * out.turn_m}, motion, posture,
        score);
  return out;
}

Matrix6 positive_part(const Matrix6& C) {
  const Eigen::SelfAdjointEigenSolver<Matrix6> eigen(C);
  return eigen.eigenvectors() * eigen.eigenvalues().cwiseMax(0.0).asDiagonal() *
         eigen.eigenvectors().transpose();
}

void widen_by_skin(const Samples& samples, const SegmentPoses& parent, const SegmentPoses& child,
                   const RelativeMotion& motion, JointFit& fit, const SkinPrior& prior) {
  const SkinSlide slide = measure_skin_slide(samples, parent, child, motion, fit, prior);
  if (!slide.known) return;
  fit.covariance = slide.covariance + slide.shift * slide.shift.transpose() + fit.open;
  fit.repeatability = slide.repeatability + fit.open;
  fit.prior_share = slide.prior_share;
  fit.skin = account_of_skin(find_skin(samples, parent, child, motion, fit), slide);
  if (fit.kind != data::JointKind::hinge) return;
  fit.axis_covariance = slide.axis_covariance;
  fit.axis_sd_rad = std::sqrt(Eigen::SelfAdjointEigenSolver<Matrix3d>(fit.axis_covariance).eigenvalues()(2));
}

}  // namespace kinemark::skeleton
