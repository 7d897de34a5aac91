// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/trajectory/gaps/internal/spatial_fills.h"

#include <Eigen/Eigenvalues>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "kinemark/math/rotation_fit.h"
#include "kinemark/stages/trajectory/gaps/internal/fills.h"
#include "kinemark/stages/trajectory/gaps/internal/regression.h"

namespace kinemark::trajectory::internal {
namespace {

constexpr double kThinM = 0.005;  // a shape narrower than this about a line gives no rotation

constexpr std::size_t kFrameMarkers = 6;
constexpr std::array<Index, 2> kFeatureCounts = {12, 36};  // 4 or 12 predictors
constexpr double kKeptVariance = 0.9995;
constexpr Index kMaxComponents = 24;
constexpr double kLeastReachM = 0.3;

/// Columns [first, first + width) of every block of a signal.
Signal part(const Signal& s, Index first, Index width) {
  const Index windows = s.rows.cols() / s.width;
  Signal out;
  out.width = width;
  out.rows.resize(s.rows.rows(), windows * width);
  out.near.resize(s.near.rows(), windows * width);
  for (Index w = 0; w < windows; ++w) {
    out.rows.middleCols(w * width, width) = s.rows.middleCols(w * s.width + first, width);
    out.near.middleCols(w * width, width) = s.near.middleCols(w * s.width + first, width);
  }
  out.gap = s.gap.middleCols(first, width);
  out.gap_near = s.gap_near.middleCols(first, width);
  return out;
}

Eigen::MatrixXd rows_of(const Eigen::MatrixXd& A, const GapProblem& p) {
  return A(p.rows, Eigen::indexing::all);
}

double rms3(const Eigen::MatrixXd& e) {
  return e.rows() == 0 ? 0.0 : std::sqrt(e.squaredNorm() / static_cast<double>(e.rows()));
}

/// The candidates in the frame of the most rigid predictors.
class LocalFills {
 public:
  LocalFills(const Recording& recording, const GapProblem& p, WalkCache& cache, std::vector<Fill>& fills)
      : p_(p), folds_(make_folds(p)), walks_(p, recording.rate_hz(), cache), fills_(fills) {
    std::vector<Index> shape_frames;
    for (Index w = 0; w < p.windows(); ++w) {
      shape_frames.push_back(p.start(w));
      shape_frames.push_back(p.start(w) + p.window.length / 2);
    }
    const std::size_t n = std::min(kFrameMarkers, p.predictors.size());
    const LocalFrame frame(recording, std::span(p.predictors).first(n), std::span(p.sd_m).first(n),
                           shape_frames);
    const auto predictors = static_cast<Index>(p.predictors.size());
    // One pass over the frames: R (row by row), c, target, predictors.
    const Signal all = gather(p, 15 + 3 * predictors, true, [&](Index f, auto out) {
      const LocalPose at = frame.at(f);
      for (Index i = 0; i < 3; ++i) out.segment(3 * i, 3) = at.R.row(i);
      out.segment(9, 3) = at.c.transpose();
      out.segment(12, 3) = (at.R.transpose() * (recording.x(p.span.marker, f) - at.c)).transpose();
      for (Index k = 0; k < predictors; ++k)
        out.segment(15 + 3 * k, 3) =
            (at.R.transpose() * (recording.x(p.predictors[static_cast<std::size_t>(k)], f) - at.c))
                .transpose();
    });
    rotation_ = part(all, 0, 9);
    centre_ = all.gap.middleCols(9, 3);
    y_ = part(all, 12, 3);
    y_.gap.resize(0, 3);  // unknown
    z_ = part(all, 15, 3 * predictors);
  }

