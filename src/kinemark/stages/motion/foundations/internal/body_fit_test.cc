// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/motion/foundations/internal/body_fit.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <string>
#include <vector>

#include "kinemark/core/index.h"
#include "kinemark/core/random.h"

namespace kinemark::motion::internal {
namespace {

using Eigen::Vector3d;

const std::vector<std::string> kNames{"LASI", "RASI", "LPSI", "RPSI", "LTHI", "RTHI", "LKNE", "RKNE",
                                      "LTIB", "RTIB", "LANK", "RANK", "LHEE", "RHEE", "LTOE", "RTOE"};

/// The standing body, `size` times as large, turned and moved.
SeenFrame standing_frame(const StandingBody& body, double size, const Eigen::Matrix3d& turn,
                         const Vector3d& place) {
  SeenFrame out;
  out.x.resize(3, static_cast<Eigen::Index>(body.markers.size()));
  out.sd = Eigen::VectorXd::Constant(out.x.cols(), 0.002);
  for (std::size_t m = 0; m < body.markers.size(); ++m) {
    Vector3d x = body.markers[m].x_in_segment;
    for (int s = body.markers[m].segment; s >= 0; s = body.segments[at(s)].parent)
      x += body.segments[at(s)].joint_in_parent;
    out.x.col(static_cast<Eigen::Index>(m)) = place + turn * (size * x);
  }
  return out;
}

Eigen::Matrix3d some_turn(double angle) {
  return Eigen::AngleAxisd(angle, Vector3d(0.3, -0.8, 0.5).normalized()).toRotationMatrix();
}

TEST(BodyFit, FindsAStandingBodyWhereverItStands) {
  const auto body = body_of_names(kNames);
  for (const double angle : {0.0, 1.0, 2.5}) {
    const auto fit =
        fit_body(body, prior_of(body), standing_frame(body, 1.0, some_turn(angle), Vector3d(1, -2, 3)));
    EXPECT_LT(fit.cost, 1e-6) << angle;
    EXPECT_LT((fit.world_from_root - some_turn(angle)).norm(), 1e-4) << angle;
  }
}

TEST(BodyFit, ASizeIsFoundNotTakenForMisplacedMarkers) {
  const auto body = body_of_names(kNames);
  const auto fit =
      fit_body(body, prior_of(body), standing_frame(body, 0.8, some_turn(1.0), Vector3d::Zero()));
  EXPECT_NEAR(fit.shared[0], std::log(0.8), 0.03);
  EXPECT_LT(fit.cost, 6.0);  // 48 coordinates
}

TEST(BodyFit, MovesWithTheLaboratory) {
  const auto body = body_of_names(kNames);
  Random random(4, 0);
  SeenFrame here = standing_frame(body, 1.05, Eigen::Matrix3d::Identity(), Vector3d::Zero());
  for (Eigen::Index m = 0; m < here.x.cols(); ++m)
    for (int a = 0; a < 3; ++a) here.x(a, m) += 0.01 * random.gaussian();
  SeenFrame there = here;
  there.x = some_turn(2.0) * here.x;
  there.x.colwise() += Vector3d(4, 5, -6);
  const auto a = fit_body(body, prior_of(body), here), b = fit_body(body, prior_of(body), there);
  EXPECT_NEAR(a.cost, b.cost, 1e-2 * (1.0 + a.cost));
  EXPECT_LT((some_turn(2.0) * a.residual - b.residual).norm(), 1e-3);
}

TEST(BodyFit, MarkersThatAreNotSeenTakeNoPart) {
  const auto body = body_of_names(kNames);
  auto frame = standing_frame(body, 1.0, some_turn(0.5), Vector3d::Zero());
  frame.x.col(7).setConstant(std::nan(""));
  const auto fit = fit_body(body, prior_of(body), frame);
  EXPECT_EQ(fit.rows[7], -1);
  EXPECT_EQ(fit.by_pose.rows(), 45);
  EXPECT_TRUE(std::isnan(fit.residual(0, 7)));
  EXPECT_LT(fit.cost, 1e-6);
}

TEST(BodyFit, InformationIsThatOfTheJacobianAndThePrior) {
  const auto body = body_of_names(kNames);
  const auto prior = prior_of(body);
  auto frame = standing_frame(body, 1.02, some_turn(0.7), Vector3d(0.2, 0.1, 0.0));
  frame.x.col(3).setConstant(std::nan(""));
  for (Eigen::Index m = 0; m < frame.sd.size(); ++m) frame.sd[m] = 0.002 + 0.001 * static_cast<double>(m % 3);
  const auto fit = fit_body(body, prior, frame);
  const Eigen::Index P = fit.pose.size(), S = fit.shared.size();
  Eigen::MatrixXd J(fit.by_pose.rows(), P + S);
  J << fit.by_pose, fit.by_shared;
  Eigen::VectorXd weight(J.rows());
  for (std::size_t m = 0; m < fit.rows.size(); ++m)
    if (fit.rows[m] >= 0)
      weight.segment<3>(fit.rows[m]).setConstant(std::pow(frame.sd[static_cast<Eigen::Index>(m)], -2.0));
  Eigen::MatrixXd expected = J.transpose() * weight.asDiagonal() * J;
  expected.bottomRightCorner(S, S) += prior.information;
  // What is left is the posture's spread, on the diagonal.
  Eigen::MatrixXd left = fit.information - expected;
  for (int s = 1; s < static_cast<int>(body.segments.size()); ++s)
    for (int a = 0; a < 3; ++a) {
      const double sd = body.segments[at(s)].turn_sd[a];
      EXPECT_NEAR(left(3 + 3 * s + a, 3 + 3 * s + a) * sd * sd, 1.0, 1e-3) << s;
    }
  left.diagonal().head(P).setZero();
  EXPECT_LT(left.cwiseAbs().maxCoeff(), 1e-6 * expected.cwiseAbs().maxCoeff());
}

TEST(BodyFit, AFitGoesOnFromAnother) {
  const auto body = body_of_names(kNames);
  const auto prior = prior_of(body);
  auto frame = standing_frame(body, 1.0, some_turn(1.4), Vector3d(1.0, 0.0, 0.0));
  const auto first = fit_body(body, prior, frame);
  frame.x.col(6) += Vector3d(0.0, 0.02, 0.0);
  const auto again = fit_body(body, prior, frame, &first), anew = fit_body(body, prior, frame);
  EXPECT_GT(again.cost, first.cost);
  EXPECT_NEAR(again.cost, anew.cost, 0.02 * (1.0 + anew.cost));
  EXPECT_EQ(again.first, first.first);
}

TEST(BodyFit, SidesThatBreakTheHabitCostMoreThanSidesThatShareIt) {
  const auto body = body_of_names(kNames);
  const auto prior = prior_of(body);
  const auto clean = standing_frame(body, 1.0, Eigen::Matrix3d::Identity(), Vector3d::Zero());
  auto both = clean, one = clean;
  constexpr Eigen::Index kLeft = 10, kRight = 11;  // ankles
  both.x.col(kLeft) += Vector3d(0.02, 0.0, 0.0);
  both.x.col(kRight) += Vector3d(0.02, 0.0, 0.0);
  one.x.col(kLeft) += Vector3d(0.02, 0.0, 0.0);
  one.x.col(kRight) -= Vector3d(0.02, 0.0, 0.0);
  EXPECT_LT(fit_body(body, prior, both).cost, fit_body(body, prior, one).cost);
}

TEST(BodyFit, FramesTeachWhereMarkersLie) {
  const auto body = body_of_names(kNames);
  const auto prior = prior_of(body);
  std::vector<SeenFrame> frames;
  for (int k = 0; k < 4; ++k)
    frames.push_back(standing_frame(body, 1.0, some_turn(0.4 * k), Vector3d(0.1 * k, 0, 0)));
  constexpr Eigen::Index kKnee = 6;
  for (int k = 0; k < 4; ++k)  // on the thigh, whichever way it points
    frames[at(k)].x.col(kKnee) += 0.02 * (some_turn(0.4 * k) * Vector3d::UnitY());
  const auto known = learn_shared(body, prior, frames);
  const Eigen::Index row = prior.mean.size() - 3 * static_cast<Eigen::Index>(body.markers.size()) + 3 * kKnee;
  for (int a = 0; a < 3; ++a)
    EXPECT_GE(known.information(row + a, row + a), prior.information(row + a, row + a));
  const auto naive = fit_body(body, prior, frames[0]), taught = fit_body(body, known, frames[0]);
  EXPECT_LT(taught.cost, 0.6 * naive.cost);
}

TEST(BodyFit, WhatFramesTeachDoesNotDependOnTheirOrder) {
  const auto body = body_of_names(kNames);
  const auto prior = prior_of(body);
  std::vector<SeenFrame> frames;
  for (int k = 0; k < 4; ++k) {
    auto frame = standing_frame(body, 1.15, Eigen::Matrix3d::Identity(), Vector3d(0.1 * k, 0, 0));
    // Left markers from the thigh on swing about the hip, which lies 30 mm further back than expected.
    const Vector3d hip = 1.15 * Vector3d(-0.09, -0.0765, -0.085) + Vector3d(0.1 * k, 0, 0);
    const Eigen::Matrix3d swing = Eigen::AngleAxisd(0.3 * k, Vector3d::UnitZ()).toRotationMatrix();
    for (std::size_t m = 4; m < kNames.size(); m += 2) {
      const auto i = static_cast<Eigen::Index>(m);
      frame.x.col(i) = hip + swing * (frame.x.col(i) - hip);
    }
    frames.push_back(std::move(frame));
  }
  const auto there = learn_shared(body, prior, frames);
  std::ranges::reverse(frames);
  const auto back = learn_shared(body, prior, frames);
  EXPECT_LT((there.mean - back.mean).cwiseAbs().maxCoeff(), 0.002);
  EXPECT_EQ(learn_shared(body, prior, {}).mean, prior.mean);
}

}  // namespace
}  // namespace kinemark::motion::internal
