// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/workflow/prepare/marker_screening.h"

#include <gmock/gmock.h>

#include <cmath>

#include "kinemark/core/random.h"

namespace kinemark::workflow {
namespace {

using data::SampleState;
using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;

/// Three markers on smooth paths, 0.5 mm of noise, at the times of the frames.
data::Trial recording(std::int64_t frames = 400, double rate_hz = 100.0) {
  data::Trial trial;
  trial.markers =
      data::Trajectories::all_missing({"A", "B", "C"}, {.rate_hz = rate_hz, .t0_s = 0.0, .frames = frames});
  Random noise(5, 0);
  for (std::int64_t f = 0; f < frames; ++f)
    for (std::int64_t m = 0; m < 3; ++m) {
      const double t = static_cast<double>(f) / rate_hz, at = static_cast<double>(m);
      trial.markers.x(f, m) =
          Eigen::Vector3d(std::sin(2.0 * t + at), 1.0 + 0.3 * at, 0.4 * std::cos(3.0 * t - at));
      for (int axis = 0; axis < 3; ++axis) trial.markers.x(f, m)[axis] += 5e-4 * noise.gaussian();
      trial.markers.state[trial.markers.index(f, m)] = SampleState::measured;
    }
  return trial;
}

/// Every second frame made by the recorder, half-way between its neighbours; analog channels beside.
data::Trial doubled() {
  auto trial = recording();
  auto& markers = trial.markers;
  for (std::int64_t f = 1; f + 1 < markers.frames(); f += 2)
    for (std::int64_t m = 0; m < 3; ++m) markers.x(f, m) = 0.5 * (markers.x(f - 1, m) + markers.x(f + 1, m));
  trial.analog = {.names = {"EMG"}, .units = {"V"}, .rate_hz = 100.0, .samples = markers.frames()};
  trial.analog.values.assign(static_cast<std::size_t>(markers.frames()), 0.0F);
  trial.first_frame = 7;
  return trial;
}

std::int64_t count(const data::Trial& trial, SampleState state) {
  return std::ranges::count(trial.markers.state, state);
}

TEST(ScreenMarkers, ACleanRecordingStaysAsItIs) {
  auto trial = recording();
  const auto before = trial.markers.x_in_world;
  const auto found =
      screen_markers(trial, {.recorder_made = RecorderMade::missing, .reject_defects = true}).value();
  EXPECT_THAT(found.sure, IsEmpty());
  EXPECT_FALSE(found.rejected);
  EXPECT_EQ(found.made_left_out, 0);
  ASSERT_TRUE(found.upsampling);
  EXPECT_FALSE(found.upsampling->recording.found());
  EXPECT_EQ(trial.markers.x_in_world, before);
}

TEST(ScreenMarkers, ASpikeIsReportedAndRejectedOnlyWhenAsked) {
  auto trial = recording();
  trial.markers.x(50, 1).x() += 0.2;
  auto reported = trial;
  const auto only_reported = screen_markers(reported, {}).value();
  ASSERT_EQ(only_reported.sure.size(), 1U);
  EXPECT_EQ(only_reported.sure[0].subject, trial.markers.names[1]);
  EXPECT_FALSE(only_reported.rejected);
  EXPECT_TRUE(reported.markers.present(50, 1));
  const auto rejected = screen_markers(trial, {.reject_defects = true}).value();
  EXPECT_TRUE(rejected.rejected);
  EXPECT_EQ(trial.markers.state[trial.markers.index(50, 1)], SampleState::rejected);
  EXPECT_EQ(count(trial, SampleState::rejected), 1);
}

TEST(ScreenMarkers, WhereDefectsTakeTooMuchNothingIsRejected) {
  auto trial = recording();
  trial.markers.x(50, 1).x() += 0.2;
  const auto found = screen_markers(trial, {.reject_defects = true, .most_rejected = 1e-4}).value();
  EXPECT_NEAR(found.sure_share, 1.0 / 1200.0, 1e-4);
  EXPECT_FALSE(found.rejected);
  EXPECT_TRUE(trial.markers.present(50, 1));
}

TEST(ScreenMarkers, NothingIsLookedForThatWasNotAsked) {
  auto trial = doubled();
  trial.markers.x(50, 1).x() += 0.2;
  const auto found = screen_markers(trial, {.find_upsampling = false,
                                            .recorder_made = RecorderMade::missing,
                                            .find_defects = false,
                                            .reject_defects = true})
                         .value();
  EXPECT_THAT(found.defects, IsEmpty());
  EXPECT_FALSE(found.upsampling);
  EXPECT_EQ(trial.markers.count_missing(), 0);
}

TEST(ScreenMarkers, MadeSamplesAreMarkedRemovedOrDecimated) {
  auto kept = doubled();
  const auto reported = screen_markers(kept, {.recorder_made = RecorderMade::keep}).value();
  EXPECT_EQ(reported.upsampling->recording.factor, 2);
  EXPECT_EQ(count(kept, SampleState::measured), 1200);
  auto marked = doubled();
  ASSERT_TRUE(screen_markers(marked, {.recorder_made = RecorderMade::mark}));
  EXPECT_NEAR(static_cast<double>(count(marked, SampleState::upsampled)), 600.0, 6.0);
  auto missing = doubled();
  const auto left_out = screen_markers(missing, {.recorder_made = RecorderMade::missing}).value();
  EXPECT_EQ(left_out.made_left_out, missing.markers.count_missing());
  EXPECT_NEAR(static_cast<double>(left_out.made_left_out), 600.0, 6.0);
  EXPECT_EQ(missing.analog.names.size(), 1U) << "the frames are the same";
  EXPECT_EQ(missing.first_frame, 7);
}

TEST(ScreenMarkers, AnotherRateLeavesOutWhatBelongsToTheOldFrames) {
  auto trial = doubled();
  const auto found = screen_markers(trial, {.recorder_made = RecorderMade::decimate}).value();
  EXPECT_EQ(trial.markers.frames(), 200);
  EXPECT_DOUBLE_EQ(trial.markers.time.rate_hz, 50.0);
  EXPECT_TRUE(trial.analog.names.empty());
  EXPECT_EQ(trial.first_frame, 1);
  EXPECT_THAT(
      found.warnings,
      ElementsAre("1 analog channel left out: samples belong to the frames as they were recorded, not "
                  "to those of 50 Hz"));
  auto bare = doubled();
  bare.analog = {};
  const auto none = screen_markers(bare, {.recorder_made = RecorderMade::decimate}).value();
  EXPECT_EQ(bare.markers.frames(), 200);
  EXPECT_THAT(none.warnings, Not(Contains(HasSubstr("samples belong to the frames as they were recorded"))));
}

TEST(ScreenMarkers, MadeFirstFindsDefectsInWhatIsLeft) {
  // A made sample that stands out is no defect of the real ones.
  auto trial = doubled();
  trial.markers.x(101, 1).x() += 0.2;
  auto first = trial;
  const auto as_recorded = screen_markers(trial, {.recorder_made = RecorderMade::missing}).value();
  EXPECT_EQ(as_recorded.sure.size(), 1U);
  const auto made_first =
      screen_markers(first, {.recorder_made = RecorderMade::missing, .made_first = true}).value();
  EXPECT_THAT(made_first.sure, IsEmpty());
}

TEST(ScreenMarkers, MarkersThatAPersonSwappedStayAsTheyAre) {
  auto swapped = recording();
  const auto names = swapped.markers.names;
  for (std::int64_t f = 100; f < 140; ++f) {
    const Eigen::Vector3d x = swapped.markers.x(f, 0);
    swapped.markers.x(f, 0) = Eigen::Vector3d(swapped.markers.x(f, 1));
    swapped.markers.x(f, 1) = x;
  }
  const auto as_it_is = swapped.markers.x_in_world;
  auto repaired = swapped;
  const auto found = screen_markers(repaired, {.exchange_back = true}).value();
  ASSERT_EQ(found.exchanged.size(), 1U);
  EXPECT_THAT(found.edited, IsEmpty());
  EXPECT_THAT(swap_sentences(found, repaired.markers.time),
              Not(Contains(HasSubstr("Left as edits have it: "))));
  for (const bool exchange_back : {true, false}) {
    auto kept = swapped;
    const auto left =
        screen_markers(
            kept, {.exchange_back = exchange_back, .swapped = {{names[1], names[0]}}, .reject_defects = true})
            .value();
    EXPECT_THAT(left.exchanged, IsEmpty());
    EXPECT_EQ(left.edited.size(), 1U);
    EXPECT_THAT(swap_sentences(left, kept.markers.time), Contains(HasSubstr("Left as edits have it: ")));
    EXPECT_THAT(left.sure, IsEmpty());
    EXPECT_EQ(left.defects.size(), found.defects.size()) << "it is said all the same";
    EXPECT_EQ(kept.markers.x_in_world, as_it_is);
  }
  // Another pair is no reason.
  auto other = swapped;
  EXPECT_EQ(screen_markers(other, {.exchange_back = true, .swapped = {{names[0], names[2]}}})
                .value()
                .exchanged.size(),
            1U);
}

TEST(NoteOnUpsampling, IsSaidOfSamplesThatTheRecorderMade) {
  const auto said = note_on_upsampling(doubled().markers).value();
  EXPECT_THAT(said, HasSubstr("the recorder measured at 50 Hz and made 1 of every 2 frames: these are no"));
  EXPECT_EQ(note_on_upsampling(recording().markers).value(), "");
  EXPECT_EQ(
      note_on_upsampling(data::Trajectories::all_missing({"A"}, {.rate_hz = 100.0, .frames = 300})).value(),
      "");
  EXPECT_EQ(note_on_upsampling({}).value(), "");
  std::vector<std::string> warnings;
  auto made = doubled(), measured = recording();
  ASSERT_TRUE(leave_out_defects(made, false, {}, warnings));
  EXPECT_THAT(warnings, Contains(said));
  warnings.clear();
  ASSERT_TRUE(leave_out_defects(measured, false, {}, warnings));
  EXPECT_THAT(warnings, Not(Contains(HasSubstr(" frames: these are no measurements of their own"))));
}

TEST(LeaveOutDefects, FiveAreSaidAndHowManyMore) {
  std::vector<std::string> warnings;
  auto clean = recording();
  ASSERT_TRUE(leave_out_defects(clean, false, {}, warnings));
  EXPECT_THAT(warnings, IsEmpty());
  auto spoilt = recording();
  for (std::int64_t k = 0; k < 8; ++k) spoilt.markers.x(40 + 40 * k, k % 3)[0] += 0.3;
  auto kept = spoilt;
  ASSERT_TRUE(leave_out_defects(kept, true, {}, warnings));
  EXPECT_THAT(warnings, IsEmpty());
  EXPECT_EQ(count(kept, SampleState::rejected), 0);
  ASSERT_TRUE(leave_out_defects(spoilt, false, {}, warnings));
  ASSERT_EQ(warnings.size(), 6u);
  EXPECT_THAT(warnings[0], ::testing::StartsWith("Left out: "));
  EXPECT_EQ(warnings[5], "Left out: 3 more defects like these.");
  auto five = recording();
  for (std::int64_t k = 0; k < 5; ++k) five.markers.x(40 + 40 * k, k % 3)[0] += 0.3;
  warnings.clear();
  ASSERT_TRUE(leave_out_defects(five, false, {}, warnings));
  EXPECT_EQ(warnings.size(), 5u);
  EXPECT_THAT(warnings, Not(Contains(HasSubstr("more defects like these."))));
  EXPECT_EQ(count(spoilt, SampleState::rejected), 8);
}

TEST(ScreenMarkers, AnInvalidTrialIsOneSentence) {
  auto trial = recording();
  trial.markers.state.pop_back();
  EXPECT_FALSE(screen_markers(trial, {}));
}

TEST(RecorderMadeNames, ComeBack) {
  for (const auto made :
       {RecorderMade::keep, RecorderMade::mark, RecorderMade::missing, RecorderMade::decimate})
    EXPECT_EQ(parse_recorder_made(to_string(made)).value(), made);
  EXPECT_THAT(parse_recorder_made("drop").error().message, HasSubstr("keep, mark, missing and decimate"));
}

}  // namespace
}  // namespace kinemark::workflow
