// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/workflow/measures/regions.h"

#include <gtest/gtest.h>

namespace kinemark::workflow {
namespace {

const TimeBase kTime{.rate_hz = 100.0, .t0_s = 0.4, .frames = 400, .first_number = 41};

TEST(ParseRegion, TakesFramesOfTheFileAndSecondsOfItsClock) {
  EXPECT_EQ(parse_region("reach=120-300", kTime).value(), (data::Region{"reach", 120, 300}));
  EXPECT_EQ(parse_region("reach=0.5s-1.25s", kTime).value(), (data::Region{"reach", 51, 126}));
  EXPECT_EQ(parse_region("a=b=120-1.25s", kTime).value(), (data::Region{"a=b", 120, 126}));
  EXPECT_EQ(parse_region("before=-5-7", kTime).value(), (data::Region{"before", -5, 7}));
}

TEST(ParseRegion, RefusesWhatIsNone) {
  for (const char* text : {"", "reach", "=1-2", "reach=1", "reach=1.5-2", "reach=a-b", "reach=1s",
                           "reach=1e30-2", "reach=nan-2"}) {
    const auto region = parse_region(text, kTime);
    ASSERT_FALSE(region) << text;
    EXPECT_EQ(region.error().code, Code::usage);
    EXPECT_NE(region.error().message.find("need NAME=FIRST-LAST"), std::string::npos);
  }
}

class RegionsBetween : public ::testing::Test {
 protected:
  RegionsBetween() {
    trial_.markers.time = kTime;
    for (const double t : {2.0, 1.0, 3.1}) trial_.events.push_back({"Foot Strike", "Right", t});
    for (const double t : {1.5, 2.5}) trial_.events.push_back({"Foot Strike", "Left", t});
    trial_.events.push_back({"Foot Off", "Right", 1.6});
  }
  data::Trial trial_;
};

TEST_F(RegionsBetween, GoFromEachEventToTheNextOfItsSide) {
  const auto found = regions_between("Foot Strike", trial_);
  ASSERT_TRUE(found);
  ASSERT_EQ(found->size(), 3u);
  EXPECT_EQ((*found)[0], (data::Region{"Foot Strike Left 1", 151, 250}));
  EXPECT_EQ((*found)[1], (data::Region{"Foot Strike Right 1", 101, 200}));
  EXPECT_EQ((*found)[2], (data::Region{"Foot Strike Right 2", 201, 310}));
}

TEST_F(RegionsBetween, OfOneEventThereAreNone) {
  const auto found = regions_between("Foot Off", trial_);
  ASSERT_FALSE(found);
  EXPECT_EQ(found.error().message,
            "no two events of one side are called 'Foot Off'; the recording has Foot Strike and Foot Off");
  EXPECT_FALSE(found.error().message.contains("the recording has no events"));
  trial_.events.clear();
  EXPECT_TRUE(regions_between("Foot Off", trial_).error().message.contains("the recording has no events"));
}

TEST_F(RegionsBetween, TwoEventsInOneFrameAreOne) {
  trial_.events = {{"A", "", 1.0}, {"A", "", 1.001}, {"A", "", 2.0}};
  const auto found = regions_between("A", trial_);
  ASSERT_TRUE(found);
  ASSERT_EQ(found->size(), 1u);
  EXPECT_EQ(found->front().name, "A 1");
}

}  // namespace
}  // namespace kinemark::workflow
