// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/motion/foundations/internal/hypotheses.h"

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "kinemark/core/index.h"

namespace kinemark::motion::internal {
namespace {

using Eigen::Matrix3d;
using Eigen::MatrixXd;
using Eigen::Vector3d;
using Eigen::VectorXd;

constexpr double kElsewhere_m = 1.0;     // SD of a marker that may be anywhere
constexpr double kUsualShift_m = 0.060;  // 1 SD per axis of markers that were put elsewhere
constexpr double kLeastGain = 1.0;       // of a shift that is fitted in full; over the least misfit it is 8
constexpr double kLeastMisfit = 0.12;    // few markers fit better than they are placed

double log_det(const Matrix3d& m) { return std::log(std::max(1e-300, m.determinant())); }

/// Inverse covariance of all seen coordinates, everything unknown averaged over.
MatrixXd inverse_covariance(const BodyFit& fit, const SeenFrame& frame) {
  const Eigen::Index n = fit.by_pose.rows();
  VectorXd weight(n);
  for (std::size_t m = 0; m < fit.rows.size(); ++m)
    if (fit.rows[m] >= 0) {
      const double sd = frame.sd[static_cast<Eigen::Index>(m)];
      weight.segment<3>(fit.rows[m]).setConstant(1.0 / (sd * sd));
    }
  MatrixXd J(n, fit.by_pose.cols() + fit.by_shared.cols());
  J << fit.by_pose, fit.by_shared;
  const MatrixXd weighted = weight.asDiagonal() * J;
  MatrixXd out = -weighted * fit.information.llt().solve(weighted.transpose());
  out.diagonal() += weight;
  return out;
}

/// First of a marker's three numbers among the shared ones.
Eigen::Index place_of(const StandingBody& body, const SharedPrior& prior, int m) {
  return prior.mean.size() - 3 * static_cast<Eigen::Index>(body.markers.size()) + 3 * m;
}

/// A fit that markers far from their places do not draw along: each step trusts them less.
BodyFit fit_without_outliers(const StandingBody& body, const SharedPrior& prior, const SeenFrame& frame) {
  constexpr double kFar = 3.0;  // times what is usual
  SeenFrame trusted = frame;
  BodyFit fit = fit_body(body, prior, trusted);
  for (int step = 0; step < 3; ++step) {
    for (int m = 0; m < frame.x.cols(); ++m) {
      if (fit.rows[at(m)] < 0) continue;
      const Eigen::Index p = place_of(body, prior, m);
      const Vector3d own = fit.shared.segment<3>(p) - prior.mean.segment<3>(p);
      const double far = std::max(std::sqrt(own.dot(prior.information.block<3, 3>(p, p) * own)),
                                  fit.residual.col(m).norm() / trusted.sd[m]);
      const double off = own.norm() + fit.residual.col(m).norm();
      trusted.sd[m] = far > kFar ? std::max(trusted.sd[m], off * far / kFar) : frame.sd[m];
    }
    fit = fit_body(body, prior, trusted);
  }
  return fit;
}

/// Gain of exchanging two markers, each looked at by itself: what is nearer to its place after than before.
void add_near_exchanges(const StandingBody& body, const SharedPrior& prior, const SeenFrame& frame,
                        std::size_t most, std::vector<Hypothesis>& out) {
  constexpr double kPosture_m = 0.020;  // the place of a segment, per axis
  const BodyFit fit = fit_without_outliers(body, prior, frame);
  const auto markers = static_cast<int>(body.markers.size());
  std::vector<Vector3d> place(body.markers.size());
  std::vector<Matrix3d> weight(body.markers.size());
  for (int m = 0; m < markers; ++m) {
    if (fit.rows[at(m)] < 0) continue;
    const Eigen::Index p = place_of(body, prior, m);
    const Matrix3d rotation = fit.by_shared.block<3, 3>(fit.rows[at(m)], p);
    const Vector3d own = fit.shared.segment<3>(p) - prior.mean.segment<3>(p);
    place[at(m)] = frame.x.col(m) - fit.residual.col(m) - rotation * own;
    weight[at(m)] = (rotation * prior.information.block<3, 3>(p, p).inverse() * rotation.transpose() +
                     kPosture_m * kPosture_m * Matrix3d::Identity())
                        .inverse();
  }
  const auto far = [&](int m, int seen) -> double {
    const Vector3d off = frame.x.col(seen) - place[at(m)];
    return off.dot(weight[at(m)] * off);
  };
  std::vector<Hypothesis> near;
  for (int a = 0; a < markers; ++a)
    for (int b = a + 1; b < markers; ++b)
      if (fit.rows[at(a)] >= 0 && fit.rows[at(b)] >= 0)
        near.push_back({.first = a, .second = b, .gain = far(a, a) + far(b, b) - far(a, b) - far(b, a)});
  std::ranges::stable_sort(near, std::greater{}, &Hypothesis::gain);
  std::erase_if(near, [](const Hypothesis& h) { return !(h.gain > 0.0); });
  if (near.size() > most) near.resize(most);
  for (const auto& h : near)
    if (std::ranges::none_of(out, [&](const auto& o) { return o.first == h.first && o.second == h.second; }))
      out.push_back(h);
}

/// What the freedom to lie anywhere gains by itself, and what far shifts cost.
double price_of(const Vector3d& shift, const Matrix3d& covariance) {
  return log_det(Matrix3d::Identity() + kUsualShift_m * kUsualShift_m * covariance.inverse()) +
         shift.squaredNorm() / (kUsualShift_m * kUsualShift_m);
}

/// What one marker elsewhere gains over `none`, the fit of the frame as it is.
Hypothesis elsewhere(const StandingBody& body, const SharedPrior& prior, const SeenFrame& frame,
                     const BodyFit& none, int marker) {
  Hypothesis h{.first = marker};
  SeenFrame changed = frame;
  changed.sd[marker] = kElsewhere_m;
  const BodyFit fit = fit_body(body, prior, changed, &none);
  const int row = fit.rows[at(marker)];
  MatrixXd J(3, fit.by_pose.cols() + fit.by_shared.cols());
  J << fit.by_pose.middleRows<3>(row), fit.by_shared.middleRows<3>(row);
  const Matrix3d expected = J * fit.information.llt().solve(J.transpose());
  const Vector3d off = fit.residual.col(marker);
  const double sd = frame.sd[marker];
  h.misfit = std::max(kLeastMisfit, (fit.cost - off.squaredNorm() / (kElsewhere_m * kElsewhere_m)) /
                                        static_cast<double>(none.by_pose.rows() - 3));
  const Matrix3d covariance = h.misfit * (expected + sd * sd * Matrix3d::Identity());
  h.gain = (none.cost - fit.cost) / h.misfit;
  h.score = h.gain - price_of(off, covariance);
  const Matrix3d root = fit.world_from_root.transpose();
  h.shift = root * off;
  h.shift_sd = (root * covariance * root.transpose()).diagonal().cwiseSqrt();
  return h;
}

/// What exchanging two markers gains over `none`, the fit of the frame as it is.
Hypothesis exchanged(const StandingBody& body, const SharedPrior& prior, const SeenFrame& frame,
                     const BodyFit& none, int first, int second) {
  SeenFrame changed = frame;
  changed.x.col(first) = frame.x.col(second);
  changed.x.col(second) = frame.x.col(first);
  // The posture that explains the mistake may be far from the right one: a foot turned about.
  const double cost =
      std::min(fit_body(body, prior, changed, &none).cost, fit_body(body, prior, changed).cost);
  Hypothesis out{.first = first, .second = second};
  out.misfit = std::max(kLeastMisfit, cost / static_cast<double>(none.by_pose.rows()));
  out.gain = out.score = (none.cost - cost) / out.misfit;
  return out;
}

}  // namespace

std::vector<Hypothesis> explain(const StandingBody& body, const SharedPrior& prior, const SeenFrame& frame,
                                int most) {
  const BodyFit none = fit_body(body, prior, frame);
  const MatrixXd W = inverse_covariance(none, frame);
  const auto markers = static_cast<int>(body.markers.size());
  const auto z_of = [&](int m) -> Vector3d { return none.residual.col(m) / (frame.sd[m] * frame.sd[m]); };
  std::vector<Hypothesis> shifts, exchanges;
  for (int a = 0; a < markers; ++a) {
    const int i = none.rows[at(a)];
    if (i < 0) continue;
    const Matrix3d Waa = W.block<3, 3>(i, i);
    shifts.push_back({.first = a, .gain = z_of(a).dot(Waa.inverse() * z_of(a))});
    for (int b = a + 1; b < markers; ++b) {
      const int j = none.rows[at(b)];
      if (j < 0) continue;
      const Vector3d d = frame.x.col(b) - frame.x.col(a);
      const Matrix3d Wbb = W.block<3, 3>(j, j), Wab = W.block<3, 3>(i, j);
      const double change = 2.0 * d.dot(z_of(a) - z_of(b)) + d.dot((Waa + Wbb - Wab - Wab.transpose()) * d);
      exchanges.push_back({.first = a, .second = b, .gain = -change});
    }
  }
  const auto best = [&](std::vector<Hypothesis>& list, double least) {
    std::erase_if(list, [&](const Hypothesis& h) { return !(h.gain > least); });
    std::ranges::stable_sort(list, std::greater{}, &Hypothesis::gain);
    if (list.size() > static_cast<std::size_t>(most)) list.resize(static_cast<std::size_t>(most));
  };
  best(shifts, kLeastGain);
  best(exchanges, 0.0);
  add_near_exchanges(body, prior, frame, static_cast<std::size_t>(most), exchanges);
  std::vector<Hypothesis> all;
  for (const auto& h : shifts) all.push_back(elsewhere(body, prior, frame, none, h.first));
  for (const auto& h : exchanges) all.push_back(exchanged(body, prior, frame, none, h.first, h.second));
  std::ranges::stable_sort(all, std::greater{}, &Hypothesis::score);
  return all;
}

Hypothesis explain_shift(const StandingBody& body, const SharedPrior& prior, const SeenFrame& frame,
                         int marker) {
  return elsewhere(body, prior, frame, fit_body(body, prior, frame), marker);
}

double share_seen(const StandingBody& body, const SharedPrior& prior, const SeenFrame& frame, double shift_m,
                  const Least& least) {
  const BodyFit none = fit_body(body, prior, frame);
  const MatrixXd W = inverse_covariance(none, frame);
  const double misfit =
      std::max(kLeastMisfit, none.cost / static_cast<double>(std::max<Eigen::Index>(1, none.by_pose.rows())));
  int asked = 0, seen = 0;
  for (const int row : none.rows) {
    if (row < 0) continue;
    const Matrix3d weight = W.block<3, 3>(row, row);
    // Faces, edges and corners of a cube; the other side of each is the same.
    for (int k = 14; k < 27; ++k) {
      const int across = k / 3 % 3, up = k / 9;
      const Vector3d shift = shift_m * Vector3d(k % 3 - 1.0, across - 1.0, up - 1.0).normalized();
      const double fall = shift.dot(weight * shift);
      ++asked;
      if (fall >= least.fall && fall / misfit - price_of(shift, misfit * weight.inverse()) >= least.score)
        ++seen;
    }
  }
  return asked > 0 ? static_cast<double>(seen) / asked : 0.0;
}

Hypothesis explain_exchange(const StandingBody& body, const SharedPrior& prior, const SeenFrame& frame,
                            int first, int second) {
  return exchanged(body, prior, frame, fit_body(body, prior, frame), first, second);
}

double explain_mirrored(const StandingBody& body, const SharedPrior& prior, const SeenFrame& frame) {
  // Bodies in 38 recordings have 0.1 to 1.2, their mirror images 1.8 and more.
  constexpr double kMostOfABody = 1.7;
  const BodyFit none = fit_body(body, prior, frame);
  const auto seen = static_cast<double>(std::max<Eigen::Index>(1, none.by_pose.rows()));
  if (none.cost <= kMostOfABody * seen) return 0.0;
  const double cost = fit_body(body, prior, mirror_image(frame)).cost;
  if (cost > kMostOfABody * seen) return 0.0;
  return std::max(0.0, none.cost - cost) / std::max(kLeastMisfit, cost / seen);
}

SeenFrame mirror_image(SeenFrame frame) {
  frame.x.row(0) *= -1.0;
  return frame;
}

}  // namespace kinemark::motion::internal
