// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/motion/smoother/internal/step_modes.h"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <algorithm>

#include "kinemark/core/index.h"
#include "kinemark/stages/motion/smoother/coordinate_smoother.h"
#include "kinemark/stages/motion/smoother/internal/frame_rows.h"

namespace kinemark::motion::internal {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr double kLeastInformation = 1e-13;  // of a frame, over that of the prior about one step
constexpr double kMostBeyond = 100.0;  // white noise is less than a tenth of what markers do otherwise (SD)
constexpr Index kAlike = 4;            // frames, with the same markers seen, in which noise is the same

std::vector<std::uint8_t> seen_markers(const MarkerInformation& information) {
  std::vector<std::uint8_t> out(at(information.weight.size()));
  for (std::size_t m = 0; m < out.size(); ++m)
    out[m] = information.weight[static_cast<Index>(m)] > 0.0 ||
             (!information.full.empty() && !information.full[m].isZero(0.0));
  return out;
}

}  // namespace

StepModes step_modes(const model::Model& model, const Observations& observations,
                     const std::vector<std::uint8_t>& fixed, const MatrixXd& states, const SinglePaths& paths,
                     double beyond_white) {
  StepModes out;
  out.precision = paths.step_variance.cwiseInverse().asDiagonal();
  std::vector<Index> free;
  for (Index i = 0; i < paths.step_variance.size(); ++i)
    if (!fixed[at(i)]) free.push_back(i);
  const auto n = static_cast<Index>(free.size());
  const Index F = states.cols();
  out.basis.setZero(paths.step_variance.size(), n);
  out.spread.setZero(n, F);
  // The nearest curve is known by white noise. Where nearly all is slow, as of skin, joints would get that as
  // their common motion.
  if (n == 0 || beyond_white > kMostBeyond) return out;
  const MatrixXd own = out.precision(free, free);

  FrameRows rows(model);
  MatrixXd H, mean = kLeastInformation * own;
  std::vector<std::vector<std::uint8_t>> seen(at(F));
  for (Index f = 0; f < F; ++f) {
    (void)rows.visit(observations, f, states.col(f));
    rows.matrix(H);
    mean += H(free, free) / static_cast<double>(F);
    seen[at(f)] = seen_markers(rows.information());
  }

  std::ptrdiff_t most = 0;
  for (const auto& markers : seen) most = std::max(most, std::ranges::count(markers, 1));

  // V' mean V = 1 and V' own V = diag(1 / step variance).
  const Eigen::GeneralizedSelfAdjointEigenSolver<MatrixXd> modes(own, mean);
  if (modes.info() != Eigen::Success) return out;
  const MatrixXd inverse = modes.eigenvectors().transpose() * mean;
  const MatrixXd curves = inverse * paths.value(free, Eigen::all);
  MatrixXd weight(n, F), spread;
  VectorXd doubt(n);
  Eigen::LLT<MatrixXd> llt(n);
  bool before = false;  // frame f - 1 was bridged
  for (Index f = 0; f < F; ++f) {
    doubt = paths.doubt.col(f)(free);
    const bool bridged = doubt.maxCoeff() > 0.0;
    if (f % kAlike != 0 && !bridged && !before && seen[at(f)] == seen[at(f - 1)]) {
      weight.col(f) = weight.col(f - 1);
      continue;
    }
    before = bridged;
    (void)rows.visit(observations, f, states.col(f));
    rows.matrix(H);
    mean = H(free, free) + kLeastInformation * own;
    for (Index i = 0; i < n; ++i)
      if (doubt[i] > 0.0) mean(i, i) += 1.0 / doubt[i];
    llt.compute(mean);
    weight.col(f).setZero();
    if (llt.info() != Eigen::Success) continue;  // numbers have no digits left for it: not seen
    spread = inverse.transpose();
    llt.matrixL().solveInPlace(spread);
    weight.col(f) = spread.colwise().squaredNorm().transpose().cwiseInverse();
    // Where markers come and go, what is slow on each of them jumps.
    if (std::ranges::count(seen[at(f)], 1) < most) weight.col(f) /= beyond_white;
  }
  VectorXd strength(n);
  for (Index k = 0; k < n; ++k) {
    // The basis has no digits left for modes that no marker tells of: all stays as it was.
    if (!(modes.eigenvalues()[k] > 0.0)) return out;
    const double first = 1.0 / modes.eigenvalues()[k];
    const auto nearest = nearest_curve(curves.row(k), weight.row(k), first, beyond_white);
    strength[k] = 1.0 / nearest.step_variance;
    out.spread.row(k) = nearest.spread;
  }
  out.precision(free, free) = inverse.transpose() * strength.asDiagonal() * inverse;
  out.basis(free, Eigen::all) = modes.eigenvectors();
  return out;
}

}  // namespace kinemark::motion::internal
