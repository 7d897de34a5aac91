// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/data/joint_choice.h"

#include <gtest/gtest.h>

namespace kinemark::data {
namespace {

TEST(JointChoice, IsReadByTheNameItIsWrittenWith) {
  for (const auto choice : {JointChoice::automatic, JointChoice::ball, JointChoice::hinge})
    EXPECT_EQ(parse_joint_choice(to_string(choice)).value(), choice);
  EXPECT_EQ(parse_joint_choice("auto").value(), JointChoice::automatic);
}

TEST(JointChoice, UnknownNameIsAUsageErrorThatListsAll) {
  const auto choice = parse_joint_choice("saddle");
  ASSERT_FALSE(choice);
  EXPECT_EQ(choice.error().code, Code::usage);
  EXPECT_EQ(choice.error().message, "'saddle' is not a kind of joint; use auto, ball or hinge");
}

}  // namespace
}  // namespace kinemark::data
