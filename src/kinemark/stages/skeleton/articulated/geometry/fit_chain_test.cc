// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/skeleton/articulated/geometry/fit_chain.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "kinemark/stages/skeleton/articulated/geometry/bootstrap.h"
#include "kinemark/stages/skeleton/articulated/geometry/segment_kind.h"
#include "kinemark/stages/skeleton/articulated/testing/random_chain.h"

namespace kinemark::skeleton {
namespace {

using data::CentreState;
using data::SegmentKind;
using testing::Each;
using testing::ElementsAre;
using testing::HasSubstr;
using testing_limbs::hide;
using testing_limbs::make_random_chain;
using testing_limbs::RandomChain;

ChainFitOptions of_kind(SegmentKind kind, int segments = 2) {
  ChainFitOptions options;
  options.kind.assign(segments, kind);
  return options;
}

int seen_on(const RandomChain& limb, std::int64_t frame, int segment) {
  int seen = 0;
  for (const int k : limb.chain.layout.markers_of(segment)) seen += limb.samples.seen(frame, k) ? 1 : 0;
  return seen;
}

// A fit that knows the true geometry.
ChainFit known_geometry(const RandomChain& limb, double noise_m) {
  ChainFit fit;
  fit.chain = limb.chain;
  fit.noise_sd_m = noise_m;
  fit.marker_weight.assign(limb.chain.markers(), 1.0);
  const auto n = static_cast<Eigen::Index>(limb.chain.globals().size());
  fit.global_covariance = Eigen::MatrixXd::Zero(n, n);
  return fit;
}

TEST(FitChain, FindsExactDataExactly) {
  for (const SegmentKind kind : {SegmentKind::line, SegmentKind::plane, SegmentKind::solid}) {
    const RandomChain limb = make_random_chain({.segments = 3,
                                                .markers_per_segment = 4,
                                                .frames = 120,
                                                .kind = kind,
                                                .noise_sd_m = 0.0,
                                                .missing = 0.15});
    const auto fit = fit_chain(limb.samples, limb.chain.layout, of_kind(kind, 3));
    ASSERT_TRUE(fit.has_value()) << fit.error().message;
    EXPECT_LT(fit->noise_sd_m, 1e-6);
    EXPECT_NEAR(fit->lengths().at(0).length_m, 0.150, 1e-6);
    ChainSolver solver(*fit);
    ChainFrame frame;
    int determined = 0;
    for (int f = 0; f < 120; ++f) {
      solver.solve(limb.samples.frame(f), nullptr, frame);
      for (int j = 0; j < 2; ++j) {
        if (frame.state[j] != CentreState::determined) continue;
        EXPECT_LT((frame.centre[j] - limb.chain.joint_centre(limb.pose[f], j)).norm(), 1e-5) << f;
        ++determined;
      }
    }
    EXPECT_GT(determined, 200);
  }
}

// Three spheres meet in two points: both must be found, equally likely, and the frame must say so.
TEST(ChainSolver, EveryFrameOfTwoAndOneMarkerIsAMirrorPair) {
  const RandomChain limb = make_random_chain({.frames = 400, .missing = 0.4});
  ChainSolver solver(known_geometry(limb, 0.001));
  ChainFrame frame;
  int pairs = 0;
  int whole = 0;
  int both_found = 0;
  for (int f = 0; f < 400; ++f) {
    const int a = seen_on(limb, f, 0);
    const int b = seen_on(limb, f, 1);
    solver.solve(limb.samples.frame(f), nullptr, frame);
    if (std::max(a, b) == 3) {
      EXPECT_EQ(frame.state[0], CentreState::determined) << f;
      ++whole;
    }
    if (a + b == 3 && std::max(a, b) == 2) {
      EXPECT_NE(frame.state[0], CentreState::determined) << f;
      ++pairs;
      if (frame.mode_count >= 2 && std::abs(frame.modes[0].cost - frame.modes[1].cost) < 1e-8) ++both_found;
    }
    if (a + b < 3) {
      EXPECT_EQ(frame.state[0], CentreState::undetermined) << f;
    }
  }
  EXPECT_GT(pairs, 50);
  EXPECT_GT(whole, 100);
  EXPECT_GT(both_found, pairs * 8 / 10);  // the others are folds, the two grown into one
}

TEST(ChainSolver, LinesAreDeterminedWhereOneShowsTwoMarkers) {
  const RandomChain limb = make_random_chain({.frames = 200, .kind = SegmentKind::line, .missing = 0.4});
  ChainSolver solver(known_geometry(limb, 0.001));
  ChainFrame frame;
  for (int f = 0; f < 200; ++f) {
    solver.solve(limb.samples.frame(f), nullptr, frame);
    const bool two = std::max(seen_on(limb, f, 0), seen_on(limb, f, 1)) >= 2;
    EXPECT_EQ(frame.state[0] == CentreState::determined, two) << f;
  }
}

// In a chain a joint can be mirrored although its neighbours are known: no marker on the middle segment.
TEST(ChainSolver, FindsMirrorsOfInnerJoints) {
  RandomChain limb = make_random_chain({.segments = 4, .markers_per_segment = 4, .frames = 40});
  for (int f = 0; f < 40; ++f) {
    for (const int k : {8, 9, 10, 11, 13, 14}) hide(limb.samples, f, k);
  }
  ChainSolver solver(known_geometry(limb, 0.001));
  ChainFrame frame;
  int determined = 0;  // of joint 1: the mirror of joint 2 moves it a little
  for (int f = 0; f < 40; ++f) {
    solver.solve(limb.samples.frame(f), nullptr, frame);
    EXPECT_EQ(frame.state[0], CentreState::determined);
    if (frame.state[1] == CentreState::determined) ++determined;
    EXPECT_NE(frame.state[2], CentreState::determined) << f;
  }
  EXPECT_GE(determined, 36);
}

TEST(ChainSolver, CovarianceIsThatOfRepeatedNoise) {
  for (const SegmentKind kind : {SegmentKind::line, SegmentKind::solid}) {
    RandomChain limb = make_random_chain({.frames = 1, .kind = kind, .noise_sd_m = 0.0});
    ChainSolver solver(known_geometry(limb, 0.001));
    ChainFrame frame;
    Random random(21, 1);
    Matrix3d scatter = Matrix3d::Zero();
    Matrix3d claimed = Matrix3d::Zero();
    const int n = 1500;
    for (int round = 0; round < n; ++round) {
      ChainSamples noisy = limb.samples;
      for (double& x : noisy.x) x += 0.001 * random.gaussian();
      solver.solve(noisy.frame(0), &limb.pose[0], frame);
      const Vector3d error = frame.centre[0] - limb.pose[0].joint0;
      scatter += error * error.transpose() / n;
      claimed += frame.own_covariance[0] / n;
    }
    EXPECT_NEAR(scatter.trace() / claimed.trace(), 1.0, 0.08);
    EXPECT_LT((scatter - claimed).norm() / claimed.norm(), 0.15);
  }
}

TEST(ChainSolver, InformationIsTheInverseOfTheOwnCovariance) {
  const RandomChain limb = make_random_chain({.frames = 1});
  ChainSolver solver(known_geometry(limb, 0.001));
  ChainFrame frame;
  solver.solve(limb.samples.frame(0), nullptr, frame);
  EXPECT_LT((frame.information[0] * frame.own_covariance[0] - Matrix3d::Identity()).norm(), 1e-6);
}

TEST(ChainSolver, APathPicksTheMirror) {
  RandomChain limb = make_random_chain({.frames = 1});
  for (const int k : {0, 3, 4}) hide(limb.samples, 0, k);
  ChainSolver solver(known_geometry(limb, 0.001));
  ChainFrame frame;
  solver.solve(limb.samples.frame(0), nullptr, frame);
  EXPECT_EQ(frame.state[0], CentreState::ambiguous);
  const Vector3d near = limb.pose[0].joint0 + Vector3d(0.004, -0.003, 0.002);
  ChainPose start;
  solver.pose_from_centres(limb.samples.frame(0), {&near, 1}, start);
  const JointPrior path{.joint = 0, .target = near, .weight = 0.01 * Matrix3d::Identity()};
  solver.solve_near(limb.samples.frame(0), start, {&path, 1}, frame);
  EXPECT_EQ(frame.state[0], CentreState::bridged);
  EXPECT_LT((frame.centre[0] - limb.pose[0].joint0).norm(), 0.01);
}

TEST(ChainSolver, AnEmptyFrameIsUndetermined) {
  RandomChain limb = make_random_chain({.frames = 1});
  for (int k = 0; k < 6; ++k) hide(limb.samples, 0, k);
  ChainSolver solver(known_geometry(limb, 0.001));
  ChainFrame frame;
  solver.solve(limb.samples.frame(0), nullptr, frame);
  EXPECT_EQ(frame.mode_count, 0);
  EXPECT_EQ(frame.state[0], CentreState::undetermined);
  EXPECT_TRUE(std::isnan(frame.centre[0][0]));
}

TEST(ChainSolver, RobustWeightsHoldAgainstAnOutlier) {
  RandomChain limb = make_random_chain({.markers_per_segment = 6, .frames = 1, .noise_sd_m = 0.0005});
  for (int i = 0; i < 3; ++i) limb.samples.x[3 * 4 + static_cast<std::size_t>(i)] += 0.05;
  ChainFit fit = known_geometry(limb, 0.0005);
  ChainFrame frame;
  ChainSolver(fit).solve(limb.samples.frame(0), nullptr, frame);
  const double plain = (frame.centre[0] - limb.pose[0].joint0).norm();
  fit.robust_dof = 4.0;
  ChainSolver(fit).solve(limb.samples.frame(0), nullptr, frame);
  EXPECT_LT((frame.centre[0] - limb.pose[0].joint0).norm(), 0.3 * plain);
}

TEST(FitChain, EstimatesTheNoise) {
  for (const SegmentKind kind : {SegmentKind::line, SegmentKind::solid}) {
    const RandomChain limb =
        make_random_chain({.frames = 300, .kind = kind, .noise_sd_m = 0.002, .missing = 0.2});
    const auto fit = fit_chain(limb.samples, limb.chain.layout, of_kind(kind));
    ASSERT_TRUE(fit.has_value());
    EXPECT_NEAR(fit->noise_sd_m, 0.002, 0.00012);
    EXPECT_NEAR(fit->chi2 / fit->residual_dof, 1.0, 1e-6);
  }
}

TEST(FitChain, RaisesANoiseThatWasGivenTooSmall) {
  const RandomChain limb = make_random_chain({.noise_sd_m = 0.003});
  ChainFitOptions options = of_kind(SegmentKind::solid);
  options.noise_sd_m = 0.001;
  EXPECT_NEAR(fit_chain(limb.samples, limb.chain.layout, options)->noise_sd_m, 0.003, 0.0003);
}

TEST(FitChain, FindsTheMarkerThatIsNoisier) {
  RandomChain limb = make_random_chain({.markers_per_segment = 6, .frames = 300});
  Random random(31, 1);
  for (std::int64_t f = 0; f < 300; ++f) {
    for (std::size_t i = 0; i < 3; ++i)
      limb.samples.x[static_cast<std::size_t>(f) * 36 + 6 + i] += 0.004 * random.gaussian();
  }
  ChainFitOptions options = of_kind(SegmentKind::solid);
  options.marker_noise = true;
  const auto fit = fit_chain(limb.samples, limb.chain.layout, options);
  ASSERT_TRUE(fit.has_value());
  std::vector<double> sorted = fit->marker_weight;
  std::sort(sorted.begin(), sorted.end());
  for (int k = 0; k < 12; ++k) {
    const double weight = fit->marker_weight[k] / sorted[6];
    if (k == 2) {
      EXPECT_LT(weight, 0.2);
    } else {
      EXPECT_NEAR(weight, 1.0, 0.35) << k;
    }
  }
}

TEST(FitChain, LengthsCarryTheirStandardDeviation) {
  double squares = 0.0;
  for (std::uint64_t seed = 1; seed <= 8; ++seed) {
    const RandomChain limb = make_random_chain({.segments = 3, .frames = 80, .seed = seed});
    const auto fit = fit_chain(limb.samples, limb.chain.layout, of_kind(SegmentKind::solid, 3));
    ASSERT_TRUE(fit.has_value());
    ASSERT_EQ(fit->lengths().size(), 1u);
    const auto length = fit->lengths()[0];
    EXPECT_EQ(length.segment, 1);
    EXPECT_LT(length.sd_m, 0.001);
    squares += std::pow((length.length_m - 0.150) / length.sd_m, 2) / 8.0;
    EXPECT_GT(fit->joint_covariance(1, true).trace(), 0.0);
    EXPECT_LT(fit->joint_covariance(1, false).trace(), 1e-6);
  }
  EXPECT_GT(squares, 0.15);
  EXPECT_LT(squares, 2.6);
}

TEST(FitChain, OneMarkerOnTheLastSegmentIsEnough) {
  RandomChain limb = make_random_chain({.frames = 200});
  limb.chain.layout.segment_of_marker = {0, 0, 0, 1};
  ChainSamples four{.frames = 200, .markers = 4, .x = {}};
  for (int f = 0; f < 200; ++f)
    four.x.insert(four.x.end(), limb.samples.frame(f), limb.samples.frame(f) + 12);
  const auto fit = fit_chain(four, limb.chain.layout);
  ASSERT_TRUE(fit.has_value()) << fit.error().message;
  ChainSolver solver(*fit);
  ChainFrame frame;
  double squares = 0.0;
  for (int f = 0; f < 200; ++f) {
    solver.solve(four.frame(f), nullptr, frame);
    squares += (frame.centre[0] - limb.pose[f].joint0).squaredNorm() / 200.0;
  }
  EXPECT_LT(std::sqrt(squares), 0.005);
}

TEST(FitChain, SaysWhatIsMissing) {
  RandomChain limb = make_random_chain({.frames = 30});
  ChainLayout bare{.parent = {0}, .segment_of_marker = {0, 0, 0, 0, 0, 0}};
  EXPECT_THAT(fit_chain(limb.samples, bare).error().message, HasSubstr("segment 1 has no marker"));
  for (int f = 0; f < 30; ++f) hide(limb.samples, f, f % 2);  // markers 0 and 1 are never seen together
  const auto fit = fit_chain(limb.samples, limb.chain.layout, of_kind(SegmentKind::solid));
  ASSERT_FALSE(fit.has_value());
  EXPECT_THAT(fit.error().message, HasSubstr("seen together"));
}

TEST(FitChain, LeavesOutAMarkerThatIsNeverSeen) {
  RandomChain limb = make_random_chain({.markers_per_segment = 5});
  for (int f = 0; f < 200; ++f) hide(limb.samples, f, 3);
  const auto fit = fit_chain(limb.samples, limb.chain.layout, of_kind(SegmentKind::solid));
  ASSERT_TRUE(fit.has_value()) << fit.error().message;
  EXPECT_EQ(fit->marker_weight[3], 0.0);
  EXPECT_THAT(fit->warnings, testing::Contains(HasSubstr("Marker 3")));
  EXPECT_NEAR(fit->noise_sd_m, 0.001, 1e-4);
  for (const bool in_parent : {true, false}) {
    const Matrix3d C = fit->joint_covariance(0, in_parent);
    EXPECT_TRUE(C.allFinite());
    EXPECT_LT(C.trace(), 0.001 * 0.001) << "200 frames of 1 mm";
  }
}

TEST(ChooseKinds, FindsLinesPlanesAndSolids) {
  for (const SegmentKind kind : {SegmentKind::line, SegmentKind::plane, SegmentKind::solid}) {
    const RandomChain limb = make_random_chain({.frames = 120, .kind = kind});
    const auto chosen = choose_kinds(limb.samples, limb.chain.layout, 0.0);
    ASSERT_TRUE(chosen.has_value());
    EXPECT_THAT(*chosen, Each(kind)) << data::to_string(kind);
  }
}

// 60 % missing leaves few frames or none with both segments whole.
TEST(ChooseKinds, SolidsStaySolidWhereNoFrameShowsBothSegments) {
  RandomChain limb = make_random_chain({.frames = 100, .noise_sd_m = 0.002});
  for (int f = 0; f < 100; ++f) hide(limb.samples, f, f % 2 == 0 ? (f / 2) % 3 : 3 + (f / 2) % 3);
  const auto chosen = choose_kinds(limb.samples, limb.chain.layout, 0.0);
  ASSERT_TRUE(chosen.has_value()) << chosen.error().message;
  EXPECT_THAT(*chosen, Each(SegmentKind::solid));
  const auto fit = fit_chain(limb.samples, limb.chain.layout);
  ASSERT_TRUE(fit.has_value()) << fit.error().message;
  EXPECT_NEAR(fit->noise_sd_m, 0.002, 0.0003);
}

TEST(ChooseKinds, TakesTheLineWhereNoiseHidesTheStagger) {
  const RandomChain limb = make_random_chain({.frames = 150, .stagger_m = 0.002, .noise_sd_m = 0.003});
  EXPECT_THAT(choose_kinds(limb.samples, limb.chain.layout, 0.003).value(),
              ElementsAre(SegmentKind::line, SegmentKind::line));
}

TEST(AcrossLine, IsANormalDeviateForALine) {
  const RandomChain line = make_random_chain({.frames = 300, .kind = SegmentKind::line});
  const RandomChain solid = make_random_chain({.frames = 300, .stagger_m = 0.005});
  EXPECT_LT(std::abs(across_line(line.samples, std::vector<int>{0, 1, 2}, 0.001)), 3.0);
  EXPECT_GT(across_line(solid.samples, std::vector<int>{0, 1, 2}, 0.001), 50.0);
  EXPECT_EQ(across_line(line.samples, std::vector<int>{0, 1}, 0.001), 0.0);
}

// Turns that the noise nearly hides fit it: residuals come out too small, shapes too wide.
TEST(Bootstrap, SeesWhatWeakTurnsDo) {
  const RandomChain weak = make_random_chain({.frames = 150, .stagger_m = 0.004, .noise_sd_m = 0.003});
  const RandomChain firm = make_random_chain({.frames = 150});
  EXPECT_TRUE(has_weak_turns(weak.chain, 0.003));
  EXPECT_FALSE(has_weak_turns(firm.chain, 0.001));
  GlobalFrames frames;
  for (int f = 0; f < 150; ++f) {
    frames.frame.push_back(f);
    frames.pose.push_back(weak.pose[f]);
    frames.weight.emplace_back(6, 1.0);
  }
  const Bootstrap found = bootstrap(weak.samples, frames, known_geometry(weak, 0.003), 1);
  EXPECT_LT(found.chi2_ratio, 0.97);
  EXPECT_GT(found.variance_ratio, 0.9);
  Chain wider = weak.chain;
  wider.add_globals(found.bias);
  EXPECT_GT(wider.marker.topRows<2>().norm(), weak.chain.marker.topRows<2>().norm());
}

}  // namespace
}  // namespace kinemark::skeleton
