// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/trajectory/edits/internal/marker_edits.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <functional>

#include "kinemark/stages/trajectory/edits/testing/edited.h"
#include "kinemark/stages/trajectory/edits/testing/numbered_trial.h"
#include "kinemark/stages/trajectory/gaps/fill_gaps.h"

namespace kinemark::trajectory::internal {
namespace {

using data::Edit;
using ::testing::HasSubstr;
using testing::moving_trial;
using ::testing::Not;

Edit event(double time_s, double to_s = 0.0) {
  return {.label = "Foot Strike", .context = "Left", .time_s = time_s, .to_s = to_s};
}

std::string why_not(Status (*verb)(data::Trial&, const Edit&), const Edit& edit) {
  auto trial = moving_trial();
  const auto s = verb(trial, edit);
  EXPECT_FALSE(s);
  EXPECT_EQ(testing::bytes_of(trial), testing::bytes_of(moving_trial())) << "a refusal changes nothing";
  return s ? "" : s.error().message;
}

TEST(EventEdits, MarkMoveDelete) {
  auto trial = moving_trial();
  ASSERT_TRUE(mark_event(trial, event(6.0)));
  ASSERT_EQ(trial.events.size(), 3U);
  EXPECT_EQ(trial.events[2].label, "Foot Strike");
  EXPECT_EQ(trial.events[2].context, "Left");
  EXPECT_EQ(trial.events[2].time_s, 6.0);
  ASSERT_TRUE(move_event(trial, event(5.4, 5.5)));
  EXPECT_EQ(trial.events[0].time_s, 5.5);
  ASSERT_TRUE(delete_event(trial, event(6.0)));
  EXPECT_EQ(trial.events.size(), 2U);
  EXPECT_EQ(trial.events[1].label, "Foot Off");
}

TEST(EventEdits, TheOneWithinHalfAFrameIsMeant) {
  auto trial = moving_trial();
  trial.events.push_back({.label = "Foot Strike", .context = "Left", .time_s = 5.402});
  ASSERT_TRUE(delete_event(trial, event(5.4045)));
  EXPECT_EQ(trial.events.size(), 2U);
  EXPECT_EQ(trial.events[0].time_s, 5.4) << "the nearest of two";
  ASSERT_TRUE(move_event(trial, event(5.4, 5.401))) << "it does not stand in its own way";
}

TEST(EventEdits, WhatIsNotThereOrCannotBeIsSaid) {
  EXPECT_THAT(why_not(delete_event, event(5.41)),
              HasSubstr("no event 'Foot Strike' (Left) is at 5.41 s; the nearest of that name is at 5.4 s"));
  EXPECT_THAT(why_not(delete_event, {.label = "Foot Strike", .time_s = 5.4}),
              HasSubstr("no event 'Foot Strike' is at 5.4 s; there is none of that name"));
  EXPECT_THAT(why_not(delete_event, event(5.41)), Not(HasSubstr("there is none of that name")));
  EXPECT_THAT(why_not(delete_event, {.label = "Foot Strike", .time_s = 5.4}),
              Not(HasSubstr("the nearest of that name is at")));
  EXPECT_THAT(why_not(move_event, event(5.4, 7.1)),
              HasSubstr("7.1 s lies outside the recording, which lasts from 5 to 6.99 s"));
  EXPECT_THAT(why_not(mark_event, event(4.9)), HasSubstr("lies outside"));
  EXPECT_THAT(why_not(mark_event, event(5.404)), HasSubstr("is at 5.4 s already"));
}

TEST(EventEdits, TheEndsOfTheRecordingBelongToIt) {
  auto trial = moving_trial();
  EXPECT_TRUE(mark_event(trial, event(4.995)));
  EXPECT_TRUE(mark_event(trial, event(6.995)));
  EXPECT_FALSE(mark_event(trial, event(6.999)));
}

using data::Edit;
using data::SampleState;
using testing::bytes_of;
using ::testing::Each;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using testing::moving_trial;
using ::testing::Not;
using testing::numbered_trial;

using Verb = std::function<Status(data::Trial&, const Edit&)>;

Status fill_only(data::Trial& trial, const Edit& edit) {
  std::vector<std::string> notes;
  return fill(trial, edit, {}, notes);
}

data::Trial after(const Verb& verb, const Edit& edit, data::Trial trial = moving_trial()) {
  const auto s = verb(trial, edit);
  EXPECT_TRUE(s) << s.error().message;
  const auto valid = trial.validate();
  EXPECT_TRUE(valid) << valid.error().message;
  return trial;
}

std::string why_not(const Verb& verb, const Edit& edit, const data::Trial& trial = moving_trial()) {
  auto touched = trial;
  const auto s = verb(touched, edit);
  EXPECT_FALSE(s) << describe(edit);
  EXPECT_EQ(bytes_of(touched), bytes_of(trial)) << "a refusal changes nothing";
  return s ? "" : s.error().message;
}

std::int64_t count(const data::Trial& trial, std::int64_t marker, SampleState state) {
  std::int64_t n = 0;
  for (std::int64_t f = 0; f < trial.markers.frames(); ++f)
    n += trial.markers.state[trial.markers.index(f, marker)] == state;
  return n;
}

TEST(MarkerEdits, FramesAreTheFilesOwn) {
  const auto trial = moving_trial();
  const auto all = frames_of({}, trial).value();
  EXPECT_EQ(all.first, 0);
  EXPECT_EQ(all.count, 200);
  const auto some = frames_of({.first_frame = 510, .last_frame = 519}, trial).value();
  EXPECT_EQ(some.first, 9);
  EXPECT_EQ(some.count, 10);
  EXPECT_THAT(frames_of({.first_frame = 500}, trial).error().message,
              HasSubstr("frame 500 is not there; the recording has frames 501 to 700"));
  EXPECT_FALSE(frames_of({.last_frame = 701}, trial));
  EXPECT_FALSE(frames_of({}, data::Trial{}));
}

TEST(MarkerEdits, UnknownNamesComeWithTheNearest) {
  for (const Verb& verb : {Verb(cut), Verb(swap_markers), Verb(relabel), Verb(fill_only), Verb(unfill)})
    EXPECT_THAT(why_not(verb, {.marker = "LKNI", .other = "RKNE"}),
                HasSubstr("no marker is named 'LKNI'; nearest: LKNE"));
  EXPECT_THAT(why_not(swap_markers, {.marker = "LKNE", .other = "zzz"}),
              HasSubstr("no marker is named 'zzz'; there are S:LASI"));
  EXPECT_THAT(why_not(cut, {.marker = "angle"}, numbered_trial()),
              HasSubstr("'angle' is an output of a model"));
  EXPECT_THAT(why_not(relabel, {.marker = "A", .other = "angle"}, numbered_trial()),
              HasSubstr("'angle' is an output of a model"));
}

TEST(MarkerEdits, RelabelOfAWholeMarkerRenamesIt) {
  const auto before = moving_trial();
  auto trial = after(relabel, {.marker = "*12", .other = "LHEE"});
  EXPECT_EQ(trial.markers.names[5], "LHEE");
  trial.markers.names[5] = "*12";
  EXPECT_EQ(bytes_of(trial), bytes_of(before));
  EXPECT_EQ(after(relabel, {.marker = "LASI", .other = "LASI2"}).markers.names[0], "LASI2")
      << "without its prefix";
  EXPECT_EQ(after(relabel, {.marker = "S:LASI", .other = "LASI"}).markers.names[0], "LASI");
}

TEST(MarkerEdits, RelabelIntoTheGapOfAnother) {
  auto before = moving_trial();
  for (std::int64_t f = 100; f < 200; ++f) before.markers.set_missing(f, 4);
  const auto trial = after(relabel, {.marker = "*12", .other = "RKNE"}, before);
  EXPECT_EQ(trial.markers.find("*12"), -1) << "nothing is left of it";
  EXPECT_EQ(trial.markers.markers(), 5);
  EXPECT_EQ(count(trial, 4, SampleState::measured), 200);
  EXPECT_EQ(Eigen::Vector3d(trial.markers.x(150, 4)), Eigen::Vector3d(before.markers.x(150, 5)));
  EXPECT_EQ(trial.markers.time_s(150, 4), before.markers.time_s(150, 5)) << "samples keep their times";
  EXPECT_EQ(trial.camera_mask[trial.markers.index(150, 4)], 6);
}

TEST(MarkerEdits, RelabelOfSomeFramesMakesAMarkerOfThem) {
  const auto before = moving_trial();
  const auto trial = after(relabel, {.marker = "LKNE", .other = "NEW", .first_frame = 601});
  ASSERT_EQ(trial.markers.names.back(), "NEW");
  EXPECT_EQ(count(trial, 6, SampleState::measured), 100);
  EXPECT_EQ(count(trial, 3, SampleState::measured), 80);
  EXPECT_EQ(Eigen::Vector3d(trial.markers.x(199, 6)), Eigen::Vector3d(before.markers.x(199, 3)));
}

TEST(MarkerEdits, RelabelNeverLaysSamplesOverOthers) {
  EXPECT_THAT(why_not(relabel, {.marker = "RKNE", .other = "LKNE"}),
              HasSubstr("both 'RKNE' and 'LKNE' have samples in 180 frames, the first of them frame 501"));
  const auto gap = after(relabel, {.marker = "RKNE", .other = "LKNE", .first_frame = 541, .last_frame = 560});
  EXPECT_EQ(count(gap, 3, SampleState::measured), 200);
  EXPECT_EQ(count(gap, 4, SampleState::missing), 20);
  EXPECT_THAT(why_not(relabel, {.marker = "*12", .other = "LKNE", .last_frame = 560}),
              HasSubstr("'*12' has no sample in frames 501 to 560"));
  EXPECT_THAT(why_not(relabel, {.marker = "LASI", .other = "S:LASI"}), HasSubstr("has that name already"));
}

TEST(MarkerEdits, SwapFromAMomentOn) {
  const auto before = moving_trial();
  const auto trial = after(swap_markers, {.marker = "LASI", .other = "RASI", .first_frame = 651});
  EXPECT_EQ(Eigen::Vector3d(trial.markers.x(149, 0)), Eigen::Vector3d(before.markers.x(149, 0)));
  EXPECT_EQ(Eigen::Vector3d(trial.markers.x(199, 0)), Eigen::Vector3d(before.markers.x(199, 1)));
  EXPECT_FALSE(trial.markers.present(152, 0)) << "gaps are swapped too";
  EXPECT_THAT(why_not(swap_markers, {.marker = "LASI", .other = "S:LASI"}), HasSubstr("are one marker"));
}

TEST(MarkerEdits, CutSamplesAreRejected) {
  const auto trial = after(cut, {.marker = "LKNE", .first_frame = 531, .last_frame = 550});
  EXPECT_EQ(count(trial, 3, SampleState::rejected), 10);
  EXPECT_EQ(count(trial, 3, SampleState::missing), 20) << "what was missing stays so";
  EXPECT_EQ(trial.camera_mask[trial.markers.index(35, 3)], 0);
  EXPECT_THAT(why_not(cut, {.marker = "LKNE", .first_frame = 541, .last_frame = 541}),
              HasSubstr("has no sample in frame 541"));
}

TEST(MarkerEdits, FillIsThatOfTheGapMethod) {
  const auto before = moving_trial();
  for (const GapMethod method :
       {GapMethod::linear, GapMethod::cubic, GapMethod::pchip, GapMethod::walk, GapMethod::rigid,
        GapMethod::regression, GapMethod::pca, GapMethod::automatic}) {
    const auto trial = after(fill_only, {.marker = "LKNE", .method = std::string(to_string(method))});
    const auto all =
        fill_gaps(before.markers, {.method = method, .max_sd_m = std::numeric_limits<double>::infinity()})
            .value();
    for (std::int64_t f = 40; f < 60; ++f) {
      ASSERT_EQ(Eigen::Vector3d(trial.markers.x(f, 3)), Eigen::Vector3d(all.trajectories.x(f, 3)))
          << to_string(method);
      ASSERT_EQ(trial.markers.made_by(f, 3), all.trajectories.made_by(f, 3));
      ASSERT_EQ(trial.markers.covariance[6 * trial.markers.index(f, 3)],
                all.trajectories.covariance[6 * trial.markers.index(f, 3)]);
    }
    EXPECT_FALSE(trial.markers.present(152, 1)) << "others stay as they are";
    EXPECT_FALSE(trial.markers.present(5, 5));
  }
}

TEST(MarkerEdits, FillKeepsToItsRange) {
  const auto whole = after(fill_only, {.marker = "LKNE", .method = "pchip"});
  const auto part =
      after(fill_only, {.marker = "LKNE", .first_frame = 545, .last_frame = 550, .method = "pchip"});
  EXPECT_EQ(count(part, 3, SampleState::missing), 14);
  EXPECT_EQ(count(part, 3, SampleState::interpolated), 6);
  EXPECT_EQ(Eigen::Vector3d(part.markers.x(45, 3)), Eigen::Vector3d(whole.markers.x(45, 3)));
  const auto cut_first = after(cut, {.marker = "LKNE", .first_frame = 561, .last_frame = 565});
  const auto both = after(fill_only, {.marker = "LKNE", .last_frame = 560, .method = "cubic"}, cut_first);
  EXPECT_EQ(count(both, 3, SampleState::interpolated), 20);
  EXPECT_EQ(count(both, 3, SampleState::rejected), 5) << "as they were";
}

TEST(MarkerEdits, FillSaysWhyNot) {
  EXPECT_THAT(why_not(fill_only, {.marker = "SACR"}), HasSubstr("'S:SACR' has no gap in frames 501 to 700"));
  EXPECT_THAT(why_not(fill_only, {.marker = "LKNE", .method = "magic"}), HasSubstr("gap method 'magic'"));
  EXPECT_THAT(why_not(fill_only, {.marker = "LKNE", .method = "none"}), HasSubstr("fills nothing"));
  EXPECT_THAT(why_not(fill_only, {.marker = "*12", .method = "cubic"}),
              HasSubstr("cannot be filled: no sample on one side"));
  auto trial = moving_trial();
  trial.markers.set_missing(150, 5);
  std::vector<std::string> notes;
  ASSERT_TRUE(fill(trial, {.marker = "*12", .method = "cubic", .line = 4}, {}, notes));
  EXPECT_THAT(
      notes,
      ElementsAre(HasSubstr("line 4: fill: the gap of '*12' in frames 501 to 600 stays open: no sample")));
  notes.clear();
  ASSERT_TRUE(fill(trial, {.marker = "LKNE", .method = "cubic", .line = 5}, {}, notes));
  EXPECT_THAT(notes, Each(Not(HasSubstr(": fill: the gap of '"))));
}

TEST(MarkerEdits, UnfillTakesFilledSamplesAlone) {
  const auto filled = after(fill_only, {.marker = "LKNE", .method = "cubic"});
  const auto trial = after(unfill, {.marker = "LKNE", .last_frame = 550}, filled);
  EXPECT_EQ(count(trial, 3, SampleState::missing), 10);
  EXPECT_EQ(count(trial, 3, SampleState::interpolated), 10);
  EXPECT_EQ(count(trial, 3, SampleState::measured), 180);
  EXPECT_EQ(trial.markers.made_by(45, 3), "");
  EXPECT_THAT(why_not(unfill, {.marker = "LKNE"}),
              HasSubstr("'LKNE' has no filled sample in frames 501 to 700"));
}

}  // namespace

}  // namespace kinemark::trajectory::internal
