// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/pipeline/files/address_settings.h"

#include <gmock/gmock.h>

namespace kinemark::pipeline {
namespace {

using testing::HasSubstr;

TEST(AddressSettings, AreReadFromAnAddress) {
  AddressSettings s("sim:rig?leds=4&rate=99.5&scene=wheel&fast&leds=5&dark=0");
  EXPECT_EQ(s.scheme(), "sim");
  EXPECT_EQ(s.what(), "rig");
  EXPECT_EQ(s.whole("leds", 8, 1, 8), 5);
  EXPECT_EQ(s.number("rate", 0.0, 0.0, 1000.0), 99.5);
  EXPECT_EQ(s.text("scene"), "wheel");
  EXPECT_TRUE(s.flag("fast"));
  EXPECT_FALSE(s.flag("dark"));
  EXPECT_FALSE(s.flag("absent"));
  EXPECT_EQ(s.number("seconds", 7.0, 0.0, 9.0), 7.0);
  EXPECT_TRUE(s.check());
}

TEST(AddressSettings, SayWhatIsWrongFirst) {
  AddressSettings out("sim:rig?leds=9&rate=x");
  EXPECT_EQ(out.whole("leds", 8, 1, 8), 8);
  EXPECT_EQ(out.number("rate", 1.0, 0.0, 2.0), 1.0);
  EXPECT_EQ(out.check().error().message, "sim:rig?leds=9&rate=x: leds must be a number from 1 to 8");
  AddressSettings half("sim:rig?leds=1.5");
  EXPECT_EQ(half.whole("leds", 8, 1, 8), 8);
  EXPECT_THAT(half.check().error().message, HasSubstr("a whole number from 1 to 8"));
  AddressSettings flag("sim:rig?fast=perhaps");
  EXPECT_TRUE(flag.flag("fast"));
  EXPECT_FALSE(flag.check());
}

TEST(AddressSettings, NameThoseThatThereAre) {
  AddressSettings s("sim:rig?led=4");
  EXPECT_EQ(s.whole("leds", 8, 1, 8), 8);
  EXPECT_FALSE(s.flag("fast"));
  EXPECT_THAT(s.check().error().message, HasSubstr("'led' is no setting of it; those are leds, fast"));
  EXPECT_EQ(s.check().error().code, Code::usage);
}

TEST(AddressSettings, LeaveAFileItsQuestionMark) {
  AddressSettings s("replay:C:/a?b.mcap");
  EXPECT_EQ(s.scheme(), "replay");
  EXPECT_EQ(s.what(), "C:/a");
  s.take_all_as_name();
  EXPECT_EQ(s.what(), "C:/a?b.mcap");
  EXPECT_TRUE(s.check());
  EXPECT_EQ(AddressSettings("walk.c3d").scheme(), "");
}

}  // namespace
}  // namespace kinemark::pipeline
