// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/data/foreign_group.h"

#include <gtest/gtest.h>

namespace kinemark::data {
namespace {

TEST(ForeignName, IsUpperCaseAndFitToShow) {
  EXPECT_EQ(foreign_name("Y_Screen"), "Y_SCREEN");
  EXPECT_EQ(foreign_name(" point "), "POINT");
  EXPECT_EQ(foreign_name("a\x01z"), "A Z");
  EXPECT_EQ(foreign_name(""), "");
}

}  // namespace
}  // namespace kinemark::data
