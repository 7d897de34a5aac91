// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/data/channels.h"

#include <gtest/gtest.h>

namespace kinemark::data {
namespace {

TEST(Channels, EachKindHasItsOwnWord) {
  EXPECT_EQ(to_string(ChannelKind::angle), "angle");
  EXPECT_EQ(to_string(ChannelKind::modeled_marker), "modeled marker");
  EXPECT_EQ(to_string(ChannelKind::other), "other");
}

TEST(Channels, NamesThatNobodyGave) {
  for (const char* name :
       {"", "*1", "*112", "*", "uname*3", "UNAME*12", "uname7", "point 12", "Anna:*4", "Anna:"})
    EXPECT_TRUE(is_unlabelled(name)) << name;
  for (const char* name : {"LASI", "*LASI", "unamed", "uname*x", "M*1", "point A", "1", "Anna:LASI"})
    EXPECT_FALSE(is_unlabelled(name)) << name;
}

TEST(Channels, NeedOneKindAndOneUnitEach) {
  Channels channels{.names = {"LKneeAngles"}, .kinds = {ChannelKind::angle}, .units = {"deg"}};
  channels.frames = 2;
  channels.values.assign(6, 0.0);
  EXPECT_TRUE(channels.validate());
  channels.units.clear();
  EXPECT_EQ(channels.validate().error().message, "1 channels have 1 kinds and 0 units; need one of each");
}

TEST(Channels, NeedThreeNumbersAFrame) {
  Channels channels{.names = {"LKneeAngles"}, .kinds = {ChannelKind::angle}, .units = {"deg"}};
  channels.frames = 2;
  channels.values.assign(2, 0.0);
  EXPECT_EQ(channels.validate().error().message, "1 channels of 2 frames hold 2 values; need 6");
}

}  // namespace
}  // namespace kinemark::data
