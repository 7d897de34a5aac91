// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/motion/foundations/internal/body_fit.h"

#include <Eigen/Cholesky>
#include <Eigen/Geometry>
#include <Eigen/LU>
#include <Eigen/SVD>
#include <algorithm>
#include <cmath>
#include <limits>

#include "kinemark/core/index.h"

namespace kinemark::motion::internal {
namespace {

using Eigen::Matrix3d;
using Eigen::Matrix3Xd;
using Eigen::MatrixXd;
using Eigen::Vector3d;
using Eigen::VectorXd;

// Numbers of a pose: place of the first segment, its turn, then the turns of all others.
// Shared numbers: whole size, sizes, joints (3 each, first segment's without effect), places (3 a marker).

Matrix3d turn(const Vector3d& w) {
  const double angle = w.norm();
  return angle < 1e-12 ? Matrix3d::Identity() : Eigen::AngleAxisd(angle, w / angle).toRotationMatrix();
}

struct Layout {
  explicit Layout(const StandingBody& b)
      : segments(static_cast<Eigen::Index>(b.segments.size())),
        sizes(static_cast<Eigen::Index>(b.sizes.size())),
        markers(static_cast<Eigen::Index>(b.markers.size())) {}
  Eigen::Index segments, sizes, markers;
  Eigen::Index pose() const { return 3 + 3 * segments; }
  Eigen::Index joints() const { return 1 + sizes; }
  Eigen::Index sites() const { return joints() + 3 * segments; }
  Eigen::Index shared() const { return sites() + 3 * markers; }
};

struct Posed {
  Matrix3Xd marker;
  std::vector<Matrix3d> rotation;
};

Vector3d scale_of(const StandingBody::Segment& segment, const VectorXd& shared) {
  const double along = std::exp(shared[0] + shared[1 + segment.size]);
  const double across = segment.width < 0 ? along : std::exp(shared[0] + shared[1 + segment.width]);
  return {along, along, across};
}

/// @param first  rotation that the turn of the first segment is counted from
void pose_body(const StandingBody& body, const Matrix3d& first, const VectorXd& pose, const VectorXd& shared,
               Posed& out) {
  const Layout layout(body);
  const auto n = body.segments.size();
  out.rotation.resize(n);
  std::vector<Vector3d> joint(n), scale(n);
  for (std::size_t s = 0; s < n; ++s) {
    const auto& segment = body.segments[s];
    const auto i = static_cast<Eigen::Index>(s);
    scale[s] = scale_of(segment, shared);
    const Matrix3d own = turn(pose.segment<3>(3 + 3 * i));
    if (segment.parent < 0) {
      joint[s] = pose.head<3>();
      out.rotation[s] = own * first;
      continue;
    }
    const auto p = at(segment.parent);
    const Vector3d offset =
        scale[p].cwiseProduct(segment.joint_in_parent) + shared.segment<3>(layout.joints() + 3 * i);
    joint[s] = joint[p] + out.rotation[p] * offset;
    out.rotation[s] = out.rotation[p] * own;
  }
  out.marker.resize(3, layout.markers);
  for (std::size_t m = 0; m < body.markers.size(); ++m) {
    const auto& marker = body.markers[m];
    const auto s = at(marker.segment);
    const auto i = static_cast<Eigen::Index>(m);
    out.marker.col(i) = joint[s] + out.rotation[s] * (scale[s].cwiseProduct(marker.x_in_segment) +
                                                      shared.segment<3>(layout.sites() + 3 * i));
  }
}

/// Rotation and place that put the standing body's markers nearest to where they were seen.
Matrix3d align(const StandingBody& body, const SeenFrame& frame, const VectorXd& shared, Vector3d& place) {
  const Layout layout(body);
  Posed posed;
  pose_body(body, Matrix3d::Identity(), VectorXd::Zero(layout.pose()), shared, posed);
  Vector3d here = Vector3d::Zero(), there = Vector3d::Zero();
  double sum = 0.0;
  std::vector<double> weight(body.markers.size(), 0.0);
  for (std::size_t m = 0; m < weight.size(); ++m) {
    if (!frame.x.col(static_cast<Eigen::Index>(m)).allFinite()) continue;
    // Limbs may point anywhere; what is near the first segment counts most.
    int depth = 0;
    for (int s = body.markers[m].segment; body.segments[at(s)].parent >= 0; s = body.segments[at(s)].parent)
      ++depth;
    weight[m] = 1.0 / (1.0 + 4.0 * depth * depth);
    sum += weight[m];
    here += weight[m] * posed.marker.col(static_cast<Eigen::Index>(m));
    there += weight[m] * frame.x.col(static_cast<Eigen::Index>(m));
  }
  place = Vector3d::Zero();
  if (sum == 0.0) return Matrix3d::Identity();
  here /= sum;
  there /= sum;
  Matrix3d cross = Matrix3d::Zero();
  for (std::size_t m = 0; m < weight.size(); ++m) {
    const auto i = static_cast<Eigen::Index>(m);
    if (weight[m] > 0.0)
      cross += weight[m] * (frame.x.col(i) - there) * (posed.marker.col(i) - here).transpose();
  }
  const Eigen::JacobiSVD<Matrix3d> svd(cross, Eigen::ComputeFullU | Eigen::ComputeFullV);
  Matrix3d flip = Matrix3d::Identity();
  flip(2, 2) = (svd.matrixU() * svd.matrixV().transpose()).determinant() < 0.0 ? -1.0 : 1.0;
  Matrix3d rotation = svd.matrixU() * flip * svd.matrixV().transpose();
  place = there - rotation * here;
  return rotation;
}

/// Information of the posture: turns about their spreads, place and turn of the first segment free.
VectorXd pose_information(const StandingBody& body) {
  const Layout layout(body);
  VectorXd out = VectorXd::Constant(layout.pose(), 1e-8);
  for (Eigen::Index s = 0; s < layout.segments; ++s) {
    const auto& segment = body.segments[static_cast<std::size_t>(s)];
    if (segment.parent < 0) continue;
    for (int a = 0; a < 3; ++a)
      out[3 + 3 * s + a] = 1.0 / std::max(1e-6, segment.turn_sd[a] * segment.turn_sd[a]);
  }
  return out;
}

void add_pair(MatrixXd& information, Eigen::Index a, Eigen::Index b, double sign, double common, double own) {
  const double c = common * common, o = std::max(1e-12, own * own);
  if (b < 0) {
    information(a, a) += 1.0 / (c + o);
    return;
  }
  if (b < a) return;
  const double det = (c + o) * (c + o) - c * c;
  information(a, a) += (c + o) / det;
  information(b, b) += (c + o) / det;
  information(a, b) -= sign * c / det;
  information(b, a) -= sign * c / det;
}

struct Seen {
  VectorXd residual, variance;
  MatrixXd by_pose, by_shared;
};

double cost_of(const StandingBody& body, const SharedPrior& prior, const VectorXd& pose_info,
               const SeenFrame& frame, const Matrix3d& first, const VectorXd& pose, const VectorXd& shared,
               Posed& posed) {
  pose_body(body, first, pose, shared, posed);
  double cost = pose.cwiseAbs2().dot(pose_info);
  const VectorXd off = shared - prior.mean;
  cost += off.dot(prior.information * off);
  for (Eigen::Index m = 0; m < frame.x.cols(); ++m)
    if (frame.x.col(m).allFinite())
      cost += (frame.x.col(m) - posed.marker.col(m)).squaredNorm() / (frame.sd[m] * frame.sd[m]);
  return cost;
}

Seen linearise(const StandingBody& body, const SeenFrame& frame, const Matrix3d& first, VectorXd pose,
               VectorXd shared, const std::vector<int>& rows, Eigen::Index count) {
  const Layout layout(body);
  Posed posed, moved;
  pose_body(body, first, pose, shared, posed);
  Seen out{VectorXd(count), VectorXd(count), MatrixXd::Zero(count, layout.pose()),
           MatrixXd::Zero(count, layout.shared())};
  for (Eigen::Index m = 0; m < layout.markers; ++m) {
    const int row = rows[static_cast<std::size_t>(m)];
    if (row < 0) continue;
    out.residual.segment<3>(row) = frame.x.col(m) - posed.marker.col(m);
    out.variance.segment<3>(row).setConstant(frame.sd[m] * frame.sd[m]);
    const auto s = at(body.markers[static_cast<std::size_t>(m)].segment);
    out.by_shared.block<3, 3>(row, layout.sites() + 3 * m) = posed.rotation[s];
  }
  constexpr double kStep = 1e-6;
  const auto differences = [&](VectorXd& x, Eigen::Index k, MatrixXd& J) {
    const double kept = x[k];
    x[k] = kept + kStep;
    pose_body(body, first, pose, shared, moved);
    x[k] = kept;
    for (Eigen::Index m = 0; m < layout.markers; ++m)
      if (const int row = rows[static_cast<std::size_t>(m)]; row >= 0)
        J.block<3, 1>(row, k) = (moved.marker.col(m) - posed.marker.col(m)) / kStep;
  };
  for (Eigen::Index k = 0; k < layout.pose(); ++k) differences(pose, k, out.by_pose);
  for (Eigen::Index k = 0; k < layout.sites(); ++k) differences(shared, k, out.by_shared);
  return out;
}

/// Inverse covariance of all numbers, pose first. A marker's place moves that marker alone, and by a
/// rotation.
MatrixXd information_of(const Seen& seen, const Layout& layout, const std::vector<int>& rows,
                        const VectorXd& pose_info, const SharedPrior& prior) {
  const Eigen::Index P = layout.pose(), S = layout.shared(), dense = P + layout.sites();
  MatrixXd weighted(seen.residual.size(), dense);
  weighted << seen.by_pose, seen.by_shared.leftCols(layout.sites());
  weighted.array().colwise() /= seen.variance.array().sqrt();
  MatrixXd out = MatrixXd::Zero(P + S, P + S);
  // A frame may show no marker; Eigen divides by the size of what is multiplied.
  if (weighted.rows() > 0)
    out.topLeftCorner(dense, dense).selfadjointView<Eigen::Lower>().rankUpdate(weighted.transpose());
  for (Eigen::Index m = 0; m < layout.markers; ++m) {
    const int row = rows[static_cast<std::size_t>(m)];
    if (row < 0) continue;
    const Eigen::Index k = dense + 3 * m;
    const double sd = std::sqrt(seen.variance[row]);
    out.block(k, 0, 3, dense) =
        seen.by_shared.block<3, 3>(row, k - P).transpose() * weighted.middleRows<3>(row) / sd;
    out.diagonal().segment<3>(k).array() += 1.0 / seen.variance[row];
  }
  out.diagonal().head(P) += pose_info;
  out.bottomRightCorner(S, S).triangularView<Eigen::Lower>() += prior.information;
  out.triangularView<Eigen::StrictlyUpper>() = out.transpose();
  return out;
}

}  // namespace

SharedPrior prior_of(const StandingBody& body) {
  const Layout layout(body);
  SharedPrior out{VectorXd::Zero(layout.shared()), MatrixXd::Zero(layout.shared(), layout.shared())};
  out.information(0, 0) = 1.0 / (body.size_sd * body.size_sd);
  for (Eigen::Index s = 0; s < layout.sizes; ++s) {
    const auto& size = body.sizes[static_cast<std::size_t>(s)];
    add_pair(out.information, 1 + s, size.mirror < 0 ? -1 : 1 + size.mirror, 1.0, size.common_sd,
             size.own_sd);
  }
  for (Eigen::Index s = 0; s < layout.segments; ++s) {
    const auto& segment = body.segments[static_cast<std::size_t>(s)];
    for (int a = 0; a < 3; ++a) {
      const Eigen::Index other = segment.mirror < 0 ? -1 : layout.joints() + 3 * segment.mirror + a;
      add_pair(out.information, layout.joints() + 3 * s + a, other, a == 2 ? -1.0 : 1.0,
               std::max(1e-4, segment.joint_common_sd), std::max(1e-4, segment.joint_own_sd));
    }
  }
  for (Eigen::Index m = 0; m < layout.markers; ++m) {
    const auto& marker = body.markers[static_cast<std::size_t>(m)];
    for (int a = 0; a < 3; ++a) {
      const Eigen::Index other = marker.mirror < 0 ? -1 : layout.sites() + 3 * marker.mirror + a;
      add_pair(out.information, layout.sites() + 3 * m + a, other, a == 2 ? -1.0 : 1.0,
               marker.spread.common[a], marker.spread.own[a]);
    }
  }
  return out;
}

BodyFit fit_body(const StandingBody& body, const SharedPrior& prior, const SeenFrame& frame,
                 const BodyFit* near) {
  const Layout layout(body);
  BodyFit out;
  out.rows.assign(body.markers.size(), -1);
  int count = 0;
  for (std::size_t m = 0; m < body.markers.size(); ++m)
    if (frame.x.col(static_cast<Eigen::Index>(m)).allFinite()) {
      out.rows[m] = count;
      count += 3;
    }
  VectorXd shared = prior.mean;
  VectorXd pose = VectorXd::Zero(layout.pose());
  Matrix3d first;
  if (near != nullptr) {
    first = near->first;
    pose = near->pose;
    shared = near->shared;
  } else {
    Vector3d place;
    first = align(body, frame, shared, place);
    pose.head<3>() = place;
  }
  const VectorXd pose_info = pose_information(body);
  const Eigen::Index P = layout.pose(), S = layout.shared();
  Posed posed;
  double cost = cost_of(body, prior, pose_info, frame, first, pose, shared, posed);
  double damping = 1e-3;
  MatrixXd information;
  Seen seen;
  for (int iteration = 0; iteration < 40; ++iteration) {
    seen = linearise(body, frame, first, pose, shared, out.rows, count);
    information = information_of(seen, layout, out.rows, pose_info, prior);
    VectorXd gradient(P + S);
    const VectorXd weighted = seen.residual.cwiseQuotient(seen.variance);
    gradient.head(P) = seen.by_pose.transpose() * weighted - pose_info.cwiseProduct(pose);
    gradient.tail(S) = seen.by_shared.transpose() * weighted - prior.information * (shared - prior.mean);
    bool better = false;
    double gain = 0.0;
    for (int attempt = 0; attempt < 8 && !better; ++attempt) {
      MatrixXd damped = information;
      damped.diagonal() *= 1.0 + damping;
      const VectorXd step = damped.llt().solve(gradient);
      const VectorXd next_pose = pose + step.head(P), next_shared = shared + step.tail(S);
      const double next = cost_of(body, prior, pose_info, frame, first, next_pose, next_shared, posed);
      better = next < cost;
      if (better) {
        gain = cost - next;
        pose = next_pose;
        shared = next_shared;
        cost = next;
        damping = std::max(1e-9, damping * 0.2);
      } else {
        damping = std::min(1e6, std::max(1e-6, damping) * 8.0);
      }
    }
    // A step that was held back gains little anywhere.
    if (!better || (gain < 1e-4 * (1.0 + cost) && damping < 1e-2)) break;
  }
  seen = linearise(body, frame, first, pose, shared, out.rows, count);
  information = information_of(seen, layout, out.rows, pose_info, prior);
  out.pose = pose;
  out.shared = shared;
  out.cost = cost;
  out.by_pose = std::move(seen.by_pose);
  out.by_shared = std::move(seen.by_shared);
  out.information = std::move(information);
  out.residual = Matrix3Xd::Constant(3, layout.markers, std::nan(""));
  for (std::size_t m = 0; m < out.rows.size(); ++m)
    if (out.rows[m] >= 0)
      out.residual.col(static_cast<Eigen::Index>(m)) = seen.residual.segment<3>(out.rows[m]);
  out.first = first;
  out.world_from_root = turn(pose.segment<3>(3)) * first;
  return out;
}

SharedPrior learn_shared(const StandingBody& body, const SharedPrior& prior,
                         const std::vector<SeenFrame>& frames) {
  constexpr int kMostPasses = 6;   // over all frames together
  constexpr double kHeld = 1e6;    // how much surer than the prior: shared numbers stay where they are
  constexpr double kLittle = 1.0;  // of the cost
  // Frame after frame: what one tells becomes what is known before the next.
  SharedPrior known = prior;
  const Layout layout(body);
  const Eigen::Index P = layout.pose(), S = layout.shared();
  std::vector<BodyFit> fits;
  const auto tells = [&](const BodyFit& fit) -> MatrixXd {
    const MatrixXd A = fit.information.topLeftCorner(P, P), C = fit.information.topRightCorner(P, S);
    return fit.information.bottomRightCorner(S, S) - C.transpose() * A.llt().solve(C);
  };
  for (const auto& frame : frames) {
    fits.push_back(fit_body(body, known, frame));
    known.mean = fits.back().shared;
    known.information = tells(fits.back());
    known.information = (0.5 * (known.information + known.information.transpose())).eval();
  }
  // Then all together: the first ones were linearised far from what all of them tell, some in another
  // posture.
  VectorXd mean = known.mean;
  VectorXd step = VectorXd::Zero(S);
  double least = std::numeric_limits<double>::infinity();
  for (int pass = 0; pass < kMostPasses && !frames.empty(); ++pass) {
    const SharedPrior held{mean, kHeld * prior.information};
    VectorXd gradient = prior.information * (prior.mean - mean);
    double cost = (mean - prior.mean).dot(prior.information * (mean - prior.mean));
    MatrixXd information = prior.information;
    std::vector<BodyFit> now;
    for (std::size_t f = 0; f < frames.size(); ++f) {
      BodyFit near = fits[f];
      near.shared = mean;
      now.push_back(fit_body(body, held, frames[f], &near));
      if (pass == 0)
        if (BodyFit again = fit_body(body, held, frames[f]); again.cost < now.back().cost)
          now.back() = std::move(again);
      const BodyFit& fit = now.back();
      cost += fit.cost;
      information += tells(fit) - held.information;
      for (std::size_t m = 0; m < fit.rows.size(); ++m)
        if (const int row = fit.rows[m]; row >= 0) {
          const auto i = static_cast<Eigen::Index>(m);
          gradient += fit.by_shared.middleRows<3>(row).transpose() * fit.residual.col(i) /
                      (frames[f].sd[i] * frames[f].sd[i]);
        }
    }
    if (cost >= least) {
      step *= 0.5;  // it went too far
    } else {
      const bool enough = least - cost < kLittle;
      least = cost;
      fits = std::move(now);
      known = {mean, (0.5 * (information + information.transpose())).eval()};
      if (enough) break;
      step = known.information.llt().solve(gradient);
    }
    mean = known.mean + step;
  }
  return known;
}

}  // namespace kinemark::motion::internal
