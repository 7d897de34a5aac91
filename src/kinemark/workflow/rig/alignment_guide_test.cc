// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/workflow/rig/alignment_guide.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "kinemark/stages/simulation/rig_recording.h"

namespace kinemark::workflow {
namespace {

using testing::HasSubstr;
using testing::Not;

simulation::PhysicalRig rig_of(std::uint64_t seed) {
  simulation::RigDrawOptions options;
  options.seed = seed;
  return *simulation::draw_rig(options);
}

std::vector<double> sides() {
  const auto s = simulation::tree_sides_m();
  return {s[0], s[1], s[2]};
}

data::Counts shown(const simulation::PhysicalRig& rig, int pose, std::int64_t frames) {
  simulation::RigRecordingOptions options;
  options.frames = frames;
  options.stream = static_cast<std::uint64_t>(pose);
  return simulation::record(
             rig, simulation::still_tree(simulation::tree_test_poses()[static_cast<std::size_t>(pose)]),
             options)
      ->counts;
}

void push(AlignmentGuide& guide, const data::Counts& counts) {
  const auto observations = static_cast<std::size_t>(counts.led_count() * counts.camera_count());
  for (std::int64_t f = 0; f < counts.frames(); ++f) {
    const auto at = static_cast<std::size_t>(f) * observations;
    guide.push(std::span(counts.counts).subspan(4 * at, 4 * observations),
               std::span(counts.flags).subspan(at, observations));
  }
}

TEST(AlignmentGuide, AsksForPosesAndThenSaysTheNextAdjustment) {
  const auto rig = rig_of(11);
  auto guide = AlignmentGuide::create(shown(rig, 0, 1), rig.nominal, sides());
  ASSERT_TRUE(guide) << guide.error().message;
  for (int pose = 0; pose < 3; ++pose) {
    EXPECT_THAT(guide->sentence(),
                HasSubstr("hold the tree still for a second, in one place after the other: "));
    push(*guide, shown(rig, pose, 100));
    EXPECT_EQ(guide->poses(), pose + 1);
  }
  push(*guide, shown(rig, 3, 100));
  ASSERT_TRUE(guide->alignment()) << guide->sentence();
  EXPECT_THAT(guide->sentence(), HasSubstr(guide->alignment()->next));
  EXPECT_THAT(guide->sentence(), HasSubstr("from 4 poses"));
  EXPECT_THAT(guide->sentence(),
              Not(HasSubstr("hold the tree still for a second, in one place after the other: ")));
}

TEST(AlignmentGuide, FindsTheRollThatACameraHas) {
  auto rig = rig_of(11);
  auto guide = *AlignmentGuide::create(shown(rig, 0, 1), rig.nominal, sides());
  for (int pose = 0; pose < 10; ++pose) push(guide, shown(rig, pose, 100));
  ASSERT_TRUE(guide.alignment());
  const auto truth = *calibration::compare_alignment(rig.nominal, rig.rig);
  for (std::size_t c = 0; c < 2; ++c)
    EXPECT_LT((guide.alignment()->cameras[c].rotation_deg - truth.cameras[c].rotation_deg).norm(), 0.3);
}

TEST(AlignmentGuide, ATreeThatStaysIsOnePose) {
  const auto rig = rig_of(12);
  auto guide = *AlignmentGuide::create(shown(rig, 0, 1), rig.nominal, sides());
  push(guide, shown(rig, 2, 500));
  EXPECT_EQ(guide.poses(), 1);
  guide.restart();
  EXPECT_EQ(guide.poses(), 0);
}

TEST(AlignmentGuide, ASecondInWhichItMovesOrIsHiddenIsNone) {
  const auto rig = rig_of(12);
  auto guide = *AlignmentGuide::create(shown(rig, 0, 1), rig.nominal, sides());
  push(guide, shown(rig, 0, 50));
  push(guide, shown(rig, 1, 50));  // elsewhere in the middle of the second
  EXPECT_EQ(guide.poses(), 0);
  auto hidden = shown(rig, 0, 100);
  hidden.flags[3] = data::kCountOccluded;
  push(guide, hidden);
  EXPECT_EQ(guide.poses(), 0);
}

TEST(AlignmentGuide, NeedsTheTreeAndTheCamerasOfTheRig) {
  const auto rig = rig_of(12);
  const auto counts = shown(rig, 0, 1);
  EXPECT_FALSE(AlignmentGuide::create(counts, rig.nominal, {0.5, 0.1, 0.1}));
  data::Rig one = rig.nominal;
  one.cameras.pop_back();
  EXPECT_THAT(AlignmentGuide::create(counts, one, sides()).error().message,
              HasSubstr("1 cameras; there are 2"));
  auto four = data::Counts::zeros({"1", "2", "3", "4"}, {"A", "B"},
                                  {.rate_hz = 100.0, .t0_s = 0.0, .frames = 0}, false);
  EXPECT_THAT(AlignmentGuide::create(four, rig.nominal, sides()).error().message,
              HasSubstr("3 LEDs; there are 4"));
}

}  // namespace
}  // namespace kinemark::workflow
