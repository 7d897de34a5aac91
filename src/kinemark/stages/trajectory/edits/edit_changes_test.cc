// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/trajectory/edits/edit_changes.h"

#include <gmock/gmock.h>

#include "kinemark/stages/trajectory/edits/apply_edits.h"
#include "kinemark/stages/trajectory/edits/testing/edited.h"

namespace kinemark::trajectory {
namespace {

using data::Edit;
using data::EditKind;
using data::SampleState;
using ::testing::IsEmpty;
using ::testing::SizeIs;

data::Trial after(const Edit& edit) {
  return apply_edits(EditedTrial{.trial = testing::moving_trial()}, {{edit}}).value().trial;
}

std::vector<MarkerChange> changes_of(const Edit& edit) {
  return changes_between(testing::moving_trial(), after(edit));
}

TEST(EditChanges, OfNothingAreNone) {
  EXPECT_THAT(changes_between(testing::moving_trial(), testing::moving_trial()), IsEmpty());
  EXPECT_THAT(changes_of({.kind = EditKind::region, .first_frame = 501, .last_frame = 510, .name = "r"}),
              IsEmpty());
}

TEST(EditChanges, OfACutAreTheSamplesThatWent) {
  const auto changes =
      changes_of({.kind = EditKind::cut, .marker = "RKNE", .first_frame = 511, .last_frame = 530});
  ASSERT_THAT(changes, SizeIs(1));
  EXPECT_EQ(changes[0].marker, "RKNE");
  EXPECT_EQ(changes[0].went, 20);
  EXPECT_EQ(changes[0].moved + changes[0].came + changes[0].restated, 0);
  EXPECT_EQ(changes[0].first_frame, 511);
  EXPECT_EQ(changes[0].last_frame, 530);
}

TEST(EditChanges, OfAFillAreTheSamplesThatCame) {
  const auto changes = changes_of({.kind = EditKind::fill, .marker = "LKNE", .method = "linear"});
  ASSERT_THAT(changes, SizeIs(1));
  EXPECT_EQ(changes[0].came, 20);
  EXPECT_EQ(changes[0].first_frame, 541);
  EXPECT_EQ(changes[0].last_frame, 560);
}

TEST(EditChanges, OfASwapAreBothMarkersWithTheWayBetweenThem) {
  const auto trial = testing::moving_trial();
  const auto changes =
      changes_of({.kind = EditKind::swap, .marker = "S:LASI", .other = "S:RASI", .first_frame = 601});
  ASSERT_THAT(changes, SizeIs(2));
  const auto& t = trial.markers;
  double largest = 0.0;
  for (std::int64_t f = 100; f < 200; ++f)
    if (t.present(f, 1)) largest = std::max(largest, (t.x(f, 0) - t.x(f, 1)).norm());
  EXPECT_EQ(changes[0].moved, 95);
  EXPECT_EQ(changes[0].went, 5) << "RASI had a gap there";
  EXPECT_EQ(changes[1].came, 5);
  EXPECT_DOUBLE_EQ(changes[0].largest_m, largest);
  EXPECT_DOUBLE_EQ(changes[1].largest_m, largest);
}

TEST(EditChanges, OfARelabelAreAMarkerThatIsGoneAndOneThatCame) {
  const auto changes = changes_of({.kind = EditKind::relabel, .marker = "*12", .other = "RANK"});
  ASSERT_THAT(changes, SizeIs(2));
  EXPECT_EQ(changes[0].marker, "RANK");
  EXPECT_EQ(changes[0].came, 100);
  EXPECT_EQ(changes[1].marker, "*12");
  EXPECT_EQ(changes[1].went, 100);
}

TEST(EditChanges, OfAStateAloneAreCountedApart) {
  auto before = testing::moving_trial(), now = before;
  now.markers.state[now.markers.index(3, 0)] = SampleState::interpolated;
  now.markers.state[now.markers.index(45, 3)] = SampleState::rejected;  // was missing
  const auto changes = changes_between(before, now);
  ASSERT_THAT(changes, SizeIs(2));
  EXPECT_EQ(changes[0].restated, 1);
  EXPECT_EQ(changes[1].restated, 1);
  EXPECT_EQ(changes[1].first_frame, 546);
}

TEST(EditChanges, OfACropAreNoneOnTheFramesThatAreLeft) {
  EXPECT_THAT(changes_of({.kind = EditKind::crop, .first_frame = 520, .last_frame = 640}), IsEmpty());
}

TEST(AlignedTo, HoldsWhatWasThereOnTheFramesAndMarkersOfAfter) {
  const auto before = testing::moving_trial();
  auto cropped = after({.kind = EditKind::crop, .first_frame = 520, .last_frame = 640});
  cropped.markers.names[4] = "new";
  const auto aligned = aligned_to(before, cropped);
  EXPECT_TRUE(aligned.validate());
  EXPECT_EQ(aligned.names, cropped.markers.names);
  EXPECT_EQ(aligned.frames(), 121);
  for (std::int64_t f = 0; f < 121; ++f)
    for (std::int64_t m = 0; m < 6; ++m) {
      if (m == 4) {
        EXPECT_FALSE(aligned.present(f, m)) << "nobody had that name";
        continue;
      }
      ASSERT_EQ(aligned.present(f, m), before.markers.present(f + 19, m));
      if (aligned.present(f, m)) {
        EXPECT_EQ(aligned.x(f, m), before.markers.x(f + 19, m));
      }
    }
}

}  // namespace
}  // namespace kinemark::trajectory
