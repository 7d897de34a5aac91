// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// Levels that the program proposes, against singular values and angles of row spaces computed here by
// themselves.
#include "kinemark/stages/motion/control/internal/propose_levels.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <Eigen/SVD>
#include <algorithm>
#include <string>
#include <vector>

#include "kinemark/model/dynamics.h"
#include "kinemark/model/kinematics.h"
#include "kinemark/model/state.h"
#include "kinemark/stages/motion/control/online_tracker.h"
#include "kinemark/stages/motion/testing/body.h"

namespace kinemark::motion {
namespace {

using ::testing::HasSubstr;

model::Model body() { return model::Model::compile(testing_body::description()).value(); }

/// Rows of markers in the metric of the kinetic energy by the symmetric root of the mass matrix: the singular
/// values are those of J L^-T.
Eigen::MatrixXd rows_of(const model::Model& model, const data::JointMotion& motion, std::int64_t frame,
                        const std::vector<std::string>& names) {
  const Eigen::Map<const Eigen::VectorXd> q(motion.q.data() + motion.index(frame, 0), motion.size());
  model::Workspace w(model);
  Eigen::MatrixXd J, M;
  model::kinematics(model, w, model::state_from_coordinates(model, q));
  model::mass_matrix(model, w, M);
  model::marker_jacobian(model, w, J);
  const Eigen::MatrixXd root = Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(M).operatorInverseSqrt();
  Eigen::MatrixXd rows(3 * static_cast<Eigen::Index>(names.size()), J.cols());
  for (std::size_t i = 0; i < names.size(); ++i)
    rows.middleRows<3>(3 * static_cast<Eigen::Index>(i)) =
        J.middleRows<3>(3 * static_cast<Eigen::Index>(model.description().find_marker(names[i])));
  return rows * root;
}

TEST(ProposeLevels, MarkersChosenAreIndependentAndDecoupledInEveryPose) {
  const auto model = body();
  const auto track = track_markers(model, testing_body::record(model, 300, 0.5e-3),
                                   {.propose_levels = true, .error_bars = false});
  ASSERT_TRUE(track) << track.error().message;
  ASSERT_TRUE(track->proposed);
  const auto& proposal = *track->proposed;
  ASSERT_GE(proposal.levels.size(), 2U);
  EXPECT_EQ(proposal.poses, 6);
  EXPECT_THAT(proposal.levels.back().markers, ::testing::ElementsAre("*"));
  std::vector<std::string> chosen;
  for (std::size_t i = 0; i < proposal.smallest.size(); ++i) {
    ASSERT_EQ(proposal.smallest[i].size(), proposal.levels[i].markers.size());
    for (const double value : proposal.smallest[i]) EXPECT_GE(value, 0.1);
    chosen.insert(chosen.end(), proposal.levels[i].markers.begin(), proposal.levels[i].markers.end());
  }
  // The first one: no other has a larger smallest singular value in its worst pose.
  double best = 0.0, of_first = 0.0;
  for (const auto& marker : model.description().markers) {
    double worst = 1e9;
    for (std::int64_t f = 0; f < 300; f += 50)
      worst =
          std::min(worst, Eigen::JacobiSVD<Eigen::MatrixXd>(rows_of(model, track->motion, f, {marker.name}))
                              .singularValues()[2]);
    best = std::max(best, worst);
    if (marker.name == proposal.levels[0].markers[0]) of_first = worst;
  }
  EXPECT_NEAR(of_first, best, 0.01 * best);
  EXPECT_NEAR(proposal.smallest[0][0], best, 0.02 * best);
  // All of them together have three directions each; two of level 1 do not share one.
  for (std::int64_t f = 0; f < 300; f += 50) {
    const Eigen::JacobiSVD<Eigen::MatrixXd> svd(rows_of(model, track->motion, f, chosen));
    EXPECT_GT(svd.singularValues().minCoeff(), 1e-3) << f;
    const auto& first = proposal.levels[0].markers;
    for (std::size_t a = 0; a < first.size(); ++a)
      for (std::size_t b = 0; b < a; ++b) {
        const auto basis = [&](const std::string& name) {
          const Eigen::JacobiSVD<Eigen::MatrixXd> one(rows_of(model, track->motion, f, {name}),
                                                      Eigen::ComputeThinV);
          return Eigen::MatrixXd(one.matrixV());
        };
        const Eigen::MatrixXd cosines = basis(first[a]).transpose() * basis(first[b]);
        EXPECT_LE(Eigen::JacobiSVD<Eigen::MatrixXd>(cosines).singularValues()[0], 0.91)
            << first[a] << ' ' << first[b];
      }
  }
}

TEST(ProposeLevels, WhatLevelsLeaveIsCounted) {
  const auto model = body();
  const auto markers = testing_body::record(model, 120, 0.5e-3);
  TrackOptions options{
      .levels = {{.markers = {"T1", "T2", "T3", "T4"}}, {.markers = {"F2"}}, {.markers = {"*"}}},
      .error_bars = false};
  const auto track = track_markers(model, markers, options).value();
  ASSERT_EQ(track.levels.size(), 3U);
  EXPECT_EQ(track.levels[0].rows, 12);
  EXPECT_EQ(track.levels[0].directions_left, 12) << "six of the root, three, one, one, one";
  EXPECT_EQ(track.levels[1].rows, 3);
  EXPECT_EQ(track.levels[1].directions_left, 6) << "the trunk takes the root";
  EXPECT_EQ(track.levels[2].directions_left, 3);
  EXPECT_EQ(track.levels[2].rows, 3 * 9);
}

TEST(ProposeLevels, WhereNothingCanBeProposedThatIsSaid) {
  const auto model = body();
  auto markers = testing_body::record(model, 60, 0.5e-3);
  TrackOptions options{.propose_levels = true, .error_bars = false};
  for (std::int64_t f = 20; f < 40; ++f)  // each marker is lost for a third of the time
    for (std::int64_t m = 0; m < markers.markers(); ++m)
      if (m % 2 == f / 30) markers.set_missing(f, m);
  const auto track = track_markers(model, markers, options);
  ASSERT_FALSE(track);
  EXPECT_THAT(track.error().message, HasSubstr("no levels can be proposed"));
  options.levels = {{.markers = {"*"}}};
  EXPECT_THAT(track_markers(model, markers, options).error().message, HasSubstr("need one of both"));
  options.levels.clear();
  const auto live = OnlineTracker::create(model, markers.names, 100.0, options);
  ASSERT_FALSE(live);
  EXPECT_THAT(live.error().message, HasSubstr("takes a whole recording"));
}

}  // namespace
}  // namespace kinemark::motion
