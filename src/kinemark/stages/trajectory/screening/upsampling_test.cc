// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/trajectory/screening/upsampling.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>

#include "kinemark/stages/trajectory/screening/testing/walker.h"

namespace kinemark::trajectory {
namespace {

using data::InterpolationKernel;

using data::SampleState;
using data::Trajectories;
using ::testing::AllOf;
using ::testing::Contains;
using ::testing::HasSubstr;
using ::testing::Not;

Trajectories linear_recording(int factor, int phase, std::int64_t frames = 1200) {
  Trajectories t = testing::walker({.frames = frames, .rate_hz = 60.0 * factor});
  for (std::int64_t m = 0; m < t.markers(); ++m) testing::interpolate_linearly(t, factor, phase, m);
  return t;
}

TEST(DetectUpsampling, FindsFactorAndPhaseOfEveryMarker) {
  for (const int factor : {2, 3, 4, 5, 6})
    for (const int phase : {0, factor - 1}) {
      const auto report = detect_upsampling(linear_recording(factor, phase, 150 * factor)).value();
      EXPECT_EQ(report.recording.factor, factor);
      EXPECT_EQ(report.recording.phase, phase);
      EXPECT_EQ(report.recording.kernel, factor == 2 ? report.recording.kernel : InterpolationKernel::linear);
      for (const data::Upsampling& u : report.markers) {
        EXPECT_EQ(u.factor, factor);
        EXPECT_EQ(u.phase, phase);
        EXPECT_LT(u.ratio, 0.1);
        EXPECT_GE(u.agreement, 0.97);
        EXPECT_LT(u.residual_m, 3.0 * u.rounding_m);
      }
      EXPECT_THAT(report.sentences.front(),
                  HasSubstr("(counted from 0); the others follow from them within"));
      EXPECT_THAT(report.sentences.front(), Not(HasSubstr("No interpolation from a lower rate was found")));
      EXPECT_THAT(report.sentences.front(), Not(HasSubstr(" The phase changes ")));
    }
}

TEST(DetectUpsampling, LeavesAnHonestRecordingAlone) {
  for (const double noise : {0.0, 0.00002, 0.001}) {
    const auto report = detect_upsampling(testing::walker({.frames = 900, .noise_m = noise})).value();
    EXPECT_FALSE(report.recording.found());
    for (const data::Upsampling& u : report.markers) EXPECT_EQ(u.factor, 1) << noise;
    EXPECT_THAT(report.sentences.front(), HasSubstr("No interpolation from a lower rate was found in"));
    EXPECT_THAT(report.sentences.front(), Not(HasSubstr("Interpolation from a lower rate cannot be looked")));
    EXPECT_THAT(report.sentences.front(), Not(HasSubstr("others follow from them within")));
  }
}

TEST(DetectUpsampling, SaysWhatItCannotSee) {
  const auto report = detect_upsampling(testing::walker()).value();
  EXPECT_THAT(report.sentences.back(), HasSubstr("low-pass"));
  EXPECT_THAT(report.sentences.back(), HasSubstr("band-limited"));
}

TEST(DetectUpsampling, TheSpectrumIsGivenWhereThereIsOne) {
  const auto open = detect_upsampling(testing::walker({.frames = 3000, .noise_m = 0.001})).value().sentences;
  ASSERT_EQ(open.size(), 3U);
  EXPECT_THAT(open[1], AllOf(HasSubstr("Spectrum: open; noise of "), HasSubstr(" mm near half the rate, "),
                             HasSubstr(" mm in the middle of the band, content up to ")));
  EXPECT_THAT(open[1], Not(HasSubstr("low-passed or model-generated")));
  const auto model = detect_upsampling(testing::walker({.frames = 600, .noise_m = 0.0})).value().sentences;
  EXPECT_THAT(model[1], HasSubstr("Spectrum: low-passed or model-generated; noise of"));
  const auto few = detect_upsampling(testing::walker({.frames = 60})).value().sentences;
  EXPECT_THAT(few, Not(Contains(HasSubstr(" mm in the middle of the band"))));
  EXPECT_THAT(few, Not(Contains(HasSubstr(", content up to "))));
}

TEST(DetectUpsampling, OneInterpolatedMarkerAmongHonestOnesIsNamed) {
  Trajectories t = testing::walker({.markers = 4, .frames = 900});
  testing::interpolate_linearly(t, 3, 1, 2);
  const auto report = detect_upsampling(t).value();
  EXPECT_FALSE(report.recording.found());
  EXPECT_EQ(report.markers[2].factor, 3);
  EXPECT_EQ(report.markers[2].phase, 1);
  EXPECT_FALSE(report.markers[1].found());
  EXPECT_THAT(report.sentences, Contains(HasSubstr("Marker 'M2': Made from")));
}

TEST(DetectUpsampling, MultiplexedMarkersShareAFactorAndHaveTheirOwnPhase) {
  Trajectories t = testing::walker({.frames = 1200, .rate_hz = 240.0});
  for (std::int64_t m = 0; m < t.markers(); ++m)
    testing::interpolate_linearly(t, 4, static_cast<int>(m % 4), m);
  const auto report = detect_upsampling(t).value();
  EXPECT_EQ(report.recording.factor, 4);
  for (std::size_t m = 0; m < report.markers.size(); ++m) {
    EXPECT_EQ(report.markers[m].factor, 4);
    EXPECT_EQ(report.markers[m].phase, static_cast<int>(m % 4));
  }
}

TEST(DetectUpsampling, PhaseCountsFromTheFirstFrameAcrossGaps) {
  Trajectories t = linear_recording(4, 2);
  for (std::int64_t f = 301; f < 350; ++f) t.set_missing(f, 0);
  for (std::int64_t f = 0; f < 77; ++f) t.set_missing(f, 1);
  const auto report = detect_upsampling(t).value();
  EXPECT_EQ(report.markers[0].phase, 2);
  EXPECT_EQ(report.markers[1].phase, 2);
}

TEST(DetectUpsampling, AStreamWithTooLittleToSeeFollowsTheRecording) {
  Trajectories t = linear_recording(4, 1);
  for (std::int64_t f = 0; f < t.frames(); ++f)
    if (f < 100 || f > 130) t.set_missing(f, 3);
  const auto report = detect_upsampling(t).value();
  EXPECT_EQ(report.markers[3].factor, 4);
  EXPECT_TRUE(report.markers[3].inherited);
  EXPECT_FALSE(report.markers[2].inherited);
}

TEST(DetectUpsampling, FollowsAPhaseThatSlips) {
  Trajectories t = linear_recording(4, 0, 1600);
  Trajectories cut = Trajectories::all_missing(t.names, {.rate_hz = 240.0, .t0_s = 0.0, .frames = 1599});
  for (std::int64_t f = 0; f < 1599; ++f)  // frame 701 is lost
    for (std::int64_t m = 0; m < t.markers(); ++m) {
      cut.x(f, m) = t.x(f < 701 ? f : f + 1, m);
      cut.state[cut.index(f, m)] = SampleState::measured;
    }
  const auto report = detect_upsampling(cut).value();
  ASSERT_EQ(report.recording.factor, 4);
  ASSERT_EQ(report.recording.runs.size(), 2U);
  EXPECT_EQ(report.recording.runs[0].phase, 0);
  EXPECT_EQ(report.recording.runs[1].phase, 3);
  EXPECT_NEAR(static_cast<double>(report.recording.runs[1].first_frame), 701.0, 4.0);
  EXPECT_EQ(report.recording.phase_at(100), 0);
  EXPECT_EQ(report.recording.phase_at(1500), 3);
  EXPECT_TRUE(report.recording.real(400));
  EXPECT_FALSE(report.recording.real(401));
  EXPECT_TRUE(report.recording.real(1199));
  EXPECT_THAT(report.sentences.front(), HasSubstr(" blocks. The phase changes 1 times."));
}

TEST(DetectUpsampling, UsesPiecesOfALongRecordingAndFollowsAll) {
  const auto report =
      detect_upsampling(linear_recording(3, 2, 30'000), {.max_factor = 4, .max_frames = 5000}).value();
  EXPECT_EQ(report.recording.factor, 3);
  EXPECT_EQ(report.markers[0].runs.size(), 1U);
  EXPECT_LT(report.markers[0].blocks, 450);
}

TEST(DetectUpsampling, OddInputIsAnswered) {
  const auto answer = [](const Trajectories& t) { return detect_upsampling(t).value(); };
  EXPECT_TRUE(answer(Trajectories::all_missing({}, {.rate_hz = 100.0})).markers.empty());
  EXPECT_FALSE(answer(testing::walker({.frames = 1})).recording.found());
  EXPECT_FALSE(answer(Trajectories::all_missing({"A"}, {.rate_hz = 100.0, .t0_s = 0.0, .frames = 500}))
                   .recording.found());
  Trajectories still = testing::walker({.markers = 2});
  for (std::int64_t f = 0; f < still.frames(); ++f)
    for (std::int64_t m = 0; m < 2; ++m) still.x(f, m).setConstant(0.25);
  const auto report = answer(still);
  EXPECT_FALSE(report.recording.found());
  EXPECT_EQ(report.recording.blocks, 0);
  EXPECT_EQ(report.sentences.front(),
            "Interpolation from a lower rate cannot be looked for: no block tells phases apart.");
}

TEST(DetectUpsampling, RefusesOptionsAndTrajectoriesThatDoNotHold) {
  EXPECT_THAT(detect_upsampling(testing::walker(), {.max_factor = 13}).error().message, HasSubstr("2 to 12"));
  EXPECT_THAT(detect_upsampling(testing::walker(), {.max_frames = 10}).error().message,
              HasSubstr("1000 or more"));
  Trajectories broken = testing::walker();
  broken.x(3, 2).setConstant(std::numeric_limits<double>::infinity());
  EXPECT_EQ(detect_upsampling(broken).error().code, Code::bad_input);
}

}  // namespace
}  // namespace kinemark::trajectory
