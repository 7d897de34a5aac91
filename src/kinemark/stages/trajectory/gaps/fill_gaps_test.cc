// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/trajectory/gaps/fill_gaps.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <limits>

#include "kinemark/core/random.h"
#include "kinemark/math/symmetric3.h"
#include "kinemark/stages/trajectory/gaps/candidates.h"
#include "kinemark/stages/trajectory/gaps/testing/moving_bodies.h"

namespace kinemark::trajectory {
namespace {

using data::SampleState;
using data::Trajectories;
using ::testing::AnyOf;
using ::testing::HasSubstr;
using testing::hide;
using testing::moving_bodies;
using ::testing::Not;
using testing::rms_between;

constexpr double kNoiseM = 2e-4;
constexpr double kInfinity = std::numeric_limits<double>::infinity();

GapResult fill(const Trajectories& t, const GapOptions& options = {}) {
  auto result = fill_gaps(t, options);
  EXPECT_TRUE(result) << result.error().message;
  return std::move(*result);
}

const data::GapAccount& only_gap(const GapResult& r) {
  EXPECT_EQ(r.gaps.size(), 1U);
  return r.gaps.front();
}

TEST(FillGaps, RecoversAMarkerOfARigidBodyToTheNoise) {
  const Trajectories clean = moving_bodies({});
  Trajectories t = moving_bodies({.noise_m = kNoiseM});
  hide(t, 2, 200, 299);
  for (const GapMethod method : {GapMethod::automatic, GapMethod::regression, GapMethod::rigid}) {
    const GapResult r = fill(t, {.method = method});
    EXPECT_TRUE(only_gap(r).filled) << only_gap(r).why_open;
    EXPECT_LT(rms_between(r.trajectories, clean, 2, 200, 299), 2.5 * kNoiseM) << to_string(method);
    EXPECT_LT(only_gap(r).sd_m, 4.0 * kNoiseM);
  }
  EXPECT_GT(rms_between(fill(t, {.method = GapMethod::cubic, .max_sd_m = kInfinity}).trajectories, clean, 2,
                        200, 299),
            0.02);
}

TEST(FillGaps, SaysHowEverySampleWasMadeAndHowSureItIs) {
  Trajectories t = moving_bodies({.noise_m = kNoiseM});
  hide(t, 1, 300, 305);
  hide(t, 7, 100, 149);
  const GapResult r = fill(t);
  EXPECT_EQ(r.filled_frames(), 56);
  EXPECT_EQ(r.trajectories.count_missing(), 0);
  EXPECT_TRUE(r.trajectories.validate());
  EXPECT_EQ(r.trajectories.state[r.trajectories.index(120, 7)], SampleState::model_filled);
  EXPECT_EQ(r.trajectories.made_by(120, 7), "auto");
  EXPECT_EQ(r.trajectories.made_by(99, 7), "");
  ASSERT_EQ(r.trajectories.covariance.size(), 6U * 600U * 10U);
  for (std::int64_t f = 0; f < 600; ++f)
    for (const std::size_t c : math::kSymmetric3Diagonal) {
      const double v = r.trajectories.covariance[6 * r.trajectories.index(f, 7) + c];
      EXPECT_GT(v, 0.1 * kNoiseM * kNoiseM);
      EXPECT_LT(v, 1e-5);
    }
  const data::GapAccount& account = r.gaps.back();
  EXPECT_EQ(account.marker, 7);
  EXPECT_EQ(account.first_frame, 100);
  EXPECT_EQ(account.last_frame, 149);
  EXPECT_GE(account.windows, 8);
  EXPECT_DOUBLE_EQ(account.window_s, 0.5);
  ASSERT_GE(account.predictors.size(), 4U);
  for (std::size_t k = 0; k < 4; ++k)
    EXPECT_EQ(account.predictors[k].substr(0, 2), "b1");  // its own body first
  double sum = 0.0;
  for (const data::GapWeight& c : account.weights) sum += c.weight;
  EXPECT_NEAR(sum, 1.0, 1e-12);
  const GapResult linear = fill(t, {.method = GapMethod::linear, .max_sd_m = kInfinity});
  EXPECT_EQ(linear.trajectories.state[linear.trajectories.index(120, 7)], SampleState::interpolated);
  EXPECT_EQ(linear.trajectories.made_by(120, 7), "linear");
}

TEST(FillGaps, NeverTouchesWhatIsThere) {
  Trajectories t = moving_bodies({.noise_m = kNoiseM});
  hide(t, 0, 50, 90);
  hide(t, 6, 400, 470);
  t.covariance.assign(2 * t.x_in_world.size(), 1e-9);
  const GapResult r = fill(t);
  for (std::int64_t f = 0; f < t.frames(); ++f)
    for (std::int64_t m = 0; m < t.markers(); ++m) {
      if (!t.present(f, m)) continue;
      EXPECT_EQ(r.trajectories.x(f, m), t.x(f, m));
      EXPECT_EQ(r.trajectories.state[t.index(f, m)], SampleState::measured);
      EXPECT_EQ(r.trajectories.covariance[6 * t.index(f, m)], 1e-9);
    }
}

TEST(FillGaps, WhatIsLeftAloneIsNeitherFilledNorLearnedFrom) {
  Trajectories t = moving_bodies({.noise_m = kNoiseM});
  hide(t, 1, 300, 305);
  hide(t, 2, 400, 405);
  const GapResult r = fill(t, {.leave = {2}});
  EXPECT_EQ(only_gap(r).marker, 1);
  EXPECT_FALSE(r.trajectories.present(402, 2));
  EXPECT_THAT(only_gap(r).predictors, Not(::testing::Contains(t.names[2])));
  EXPECT_THAT(fill(t).gaps.front().predictors, ::testing::Contains(t.names[2]))
      << "the nearest neighbour else";
  EXPECT_TRUE(std::isnan(r.trajectories.covariance[6 * r.trajectories.index(0, 2)]))
      << "nobody says how it errs";
  EXPECT_GT(r.trajectories.covariance[6 * r.trajectories.index(0, 1)], 0.0);
}

TEST(FillGaps, MovesWithTheLab) {
  Trajectories t = moving_bodies({.noise_m = kNoiseM});
  hide(t, 3, 250, 320);
  const Eigen::Matrix3d R =
      Eigen::AngleAxisd(1.1, Eigen::Vector3d(1.0, -2.0, 0.5).normalized()).toRotationMatrix();
  const Eigen::Vector3d p(3.0, -1.0, 0.7);
  Trajectories moved = t;
  for (std::int64_t f = 0; f < t.frames(); ++f)
    for (std::int64_t m = 0; m < t.markers(); ++m)
      if (t.present(f, m)) moved.x(f, m) = R * t.x(f, m) + p;
  const GapResult a = fill(t);
  const GapResult b = fill(moved);
  for (std::int64_t f = 250; f <= 320; ++f)
    EXPECT_LT((R * a.trajectories.x(f, 3) + p - b.trajectories.x(f, 3)).norm(), 1e-7) << f;
  EXPECT_NEAR(only_gap(a).sd_m, only_gap(b).sd_m, 1e-7);
}

TEST(FillGaps, DoesNotDependOnTheOrderOfTheMarkers) {
  Trajectories t = moving_bodies({.noise_m = kNoiseM});
  hide(t, 3, 250, 320);
  Trajectories permuted = t;
  const auto other = [&](std::int64_t m) { return t.markers() - 1 - m; };
  for (std::int64_t m = 0; m < t.markers(); ++m) {
    permuted.names[static_cast<std::size_t>(other(m))] = t.names[static_cast<std::size_t>(m)];
    for (std::int64_t f = 0; f < t.frames(); ++f) {
      permuted.x(f, other(m)) = t.x(f, m);
      permuted.state[t.index(f, other(m))] = t.state[t.index(f, m)];
    }
  }
  const GapResult a = fill(t);
  const GapResult b = fill(permuted);
  for (std::int64_t f = 250; f <= 320; ++f)
    EXPECT_LT((a.trajectories.x(f, 3) - b.trajectories.x(f, other(3))).norm(), 1e-9) << f;
}

TEST(FillGaps, SameBitsForAnyNumberOfThreads) {
  Trajectories t = moving_bodies({.noise_m = kNoiseM});
  for (std::int64_t m = 0; m < t.markers(); ++m) hide(t, m, 50 * m + 20, 50 * m + 30 + 4 * m);
  const GapResult one = fill(t, {.threads = 1});
  const GapResult many = fill(t, {.threads = 3});
  EXPECT_EQ(one.trajectories.x_in_world, many.trajectories.x_in_world);
  EXPECT_EQ(one.trajectories.covariance, many.trajectories.covariance);
}

TEST(FillGaps, SdGrowsIntoTheGapAndWithItsLength) {
  Trajectories t = moving_bodies({.bodies = 1, .noise_m = kNoiseM});
  double before = 0.0;
  for (const std::int64_t length : {20, 60, 180}) {
    Trajectories g = t;
    hide(g, 0, 250, 249 + length);
    const auto all = compare_candidates(g, 0, 250, 249 + length).value();
    const GapResult r = fill(g, {.method = GapMethod::walk, .max_sd_m = kInfinity});
    EXPECT_GT(only_gap(r).sd_m, 1.3 * before);
    before = only_gap(r).sd_m;
    const auto variance = [&](std::int64_t f) {
      return r.trajectories.covariance[6 * r.trajectories.index(f, 0)];
    };
    EXPECT_GT(variance(250 + length / 2), variance(250));
    EXPECT_GT(variance(250 + length / 2), variance(249 + length));
    EXPECT_LT(all.sd_m.maxCoeff(), std::sqrt(variance(250 + length / 2)));
  }
}

TEST(FillGaps, SdCoversTheErrors) {
  const Trajectories clean = moving_bodies({.frames = 2000});
  const Trajectories noisy = moving_bodies({.frames = 2000, .noise_m = 1e-3});
  double inside_1 = 0.0;
  double inside_2 = 0.0;
  double n = 0.0;
  for (std::int64_t k = 0; k < 30; ++k) {
    Trajectories t = noisy;
    const std::int64_t first = 60 + 61 * k;
    const std::int64_t m = k % 10;
    hide(t, m, first, first + 49);
    const GapResult r = fill(t, {.method = GapMethod::regression});
    for (std::int64_t f = first; f < first + 50; f += 5)
      for (int axis = 0; axis < 3; ++axis) {
        const double z = std::abs(r.trajectories.x(f, m)(axis) - noisy.x(f, m)(axis)) /
                         std::sqrt(r.trajectories.covariance[6 * t.index(f, m)]);
        inside_1 += z < 1.0 ? 1.0 : 0.0;
        inside_2 += z < 2.0 ? 1.0 : 0.0;
        n += 1.0;
      }
  }
  EXPECT_GT(inside_1 / n, 0.62);
  EXPECT_LT(inside_1 / n, 0.90);
  EXPECT_GT(inside_2 / n, 0.90);
}

TEST(FillGaps, LeavesOpenWhatIsTooLongOrTooUncertain) {
  Trajectories t = moving_bodies({.bodies = 1, .noise_m = kNoiseM});
  for (std::int64_t m = 0; m < 5; ++m) hide(t, m, 200, 320);  // everything gone for 1.21 s
  const GapResult uncertain = fill(t);
  EXPECT_EQ(uncertain.filled_frames(), 0);
  EXPECT_THAT(uncertain.gaps.front().why_open, HasSubstr("its standard deviation would be"));
  EXPECT_GT(uncertain.gaps.front().sd_m, 0.02);
  const GapResult longer = fill(t, {.max_gap_s = 1.0});
  EXPECT_THAT(longer.gaps.front().why_open, HasSubstr("1.21 s long; at most 1 s are filled"));
  EXPECT_THAT(longer.gaps.front().why_open, Not(HasSubstr("its standard deviation would be")));
  EXPECT_THAT(uncertain.gaps.front().why_open,
              Not(AnyOf(HasSubstr("s long; at most"), HasSubstr("frames long; at most"),
                        HasSubstr("too few complete spans to learn from"),
                        HasSubstr("so that its standard deviation is unknown"),
                        HasSubstr("the predicted path is not finite"))));
  EXPECT_EQ(longer.trajectories.count_missing(), t.count_missing());
  EXPECT_EQ(fill(t, {.max_sd_m = kInfinity}).filled_frames(), 5 * 121);
}

TEST(FillGaps, FillsTheEndsOfARecordingFromTheNeighboursOnly) {
  const Trajectories clean = moving_bodies({});
  Trajectories t = moving_bodies({.noise_m = kNoiseM});
  hide(t, 1, 0, 59);
  hide(t, 2, 540, 599);
  const GapResult r = fill(t);
  EXPECT_EQ(r.trajectories.count_missing(), 0);
  EXPECT_TRUE(r.gaps[0].at_edge);
  EXPECT_LT(rms_between(r.trajectories, clean, 1, 0, 59), 3.0 * kNoiseM);
  EXPECT_LT(rms_between(r.trajectories, clean, 2, 540, 599), 3.0 * kNoiseM);

  Trajectories alone = Trajectories::all_missing({"alone"}, t.time);
  for (std::int64_t f = 5; f < 560; ++f) {
    alone.x(f, 0) = clean.x(f, 0);
    alone.state[alone.index(f, 0)] = SampleState::measured;
  }
  const GapResult edge = fill(alone, {.max_sd_m = kInfinity});
  EXPECT_TRUE(edge.gaps[0].filled);  // 0.05 s at the start
  EXPECT_THAT(edge.gaps[1].why_open,
              HasSubstr("no sample on one side and no neighbours to learn from; at most"));
  EXPECT_THAT(edge.gaps[1].why_open, Not(HasSubstr("the method uses no neighbours")));
}

TEST(FillGaps, AMethodWithoutNeighboursDoesNotMissThem) {
  Trajectories t = moving_bodies({.noise_m = kNoiseM});
  hide(t, 2, 540, 599);
  const GapResult edge = fill(t, {.method = GapMethod::cubic, .max_sd_m = kInfinity});
  EXPECT_THAT(only_gap(edge).why_open,
              HasSubstr("no sample on one side, and the method uses no neighbours; at most 0.1 s"));
  EXPECT_THAT(only_gap(edge).why_open, Not(HasSubstr("no neighbours to learn from")));
}

TEST(FillGaps, SaysWhatThereIsNothingToPredictFrom) {
  // One marker; what is beside its gap was made by somebody else.
  Trajectories t = Trajectories::all_missing({"alone"}, {.rate_hz = 100.0, .frames = 300});
  const Trajectories bodies = moving_bodies({.frames = 300, .noise_m = kNoiseM});
  for (std::int64_t f = 0; f < 300; ++f) {
    t.x(f, 0) = bodies.x(f, 0);
    t.state[t.index(f, 0)] = SampleState::measured;
  }
  hide(t, 0, 100, 109);
  const auto why = [](const Trajectories& in, GapMethod method) {
    return only_gap(fill(in, {.method = method, .max_sd_m = kInfinity})).why_open;
  };
  const std::string samples = why(t, GapMethod::regression);
  EXPECT_EQ(samples, "no neighbours to learn from");
  EXPECT_THAT(samples, Not(HasSubstr("no sample beside it to predict from")));
  for (const std::int64_t f : {99, 110}) t.state[t.index(f, 0)] = SampleState::interpolated;
  EXPECT_EQ(why(t, GapMethod::automatic),
            "no neighbours to learn from and no sample beside it to predict from");
  const std::string path = why(t, GapMethod::linear);
  EXPECT_EQ(path, "no sample beside it to predict from");
  EXPECT_THAT(path, Not(HasSubstr("no neighbours to learn from")));
}

TEST(FillGaps, FewSamplesHaveNothingToLearnFrom) {
  Trajectories t = moving_bodies({.frames = 40, .noise_m = kNoiseM});
  hide(t, 2, 8, 31);
  EXPECT_EQ(only_gap(fill(t, {.method = GapMethod::regression})).why_open,
            "too few complete spans to learn from");
  EXPECT_EQ(only_gap(fill(t)).why_open,
            "too few complete spans to learn from, so that its standard deviation is unknown");
}

TEST(FillGaps, SplitsAGapWhereTheNeighboursChangeAndTiesThePieces) {
  const Trajectories clean = moving_bodies({});
  Trajectories t = moving_bodies({.noise_m = kNoiseM});
  hide(t, 0, 200, 299);
  for (const std::int64_t m : {1, 2}) hide(t, m, 150, 240);   // first half: 3 and 4 are left of the body,
  for (const std::int64_t m : {3, 4}) hide(t, m, 246, 330);   // second half: 1 and 2
  for (std::int64_t m = 5; m < 7; ++m) hide(t, m, 150, 330);  // and of the other body three
  const GapResult r = fill(t, {.max_sd_m = kInfinity});
  EXPECT_EQ(r.trajectories.count_missing(), 0);
  double largest = 0.0;
  for (std::int64_t f = 199; f <= 299; ++f) {
    const Eigen::Vector3d step =
        r.trajectories.x(f + 1, 0) - r.trajectories.x(f, 0) - clean.x(f + 1, 0) + clean.x(f, 0);
    largest = std::max(largest, step.norm());
  }
  EXPECT_LT(largest, 0.01);
}

TEST(FillGaps, PiecesMeetWhereTheBodyIsSeenByTurns) {
  const Trajectories clean = moving_bodies({.bodies = 3});
  Trajectories t = moving_bodies({.bodies = 3, .noise_m = kNoiseM});
  hide(t, 10, 200, 299);
  for (std::int64_t m = 11; m < 15; ++m) hide(t, m, 180, 230);  // own body gone first, then the middle one
  for (std::int64_t m = 5; m < 10; ++m) hide(t, m, 231, 320);
  const GapResult r = fill(t, {.max_sd_m = kInfinity});
  int pieces = 0;
  for (const data::GapAccount& g : r.gaps) pieces += g.marker == 10 ? 1 : 0;
  EXPECT_EQ(pieces, 2);
  EXPECT_LT(rms_between(r.trajectories, clean, 10, 240, 299), 5e-3);  // with its own body
  const Eigen::Vector3d jump =
      r.trajectories.x(231, 10) - r.trajectories.x(230, 10) - clean.x(231, 10) + clean.x(230, 10);
  EXPECT_LT(jump.norm(), 3e-3);
}

TEST(FillGaps, FindsASwapInTheBodyAndIsNotMisledByIt) {
  const Trajectories clean = moving_bodies({});
  Trajectories t = moving_bodies({.noise_m = kNoiseM});
  for (std::int64_t f = 210; f < 290; ++f) {
    const Eigen::Vector3d x = t.x(f, 1);
    t.x(f, 1) = t.x(f, 2);
    t.x(f, 2) = x;
  }
  hide(t, 0, 230, 269);
  const GapResult r = fill(t);
  ASSERT_EQ(r.swaps.size(), 1U);
  EXPECT_EQ(r.swaps[0].kind, data::FindingKind::label_swap);
  EXPECT_EQ(r.swaps[0].subject, "b0m1");
  EXPECT_EQ(r.swaps[0].partner, "b0m2");
  EXPECT_NEAR(static_cast<double>(r.swaps[0].first_frame), 210.0, 1.0);
  EXPECT_NEAR(static_cast<double>(r.swaps[0].last_frame), 289.0, 1.0);
  EXPECT_THAT(r.swaps[0].description,
              HasSubstr("markers 'b0m1' and 'b0m2' have exchanged labels in frames 2"));
  EXPECT_EQ(r.trajectories.x(250, 1), t.x(250, 1));  // reported, not changed
  EXPECT_LT(rms_between(r.trajectories, clean, 0, 230, 269), 3.0 * kNoiseM);
  EXPECT_TRUE(fill(moving_bodies({.noise_m = kNoiseM})).swaps.empty());
}

TEST(FillGaps, SurvivesAndExplainsBadInput) {
  const TimeBase clock{.rate_hz = 100.0, .frames = 50};
  const GapResult missing = fill(Trajectories::all_missing({"a", "b"}, clock));
  EXPECT_EQ(missing.gaps.size(), 2U);
  EXPECT_EQ(missing.gaps[0].why_open, "the marker was never measured");
  EXPECT_TRUE(fill(Trajectories::all_missing({"a"}, {.rate_hz = 100.0, .frames = 1})).gaps.size() == 1);
  EXPECT_TRUE(fill(Trajectories::all_missing({"a"}, {.rate_hz = 100.0})).gaps.empty());
  EXPECT_TRUE(fill(Trajectories::all_missing({}, clock)).gaps.empty());

  Trajectories single = Trajectories::all_missing({"a"}, clock);  // one sample in the middle
  single.x(20, 0).setConstant(1.0);
  single.state[20] = SampleState::measured;
  const GapResult r = fill(single);
  EXPECT_EQ(r.trajectories.count_missing(), 49);
  ASSERT_EQ(r.gaps.size(), 2U);
  EXPECT_THAT(r.gaps[0].why_open, Not(HasSubstr("the marker was never measured")));

  Trajectories still = moving_bodies({.frames = 300});  // nothing moves, every matrix is singular
  for (std::int64_t f = 0; f < 300; ++f)
    for (std::int64_t m = 0; m < still.markers(); ++m) still.x(f, m) = still.x(0, m);
  const Trajectories constant = still;
  hide(still, 4, 100, 160);
  const GapResult filled = fill(still);
  EXPECT_TRUE(only_gap(filled).filled) << only_gap(filled).why_open;
  EXPECT_LT(rms_between(filled.trajectories, constant, 4, 100, 160), 1e-9);

  Trajectories infinite = moving_bodies({.frames = 50});
  infinite.x(3, 1)(0) = kInfinity;
  EXPECT_EQ(fill_gaps(infinite).error().code, Code::bad_input);
}

TEST(FillGaps, APathBeyondAllNumbersStaysOpen) {
  Trajectories t = moving_bodies({.noise_m = kNoiseM});
  for (std::int64_t f = 0; f < t.frames(); ++f) t.x(f, 2) *= 1e170;
  hide(t, 2, 200, 240);
  for (const GapMethod method : {GapMethod::automatic, GapMethod::cubic, GapMethod::regression}) {
    const GapResult r = fill(t, {.method = method, .max_sd_m = kInfinity});
    EXPECT_TRUE(r.trajectories.validate());
    EXPECT_TRUE(only_gap(r).filled || !only_gap(r).why_open.empty());
  }
  EXPECT_EQ(only_gap(fill(t, {.method = GapMethod::regression, .max_sd_m = kInfinity})).why_open,
            "the predicted path is not finite");
  EXPECT_EQ(only_gap(fill(t, {.method = GapMethod::cubic})).why_open, "its standard deviation is unknown");
}

TEST(FillGaps, AGapOfThousandsOfFramesIsTooLongForAnyLimit) {
  const auto why = [](std::int64_t frames) {
    Trajectories t = Trajectories::all_missing({"a"}, {.rate_hz = 100.0, .frames = frames + 2});
    for (const std::int64_t f : {std::int64_t{0}, frames + 1})
      t.state[t.index(f, 0)] = SampleState::measured, t.x(f, 0).setZero();
    return only_gap(fill(t, {.method = GapMethod::linear, .max_gap_s = 100.0, .max_sd_m = kInfinity}))
        .why_open;
  };
  EXPECT_EQ(why(4001), "4001 frames long; at most 4000 are filled");
  EXPECT_EQ(why(4000), "");
}

TEST(FillGaps, EveryMethodCopesWithEveryRaggedRecording) {
  Random random(11, 1);
  for (const int method : {1, 2, 3, 4, 5, 6, 7, 8}) {
    Trajectories t = moving_bodies({.frames = 160, .noise_m = kNoiseM, .seed = 4});
    for (std::int64_t m = 0; m < t.markers(); ++m)
      for (std::int64_t f = 0; f < t.frames();) {
        const auto length = static_cast<std::int64_t>(random.uniform(1.0, 40.0));
        if (random.uniform() < 0.4) hide(t, m, f, std::min(f + length, t.frames()) - 1);
        f += length;
      }
    const GapResult r = fill(t, {.method = static_cast<GapMethod>(method), .max_sd_m = kInfinity});
    EXPECT_TRUE(r.trajectories.validate()) << method;
    for (const data::GapAccount& g : r.gaps) EXPECT_NE(g.filled, !g.why_open.empty());
  }
}

TEST(FillGaps, DoesNothingUnlessAskedAndStopsWhenAsked) {
  Trajectories t = moving_bodies({.frames = 300});
  hide(t, 1, 100, 110);
  const GapResult r = fill(t, {.method = GapMethod::none});
  EXPECT_EQ(r.trajectories.count_missing(), 11);
  EXPECT_FALSE(only_gap(r).filled);
  EXPECT_EQ(only_gap(r).why_open, "filling was not asked for");
  hide(t, 1, 111, 280);
  EXPECT_THAT(only_gap(fill(t, {.max_gap_s = 1.0})).why_open, Not(HasSubstr("filling was not asked for")));
  const auto stopped = fill_gaps(t, {.progress = [](std::int64_t, std::int64_t) { return false; }});
  ASSERT_FALSE(stopped);
  EXPECT_EQ(stopped.error().code, Code::cancelled);
}

TEST(FillGaps, LeavesSamplesMadeByOthersAlone) {
  Trajectories t = moving_bodies({.noise_m = kNoiseM});
  hide(t, 0, 200, 230);
  for (std::int64_t f = 100; f < 120; ++f) t.state[t.index(f, 0)] = SampleState::interpolated;
  t.set_missing(300, 0, SampleState::rejected);
  const GapResult r = fill(t);
  EXPECT_EQ(r.gaps.size(), 2U);
  EXPECT_EQ(r.trajectories.state[t.index(110, 0)], SampleState::interpolated);
  EXPECT_EQ(r.trajectories.x(110, 0), t.x(110, 0));
  EXPECT_TRUE(r.trajectories.present(300, 0));  // rejected counts as missing
}

TEST(CompareCandidates, RefusesStretchesThatAreNoGap) {
  Trajectories t = moving_bodies({.frames = 300});
  hide(t, 1, 100, 110);
  EXPECT_TRUE(compare_candidates(t, 1, 100, 110));
  EXPECT_THAT(compare_candidates(t, 1, 99, 110).error().message, HasSubstr("not missing"));
  EXPECT_THAT(compare_candidates(t, 10, 0, 1).error().message, HasSubstr("10 markers"));
  EXPECT_EQ(compare_candidates(t, 1, 100, 110, {.max_gap_s = 0.0}).error().code, Code::usage);
}

TEST(FillGaps, ChosenGapsAreFilledAsAmongAll) {
  Trajectories t = moving_bodies({.noise_m = kNoiseM});
  hide(t, 1, 300, 305);
  hide(t, 1, 400, 405);
  hide(t, 7, 100, 149);
  const GapResult all = fill(t);
  const GapResult one = fill(t, {.only = {.marker = 1, .first_frame = 305, .last_frame = 399}});
  EXPECT_EQ(only_gap(one).first_frame, 300);
  EXPECT_EQ(rms_between(one.trajectories, all.trajectories, 1, 300, 305), 0.0);
  EXPECT_FALSE(one.trajectories.present(400, 1));
  EXPECT_FALSE(one.trajectories.present(100, 7));
  EXPECT_TRUE(fill(t, {.only = {.marker = 1, .first_frame = 306, .last_frame = 399}}).gaps.empty());
  EXPECT_EQ(fill(t, {.only = {.first_frame = 140, .last_frame = 300}}).gaps.size(), 2U) << "of all markers";
}

}  // namespace
}  // namespace kinemark::trajectory
