// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/skeleton/articulated/geometry/fit_chain.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "kinemark/math/euler.h"
#include "kinemark/stages/skeleton/articulated/frame/chain_solver.h"
#include "kinemark/stages/skeleton/articulated/testing/random_chain.h"

namespace kinemark::skeleton::articulated {
namespace {

using data::CentreState;
using data::SegmentKind;
using testing::Contains;
using testing::HasSubstr;
using testing::IsEmpty;
using testing_limbs::hide;
using testing_limbs::make_random_chain;
using testing_limbs::move_lab;
using testing_limbs::RandomChain;
using testing_limbs::redraw;

ChainFitOptions of_kind(SegmentKind kind, int segments = 2) {
  ChainFitOptions options;
  options.kind.assign(segments, kind);
  return options;
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
    EXPECT_THAT(fit->warnings, IsEmpty());
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

TEST(FitChain, AnyNumberOfThreadsGivesTheSameBits) {
  for (const SegmentKind kind : {SegmentKind::line, SegmentKind::solid}) {
    const RandomChain limb =
        make_random_chain({.segments = 3, .frames = 200, .kind = kind, .noise_sd_m = 0.002, .missing = 0.2});
    ChainFitOptions options = of_kind(kind, 3);
    const auto one = fit_chain(limb.samples, limb.chain.layout, options);
    options.threads = 3;
    const auto three = fit_chain(limb.samples, limb.chain.layout, options);
    ASSERT_TRUE(one && three);
    EXPECT_EQ(one->chain.marker, three->chain.marker);
    EXPECT_EQ(one->chain.joint, three->chain.joint);
    EXPECT_EQ(one->geometry_covariance, three->geometry_covariance);
    EXPECT_EQ(one->noise_sd_m, three->noise_sd_m);
  }
}

TEST(FitChain, AGeometryThatIsNoBodysIsNotRefined) {
  const RandomChain limb = make_random_chain({.frames = 200, .noise_sd_m = 0.01});
  bool said = false;
  const auto steps = [&](const ChainFitOptions& options) {
    int asked = 0;
    const auto fit = fit_chain(limb.samples, limb.chain.layout, options, [&](std::int64_t, std::int64_t) {
      ++asked;
      return true;
    });
    EXPECT_NEAR(fit->noise_sd_m, 0.01, 0.001);
    EXPECT_EQ(fit->refined, fit->warnings.empty());
    said = std::ranges::any_of(fit->warnings, [](const auto& w) {
      return w.contains("so far from what is expected that it was not refined");
    });
    return asked;
  };
  const ChainFitOptions whole = of_kind(SegmentKind::solid);
  ChainFitOptions loose = whole, noisy = whole, far = whole, changing = whole;
  loose.most_noise_m = 0.02;
  loose.most_reach_m = 0.5;
  loose.most_change_m = 0.1;
  noisy.most_noise_m = 0.005;
  far.most_reach_m = 0.01;
  changing.most_change_m = 0.002;
  const int all = steps(whole);
  EXPECT_FALSE(said);
  EXPECT_EQ(steps(loose), all);
  EXPECT_FALSE(said);
  EXPECT_LT(steps(noisy), all);
  EXPECT_TRUE(said);
  EXPECT_LT(steps(far), all);
  EXPECT_TRUE(said);
  EXPECT_LT(steps(changing), all);
  EXPECT_TRUE(said);
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
  EXPECT_THAT(fit->warnings,
              Contains("Marker 3 is not seen together with three others of its segment in three "
                       "frames; it was left out."));
  EXPECT_NEAR(fit->noise_sd_m, 0.001, 1e-4);
  for (const bool in_parent : {true, false}) {
    const Matrix3d C = fit->joint_covariance(0, in_parent);
    EXPECT_TRUE(C.allFinite());
    EXPECT_LT(C.trace(), 0.001 * 0.001) << "200 frames of 1 mm";
  }
}

TEST(FitChain, FewFramesThatShowAllAreSaidToBeFew) {
  RandomChain limb = make_random_chain({.segments = 3, .frames = 60});
  for (int f = 12; f < 60; ++f)
    for (int m = 0; m < 6; ++m) hide(limb.samples, f, m + (f % 2 == 0 ? 0 : 3));  // one end of the limb alone
  const auto fit = fit_chain(limb.samples, limb.chain.layout, of_kind(SegmentKind::solid, 3));
  ASSERT_TRUE(fit.has_value()) << fit.error().message;
  EXPECT_THAT(
      fit->warnings,
      Contains(HasSubstr("Fewer than 20 of the frames that are used determine all joints by themselves")));
}

// The joint hardly moves: a joint on the other side of the markers' plane explains the frames as well.
TEST(FitChain, AJointThatHardlyMovesHasAMirror) {
  RandomChain limb = make_random_chain({.frames = 60});
  Random random(4, 4);
  for (ChainPose& pose : limb.pose) {
    Vector3d turn;
    for (double& rad : turn) rad = 0.02 * random.gaussian();
    pose.rotation[1] = pose.rotation[0] * math::exp_so3(turn);
  }
  redraw(limb, 0.001, 3);
  const auto fit = fit_chain(limb.samples, limb.chain.layout, of_kind(SegmentKind::solid));
  ASSERT_TRUE(fit.has_value()) << fit.error().message;
  EXPECT_THAT(fit->warnings,
              Contains("A mirrored geometry fits nearly as well; which side of its markers a joint "
                       "lies on is not known."));
}

// Lengths and shapes are the limb's, wherever the lab's axes are; only rounding differs.
TEST(FitChain, DoesNotChangeWithTheLab) {
  RandomChain limb = make_random_chain({.segments = 3, .frames = 80, .missing = 0.1});
  const auto here = fit_chain(limb.samples, limb.chain.layout, of_kind(SegmentKind::solid, 3));
  move_lab(limb, math::exp_so3({1.1, 0.2, -0.6}), {1.0, 2.0, 0.3});
  const auto there = fit_chain(limb.samples, limb.chain.layout, of_kind(SegmentKind::solid, 3));
  ASSERT_TRUE(here && there);
  EXPECT_NEAR(here->noise_sd_m, there->noise_sd_m, 1e-6);
  EXPECT_NEAR(here->lengths()[0].length_m, there->lengths()[0].length_m, 2e-5);
  EXPECT_NEAR(here->lengths()[0].sd_m, there->lengths()[0].sd_m, 1e-5);
}

TEST(FitChain, TheErrorOfALengthFallsWithTheFrames) {
  const auto sd_of = [](int frames) {
    const RandomChain limb = make_random_chain({.segments = 3, .frames = frames});
    return fit_chain(limb.samples, limb.chain.layout, of_kind(SegmentKind::solid, 3))->lengths()[0].sd_m;
  };
  EXPECT_NEAR(sd_of(60) / sd_of(240), 2.0, 0.3);
}

TEST(FitChain, StopsWhenAskedAndWantsFiveFrames) {
  const RandomChain limb = make_random_chain({.frames = 60});
  int asked = 0;
  const auto stop = [&asked](std::int64_t, std::int64_t) { return ++asked < 3; };
  const auto stopped = fit_chain(limb.samples, limb.chain.layout, of_kind(SegmentKind::solid), stop);
  ASSERT_FALSE(stopped.has_value());
  EXPECT_EQ(stopped.error().code, Code::cancelled);
  EXPECT_EQ(asked, 3);
  const RandomChain few = make_random_chain({.frames = 4});
  EXPECT_THAT(fit_chain(few.samples, few.chain.layout, of_kind(SegmentKind::solid)).error().message,
              HasSubstr("fewer than five frames"));
}

}  // namespace
}  // namespace kinemark::skeleton::articulated
