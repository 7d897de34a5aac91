// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stream/device.h"

#include <gmock/gmock.h>

namespace kinemark::stream {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;

TEST(OwnNames, AreThoseOfTheDeviceThenNumbersAndLetters) {
  EXPECT_THAT(own_names({}, 3, false), ElementsAre("1", "2", "3"));
  EXPECT_THAT(own_names({}, 2, true), ElementsAre("A", "B"));
  EXPECT_THAT(own_names({"hand"}, 2, false), ElementsAre("hand", "2"));
  EXPECT_THAT(own_names({"hand", "wrist"}, 1, false), ElementsAre("hand"));
  EXPECT_THAT(own_names({"left"}, 0, true), IsEmpty());
  EXPECT_EQ(own_names({}, 27, true).back(), "27");
}

}  // namespace
}  // namespace kinemark::stream
