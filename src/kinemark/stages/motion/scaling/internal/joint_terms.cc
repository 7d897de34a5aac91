// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/motion/scaling/internal/joint_terms.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <iterator>

#include "kinemark/core/index.h"
#include "kinemark/math/rotation_fit.h"
#include "kinemark/math/se3.h"

namespace kinemark::motion::internal {
namespace {

using Eigen::Index;
using Eigen::Matrix3d;
using Eigen::Vector3d;

constexpr double kLeastSd_m = 1e-4;  // nothing is known better

/// Inverse, with deviations of kLeastSd_m at least.
Matrix3d information_of(const Matrix3d& covariance) {
  const Eigen::SelfAdjointEigenSolver<Matrix3d> eigen(0.5 * (covariance + covariance.transpose()));
  const Vector3d variance = eigen.eigenvalues().cwiseMax(kLeastSd_m * kLeastSd_m);
  return eigen.eigenvectors() * variance.cwiseInverse().asDiagonal() * eigen.eigenvectors().transpose();
}

}  // namespace

JointTerms::JointTerms(const data::ModelDescription& model, const std::vector<GeometryParameter>& parameters,
                       const std::vector<MeasuredJoint>& joints)
    : columns_(std::ssize(parameters)) {
  for (const auto& measured : joints) {
    const auto joint = std::ranges::find(model.joints, measured.joint, &data::JointDescription::name);
    if (joint == model.joints.end()) continue;
    const auto idx = static_cast<int>(joint - model.joints.begin());
    const auto frame =
        measured.in_parent ? GeometryTerm::Moves::parent_frame : GeometryTerm::Moves::child_frame;
    Term term{.joint = (measured.in_parent ? joint->parent_from_joint : joint->child_from_joint).translation,
              .markers = Eigen::Matrix3Xd(3, measured.x.cols()),
              .x = measured.x,
              .centre = measured.centre,
              .information = information_of(measured.covariance),
              .moves = {}};
    for (Index m = 0; m < term.markers.cols(); ++m)
      term.markers.col(m) = model.markers[at(measured.markers[at(m)])].x_in_body;
    for (std::size_t k = 0; k < parameters.size(); ++k) {
      Move move{.column = static_cast<int>(k), .markers = Eigen::Matrix3Xd::Zero(3, term.markers.cols())};
      bool moves = false;
      for (const auto& part : parameters[k].terms) {
        if (part.moves == frame && part.idx == idx) {
          move.joint += part.direction;
          moves = true;
        }
        if (part.moves != GeometryTerm::Moves::marker) continue;
        const auto m = std::ranges::find(measured.markers, part.idx);
        if (m == measured.markers.end()) continue;
        move.markers.col(m - measured.markers.begin()) += part.direction;
        moves = true;
      }
      if (moves) term.moves.push_back(std::move(move));
    }
    terms_.push_back(std::move(term));
  }
}

JointSums JointTerms::sums(const Eigen::VectorXd& x) const {
  JointSums all{.information = Eigen::MatrixXd::Zero(columns_, columns_),
                .gradient = Eigen::VectorXd::Zero(columns_)};
  for (const auto& term : terms_) {
    Vector3d joint = term.joint;
    Eigen::Matrix3Xd markers = term.markers;
    for (const auto& move : term.moves) {
      joint += x[move.column] * move.joint;
      markers += x[move.column] * move.markers;
    }
    const auto body_from_markers = math::fit_rigid(term.x, markers).target_from_source;
    const Matrix3d& R = body_from_markers.rotation;
    const Vector3d predicted = R * term.centre + body_from_markers.translation;
    const Vector3d middle = R * term.x.rowwise().mean() + body_from_markers.translation;
    const Vector3d e = joint - predicted;
    const Matrix3d information = R * term.information * R.transpose();
    // The markers turn by (sum r x r x)^-1 sum r x dx when they move by dx, and the covariance with them.
    Matrix3d inertia = Matrix3d::Zero();
    for (Index m = 0; m < term.x.cols(); ++m) {
      const Matrix3d r = math::skew(R * term.x.col(m) + body_from_markers.translation - middle);
      inertia += r.transpose() * r;
    }
    const Matrix3d turn = -math::skew(joint - middle) * inertia.inverse();
    Eigen::MatrixXd A(3, std::ssize(term.moves));
    for (Index k = 0; k < A.cols(); ++k) {
      const auto& move = term.moves[at(k)];
      Vector3d torque = Vector3d::Zero();
      for (Index m = 0; m < term.x.cols(); ++m)
        torque +=
            (R * term.x.col(m) + body_from_markers.translation - middle).cross(Vector3d(move.markers.col(m)));
      A.col(k) = move.joint - move.markers.rowwise().mean() - turn * torque;
    }
    all.squares += e.dot(information * e);
    const Eigen::MatrixXd weighted = information * A;
    for (Index k = 0; k < A.cols(); ++k) {
      const int column = term.moves[at(k)].column;
      all.gradient[column] -= weighted.col(k).dot(e);
      for (Index i = 0; i < A.cols(); ++i)
        all.information(column, term.moves[at(i)].column) += weighted.col(k).dot(A.col(i));
    }
  }
  return all;
}

}  // namespace kinemark::motion::internal
