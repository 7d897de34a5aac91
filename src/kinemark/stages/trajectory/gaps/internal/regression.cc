// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/trajectory/gaps/internal/regression.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace kinemark::trajectory::internal {
namespace {

constexpr Index kFolds = 8;
constexpr Index kOverlapMargin = 2;  // frames
constexpr std::array kPenalties = {1e-6, 1e-5, 1e-4, 1e-3, 1e-2, 1e-1};
constexpr double kLeastPower = 1e-18;    // m^2: all features constant
constexpr double kLeastPenalty = 1e-15;  // m^2

/// Sums over some windows, sufficient for all later steps.
struct Sums {
  Eigen::MatrixXd zz;  // P x P
  Eigen::MatrixXd zy;  // P x 3
  double yy = 0.0;
  Sums& operator+=(const Sums& other) {
    zz += other.zz;
    zy += other.zy;
    yy += other.yy;
    return *this;
  }
};

/// Cholesky factor of the normal matrix of the first p features.
Eigen::LLT<Eigen::MatrixXd> factor_ridge(const Sums& s, Index p, double penalty) {
  Eigen::MatrixXd G = s.zz.topLeftCorner(p, p);
  const double power = std::max(G.trace() / static_cast<double>(p), kLeastPower);
  G.diagonal().array() += penalty * power + kLeastPenalty;
  return G.llt();
}

Eigen::MatrixXd solve_ridge(const Sums& s, Index p, double penalty) {
  return factor_ridge(s, p, penalty).solve(s.zy.topRows(p));
}

/// Sum over the rows of z' G^-1 z: how far they lie outside of what the coefficients were learnt from.
double sum_leverage(const Eigen::LLT<Eigen::MatrixXd>& G, const Eigen::MatrixXd& Z) {
  return G.matrixL().solve(Z.transpose()).squaredNorm();
}

/// Squared error of coefficients on the windows of the sums.
double squared_error(const Sums& s, const Eigen::MatrixXd& B) {
  const Index p = B.rows();
  return s.yy - 2.0 * B.cwiseProduct(s.zy.topRows(p)).sum() +
         B.cwiseProduct(s.zz.topLeftCorner(p, p) * B).sum();
}

}  // namespace

std::vector<Fold> make_folds(const GapProblem& p) {
  const Index n = p.windows();
  const Index parts = std::min(kFolds, n);
  std::vector<Fold> folds;
  for (Index k = 0; k < parts; ++k) {
    Fold fold{.first = k * n / parts, .end = (k + 1) * n / parts, .train = {}};
    const Index from = p.start(fold.first) - kOverlapMargin;
    const Index to = p.start(fold.end - 1) + p.window.length + kOverlapMargin;
    for (Index w = 0; w < n; ++w)
      if (p.start(w) + p.window.length <= from || p.start(w) >= to) fold.train.push_back(w);
    folds.push_back(std::move(fold));
  }
  return folds;
}

Innovation tie(const Signal& s, const Eigen::MatrixXd& A_rows, const Eigen::MatrixXd& A_gap) {
  Innovation v;
  v.width = s.width;
  v.rows = s.rows;
  v.rows.noalias() -= A_rows * s.near;
  if (s.gap.rows() > 0) v.gap = s.gap - A_gap * s.gap_near;
  return v;
}

Innovation untie(const Signal& s) {
  Innovation v;
  v.width = s.width;
  const Index windows = s.rows.cols() / s.width;
  v.mean = Eigen::RowVectorXd::Zero(s.width);
  for (Index w = 0; w < windows; ++w) v.mean += s.rows.middleCols(w * s.width, s.width).colwise().mean();
  v.mean /= static_cast<double>(windows);
  v.rows = s.rows;
  for (Index w = 0; w < windows; ++w) v.rows.middleCols(w * s.width, s.width).rowwise() -= v.mean;
  if (s.gap.rows() > 0) v.gap = s.gap.rowwise() - v.mean;
  v.gap_near = s.gap_near.rowwise() - v.mean;
  return v;
}