  void rigid_untied() {
    const Innovation y = untie(y_);
    Eigen::MatrixXd errors = y.rows;
    for (const Fold& fold : folds_) {
      if (fold.train.empty()) continue;
      Eigen::RowVector3d mean = Eigen::RowVector3d::Zero();
      for (const Index w : fold.train) mean += y.rows.middleCols(3 * w, 3).colwise().mean();
      mean /= static_cast<double>(fold.train.size());
      for (Index w = fold.first; w < fold.end; ++w) errors.middleCols(3 * w, 3).rowwise() -= mean;
    }
    add(FillKind::rigid_untied, y.mean.replicate(p_.shape.length, 1), std::move(errors), rms3(y.gap_near),
        stretch(untie(z_)));
  }
  void regression_untied() {
    const Innovation y = untie(y_);
    const Regression r = regress(y, untie(z_), folds_, kFeatureCounts, true);
    add(FillKind::regression_untied, r.gap.rowwise() + y.mean, r.errors, rms3(r.gap_near), r.stretch);
  }
  void rigid_chord() {
    const Eigen::MatrixXd A = chord_operator(p_.shape);
    const Eigen::MatrixXd A_rows = rows_of(chord_operator(p_.window), p_);
    add(FillKind::rigid_chord, A * y_.gap_near, y_.rows - A_rows * y_.near, 0.0, stretch(tie(z_, A_rows, A)));
  }
  void regression_chord() {
    const Eigen::MatrixXd A = chord_operator(p_.shape);
    const Eigen::MatrixXd A_rows = rows_of(chord_operator(p_.window), p_);
    const Regression r = regress(tie(y_, A_rows, A), tie(z_, A_rows, A), folds_, kFeatureCounts, false);
    add(FillKind::regression_chord, A * y_.gap_near + r.gap, r.errors, 0.0, r.stretch);
  }
  /// False when no walk is possible.
  bool rigid_walk() {
    const auto walk = walks_.best(y_, 1, p_.shortened() ? 1 : 4);
    if (!walk) return false;
    add(FillKind::rigid_walk, *walk->gap * y_.gap_near, y_.rows - *walk->rows * y_.near, 0.0,
        stretch(tie(z_, *walk->rows, *walk->gap)));
    return true;
  }
  /// The best of orders `lowest` to `highest`. False when no walk is possible.
  bool regression_walk(FillKind kind, int lowest, int highest) {
    std::optional<Regression> best;
    Eigen::MatrixXd fill;
    for (int order = lowest; order <= highest; ++order) {
      const auto walk = walks_.best(y_, order, order);
      if (!walk) continue;
      Regression r = regress(tie(y_, *walk->rows, *walk->gap), tie(z_, *walk->rows, *walk->gap), folds_,
                             kFeatureCounts, false);
      if (best && r.mean_square >= best->mean_square) continue;
      fill = *walk->gap * y_.gap_near + r.gap;
      best = std::move(r);
    }
    if (!best) return false;
    add(kind, fill, best->errors, 0.0, best->stretch);
    return true;
  }

 private:
  static double stretch(const Innovation& z) { return stretch_of(z.rows, z.gap); }
  /// Into the world: both arguments are local.
  void add(FillKind kind, const Eigen::MatrixXd& gap, Eigen::MatrixXd errors, double near_rms_m = 0.0,
           double stretch = 1.0) {
    const auto rotation_of = [](const auto& row) {  // R' as it was stored, column by column
      return Eigen::Map<const Eigen::Matrix3d>(row.data());
    };
    Fill fill{.kind = kind,
              .gap = centre_,
              .errors = std::move(errors),
              .near_rms_m = near_rms_m,
              .stretch = stretch};
    for (Index i = 0; i < p_.shape.length; ++i) {
      const Eigen::Matrix<double, 1, 9> row = rotation_.gap.row(i);
      fill.gap.row(i) += gap.row(i) * rotation_of(row);
    }
    for (Index w = 0; w < p_.windows(); ++w)
      for (Index r = 0; r < p_.rows.size(); ++r) {
        const Eigen::Matrix<double, 1, 9> row = rotation_.rows.block<1, 9>(r, 9 * w);
        const Eigen::RowVector3d local = fill.errors.block<1, 3>(r, 3 * w);
        fill.errors.block<1, 3>(r, 3 * w) = local * rotation_of(row);
      }
    fills_.push_back(std::move(fill));
  }

