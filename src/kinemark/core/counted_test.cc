// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/core/counted.h"

#include <gtest/gtest.h>

namespace kinemark {
namespace {

TEST(Counted, OneIsNamedInTheSingular) {
  EXPECT_EQ(counted(1, "event"), "1 event");
  EXPECT_EQ(counted(0, "event"), "0 events");
  EXPECT_EQ(counted(3, "event"), "3 events");
  EXPECT_EQ(counted(1, "group of parameters", "groups of parameters"), "1 group of parameters");
  EXPECT_EQ(counted(2, "group of parameters", "groups of parameters"), "2 groups of parameters");
}

}  // namespace
}  // namespace kinemark
