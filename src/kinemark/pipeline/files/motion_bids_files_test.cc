// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/pipeline/files/motion_bids_files.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "kinemark/io/bids/motion_bids.h"
#include "kinemark/io/file.h"
#include "support/scratch.h"

namespace kinemark::pipeline {
namespace {

using ::testing::HasSubstr;
using ::testing::SizeIs;

constexpr const char* kName = "sub-01_task-walk_tracksys-omc_motion.tsv";

data::Trial small_trial() {
  data::Trial trial;
  trial.markers = data::Trajectories::all_missing({"A"}, {.rate_hz = 100.0, .frames = 2});
  trial.markers.x(0, 0) = Eigen::Vector3d(1.0, 2.0, 3.0);
  trial.markers.state[0] = data::SampleState::measured;
  return trial;
}

TEST(MotionBidsFiles, ADataSetGrowsAndKeepsItsOwnWords) {
  const testing_support::ScratchFolder scratch;
  const auto path = scratch.path() / "study" / "sub-01" / "motion" / kName;
  const auto first = write_motion_bids(path, small_trial(), {}, {});
  ASSERT_TRUE(first) << first.error().message;
  EXPECT_THAT(*first, SizeIs(6));
  EXPECT_EQ(first->front(), path);
  ASSERT_TRUE(io::write_text(scratch.path() / "study" / "README", "mine", true));
  const auto other =
      scratch.path() / "study" / "sub-01" / "motion" / "sub-01_task-run_tracksys-omc_motion.tsv";
  const auto second = write_motion_bids(other, small_trial(), {.force = true}, {});
  ASSERT_TRUE(second) << second.error().message;
  EXPECT_THAT(*second, SizeIs(4));
  EXPECT_EQ(io::read_text(scratch.path() / "study" / "README").value(), "mine");
  EXPECT_TRUE(io::read_motion_bids(path));
  EXPECT_TRUE(io::read_motion_bids(other));
}

TEST(MotionBidsFiles, WhereOneFileIsThereNoneIsWritten) {
  const testing_support::ScratchFolder scratch;
  const auto path = scratch.path() / "sub-01" / "motion" / kName;
  std::filesystem::create_directories(path.parent_path());
  const auto channels = path.parent_path() / "sub-01_task-walk_tracksys-omc_channels.tsv";
  ASSERT_TRUE(io::write_text(channels, "mine", false));
  const auto refused = write_motion_bids(path, small_trial(), {}, {});
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().code, Code::io);
  EXPECT_THAT(refused.error().message, HasSubstr("channels.tsv"));
  EXPECT_FALSE(std::filesystem::exists(path));
  EXPECT_FALSE(std::filesystem::exists(scratch / "README"));
  EXPECT_EQ(io::read_text(channels).value(), "mine");
  EXPECT_TRUE(write_motion_bids(path, small_trial(), {.force = true}, {}));
  EXPECT_NE(io::read_text(channels).value(), "mine");
}

TEST(MotionBidsFiles, AWrongNameMakesNoFolder) {
  const testing_support::ScratchFolder scratch;
  const auto refused =
      write_motion_bids(scratch.path() / "sub-01" / "motion" / "walk.tsv", small_trial(), {}, {});
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().code, Code::usage);
  EXPECT_THAT(refused.error().message, HasSubstr("sub-LABEL[/ses-LABEL]/motion/sub-LABEL"));
  data::Trial empty;
  empty.markers = data::Trajectories::all_missing({}, {.rate_hz = 100.0, .frames = 2});
  EXPECT_FALSE(write_motion_bids(scratch.path() / "sub-01" / "motion" / kName, empty, {}, {}));
  EXPECT_EQ(scratch.count_files(), 0);
}

}  // namespace
}  // namespace kinemark::pipeline
