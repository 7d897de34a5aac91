// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/trajectory/edits/apply_edits.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "kinemark/stages/trajectory/edits/testing/edited.h"

namespace kinemark::trajectory {
namespace {

using data::Edit;
using data::EditKind;
using testing::bytes_of;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using testing::moving_trial;

data::EditList list_of(std::vector<Edit> edits) {
  data::EditList list{.edits = std::move(edits)};
  int line = 1;
  for (auto& edit : list.edits) edit.line = ++line;
  return list;
}

EditedTrial edited(std::vector<Edit> edits) {
  auto out = apply_edits(moving_trial(), list_of(std::move(edits)));
  EXPECT_TRUE(out) << out.error().message;
  return std::move(*out);
}

std::string why_not(std::vector<Edit> edits) {
  const auto out = apply_edits(moving_trial(), list_of(std::move(edits)));
  EXPECT_FALSE(out);
  if (out) return "";
  EXPECT_EQ(out.error().code, Code::bad_input);
  return out.error().message;
}

TEST(ApplyEdits, NothingChangesNothing) {
  EXPECT_EQ(bytes_of(edited({})), bytes_of(moving_trial()));
  EXPECT_THAT(edited({}).notes, IsEmpty());
}

TEST(ApplyEdits, OperationsWorkOnWhatTheEarlierOnesLeft) {
  const auto out = edited(
      {{.kind = EditKind::relabel, .marker = "RKNE", .other = "LHEE"},
       {.kind = EditKind::cut, .marker = "LHEE", .first_frame = 650, .last_frame = 654},
       {.kind = EditKind::fill, .marker = "LHEE", .first_frame = 650, .last_frame = 654, .method = "cubic"}});
  EXPECT_EQ(out.trial.markers.find("RKNE"), -1);
  EXPECT_EQ(out.trial.markers.made_by(150, 4), "cubic");
  EXPECT_NEAR((out.trial.markers.x(151, 4) - moving_trial().markers.x(151, 4)).norm(), 0.0, 1e-4);
}

TEST(ApplyEdits, AFailureNamesItsLine) {
  EXPECT_EQ(why_not({{.kind = EditKind::cut, .marker = "LKNE"}, {.kind = EditKind::cut, .marker = "LKNE"}}),
            "line 3: cut: 'LKNE' has no sample in frames 501 to 700; need one at least");
  EXPECT_THAT(why_not({{.kind = EditKind::swap, .marker = "LKNE"}}),
              HasSubstr("line 2: swap: swap needs a second marker"));
  EXPECT_THAT(why_not({{.kind = EditKind::undo}}), HasSubstr("line 2: undo of 1 operation"));
  const std::vector<Edit> undo{{.kind = EditKind::undo, .id = "7"}};
  EXPECT_THAT(apply_edits(EditedTrial{.trial = moving_trial()}, undo).error().message,
              HasSubstr("edit '7': undo: is for a list"));
}

TEST(ApplyEdits, CropKeepsNumbersAndTimes) {
  const auto out = edited({{.kind = EditKind::region, .first_frame = 510, .last_frame = 600, .name = "gait"},
                           {.kind = EditKind::region, .first_frame = 501, .last_frame = 505, .name = "still"},
                           {.kind = EditKind::crop, .first_frame = 521, .last_frame = 560},
                           {.kind = EditKind::cut, .marker = "SACR", .first_frame = 521, .last_frame = 521}});
  EXPECT_EQ(out.trial.first_frame, 521);
  EXPECT_EQ(out.trial.last_frame(), 560);
  EXPECT_DOUBLE_EQ(out.trial.markers.time.t0_s, 5.2);
  EXPECT_EQ(out.trial.markers.state[2], data::SampleState::rejected);
  ASSERT_EQ(out.trial.events.size(), 1U);
  EXPECT_EQ(out.trial.events[0].time_s, 5.4);
  EXPECT_THAT(out.regions, ElementsAre(data::Region{.name = "gait", .first_frame = 521, .last_frame = 560}));
  EXPECT_THAT(
      why_not({{.kind = EditKind::crop, .first_frame = 521}, {.kind = EditKind::crop, .first_frame = 510}}),
      HasSubstr("line 3: crop: frame 510 is not there; the recording has frames 521 to 700"));
}

TEST(ApplyEdits, ARegionThatIsThereGetsTheNewFrames) {
  const auto out =
      edited({{.kind = EditKind::region, .first_frame = 510, .last_frame = 600, .name = "gait"},
              {.kind = EditKind::region, .first_frame = 501, .last_frame = 505, .name = "still"},
              {.kind = EditKind::region, .first_frame = 520, .last_frame = 530, .name = "gait"}});
  EXPECT_THAT(out.regions, ElementsAre(data::Region{.name = "gait", .first_frame = 520, .last_frame = 530},
                                       data::Region{.name = "still", .first_frame = 501, .last_frame = 505}));
  EXPECT_EQ(bytes_of(out.trial), bytes_of(moving_trial()));
  EXPECT_THAT(why_not({{.kind = EditKind::region, .first_frame = 1, .last_frame = 5, .name = "x"}}),
              HasSubstr("frame 1 is not there"));
}

TEST(ApplyEdits, EventsAreEdited) {
  const auto out =
      edited({{.kind = EditKind::mark_event, .label = "Turn", .time_s = 5.5},
              {.kind = EditKind::move_event, .label = "Turn", .time_s = 5.5, .to_s = 5.6},
              {.kind = EditKind::delete_event, .label = "Foot Off", .context = "Right", .time_s = 6.2}});
  ASSERT_EQ(out.trial.events.size(), 2U);
  EXPECT_EQ(out.trial.events[1].label, "Turn");
  EXPECT_EQ(out.trial.events[1].time_s, 5.6);
}

TEST(ApplyEdits, CanBeStopped) {
  const std::vector<Edit> edits{{.kind = EditKind::cut, .marker = "LKNE"},
                                {.kind = EditKind::cut, .marker = "RKNE"}};
  std::vector<std::int64_t> seen;
  const auto out = apply_edits(
      EditedTrial{.trial = moving_trial()}, edits,
      {.progress = [&](std::int64_t done, std::int64_t) { return seen.push_back(done), done < 1; }});
  ASSERT_FALSE(out);
  EXPECT_EQ(out.error().code, Code::cancelled);
  EXPECT_THAT(seen, ElementsAre(0, 1));
}

}  // namespace
}  // namespace kinemark::trajectory