Regression regress(const Innovation& y, const Innovation& z, const std::vector<Fold>& folds,
                   std::span<const Index> widths, bool untied) {
  const Index P = z.width;
  const Index W = y.rows.cols() / 3;
  const auto Z = [&](Index w, Index p) { return z.rows.middleCols(w * P, p); };
  const auto Y = [&](Index w) { return y.rows.middleCols(w * 3, 3); };
  std::vector<Sums> window(static_cast<std::size_t>(W));
  Sums total{Eigen::MatrixXd::Zero(P, P), Eigen::MatrixXd::Zero(P, 3)};
  for (Index w = 0; w < W; ++w) {
    Sums& s = window[static_cast<std::size_t>(w)];
    s.zz.noalias() = Z(w, P).transpose() * Z(w, P);
    s.zy.noalias() = Z(w, P).transpose() * Y(w);
    s.yy = Y(w).squaredNorm();
    total += s;
  }
  struct Split {
    Sums train, test;
  };
  std::vector<Split> splits;
  for (const Fold& fold : folds) {
    const Sums none{Eigen::MatrixXd::Zero(P, P), Eigen::MatrixXd::Zero(P, 3)};
    Split split{none, none};
    for (const Index w : fold.train) split.train += window[static_cast<std::size_t>(w)];
    for (Index w = fold.first; w < fold.end; ++w) split.test += window[static_cast<std::size_t>(w)];
    splits.push_back(std::move(split));
  }
  Index best_width = std::min(P, widths[0]);
  double best_penalty = kPenalties.back();
  double least = std::numeric_limits<double>::infinity();
  for (const Index asked : widths) {
    const Index p = std::min(P, asked);
    for (const double penalty : kPenalties) {
      double sum = 0.0;
      for (std::size_t k = 0; k < folds.size(); ++k)
        sum += folds[k].train.size() < 2
                   ? splits[k].test.yy
                   : squared_error(splits[k].test, solve_ridge(splits[k].train, p, penalty));
      if (sum < least) {
        least = sum;
        best_width = p;
        best_penalty = penalty;
      }
    }
  }
  Regression out;
  out.errors = y.rows;
  double usual = 0.0;
  double usual_rows = 0.0;
  for (std::size_t k = 0; k < folds.size(); ++k) {
    const Fold& fold = folds[k];
    if (fold.train.size() < 2) continue;
    const Eigen::LLT<Eigen::MatrixXd> G = factor_ridge(splits[k].train, best_width, best_penalty);
    const Eigen::MatrixXd B = G.solve(splits[k].train.zy.topRows(best_width));
    Eigen::RowVector3d offset = Eigen::RowVector3d::Zero();
    if (untied) {
      for (const Index w : fold.train)
        offset += Y(w).colwise().mean() - Z(w, best_width).colwise().mean() * B;
      offset /= static_cast<double>(fold.train.size());
    }
    for (Index w = fold.first; w < fold.end; ++w) {
      auto e = out.errors.middleCols(w * 3, 3);
      e.noalias() -= Z(w, best_width) * B;
      e.rowwise() -= offset;
      usual += sum_leverage(G, Z(w, best_width));
      usual_rows += static_cast<double>(e.rows());
    }
  }
  out.mean_square = out.errors.squaredNorm() / static_cast<double>(out.errors.size());
  const Eigen::LLT<Eigen::MatrixXd> G = factor_ridge(total, best_width, best_penalty);
  const Eigen::MatrixXd B = G.solve(total.zy.topRows(best_width));
  out.gap = z.gap.leftCols(best_width) * B;
  if (usual > 0.0)
    out.stretch = std::sqrt(sum_leverage(G, z.gap.leftCols(best_width)) / static_cast<double>(z.gap.rows()) /
                            (usual / usual_rows));
  if (untied) out.gap_near = y.gap_near - z.gap_near.leftCols(best_width) * B;
  return out;
}

}  // namespace kinemark::trajectory::internal
