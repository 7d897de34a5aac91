// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/trajectory/screening/screen.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <limits>
#include <utility>

#include "kinemark/stages/trajectory/screening/testing/walker.h"

namespace kinemark::trajectory {
namespace {

using data::FindingKind;

using data::SampleState;
using data::Trajectories;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;
using ::testing::SizeIs;

std::vector<data::Finding> found(const Trajectories& t, std::span<const double> times = {}) {
  return screen(t, {}, times).value();
}

/// The one finding there is.
data::Finding only(const Trajectories& t, std::span<const double> times = {}) {
  const auto findings = found(t, times);
  EXPECT_THAT(findings, SizeIs(1));
  for (const data::Finding& f : findings) SCOPED_TRACE(f.description);
  return findings.empty() ? data::Finding{} : findings.front();
}

void expect(const data::Finding& f, FindingKind kind, std::int64_t marker, std::int64_t first,
            std::int64_t last, std::int64_t other = -1) {
  EXPECT_EQ(to_string(f.kind), to_string(kind)) << f.description;
  const auto name_of = [](std::int64_t m) { return m < 0 ? std::string() : "M" + std::to_string(m); };
  EXPECT_EQ(f.subject, name_of(marker));
  EXPECT_EQ(f.partner, name_of(other));
  EXPECT_TRUE(f.validate());
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
  expect(only(t), FindingKind::zero, 2, 50, 53);
  EXPECT_THAT(only(t).description,
              HasSubstr("marker 'M2' is exactly at the origin in frames 50 to 53; the nearest sample is "));
  EXPECT_THAT(only(t).description, Not(HasSubstr("it is never seen anywhere else")));
  Trajectories always = testing::walker();
  for (std::int64_t f = 0; f < always.frames(); ++f) always.x(f, 5).setZero();
  expect(only(always), FindingKind::zero, 5, 0, always.frames() - 1);
  EXPECT_THAT(only(always).description, HasSubstr("it is never seen anywhere else"));
  EXPECT_THAT(only(always).description, Not(HasSubstr("the nearest sample is ")));
}

TEST(Screen, PassingThroughTheOriginIsNoZero) {
  Trajectories t = testing::walker({.markers = 1, .frames = 201, .noise_m = 0.0});
  for (std::int64_t f = 0; f < t.frames(); ++f) t.x(f, 0).setConstant(0.001 * static_cast<double>(f - 100));
  EXPECT_THAT(found(t), IsEmpty());
}

TEST(Screen, AHeldValueIsStuck) {
  Trajectories t = testing::walker();
  for (std::int64_t f = 201; f <= 230; ++f) t.x(f, 4) = t.x(200, 4);
  expect(only(t), FindingKind::stuck, 4, 200, 230);
  EXPECT_THAT(
      only(t).description,
      HasSubstr("marker 'M4' holds one value, digit by digit, in frames 200 to 230; beside them it moves "));
  Trajectories to_the_end = testing::walker();
  for (std::int64_t f = 581; f < 600; ++f) to_the_end.x(f, 1) = to_the_end.x(580, 1);
  expect(only(to_the_end), FindingKind::stuck, 1, 580, 599);
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
  expect(findings.front(), FindingKind::duplicated_frame, -1, 301, 302);
  EXPECT_THAT(
      findings.front().description,
      HasSubstr("repeat frame 300 in frames 301 to 302, digit by digit, while 8 of them move right before"));
  for (const data::Finding& f : findings) EXPECT_NE(f.kind, FindingKind::stuck);
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
  for (const data::Finding& f : findings)
    called += f.kind == FindingKind::duplicated_frame ? f.last_frame - f.first_frame + 1 : 0;
  EXPECT_GT(repeats, 200);
  EXPECT_GT(called, repeats * 8 / 10);
}

TEST(Screen, AClockThatJumpsIsFoundFromItsTimes) {
  const Trajectories t = testing::walker({.markers = 2, .frames = 50});
  std::vector<double> times;
  for (int f = 0; f < 50; ++f) times.push_back(0.01 * f + (f >= 20 ? 0.03 : 0.0));
  expect(only(t, times), FindingKind::clock_jump, -1, 20, 20);
  EXPECT_EQ(only(t, times).description, "frame 20 is 0.04 s after the one before, 4 times the usual 0.01 s");
  times[30] = times[29];
  times[40] = std::numeric_limits<double>::quiet_NaN();
  const auto findings = found(t, times);
  std::vector<std::int64_t> frames;
  for (const data::Finding& f : findings) frames.push_back(f.first_frame);
  EXPECT_EQ(frames, (std::vector<std::int64_t>{20, 30, 31, 40}));
  EXPECT_EQ(findings.back().description, "frame 40 is at a time that is not a number");
  EXPECT_THAT(findings.back().description, Not(HasSubstr("s after the one before, ")));
  EXPECT_THAT(findings.front().description, Not(HasSubstr("at a time that is not a number")));
  EXPECT_THAT(findings.front().description, Not(HasSubstr("this is no clock")));
  EXPECT_EQ(reject_defects(t, findings).value().x_in_world, t.x_in_world);
  const data::Finding stands = only(t, std::vector<double>(50, 1.0));
  expect(stands, FindingKind::clock_jump, -1, 0, 49);
  EXPECT_EQ(stands.description, "the times of most frames do not increase: this is no clock");
  EXPECT_THAT(stands.description, Not(HasSubstr("no two frames that follow each other have times")));
  const data::Finding none = only(t, std::vector<double>(50, std::numeric_limits<double>::quiet_NaN()));
  EXPECT_EQ(none.description, "no two frames that follow each other have times: this is no clock");
  EXPECT_THAT(none.description, Not(HasSubstr("the times of most frames do not increase")));
  Trajectories from_one = t;
  from_one.time.first_number = 1;
  EXPECT_THAT(found(from_one, times).front().description, HasSubstr("frame 21 is "));
}

TEST(Screen, LostFramesShowAsALeapOfAllMarkers) {
  const Trajectories whole = testing::walker({.frames = 401, .noise_m = 0.00005});
  Trajectories t = testing::walker({.frames = 400});
  for (std::int64_t f = 0; f < 400; ++f)
    for (std::int64_t m = 0; m < t.markers(); ++m) t.x(f, m) = whole.x(f < 150 ? f : f + 1, m);
  const data::Finding f = only(t);
  expect(f, FindingKind::clock_jump, -1, 150, 150);
  EXPECT_EQ(f.size, 1.0) << "one frame lost";
  EXPECT_THAT(f.description, HasSubstr("between frames 149 and 150 all 8 markers that are seen go "));
  EXPECT_THAT(f.description, HasSubstr(" times as far as in the frames beside: 1 lost there"));
  EXPECT_THAT(f.description, Not(HasSubstr("instants between frames ")));
}

TEST(Screen, FramesLeftOutAgainAndAgainAreOneFinding) {
  const Trajectories whole = testing::walker({.frames = 600, .rate_hz = 120.0, .noise_m = 0.00002});
  Trajectories t = testing::walker({.frames = 500});
  for (std::int64_t f = 0; f < 500; ++f)
    for (std::int64_t m = 0; m < t.markers(); ++m) t.x(f, m) = whole.x(f / 5 * 6 + f % 5, m);
  EXPECT_THAT(only(t).description,
              HasSubstr(" instants between frames 5 and 495 all markers that are seen go 2.0"));
  EXPECT_THAT(only(t).description,
              HasSubstr("times as far as in the frames beside, most often every 5 frames: 120 Hz from which "
                        "every 6th frame was left out?"));
  EXPECT_THAT(only(t).description, Not(HasSubstr("times as far as in the frames beside: ")));
  // Two at a time: the rate that they would have had is another one.
  const Trajectories fast = testing::walker({.frames = 700, .rate_hz = 140.0, .noise_m = 0.00002});
  for (std::int64_t f = 0; f < 500; ++f)
    for (std::int64_t m = 0; m < t.markers(); ++m) t.x(f, m) = fast.x(f / 5 * 7 + f % 5, m);
  const auto twos = found(t);
  ASSERT_FALSE(twos.empty());
  EXPECT_THAT(twos.front().description, Not(HasSubstr("th frame was left out?")));
}

TEST(Screen, AMarkerInMillimetresAmongMetres) {
  Trajectories t = testing::walker();
  for (std::int64_t f = 0; f < t.frames(); ++f) t.x(f, 3) *= 1000.0;
  expect(only(t), FindingKind::unit_slip, 3, 0, t.frames() - 1);
  EXPECT_THAT(only(t).description, HasSubstr(" m from the origin and moves by "));
  EXPECT_THAT(only(t).description, Not(HasSubstr("divided by 1000 it joins the frames beside")));
  Trajectories part = testing::walker();
  for (std::int64_t f = 100; f < 140; ++f) part.x(f, 3) /= 1000.0;
  expect(only(part), FindingKind::unit_slip, 3, 100, 139);
  EXPECT_EQ(
      only(part).description,
      "marker 'M3' is a thousand times too small in frames 100 to 139: times or divided by 1000 it joins "
      "the frames beside");
  EXPECT_THAT(only(part).description, Not(HasSubstr(" m from the origin and moves by ")));
  EXPECT_THAT(only(part).description, Not(HasSubstr("markers that are seen change by a factor")));
}

TEST(Screen, ARecordingThatChangesItsUnitIsOneFinding) {
  Trajectories t = testing::walker();
  for (std::int64_t f = 480; f < 600; ++f)
    for (std::int64_t m = 0; m < t.markers(); ++m) t.x(f, m) *= 1000.0;
  expect(only(t), FindingKind::unit_slip, -1, 480, 599);
  EXPECT_EQ(only(t).description,
            "all 8 markers that are seen change by a factor of a thousand in frames 480 to 599");
  EXPECT_THAT(only(t).description, Not(HasSubstr("the unit of the whole recording is wrong")));
  Trajectories large = testing::walker(), far = large;
  for (double& x : large.x_in_world) x *= 1000.0;
  EXPECT_THAT(only(large).description,
              HasSubstr(" m from the origin (median): the unit of the whole recording is wrong"));
  for (double& x : far.x_in_world) x += 1000.0;
  EXPECT_THAT(found(far), IsEmpty()) << "of the size of a body, far from the origin";
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
    expect(only(t), FindingKind::spike, 6, 321, 320 + width);
    EXPECT_THAT(only(t).description, HasSubstr("marker 'M6' leaves its path by 2"));
    EXPECT_THAT(only(t).description, HasSubstr(" times what the samples beside leave it by"));
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
    expect(only(t), FindingKind::label_swap, 1, 250, last, 2);
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
  const data::Finding f = only(t);
  expect(f, FindingKind::label_swap, 0, 0, 89, 7);
  EXPECT_THAT(f.description, HasSubstr("cannot be decided"));
}

TEST(Screen, AMarkerThatVisitsThePathOfALostOne) {
  Trajectories t = testing::walker();
  for (std::int64_t f = 400; f <= 412; ++f) {
    t.x(f, 5) = t.x(f, 4);
    t.set_missing(f, 4);
  }
  expect(only(t), FindingKind::swap_within, 5, 400, 412, 4);
}

TEST(Screen, AMarkerThatShowsASeenOneTwice) {
  Trajectories t = testing::walker();
  for (std::int64_t f = 400; f <= 401; ++f) t.x(f, 5) = t.x(f, 4);
  expect(only(t), FindingKind::swap_within, 5, 400, 401, 4);
}

TEST(Screen, DefectsAreFoundBesideOneAnother) {
  Trajectories t = testing::walker();
  t.x(100, 0).z() += 0.05;
  for (std::int64_t f = 200; f < 203; ++f) t.x(f, 0).setZero();
  for (std::int64_t f = 301; f <= 330; ++f) t.x(f, 7) = t.x(300, 7);
  const auto findings = found(t);
  ASSERT_THAT(findings, SizeIs(3));
  expect(findings[0], FindingKind::spike, 0, 100, 100);
  expect(findings[1], FindingKind::zero, 0, 200, 202);
  expect(findings[2], FindingKind::stuck, 7, 300, 330);
}

/// A spike, a stuck marker, an exchange of labels and a visit, far from one another; one marker with a gap.
Trajectories spoilt() {
  Trajectories t = testing::walker();
  t.x(100, 0).z() += 0.05;
  for (std::int64_t f = 201; f <= 230; ++f) t.x(f, 7) = t.x(200, 7);
  for (std::int64_t f = 320; f <= 359; ++f) {
    const Eigen::Vector3d one = t.x(f, 1);
    t.x(f, 1) = t.x(f, 2);
    t.x(f, 2) = one;
  }
  for (std::int64_t f = 450; f <= 462; ++f) {
    t.x(f, 5) = t.x(f, 4);
    t.set_missing(f, 4);
  }
  for (std::int64_t f = 520; f <= 540; ++f) t.set_missing(f, 6);
  return t;
}

/// "kind subject partner first-last" of each, in alphabetical order.
std::vector<std::string> summaries_of(const Trajectories& t) {
  std::vector<std::string> out;
  for (const data::Finding& f : found(t)) {
    std::string one = f.subject, other = f.partner;
    if (f.kind == FindingKind::label_swap && other < one) std::swap(one, other);  // named in either order
    out.push_back(std::string(to_string(f.kind)) + " " + one + " " + other + " " +
                  std::to_string(f.first_frame) + "-" + std::to_string(f.last_frame));
  }
  std::ranges::sort(out);
  return out;
}

const std::vector<std::string> kSpoilt{"label swap M1 M2 320-359", "spike M0  100-100", "stuck M7  200-230",
                                       "swap within M5 M4 450-462"};

TEST(ScreenLaws, WhatIsSpoiltIsFound) { EXPECT_EQ(summaries_of(spoilt()), kSpoilt); }

TEST(ScreenLaws, TheLaboratoryMayLieElsewhere) {
  Trajectories t = spoilt();
  const Eigen::Matrix3d rotation =
      Eigen::AngleAxisd(2.1, Eigen::Vector3d(1.0, -2.0, 0.5).normalized()).toRotationMatrix();
  for (std::int64_t f = 0; f < t.frames(); ++f)
    for (std::int64_t m = 0; m < t.markers(); ++m)
      t.x(f, m) = (rotation * t.x(f, m) + Eigen::Vector3d(12.0, -3.0, 0.7)).eval();
  EXPECT_EQ(summaries_of(t), kSpoilt);
}

TEST(ScreenLaws, MarkersMayComeInAnyOrder) {
  const Trajectories t = spoilt();
  for (const std::int64_t step : {3, 5, 7}) {  // of 8 markers
    std::vector<std::string> names;
    for (std::int64_t m = 0; m < 8; ++m) names.push_back(t.names[static_cast<std::size_t>(step * m % 8)]);
    auto other = Trajectories::all_missing(names, t.time);
    for (std::int64_t f = 0; f < t.frames(); ++f)
      for (std::int64_t m = 0; m < 8; ++m) {
        other.x(f, m) = t.x(f, step * m % 8);
        other.state[other.index(f, m)] = t.state[t.index(f, step * m % 8)];
      }
    EXPECT_EQ(summaries_of(other), kSpoilt) << step;
  }
}

TEST(ScreenLaws, AnotherMarkerThatIsNeverSeenChangesNothing) {
  const Trajectories t = spoilt();
  auto names = t.names;
  names.emplace_back("ghost");
  auto more = Trajectories::all_missing(names, t.time);
  for (std::int64_t f = 0; f < t.frames(); ++f)
    for (std::int64_t m = 0; m < t.markers(); ++m) {
      more.x(f, m) = t.x(f, m);
      more.state[more.index(f, m)] = t.state[t.index(f, m)];
    }
  EXPECT_EQ(summaries_of(more), kSpoilt);
}

TEST(ScreenLaws, WhatWasRejectedIsNotFoundAgain) {
  const Trajectories t = spoilt();
  const Trajectories rest = reject_defects(t, found(t)).value();
  EXPECT_THAT(summaries_of(rest), IsEmpty());
  // 1 of the spike, 31 stuck, 40 of each of two labels, 13 of the visit; nothing else was touched.
  EXPECT_EQ(rest.count_missing() - t.count_missing(), 1 + 31 + 2 * 40 + 13);
  EXPECT_EQ(reject_defects(rest, found(t)).value().state, rest.state) << "rejected twice is rejected";
}

TEST(ScreenLaws, WordsNameTheMarkersAndTheFrames) {
  const Trajectories t = spoilt();
  for (const data::Finding& f : found(t)) {
    const std::string sentence = sentence_of(f, t.time);
    EXPECT_THAT(sentence, HasSubstr("'" + f.subject + "'"));
    if (!f.partner.empty()) {
      EXPECT_THAT(sentence, HasSubstr("'" + f.partner + "'"));
    }
    EXPECT_THAT(sentence, HasSubstr(std::to_string(f.first_frame)));
    EXPECT_THAT(sentence, HasSubstr(std::to_string(f.last_frame)));
    EXPECT_TRUE(sentence.starts_with('M') && sentence.ends_with('.')) << sentence;
    EXPECT_EQ(sentence.find(".."), std::string::npos) << sentence;
  }
}

TEST(ScreenLaws, SizesAreThoseOfTheDamage) {
  for (const data::Finding& f : found(spoilt())) {
    if (f.kind == FindingKind::spike) {
      EXPECT_NEAR(f.size, 0.05, 0.005);
    }
    if (f.kind == FindingKind::swap_within) {
      EXPECT_GT(f.size, 0.03) << "no shorter jump is looked for";
    }
  }
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
  for (const data::Finding& wrong : {data::Finding{.subject = "M99", .first_frame = 0, .last_frame = 0},
                                     {.subject = "M0"},
                                     {.subject = "M0", .first_frame = 5, .last_frame = 600},
                                     {.subject = "M0", .first_frame = 5, .last_frame = 4},
                                     {.subject = "M0", .partner = "m1", .first_frame = 5, .last_frame = 5}})
    EXPECT_EQ(reject_defects(t, std::vector{wrong}).error().code, Code::bad_input) << wrong.subject;
}

TEST(RejectFindings, TakesOnlyWhatIsSureEnough) {
  const Trajectories t = testing::walker();
  const std::vector<data::Finding> findings{
      {.kind = FindingKind::spike, .subject = "M1", .first_frame = 7, .last_frame = 8, .confidence = 0.6}};
  EXPECT_EQ(reject_defects(t, findings).value().state, t.state);
  const Trajectories out = reject_defects(t, findings, 0.5).value();
  EXPECT_TRUE(out.validate());
  EXPECT_EQ(out.count_missing(), 2);
}

}  // namespace
}  // namespace kinemark::trajectory
