// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/trajectory/screening/screen.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>

#include "kinemark/stages/trajectory/screening/testing/walker.h"

namespace kinemark::trajectory {
namespace {

using data::DefectKind;

using data::SampleState;
using data::Trajectories;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::SizeIs;

std::vector<data::Defect> found(const Trajectories& t, std::span<const double> times = {}) {
  return screen(t, {}, times).value();
}

/// The one finding there is.
data::Defect only(const Trajectories& t, std::span<const double> times = {}) {
  const auto findings = found(t, times);
  EXPECT_THAT(findings, SizeIs(1));
  for (const data::Defect& f : findings) SCOPED_TRACE(f.sentence);
  return findings.empty() ? data::Defect{} : findings.front();
}

void expect(const data::Defect& f, DefectKind kind, std::int64_t marker, std::int64_t first,
            std::int64_t last, std::int64_t other = -1) {
  EXPECT_EQ(to_string(f.kind), to_string(kind)) << f.sentence;
  EXPECT_EQ(f.marker, marker);
  EXPECT_EQ(f.other_marker, other);
  EXPECT_EQ(f.first_frame, first);
  EXPECT_EQ(f.last_frame, last);
  EXPECT_GE(f.confidence, 0.8);
  EXPECT_LT(f.confidence, 1.0);
}

TEST(Screen, CleanRecordingsAreClean) {
  for (const double noise : {0.0, 0.0002, 0.002})
    for (const double rate : {30.0, 100.0, 500.0})
      EXPECT_THAT(found(testing::walker({.rate_hz = rate, .noise_m = noise, .seed = 3})), IsEmpty())
          << noise << " m at " << rate << " Hz";
}

TEST(Screen, ARecordingThatRestsIsClean) {
  Trajectories t = testing::walker({.noise_m = 0.0});
  for (std::int64_t f = 1; f < t.frames(); ++f)
    for (std::int64_t m = 0; m < t.markers(); ++m) t.x(f, m) = t.x(0, m);
  EXPECT_THAT(found(t), IsEmpty());
  Random random(1, 2);
  for (double& x : t.x_in_world) x = std::round((x + 0.0001 * random.gaussian()) / 0.001) * 0.001;
  EXPECT_THAT(found(t), IsEmpty());  // noise below the rounding step: values repeat and nothing is stuck
}

TEST(Screen, ZerosAreMissingSamples) {
  Trajectories t = testing::walker();
  for (std::int64_t f = 50; f <= 53; ++f) t.x(f, 2).setZero();
  expect(only(t), DefectKind::zero, 2, 50, 53);
  Trajectories always = testing::walker();
  for (std::int64_t f = 0; f < always.frames(); ++f) always.x(f, 5).setZero();
  expect(only(always), DefectKind::zero, 5, 0, always.frames() - 1);
}

TEST(Screen, PassingThroughTheOriginIsNoZero) {
  Trajectories t = testing::walker({.markers = 1, .frames = 201, .noise_m = 0.0});
  for (std::int64_t f = 0; f < t.frames(); ++f) t.x(f, 0).setConstant(0.001 * static_cast<double>(f - 100));
  EXPECT_THAT(found(t), IsEmpty());
}

TEST(Screen, AHeldValueIsStuck) {
  Trajectories t = testing::walker();
  for (std::int64_t f = 201; f <= 230; ++f) t.x(f, 4) = t.x(200, 4);
  expect(only(t), DefectKind::stuck, 4, 200, 230);
  Trajectories to_the_end = testing::walker();
  for (std::int64_t f = 581; f < 600; ++f) to_the_end.x(f, 1) = to_the_end.x(580, 1);
  expect(only(to_the_end), DefectKind::stuck, 1, 580, 599);
}

TEST(Screen, HeldByTheRecorderAtARegularFactorIsNotStuckNorDuplicated) {
  Trajectories t = testing::walker();
  for (std::int64_t f = 0; f < t.frames(); ++f)
    for (std::int64_t m = 0; m < t.markers(); ++m) t.x(f, m) = Eigen::Vector3d(t.x(f - f % 3, m));
  EXPECT_THAT(found(t), IsEmpty());
}

TEST(Screen, RepeatedFramesAreDuplicated) {
  Trajectories t = testing::walker();
  for (std::int64_t m = 0; m < t.markers(); ++m)
    for (std::int64_t f = 301; f <= 302; ++f) t.x(f, m) = t.x(300, m);
  const auto findings = found(t);
  ASSERT_FALSE(findings.empty());
  expect(findings.front(), DefectKind::duplicated_frame, -1, 301, 302);
  for (const data::Defect& f : findings) EXPECT_NE(f.kind, DefectKind::stuck);
  const Trajectories out = reject_defects(t, findings).value();
  for (std::int64_t m = 0; m < t.markers(); ++m) {
    EXPECT_TRUE(out.present(300, m));
    EXPECT_EQ(out.state[out.index(301, m)], SampleState::rejected);
  }
}

TEST(Screen, FramesHeldIrregularlyAreDuplicated) {
  // A stream of 140 Hz in a clock of 250 Hz: some frames twice, some once.
  const Trajectories source = testing::walker({.rate_hz = 140.0});
  Trajectories t = testing::walker({.frames = 500, .rate_hz = 250.0});
  int repeats = 0;
  for (std::int64_t f = 0; f < 500; ++f) {
    repeats += f > 0 && f * 140 / 250 == (f - 1) * 140 / 250 ? 1 : 0;
    for (std::int64_t m = 0; m < t.markers(); ++m) t.x(f, m) = source.x(f * 140 / 250, m);
  }
  const auto findings = found(t);
  std::int64_t called = 0;
  for (const data::Defect& f : findings)
    called += f.kind == DefectKind::duplicated_frame ? f.last_frame - f.first_frame + 1 : 0;
  EXPECT_GT(repeats, 200);
  EXPECT_GT(called, repeats * 8 / 10);
}

TEST(Screen, AClockThatJumpsIsToldFromItsTimes) {
  const Trajectories t = testing::walker({.markers = 2, .frames = 50});
  std::vector<double> times;
  for (int f = 0; f < 50; ++f) times.push_back(0.01 * f + (f >= 20 ? 0.03 : 0.0));
  expect(only(t, times), DefectKind::clock_jump, -1, 20, 20);
  times[30] = times[29];
  times[40] = std::numeric_limits<double>::quiet_NaN();
  const auto findings = found(t, times);
  std::vector<std::int64_t> frames;
  for (const data::Defect& f : findings) frames.push_back(f.first_frame);
  EXPECT_EQ(frames, (std::vector<std::int64_t>{20, 30, 31, 40}));
  EXPECT_EQ(reject_defects(t, findings).value().x_in_world, t.x_in_world);
  expect(only(t, std::vector<double>(50, 1.0)), DefectKind::clock_jump, -1, 0, 49);
}

TEST(Screen, LostFramesShowAsALeapOfAllMarkers) {
  const Trajectories whole = testing::walker({.frames = 401, .noise_m = 0.00005});
  Trajectories t = testing::walker({.frames = 400});
  for (std::int64_t f = 0; f < 400; ++f)
    for (std::int64_t m = 0; m < t.markers(); ++m) t.x(f, m) = whole.x(f < 150 ? f : f + 1, m);
  const data::Defect f = only(t);
  expect(f, DefectKind::clock_jump, -1, 150, 150);
  EXPECT_NEAR(f.evidence, 2.0, 0.05);
}

TEST(Screen, FramesLeftOutAgainAndAgainAreOneFinding) {
  const Trajectories whole = testing::walker({.frames = 600, .rate_hz = 120.0, .noise_m = 0.00002});
  Trajectories t = testing::walker({.frames = 500});
  for (std::int64_t f = 0; f < 500; ++f)
    for (std::int64_t m = 0; m < t.markers(); ++m) t.x(f, m) = whole.x(f / 5 * 6 + f % 5, m);
  EXPECT_THAT(only(t).sentence, HasSubstr("120 Hz from which every 6th frame was left out"));
}

TEST(Screen, AMarkerInMillimetresAmongMetres) {
  Trajectories t = testing::walker();
  for (std::int64_t f = 0; f < t.frames(); ++f) t.x(f, 3) *= 1000.0;
  expect(only(t), DefectKind::unit_slip, 3, 0, t.frames() - 1);
  Trajectories part = testing::walker();
  for (std::int64_t f = 100; f < 140; ++f) part.x(f, 3) /= 1000.0;
  expect(only(part), DefectKind::unit_slip, 3, 100, 139);
}

TEST(Screen, ARecordingThatChangesItsUnitIsOneFinding) {
  Trajectories t = testing::walker();
  for (std::int64_t f = 480; f < 600; ++f)
    for (std::int64_t m = 0; m < t.markers(); ++m) t.x(f, m) *= 1000.0;
  expect(only(t), DefectKind::unit_slip, -1, 480, 599);
  for (double& x : t.x_in_world) x *= 1000.0;
  EXPECT_THAT(found(t).front().sentence, HasSubstr("whole recording"));
}

TEST(Screen, ForcesKeptAsPointsAreNoUnitSlip) {
  Trajectories t = testing::walker();
  Random random(4, 4);
  for (std::int64_t f = 0; f < t.frames(); ++f)
    for (int a = 0; a < 3; ++a)
      t.x(f, 3)(a) = 0.001 * std::sin(0.05 * static_cast<double>(f) + a) + 1e-5 * random.gaussian();
  EXPECT_THAT(found(t), IsEmpty());
}

TEST(Screen, SpikesOfOneToThreeSamples) {
  for (const int width : {1, 2, 3}) {
    Trajectories t = testing::walker();
    for (int i = 0; i < width; ++i) t.x(321 + i, 6) += Eigen::Vector3d(0.01, -0.015, 0.02);
    expect(only(t), DefectKind::spike, 6, 321, 320 + width);
  }
}

TEST(Screen, AStepIsNoSpike) {
  Trajectories t = testing::walker();
  for (std::int64_t f = 300; f < 600; ++f) t.x(f, 6).z() += 0.02;
  EXPECT_THAT(found(t), IsEmpty());
}

TEST(Screen, TwoMarkersThatExchangeTheirLabels) {
  for (const std::int64_t last : {250, 259, 320}) {
    Trajectories t = testing::walker();
    for (std::int64_t f = 250; f <= last; ++f) {
      const Eigen::Vector3d one = t.x(f, 1);
      t.x(f, 1) = t.x(f, 2);
      t.x(f, 2) = one;
    }
    expect(only(t), DefectKind::label_swap, 1, 250, last, 2);
    const Trajectories out = reject_defects(t, found(t)).value();
    EXPECT_EQ(out.state[out.index(250, 1)], SampleState::rejected);
    EXPECT_EQ(out.state[out.index(last, 2)], SampleState::rejected);
    EXPECT_TRUE(out.present(last + 1, 2));
    EXPECT_TRUE(out.present(250, 3));
  }
}

TEST(Screen, AnExchangeThatNeverEndsNamesTheShorterSide) {
  Trajectories t = testing::walker();
  for (std::int64_t f = 0; f < 90; ++f) {
    const Eigen::Vector3d one = t.x(f, 0);
    t.x(f, 0) = t.x(f, 7);
    t.x(f, 7) = one;
  }
  const data::Defect f = only(t);
  expect(f, DefectKind::label_swap, 0, 0, 89, 7);
  EXPECT_THAT(f.sentence, HasSubstr("cannot be decided"));
}

TEST(Screen, AMarkerThatVisitsThePathOfALostOne) {
  Trajectories t = testing::walker();
  for (std::int64_t f = 400; f <= 412; ++f) {
    t.x(f, 5) = t.x(f, 4);
    t.set_missing(f, 4);
  }
  expect(only(t), DefectKind::swap_within, 5, 400, 412, 4);
}

TEST(Screen, AMarkerThatShowsASeenOneTwice) {
  Trajectories t = testing::walker();
  for (std::int64_t f = 400; f <= 401; ++f) t.x(f, 5) = t.x(f, 4);
  expect(only(t), DefectKind::swap_within, 5, 400, 401, 4);
}

TEST(Screen, DefectsAreFoundBesideOneAnother) {
  Trajectories t = testing::walker();
  t.x(100, 0).z() += 0.05;
  for (std::int64_t f = 200; f < 203; ++f) t.x(f, 0).setZero();
  for (std::int64_t f = 301; f <= 330; ++f) t.x(f, 7) = t.x(300, 7);
  const auto findings = found(t);
  ASSERT_THAT(findings, SizeIs(3));
  expect(findings[0], DefectKind::spike, 0, 100, 100);
  expect(findings[1], DefectKind::zero, 0, 200, 202);
  expect(findings[2], DefectKind::stuck, 7, 300, 330);
}

TEST(Screen, EachKindCanBeSwitchedOff) {
  Trajectories t = testing::walker();
  t.x(100, 0).z() += 0.05;
  EXPECT_THAT(screen(t, {.spikes = false}).value(), IsEmpty());
  EXPECT_THAT(screen(t, {.min_spike_m = 0.06}).value(), IsEmpty());
  EXPECT_THAT(screen(t, {.min_confidence = 1.0}).value(), IsEmpty());
}

TEST(Screen, GapsAndShortRecordingsAreAnswered) {
  Trajectories t = testing::walker({.seed = 9});
  Random random(5, 5);
  for (std::int64_t f = 0; f < t.frames(); ++f)
    for (std::int64_t m = 0; m < t.markers(); ++m)
      if (random.uniform() < 0.3) t.set_missing(f, m);
  EXPECT_THAT(found(t), IsEmpty());
  for (const std::int64_t frames : {0, 1, 2, 3, 5, 9})
    EXPECT_THAT(found(testing::walker({.frames = frames})), IsEmpty());
  EXPECT_THAT(found(Trajectories::all_missing({}, {.rate_hz = 100.0, .t0_s = 0.0, .frames = 20})), IsEmpty());
  EXPECT_THAT(found(Trajectories::all_missing({"A", "B"}, {.rate_hz = 100.0, .t0_s = 0.0, .frames = 20})),
              IsEmpty());
}

TEST(Screen, NoiseOfAnySizeIsAnsweredQuickly) {
  Trajectories t = testing::walker({.markers = 20, .noise_m = 3.0});
  EXPECT_TRUE(screen(t));
  for (double& x : t.x_in_world) x *= 1e200;
  EXPECT_TRUE(screen(t));
}

TEST(Screen, RefusesWhatDoesNotHold) {
  const Trajectories t = testing::walker();
  EXPECT_THAT(screen(t, {.min_spike_m = 0.0}).error().message, HasSubstr("spike"));
  EXPECT_THAT(screen(t, {.min_jump_m = -1.0}).error().message, HasSubstr("jump"));
  EXPECT_THAT(screen(t, {.min_stuck_s = std::numeric_limits<double>::quiet_NaN()}).error().message,
              HasSubstr("stuck"));
  EXPECT_THAT(screen(t, {.min_confidence = 2.0}).error().message, HasSubstr("0 to 1"));
  EXPECT_THAT(screen(t, {}, std::vector<double>(3)).error().message, HasSubstr("3 frame times"));
  EXPECT_EQ(reject_defects(t, std::vector<data::Defect>{{.marker = 99}}).error().code, Code::bad_input);
  EXPECT_EQ(reject_defects(t, std::vector<data::Defect>{{.marker = 0, .first_frame = 5, .last_frame = 600}})
                .error()
                .code,
            Code::bad_input);
}

TEST(RejectFindings, TakesOnlyWhatIsSureEnough) {
  const Trajectories t = testing::walker();
  const std::vector<data::Defect> findings{
      {.kind = DefectKind::spike, .marker = 1, .first_frame = 7, .last_frame = 8, .confidence = 0.6}};
  EXPECT_EQ(reject_defects(t, findings).value().state, t.state);
  const Trajectories out = reject_defects(t, findings, 0.5).value();
  EXPECT_TRUE(out.validate());
  EXPECT_EQ(out.count_missing(), 2);
}

}  // namespace
}  // namespace kinemark::trajectory
