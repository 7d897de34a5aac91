// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/report/ik_summary.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "kinemark/core/units.h"
#include "kinemark/stages/report/internal/example_trial.h"

namespace kinemark::report {
namespace {

using internal::example_trial;
using testing::HasSubstr;

/// Four frames at 10 Hz, one coordinate, markers A and B; errors along x in mm as given, NaN: not seen.
data::JointMotion motion_with_errors(const std::vector<std::pair<double, double>>& errors_mm) {
  data::JointMotion m;
  m.coordinates = {"hip"};
  m.is_rotation = {true};
  m.markers = {"A", "B"};
  m.time = {.rate_hz = 10.0, .t0_s = 0.0, .frames = std::ssize(errors_mm)};
  m.q.assign(errors_mm.size(), 0.0);
  for (const auto& [a, b] : errors_mm)
    for (const double e : {a, b}) {
      m.marker_error.push_back(1e-3 * e);
      m.marker_error.push_back(std::isnan(e) ? kNaN : 0.0);
      m.marker_error.push_back(std::isnan(e) ? kNaN : 0.0);
    }
  return m;
}

TEST(Summarize, CountsErrorsOverSeenMarkersOnly) {
  const auto s = summarize({}, motion_with_errors({{3, 4}, {kNaN, -4}, {0, kNaN}}), nullptr);
  ASSERT_TRUE(s) << s.error().message;
  EXPECT_NEAR(s->rms_error_m, 1e-3 * std::sqrt((9 + 16 + 16 + 0) / 4.0), 1e-15);
  EXPECT_DOUBLE_EQ(s->max_error_m, 4e-3);
  EXPECT_EQ(s->markers[0].seen_frames, 2);
  EXPECT_NEAR(s->markers[0].rms_error_m, 1e-3 * std::sqrt(4.5), 1e-15);
  EXPECT_EQ(s->markers[0].max_error_frame, 0);
  EXPECT_EQ(s->markers[1].seen_frames, 2);
  EXPECT_DOUBLE_EQ(s->markers[1].max_error_m, 4e-3);
}

TEST(Summarize, WithoutErrorsSaysUnknownNotZero) {
  data::JointMotion m = motion_with_errors({{kNaN, kNaN}});
  for (const bool empty : {false, true}) {
    if (empty) m.marker_error.clear();
    const auto s = summarize({}, m, nullptr);
    ASSERT_TRUE(s);
    EXPECT_TRUE(std::isnan(s->rms_error_m));
    EXPECT_TRUE(std::isnan(s->markers[0].max_error_m));
    EXPECT_TRUE(s->worst_frames.empty());
  }
}

TEST(Summarize, WorstFramesComeLargestFirstAndApart) {
  const auto m = motion_with_errors({{1, 1}, {9, 1}, {8, 1}, {1, 1}, {1, 7}, {5, kNaN}, {1, 1}});
  const auto s = summarize({}, m, nullptr, {.worst_frames = 3, .worst_frame_distance_s = 0.2});
  ASSERT_TRUE(s);
  ASSERT_EQ(s->worst_frames.size(), 3U);
  EXPECT_EQ(s->worst_frames[0].frame, 1) << "frame 2 is the same event";
  EXPECT_EQ(s->worst_frames[0].marker, "A");
  EXPECT_DOUBLE_EQ(s->worst_frames[0].time_s, 0.1);
  EXPECT_EQ(s->worst_frames[1].frame, 4);
  EXPECT_EQ(s->worst_frames[1].marker, "B");
  EXPECT_DOUBLE_EQ(s->worst_frames[1].marker_error_m, 7e-3);
  EXPECT_EQ(s->worst_frames[1].markers_seen, 2);
  EXPECT_EQ(s->worst_frames[2].frame, 6)
      << "frame 5 is next to frame 4, frames 0 and 3 tie with 6 but are next to others";
}

TEST(Summarize, EqualFramesAreListedInTheirOrder) {
  const auto s =
      summarize({}, motion_with_errors({{2, 2}, {2, 2}, {2, 2}}), nullptr, {.worst_frame_distance_s = 0.0});
  ASSERT_TRUE(s);
  ASSERT_EQ(s->worst_frames.size(), 3U);
  for (int f = 0; f < 3; ++f) EXPECT_EQ(s->worst_frames[static_cast<std::size_t>(f)].frame, f);
}

TEST(Summarize, DescribesTheExampleTrial) {
  const auto t = example_trial(600);
  ASSERT_TRUE(t.motion.validate()) << t.motion.validate().error().message;
  ASSERT_TRUE(t.markers.validate()) << t.markers.validate().error().message;
  const auto s = summarize(t.run, t.motion, &t.markers);
  ASSERT_TRUE(s) << s.error().message;
  EXPECT_EQ(s->verdict, Verdict::attention);
  EXPECT_EQ(s->status_frames, (std::array<std::int64_t, 4>{500, 3, 97, 0}));
  // 2 of 19 coordinates that are not locked are lost in 97 of 600 frames.
  EXPECT_NEAR(s->determined_fraction, 1.0 - 2.0 * 97.0 / (19.0 * 600.0), 1e-12);
  EXPECT_EQ(s->worst_frames.front().marker, "R.Midfoot");
  const auto wrist = std::ranges::find(s->coordinates, "wrist_flex_r", &CoordinateSummary::name);
  EXPECT_EQ(wrist->determined_frames, 503);
  EXPECT_NEAR(wrist->median_sd, 2.2 * kRadPerDeg, 0.3 * kRadPerDeg);
  EXPECT_LT(wrist->min, wrist->max);
  EXPECT_TRUE(std::ranges::find(s->coordinates, "subtalar_angle_r", &CoordinateSummary::name)->locked);
  const MarkerRow& excluded = s->markers.back();
  EXPECT_EQ(excluded.name, "L.Bicep");
  EXPECT_FALSE(excluded.used);
  EXPECT_EQ(excluded.seen_frames, 600);
  EXPECT_TRUE(s->markers.front().used);
  EXPECT_DOUBLE_EQ(s->markers.front().weight, 10.0);
}

TEST(Summarize, MotionWithoutStatusOrFlagsCountsAsGood) {
  auto m = motion_with_errors({{1, 1}, {1, 1}});
  const auto s = summarize({}, m, nullptr);
  ASSERT_TRUE(s);
  EXPECT_EQ(s->status_frames[0], 2);
  EXPECT_DOUBLE_EQ(s->determined_fraction, 1.0);
  EXPECT_EQ(s->verdict, Verdict::good);
}

TEST(Summarize, AnEmptyMotionIsNotACrash) {
  auto m = motion_with_errors({});
  const auto s = summarize({}, m, nullptr);
  ASSERT_TRUE(s) << s.error().message;
  EXPECT_TRUE(std::isnan(s->determined_fraction));
}

TEST(Summarize, RefusesWhatDoesNotFitTogether) {
  const auto t = example_trial(100);
  auto late = t.markers;
  late.time.t0_s += 1.0;
  EXPECT_THAT(summarize(t.run, t.motion, &late).error().message, HasSubstr("from 0.5 s, its markers 100"));
  late = t.markers;
  late.state.pop_back();
  EXPECT_THAT(summarize(t.run, t.motion, &late).error().message, HasSubstr("no state"));
  auto broken = t.motion;
  broken.q.pop_back();
  EXPECT_FALSE(summarize(t.run, broken, nullptr));
  EXPECT_EQ(summarize(t.run, t.motion, nullptr, {.worst_frames = -1}).error().code, Code::usage);
  EXPECT_EQ(summarize(t.run, t.motion, nullptr, {.worst_frame_distance_s = -0.1}).error().code, Code::usage);
  EXPECT_EQ(summarize(t.run, t.motion, nullptr, {.worst_frame_distance_s = kNaN}).error().code, Code::usage);
}

}  // namespace
}  // namespace kinemark::report
