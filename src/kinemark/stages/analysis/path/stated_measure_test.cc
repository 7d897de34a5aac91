// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/analysis/path/stated_measure.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

namespace kinemark::analysis {
namespace {

const PathDefinition& definition(std::string_view id) {
  for (const auto& d : path_definitions())
    if (d.what.id == id) return d;
  throw std::invalid_argument("no such measure");
}

std::vector<double> around(double middle, double spread) {
  std::vector<double> out;
  for (int k = -49; k <= 49; ++k) out.push_back(middle + spread * k / 49.0);
  return out;
}

class StatedMeasure : public ::testing::Test {
 protected:
  StretchSummary stretch_{.subject = "RFIN",
                          .start_s = 0.0,
                          .end_s = 2.0,
                          .noise_sd_m = 1e-3,
                          .cut_off_hz = 5.0,
                          .order = 4,
                          .refits = 99};
  PathFrame frame_;

  data::Measure tell(std::string_view id, double estimate, double middle, double spread) {
    const auto deviations = around(middle, spread);
    const auto out = state_measure(definition(id), stretch_, frame_,
                                   {.estimate = estimate,
                                    .estimate_of_interval = estimate,
                                    .deviations = deviations,
                                    .deviations_of_interval = deviations});
    EXPECT_TRUE(out.validate()) << id;
    return out;
  }
  static bool says(const data::Measure& measure, std::string_view words) {
    return measure.remark.find(words) != std::string::npos;
  }
};

TEST_F(StatedMeasure, HasTheBiasTakenOffAndATwoSidedInterval) {
  const auto m = tell("path_length", 1.0, 0.02, 0.05);
  EXPECT_NEAR(m.value, 0.98, 1e-12);
  EXPECT_EQ(m.uncorrected, 1.0);
  EXPECT_EQ(m.interval.kind, data::IntervalKind::two_sided);
  EXPECT_FALSE(m.interval.approximate);
  EXPECT_TRUE(m.remark.empty()) << m.remark;
  EXPECT_EQ(m.method, "order 4, 7.5 Hz, 99 refits");
  EXPECT_EQ(m.subject, "RFIN");
}

TEST_F(StatedMeasure, RatiosOfWhatMayBeNothingHaveNoUpperEnd) {
  // Deviations are of the square of 1 - 1 over the square of the ratio: 0.5625 for a ratio of 2.
  const auto ratio = [](double square) { return 1.0 / std::sqrt(1.0 - std::sqrt(square)); };
  const auto known = tell("plane_axes_ratio", 2.0, 0.01, 0.05);
  EXPECT_NEAR(known.value, ratio(0.5525), 1e-12);
  EXPECT_EQ(known.interval.kind, data::IntervalKind::two_sided);
  EXPECT_NEAR(known.interval.low, ratio(0.5025), 0.01);  // the wider of both ends
  EXPECT_NEAR(known.interval.high, ratio(0.6225), 0.02);
  EXPECT_FALSE(says(known, "what it is divided by is not distinguishable from 0"));
  EXPECT_FALSE(says(known, "not distinguishable from 1"));
  for (const double bias : {-0.01, -0.6}) {  // with what is left of the divisor, and with nothing
    const auto line = tell("plane_axes_ratio", 2.0, bias, 0.5);
    EXPECT_EQ(line.interval.kind, data::IntervalKind::at_least);
    EXPECT_LT(line.interval.low, 2.0);
    EXPECT_TRUE(std::isfinite(line.value));
    EXPECT_TRUE(says(line, "what it is divided by is not distinguishable from 0"));
  }
}

TEST_F(StatedMeasure, RatiosOfWhatMayBeAlikeAreAtMost) {
  const auto circle = tell("ellipse_ratio", 1.005, 1e-4, 2e-4);  // 1e-4 for 1.005
  EXPECT_EQ(circle.interval.kind, data::IntervalKind::at_most);
  EXPECT_GE(circle.value, 1.0);
  EXPECT_LT(circle.value, 1.003);
  EXPECT_GT(circle.interval.high, 1.005);
  EXPECT_TRUE(says(circle, "not distinguishable from 1"));
}

TEST_F(StatedMeasure, WhatDoesNotGoAroundHasNoEllipse) {
  EXPECT_TRUE(says(tell("ellipse_ratio", kNaN, 0.0, 0.1), "the movement does not go around"));
  EXPECT_FALSE(says(tell("ellipse_ratio", 1.2, 0.0, 0.01), "the movement does not go around"));
  EXPECT_TRUE(
      says(tell("plane_axes_ratio", kNaN, 0.0, 0.1), "the movement does not come back to where it was"));
}

TEST_F(StatedMeasure, DeviationsAreNotBelowNone) {
  const auto even = tell("cycle_time_sd", 0.001, 0.002, 0.004);
  EXPECT_EQ(even.value, 0.0);
  EXPECT_EQ(even.interval.low, 0.0);
  EXPECT_GT(even.interval.high, 0.0);
  EXPECT_LT(tell("onset", 0.001, 0.002, 0.004).value, 0.0);  // an instant may lie before the first sample
}

TEST_F(StatedMeasure, LengthsAcrossARestAreAtMost) {
  frame_.share_at_rest = 0.4;
  const auto m = tell("path_length", 1.0, 0.02, 0.05);
  EXPECT_EQ(m.interval.kind, data::IntervalKind::at_most);
  EXPECT_TRUE(says(m, "40 % of the span are at rest, where noise can only lengthen"));
  EXPECT_EQ(tell("movement_path", 1.0, 0.02, 0.05).interval.kind, data::IntervalKind::two_sided);
  frame_.share_at_rest = 0.01;
  EXPECT_FALSE(says(tell("path_length", 1.0, 0.02, 0.05), "% of the span are at rest, where noise"));
}

TEST_F(StatedMeasure, PeaksOfAConstantSpeedAreAtMost) {
  const auto varied = tell("peak_speed", 1.0, 0.02, 0.05);
  EXPECT_EQ(varied.interval.kind, data::IntervalKind::two_sided);
  EXPECT_FALSE(says(varied, "the speed hardly changes, so that its largest value is the noise's"));
  frame_.steady = true;
  const auto m = tell("peak_speed", 1.0, 0.02, 0.05);
  EXPECT_EQ(m.interval.kind, data::IntervalKind::at_most);
  EXPECT_TRUE(says(m, "the speed hardly changes, so that its largest value is the noise's"));
  EXPECT_EQ(tell("mean_speed", 1.0, 0.02, 0.05).interval.kind, data::IntervalKind::two_sided);
}

TEST_F(StatedMeasure, ThicknessThatMayBeNoneSaysSo) {
  const auto none = tell("plane_sd", 1e-3, 0.9e-6, 0.4e-6);
  EXPECT_EQ(none.interval.kind, data::IntervalKind::at_most);
  EXPECT_TRUE(says(none, "not distinguishable from 0"));
  const auto some = tell("plane_sd", 5e-3, 0.9e-6, 0.4e-6);
  EXPECT_EQ(some.interval.kind, data::IntervalKind::two_sided);
  EXPECT_FALSE(says(some, "not distinguishable"));
  EXPECT_NEAR(some.value, std::sqrt(25e-6 - 0.9e-6), 1e-9);
}

TEST_F(StatedMeasure, NoIntervalBelowTheNoiseButForTremor) {
  stretch_.below_noise = 0.5;
  const auto m = tell("peak_speed", 1.0, 0.02, 0.05);
  EXPECT_EQ(m.interval.kind, data::IntervalKind::none);
  EXPECT_TRUE(says(m, "no interval: the movement about its slow trend is below half the noise of 1 mm"));
  EXPECT_NE(tell("tremor", 2e-3, 1e-6, 0.2e-6).interval.kind, data::IntervalKind::none);
  stretch_.below_noise = 0.0;
  EXPECT_FALSE(says(tell("peak_speed", 1.0, 0.02, 0.05), "the movement about its slow trend is below"));
}

TEST_F(StatedMeasure, NoIntervalAcrossALongGap) {
  stretch_.longest_gap_s = 0.5;
  const auto m = tell("peak_speed", 1.0, 0.02, 0.05);
  EXPECT_EQ(m.interval.kind, data::IntervalKind::none);
  EXPECT_TRUE(says(m, "no interval: what happened in a gap of 0.5 s is not known"));
  EXPECT_NEAR(m.value, 0.98, 1e-12);
  stretch_.longest_gap_s = 0.1;
  const auto across = tell("peak_speed", 1.0, 0.02, 0.05);
  EXPECT_EQ(across.interval.kind, data::IntervalKind::two_sided);
  EXPECT_FALSE(says(across, "no interval: what happened in a gap of"));
}

TEST_F(StatedMeasure, NoIntervalThatNobodyAskedFor) {
  stretch_.refits = 0;
  const auto m = state_measure(definition("mean_speed"), stretch_, frame_, {.estimate = 0.4});
  EXPECT_EQ(m.value, 0.4);
  EXPECT_EQ(m.interval.kind, data::IntervalKind::none);
  EXPECT_TRUE(says(m, "no interval was asked for"));
  EXPECT_EQ(m.method, "order 4, 7.5 Hz");
  const auto raw = state_measure(definition("tremor"), stretch_, frame_, {.estimate = 0.4});
  EXPECT_EQ(raw.method, "unsmoothed");
  EXPECT_FALSE(raw.method.contains("refits of noise"));
  stretch_.refits = 99;
  EXPECT_FALSE(says(tell("mean_speed", 0.4, 0.0, 0.1), "no interval was asked for"));
  EXPECT_EQ(tell("tremor", 0.4, 0.0, 0.1).method, "unsmoothed, 99 refits of noise");
}

TEST_F(StatedMeasure, TooWideIntervalsSupportNoClaim) {
  EXPECT_TRUE(says(tell("peak_speed", 1.0, 0.0, 0.6), "too wide to support a claim"));
  EXPECT_FALSE(says(tell("peak_speed", 1.0, 0.0, 0.4), "the interval is too wide to support a claim"));
  EXPECT_FALSE(says(tell("onset", 0.1, 0.0, 0.6), "the interval is too wide"));  // an instant has no size
}

TEST_F(StatedMeasure, ApproximateIntervalsAreMarked) {
  EXPECT_TRUE(tell("extent_long", 1.0, 0.0, 0.1).interval.approximate);
  EXPECT_FALSE(tell("sparc", -1.5, 0.0, 0.1).interval.approximate);
  frame_.discrete = true;
  EXPECT_TRUE(tell("sparc", -1.5, 0.0, 0.1).interval.approximate);
}

TEST_F(StatedMeasure, IntervalsOfJerkComeFromTheLeastSmoothed) {
  const auto near = around(0.0, 0.1), far = around(0.0, 0.4);
  const auto m = state_measure(
      definition("rms_jerk"), stretch_, frame_,
      {.estimate = 5.0, .estimate_of_interval = 5.2, .deviations = near, .deviations_of_interval = far});
  EXPECT_NEAR(m.value, 5.0, 1e-12);
  EXPECT_NEAR(0.5 * (m.interval.low + m.interval.high), 5.2, 1e-9);
  EXPECT_NEAR(m.sd, 0.4 * std::sqrt(50.0 * 99.0 / (3.0 * 49.0 * 98.0)), 1e-9);  // of 99 equal steps, N - 1
  EXPECT_EQ(m.method, "order 4, 7.5 Hz, interval 12.5 Hz, 99 refits");
}

TEST_F(StatedMeasure, ValuesThatDependOnTheSmoothingSaySo) {
  const auto near = around(0.0, 0.1), far = around(0.0, 0.4);
  const auto m = state_measure(
      definition("curvature"), stretch_, frame_,
      {.estimate = 5.0, .estimate_of_interval = 8.0, .deviations = near, .deviations_of_interval = far});
  EXPECT_NEAR(m.value, 8.0, 1e-12);
  EXPECT_LT(m.interval.low, 8.0);
  EXPECT_GT(m.interval.high, 8.0);
  EXPECT_TRUE(says(m, "depends on how strongly the path is smoothed"));
  EXPECT_FALSE(says(tell("curvature", 5.0, 0.0, 0.1), "depends on how strongly"));
}

TEST_F(StatedMeasure, OnlyTheUpperEndWhereTheLowerFails) {
  const auto height = tell("box_height", 1.0, 0.1, 0.1);
  EXPECT_EQ(height.interval.kind, data::IntervalKind::at_most);
  EXPECT_EQ(height.remark, "noise can only lengthen it");
  EXPECT_FALSE(says(tell("box_length", 1.0, 0.1, 0.1), "noise can only lengthen it"));
  EXPECT_EQ(tell("extent_thick", 1.0, 0.1, 0.1).interval.kind, data::IntervalKind::at_most);
  const auto on = tell("ldlj", -5.0, 0.0, 0.1);
  EXPECT_EQ(on.interval.kind, data::IntervalKind::two_sided);
  EXPECT_FALSE(says(on, "a start has jerk that no filter passes"));
  frame_.discrete = true;
  const auto m = tell("ldlj", -5.0, 0.0, 0.1);
  EXPECT_EQ(m.interval.kind, data::IntervalKind::at_most);
  EXPECT_TRUE(says(m, "a start has jerk that no filter passes"));
}

TEST_F(StatedMeasure, SizesAreNotBelowZero) {
  const auto m = tell("extent_wide", 0.1, 0.3, 0.05);
  EXPECT_EQ(m.value, 0.0);
  EXPECT_EQ(m.interval.low, 0.0);
  EXPECT_LT(tell("ldlj", -5.0, 0.1, 0.4).value, -5.0);
}

TEST_F(StatedMeasure, WhatNeedsAChangingSpeedSaysSo) {
  const auto changing = tell("power_law_exponent", 0.33, 0.0, 0.1);
  EXPECT_TRUE(std::isfinite(changing.value));
  EXPECT_FALSE(says(changing, "the speed hardly changes"));
  frame_.steady = true;
  EXPECT_EQ(tell("power_law_exponent", 0.33, 0.0, 0.1).remark, "the speed hardly changes");
  EXPECT_TRUE(std::isnan(tell("ldlj_speed", -5.0, 0.0, 0.1).value));
}

TEST_F(StatedMeasure, CountsAreWholeNumbers) { EXPECT_EQ(tell("submovements", 3.0, 0.2, 0.4).value, 3.0); }

TEST_F(StatedMeasure, WhatIsNotDeterminedSaysWhy) {
  EXPECT_EQ(tell("onset", kNaN, 0.0, 0.1).remark, "the span does not begin and end at rest");
  EXPECT_EQ(tell("cycle_time", kNaN, 0.0, 0.1).remark, "the movement does not repeat");
  EXPECT_EQ(tell("ellipse_major", kNaN, 0.0, 0.1).remark, "the movement does not go around");
  EXPECT_EQ(tell("farthest_sample", kNaN, 0.0, 0.1).remark,
            "the movement does not come back to where it was");
  EXPECT_EQ(tell("peak_speed", kNaN, 0.0, 0.1).remark, "too little movement");
  EXPECT_FALSE(says(tell("onset", 0.4, 0.0, 0.1), "the span does not begin and end at rest"));
  EXPECT_FALSE(says(tell("cycle_time", 0.4, 0.0, 0.1), "the movement does not repeat"));
  EXPECT_FALSE(says(tell("ellipse_major", 0.4, 0.0, 0.1), "the movement does not come back to where it was"));
}

TEST_F(StatedMeasure, NoIntervalWhereRefitsDoNotDetermineIt) {
  auto deviations = around(0.0, 0.1);
  const auto of = [&] {
    return state_measure(definition("cycle_time"), stretch_, frame_,
                         {.estimate = 1.0, .deviations = deviations});
  };
  EXPECT_EQ(of().interval.kind, data::IntervalKind::two_sided);
  EXPECT_FALSE(says(of(), "no interval: too many of the refits do not determine it"));
  for (std::size_t k = 0; k < 40; ++k) deviations[k] = kNaN;
  EXPECT_EQ(of().interval.kind, data::IntervalKind::none);
  EXPECT_EQ(of().remark, "no interval: too many of the refits do not determine it");
  EXPECT_EQ(of().value, 1.0);
}

TEST_F(StatedMeasure, WhereTheVelocityJumpsPeaksAreBoundsAndJerkHasNone) {
  for (const auto* id : {"peak_acceleration", "rms_jerk", "ldlj", "ldlj_speed", "peak_speed"}) {
    const auto smooth = tell(id, 8.0, 0.1, 0.2);
    EXPECT_EQ(smooth.interval.kind, data::IntervalKind::two_sided) << id;
    EXPECT_FALSE(says(smooth, "the velocity jumps")) << id;
    EXPECT_FALSE(says(smooth, "quicker than samples can tell")) << id;
    EXPECT_FALSE(says(smooth, "and jerk has no bound there")) << id;
    EXPECT_FALSE(says(smooth, "where it is largest, and smoothing adds to it there")) << id;
  }
  stretch_.velocity_jumps = "at 1.250 s";
  const auto peak = tell("peak_acceleration", 8.0, 0.1, 0.2);
  EXPECT_EQ(peak.interval.kind, data::IntervalKind::at_least);
  EXPECT_NEAR(peak.interval.low, 7.7, 0.02);
  EXPECT_TRUE(says(peak, "the velocity jumps (at 1.250 s), quicker than samples can tell"));
  for (const auto* id : {"rms_jerk", "ldlj", "ldlj_speed"}) {
    const auto jerk = tell(id, 8.0, 0.1, 0.2);
    EXPECT_EQ(jerk.interval.kind, data::IntervalKind::none) << id;
    EXPECT_TRUE(says(jerk, "no interval: the velocity jumps (at 1.250 s), and jerk has no bound there"))
        << id;
  }
  EXPECT_EQ(tell("peak_speed", 8.0, 0.1, 0.2).interval.kind, data::IntervalKind::two_sided);
  stretch_.peak_at_jump = true;
  const auto speed = tell("peak_speed", 8.0, 0.1, 0.2);
  EXPECT_EQ(speed.interval.kind, data::IntervalKind::none);
  EXPECT_TRUE(says(
      speed,
      "no interval: the velocity jumps (at 1.250 s) where it is largest, and smoothing adds to it there"));
  EXPECT_EQ(tell("path_length", 8.0, 0.1, 0.2).interval.kind, data::IntervalKind::two_sided);
}

TEST_F(StatedMeasure, HoldsWhatAFitWithSharpEndsGivesWhereTheyDisagree) {
  const auto with = [this](std::string_view id, const SharpValue& sharp) {
    const auto deviations = around(0.0, 0.01);
    return state_measure(definition(id), stretch_, frame_,
                         {.estimate = 1.7, .deviations = deviations, .sharp = sharp});
  };
  constexpr auto kSaid = "smoothing rounds off sharp starts and stops";
  const auto alone = with("movement_end", {});
  EXPECT_FALSE(says(alone, kSaid));
  EXPECT_NEAR(alone.interval.low, 1.69, 1e-3);
  const auto agrees = with("movement_end", {.value = 1.698, .low = 1.68, .high = 1.71});
  EXPECT_EQ(agrees.interval.low, alone.interval.low);
  EXPECT_FALSE(says(agrees, "smoothing rounds off sharp starts and stops: the interval holds what a fit"));
  const auto apart = with("movement_end", {.value = 1.688, .low = 1.684, .high = 1.692});
  EXPECT_EQ(apart.value, alone.value);
  EXPECT_EQ(apart.interval.low, 1.684);
  EXPECT_EQ(apart.interval.high, alone.interval.high);
  EXPECT_TRUE(says(
      apart,
      "smoothing rounds off sharp starts and stops: the interval holds what a fit with them gives, too"));
  const auto acceleration = with("peak_acceleration", {.high = 2.5});
  EXPECT_EQ(acceleration.interval.high, 2.5);
  EXPECT_TRUE(says(acceleration, kSaid));
  EXPECT_FALSE(says(with("peak_acceleration", {.high = 1.5}), kSaid));
}

TEST(PathDefinitions, HaveOneIdEachAndSayWhatTheyAre) {
  std::vector<std::string_view> ids;
  for (const auto& d : path_definitions()) {
    EXPECT_FALSE(d.what.title.empty() || d.what.formula.empty() || d.what.source.empty()) << d.what.id;
    EXPECT_EQ(std::ranges::count(ids, d.what.id), 0) << d.what.id;
    ids.push_back(d.what.id);
  }
}

TEST_F(StatedMeasure, SlowNoiseWithdrawsOnlyWhatRestsOnIt) {
  const auto known = tell("extent_long", 1.0, 0.0, 0.1);
  EXPECT_EQ(known.interval.kind, data::IntervalKind::two_sided);
  EXPECT_FALSE(says(known, "the noise below 2 Hz cannot be distinguished from movement"));
  stretch_.slow_noise_unknown = true;
  stretch_.slow_low_m = 1e-4, stretch_.slow_high_m = 9e-4;
  for (const char* id :
       {"extent_long", "extent_wide", "largest_distance", "farthest_sample", "plane_sd", "box_length"}) {
    const auto none = tell(id, 1.0, 0.0, 0.1);
    EXPECT_EQ(none.interval.kind, data::IntervalKind::none) << id;
    EXPECT_EQ(none.remark,
              "no interval: the noise below 2 Hz cannot be distinguished from movement (between 0.1 and 0.9 "
              "mm); state it");
  }
  for (const char* id : {"path_length", "peak_speed", "cycle_time"})
    EXPECT_NE(tell(id, 1.0, 0.0, 0.1).interval.kind, data::IntervalKind::none) << id;
}

TEST_F(StatedMeasure, NoiseThatIsNotKnownLeavesNoInterval) {
  stretch_.no_noise = "the noise above the movement fits no model";
  const auto none = tell("path_length", 1.0, 0.02, 0.05);
  EXPECT_EQ(none.interval.kind, data::IntervalKind::none);
  EXPECT_EQ(none.remark, "no interval: the noise above the movement fits no model");
}

TEST_F(StatedMeasure, AFilterWithinTheMovementTakesPeaksAndJerk) {
  const char* within = "no interval: the spectrum falls within the movement's band as behind a low-pass";
  EXPECT_FALSE(says(tell("peak_speed", 1.0, 0.0, 0.1), "the spectrum falls within the movement's band"));
  EXPECT_EQ(tell("peak_speed", 1.0, 0.0, 0.1).interval.kind, data::IntervalKind::two_sided);
  stretch_.filtered_within = true;
  EXPECT_TRUE(says(tell("peak_speed", 1.0, 0.0, 0.1), within));
  EXPECT_TRUE(
      says(tell("rms_jerk", 1.0, 0.0, 0.1), "no interval: the spectrum falls within the movement's band"));
  EXPECT_EQ(tell("path_length", 1.0, 0.0, 0.1).interval.kind, data::IntervalKind::two_sided);
}

TEST_F(StatedMeasure, WhatAFilterTookOfABandMayHaveBeenMore) {
  const auto whole = tell("tremor", 1.0, 0.0, 0.1);
  EXPECT_EQ(whole.interval.kind, data::IntervalKind::two_sided);
  stretch_.filtered_hz = 14.0;
  const auto above = tell("tremor", 1.0, 0.0, 0.1);
  EXPECT_EQ(above.interval.kind, data::IntervalKind::two_sided);
  EXPECT_FALSE(says(above, "its spectrum falls as behind a low-pass at"));
  stretch_.filtered_hz = 6.0;
  const auto part = tell("tremor", 1.0, 0.0, 0.1);
  EXPECT_EQ(part.interval.kind, data::IntervalKind::at_least);
  EXPECT_EQ(part.remark, "its spectrum falls as behind a low-pass at 6 Hz: what it had above may be lost");
}

TEST_F(StatedMeasure, CorrelatedNoiseTakesUpperEndsThatWouldNotHold) {
  const char* ids[] = {"ldlj", "movement_mean_speed"};
  frame_.discrete = true;
  for (const char* id : ids) {
    const auto white = tell(id, 1.0, 0.02, 0.05);
    const bool jerk = std::string_view(id) == "ldlj";  // a speed between instants errs to both sides
    EXPECT_EQ(white.interval.kind, jerk ? data::IntervalKind::at_most : data::IntervalKind::two_sided) << id;
    EXPECT_FALSE(says(white, "no interval: the noise is correlated, and an upper end"));
  }
  stretch_.correlated = true;
  for (const char* id : ids) {
    const auto none = tell(id, 1.0, 0.02, 0.05);
    EXPECT_EQ(none.interval.kind, data::IntervalKind::none) << id;
    EXPECT_EQ(none.remark,
              "no interval: the noise is correlated, and an upper end would not hold between two rests");
  }
  // Paths have theirs, and what goes on has both.
  EXPECT_EQ(tell("movement_path", 1.0, 0.02, 0.05).interval.kind, data::IntervalKind::at_most);
  frame_.discrete = false;
  for (const char* id : ids)
    EXPECT_EQ(tell(id, 1.0, 0.02, 0.05).interval.kind, data::IntervalKind::two_sided) << id;
}

TEST_F(StatedMeasure, DoubtAboutTheNoiseIsSaidWhereItDecides) {
  const auto deviations = around(0.0, 0.1);
  MeasureNumbers numbers{.estimate = 1.0, .deviations = deviations, .doubt = 1.5};
  EXPECT_FALSE(
      says(state_measure(definition("peak_speed"), stretch_, frame_, numbers), "doubt about the noise"));
  numbers.doubt = 3.0;
  EXPECT_TRUE(
      says(state_measure(definition("peak_speed"), stretch_, frame_, numbers), "doubt about the noise"));
}

TEST_F(StatedMeasure, QuickMovementBelowTheNoiseSaysHowMuch) {
  stretch_.below_noise = 1.5;
  EXPECT_TRUE(says(tell("peak_speed", 1.0, 0.0, 0.1), "below 1.5 times the noise of 1 mm"));
  EXPECT_EQ(tell("tremor", 1.0, 0.0, 0.1).interval.kind, data::IntervalKind::two_sided);
}

TEST_F(StatedMeasure, MovementsPathsAreUpperBoundsOnlyBetweenRests) {
  const auto on = tell("movement_path", 1.0, 0.02, 0.05);
  EXPECT_EQ(on.interval.kind, data::IntervalKind::two_sided);
  EXPECT_FALSE(says(on, "before and behind a movement noise can only lengthen it"));
  frame_.discrete = true;
  const auto path = tell("movement_path", 1.0, 0.02, 0.05);
  EXPECT_EQ(path.interval.kind, data::IntervalKind::at_most);
  EXPECT_EQ(path.remark, "before and behind a movement noise can only lengthen it");
}

}  // namespace
}  // namespace kinemark::analysis