  const GapProblem& p_;
  std::vector<Fold> folds_;
  WalkChooser walks_;
  std::vector<Fill>& fills_;
  Signal rotation_, y_, z_;
  Eigen::MatrixXd centre_;  // L x 3
};

/// Weights that favour near markers: exp(-(d / s)^2 / 2), s twice the distance to the third nearest.
Eigen::VectorXd nearness(const Recording& recording, const GapProblem& p, const std::vector<Index>& markers) {
  const auto n = static_cast<Index>(markers.size());
  Eigen::VectorXd d = Eigen::VectorXd::Zero(n);
  for (Index k = 0; k < n; ++k)
    for (Index w = 0; w < p.windows(); ++w)
      d(k) += (recording.x(p.span.marker, p.start(w)) -
               recording.x(markers[static_cast<std::size_t>(k)], p.start(w)))
                  .norm() /
              static_cast<double>(p.windows());
  Eigen::VectorXd sorted = d;
  std::ranges::sort(sorted);
  const double reach = std::max(2.0 * sorted(std::min<Index>(2, n - 1)), kLeastReachM);
  return (-0.5 * (d / reach).array().square()).exp();
}

/// Regression on the scores of the principal components of all markers that are complete wherever it matters,
/// about their weighted centre. The idea is that of Gloersen & Federolf (2016), PLoS ONE 11(3):e0152616.
void pca_fills(const Recording& recording, const GapProblem& p, bool untied, bool tied,
               std::vector<Fill>& fills) {
  std::vector<Index> markers;
  for (const Index k : p.candidates)
    if (std::ranges::all_of(p.starts, [&](Index s) {
          return recording.complete(k, s - p.window.left, s + p.window.length + p.window.right);
        }))
      markers.push_back(k);
  if (markers.size() < 3) return;
  const auto n = static_cast<Index>(markers.size());
  const Eigen::VectorXd weight = nearness(recording, p, markers);
  const Eigen::VectorXd share = weight / weight.sum();
  const Signal all = gather(p, 6 + 3 * n, true, [&](Index f, auto out) {
    Eigen::RowVector3d centre = Eigen::RowVector3d::Zero();
    for (Index k = 0; k < n; ++k)
      centre += share(k) * recording.x(markers[static_cast<std::size_t>(k)], f).transpose();
    out.segment(0, 3) = recording.x(p.span.marker, f).transpose() - centre;
    out.segment(3, 3) = centre;
    for (Index k = 0; k < n; ++k)
      out.segment(6 + 3 * k, 3) =
          weight(k) * (recording.x(markers[static_cast<std::size_t>(k)], f).transpose() - centre);
  });
  Signal y = part(all, 0, 3);
  y.gap.resize(0, 3);
  const Eigen::MatrixXd centre = all.gap.middleCols(3, 3);
  Signal z = part(all, 6, 3 * n);
  // Components of windows and gap together, so that the gap's own postures are in their span.
  std::vector<Eigen::RowVectorXd> postures;
  for (Index w = 0; w < p.windows(); ++w)
    for (Index r = 0; r < p.rows.size(); r += 2) postures.emplace_back(z.rows.block(r, w * 3 * n, 1, 3 * n));
  const Index step = 1 + p.shape.length / 24;
  for (Index i = 0; i < p.shape.length; i += step) postures.emplace_back(z.gap.row(i));
  Eigen::MatrixXd F(static_cast<Index>(postures.size()), 3 * n);
  for (Index i = 0; i < F.rows(); ++i) F.row(i) = postures[static_cast<std::size_t>(i)];
  F.rowwise() -= Eigen::RowVectorXd(F.colwise().mean());
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(F.transpose() * F);
  const double total = std::max(eigen.eigenvalues().sum(), 1e-300);
  Index kept = 0;
  for (double sum = 0.0; kept < std::min(kMaxComponents, 3 * n) && sum < kKeptVariance * total; ++kept)
    sum += eigen.eigenvalues()(3 * n - 1 - kept);
  kept = std::max<Index>(kept, 1);
  const Eigen::MatrixXd V = eigen.eigenvectors().rightCols(kept).rowwise().reverse();
  const auto project = [&](const Eigen::MatrixXd& blocks) {
    const Index count = blocks.cols() / (3 * n);
    Eigen::MatrixXd out(blocks.rows(), count * kept);
    for (Index w = 0; w < count; ++w)
      out.middleCols(w * kept, kept).noalias() = blocks.middleCols(w * 3 * n, 3 * n) * V;
    return out;
  };
  const Signal scores{kept, project(z.rows), project(z.near), z.gap * V, z.gap_near * V};
  const std::vector<Fold> folds = make_folds(p);
  const std::array widths = {kept};
  if (untied) {
    const Innovation v = untie(y);
    const Regression r = regress(v, untie(scores), folds, widths, true);
    fills.push_back({.kind = FillKind::pca_untied,
                     .gap = centre + (r.gap.rowwise() + v.mean),
                     .errors = r.errors,
                     .near_rms_m = rms3(r.gap_near),
                     .stretch = r.stretch});
  }
  if (tied) {
    const Eigen::MatrixXd A = chord_operator(p.shape);
    const Eigen::MatrixXd A_rows = rows_of(chord_operator(p.window), p);
    const Regression r = regress(tie(y, A_rows, A), tie(scores, A_rows, A), folds, widths, false);
    fills.push_back({.kind = FillKind::pca_chord,
                     .gap = centre + A * y.gap_near + r.gap,
                     .errors = r.errors,
                     .stretch = r.stretch});
  }
}

}  // namespace

LocalFrame::LocalFrame(const Recording& recording, std::span<const Index> markers,
                       std::span<const double> sd_m, std::span<const Index> shape_frames)
    : recording_(&recording), markers_(markers.begin(), markers.end()) {
  const auto n = static_cast<Index>(markers_.size());
  weight_.setConstant(n, 1.0);
  if (n < 3 || shape_frames.empty()) {
    if (n > 0) weight_ /= static_cast<double>(n);
    return;
  }
  for (Index k = 0; k < n; ++k) {
    const double sd = sd_m[static_cast<std::size_t>(k)];
    weight_(k) = 1.0 / (sd * sd + 1e-6);
  }
  weight_ /= weight_.sum();
  const auto place_shape = [&](Index frame) {
    const Eigen::Vector3d c = centre(frame);
    for (Index k = 0; k < n; ++k)
      shape_.col(k) = recording_->x(markers_[static_cast<std::size_t>(k)], frame) - c;
  };
  shape_.resize(3, n);
  place_shape(shape_frames[shape_frames.size() / 2]);
  has_rotation_ = true;
  for (int round = 0; round < 3; ++round) {
    Eigen::Matrix3Xd sum = Eigen::Matrix3Xd::Zero(3, n);
    for (const Index frame : shape_frames) {
      const LocalPose p = at(frame);
      for (Index k = 0; k < n; ++k)
        sum.col(k) += p.R.transpose() * (recording_->x(markers_[static_cast<std::size_t>(k)], frame) - p.c);
    }
    shape_ = sum / static_cast<double>(shape_frames.size());
    shape_.colwise() -= Eigen::Vector3d(shape_ * weight_);
  }
  const Eigen::Matrix3d spread = shape_ * weight_.asDiagonal() * shape_.transpose();
  has_rotation_ =
      Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(spread, Eigen::EigenvaluesOnly).eigenvalues()(1) >
      kThinM * kThinM;
}

Eigen::Vector3d LocalFrame::centre(Index frame) const {
  Eigen::Vector3d c = Eigen::Vector3d::Zero();
  for (std::size_t k = 0; k < markers_.size(); ++k)
    c += weight_(static_cast<Index>(k)) * recording_->x(markers_[k], frame);
  return c;
}

LocalPose LocalFrame::at(Index frame) const {
  LocalPose p;
  p.c = centre(frame);
  if (!has_rotation_) return p;
  Eigen::Matrix3d S = Eigen::Matrix3d::Zero();
  for (std::size_t k = 0; k < markers_.size(); ++k) {
    const auto i = static_cast<Index>(k);
    S += weight_(i) * (recording_->x(markers_[k], frame) - p.c) * shape_.col(i).transpose();
  }
  p.R = math::fit_rotation(S).rotation;
  return p;
}

void spatial_fills(const Recording& recording, const GapProblem& problem, GapMethod method, WalkCache& cache,
                   std::vector<Fill>& fills) {
  const bool all = method == GapMethod::automatic;
  const bool ends = problem.shape.near() > 0;
  if (all || method == GapMethod::pca) {
    pca_fills(recording, problem, all || !ends, ends, fills);
    if (!all) return;
  }
  LocalFills local(recording, problem, cache, fills);
  const bool shape = problem.predictors.size() >= 3;
  if (all || method == GapMethod::rigid) {
    if (shape && (all || !ends)) local.rigid_untied();
    if (ends && (!local.rigid_walk() || all)) local.rigid_chord();
  }
  if (all || method == GapMethod::regression) {
    if (all || !ends) local.regression_untied();
    const int highest = problem.shortened() ? 1 : 2;
    if (ends && (!local.regression_walk(FillKind::regression_walk, 1, highest) || all))
      local.regression_chord();
    if (all && ends && !problem.shortened()) local.regression_walk(FillKind::regression_stiff, 3, 4);
  }
}

}  // namespace kinemark::trajectory::internal
