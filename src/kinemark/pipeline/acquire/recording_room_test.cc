// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/pipeline/acquire/recording_room.h"

#include <gmock/gmock.h>

#include <fstream>

#include "support/scratch.h"

namespace kinemark::pipeline {
namespace {

using testing::HasSubstr;

stream::GrantedPlan plan() {
  stream::GrantedPlan out;
  out.plan.rate_hz = 100.0;
  out.layout = data::Counts::zeros({"hand"}, {"A"}, {.rate_hz = 100.0}, true);
  return out;
}

TEST(CheckRoom, AsksForRoomOfTheWholeTrial) {
  const testing_support::ScratchFolder scratch;
  EXPECT_TRUE(check_room(scratch / "a.mcap", false, plan(), 0.0));
  // 10,700 bytes in a second: no disk has room for 10^15 of them.
  const auto refused = check_room(scratch / "a.mcap", false, plan(), 1e15);
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().code, Code::io);
  EXPECT_THAT(refused.error().message, HasSubstr("the disk has room for"));
  EXPECT_THAT(refused.error().message, HasSubstr("minutes of this trial"));
}

TEST(CheckRoom, AFileThatIsThereIsRefusedUnlessForced) {
  const testing_support::ScratchFolder scratch;
  std::ofstream(scratch / "a.mcap") << "mine";
  EXPECT_THAT(check_room(scratch / "a.mcap", false, plan(), 1.0).error().message,
              HasSubstr("exists already"));
  EXPECT_TRUE(check_room(scratch / "a.mcap", true, plan(), 1.0));
  std::filesystem::create_symlink(scratch / "absent", scratch / "link.mcap");
  EXPECT_FALSE(check_room(scratch / "link.mcap", false, plan(), 1.0));
}

}  // namespace
}  // namespace kinemark::pipeline
